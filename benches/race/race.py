#!/usr/bin/env python3
"""Error over time of diacaustic and of other renderers, on the same scenes, in one run.

    benches/race/race.py [--scenes teapot,crystal,ball,rough,large-lamp,sun,sky] [--renderers diacaustic,pov-ray,mitsuba] [--targets 0.6,0.3] [--folder target/race] [--plot FILE.png]
                        [--quick]

Needs target/release/diacaustic (cargo build --release) and `pip install numpy OpenEXR matplotlib`; takes part whatever else is there of POV-Ray
(`apt-get install povray`) and Mitsuba (`pip install mitsuba`), and says what is not. References are long renders of diacaustic, made once and kept in the folder; where
../shared/reference lies beside the repository, its pictures are rendered and compared too, which checks the long renders' settings. Prints a table in Markdown: wall and
processor seconds of whole processes, with every cache of kernels warm, and the relative squared errors of the caustic's and the floor's pixels.
"""
import argparse
import functools
import pathlib
import sys

import others
from scoring import Reference, read_rgb
from timing import timed

HERE = pathlib.Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
PROGRAM = REPOSITORY / "target" / "release" / "diacaustic"
SHARED = REPOSITORY.parent / "shared" / "reference"
# Samples and photons of a reference, and what makes its layers.
LONG = ["--samples", "128", "--photons", "20000000", "--set", "render.footprints=false", "--set", "output.layers=true"]
TARGETS = "0.6,0.3,0.2,0.1,0.05"


def diacaustic(targets, scene, folder, quick):
    """Renders that choose their photons and samples, for one target error after the other."""
    picture = folder / "diacaustic.exr"
    for target in targets[:3] if quick else targets:
        command = [PROGRAM, scene, "--target-error", target, "--set", "render.footprints=true", "--quiet", "--output", picture]
        yield f"target error {target}", timed(command), read_rgb(picture)


def references(names, folder, quick):
    for name in names:
        picture = folder / f"{name}.reference.exr"
        if not picture.exists():
            print(f"making the reference of {name}: minutes", file=sys.stderr)
            long = LONG if not quick else ["--samples", "16", "--photons", "2000000", *LONG[4:]]
            unfinished = folder / f"{name}.unfinished.exr"
            timed([PROGRAM, HERE / "scenes" / f"{name}.toml", *long, "--quiet", "--output", unfinished])
            unfinished.rename(picture)
        yield name, Reference.of_layers(picture)


def check_against_shared(scenes, folder):
    """The long render's settings on the shared scenes, as far as they are raced, against their pictures."""
    if not SHARED.is_dir():
        print(f"{SHARED} is not there: the references are not checked against it", file=sys.stderr)
        return
    for name in {"teapot", "ball"}.intersection(scenes):
        picture = folder / f"shared-{name}.exr"
        if not picture.exists():
            text = (REPOSITORY / "tests" / "scenes" / f"reference-{name}.toml").read_text()
            copy = folder / f"shared-{name}.toml"
            copy.write_text(text.replace("../../../shared/reference", str(SHARED)))
            timed([PROGRAM, copy, *LONG[:6], "--quiet", "--output", picture])
        caustic, floor = Reference.of_shared(SHARED / f"{name}.exr").errors(read_rgb(picture))
        print(f"{name} of ../shared/reference, by the references' settings: caustic {caustic:.1e}, floor {floor:.1e}", file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", default="teapot,crystal,ball,rough,large-lamp,sun,sky")
    parser.add_argument("--renderers", default="diacaustic,pov-ray,mitsuba")
    parser.add_argument("--targets", default=TARGETS, help="target errors of diacaustic")
    parser.add_argument("--folder", type=pathlib.Path, default=REPOSITORY / "target" / "race")
    parser.add_argument("--plot", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="short ladders and poor references, to try the script")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    racers = {"diacaustic": functools.partial(diacaustic, arguments.targets.split(",")), **others.available()}
    chosen = [name for name in arguments.renderers.split(",") if name in racers]
    for name in set(arguments.renderers.split(",")) - set(chosen):
        print(f"{name} is not installed and does not take part", file=sys.stderr)
    if not arguments.quick:
        check_against_shared(arguments.scenes.split(","), arguments.folder)
    rows = []
    print("| scene | renderer | setting | wall s | processor s | caustic | floor | caustic's energy |\n|---|---|---|---:|---:|---:|---:|---:|")
    for scene, reference in references(arguments.scenes.split(","), arguments.folder, arguments.quick):
        for renderer in chosen:
            race = racers[renderer]
            # Once without counting: kernels are compiled and cached.
            warm = True
            for setting, time, picture in race(HERE / "scenes" / f"{scene}.toml", arguments.folder, arguments.quick):
                if warm:
                    warm = False
                    setting, time, picture = next(race(HERE / "scenes" / f"{scene}.toml", arguments.folder, arguments.quick))
                picture = reference.exposed(picture) if renderer in others.UNCALIBRATED else picture
                caustic, floor = reference.errors(picture)
                energy = reference.energy(picture)
                rows.append((scene, renderer, setting, time, caustic, floor))
                print(f"| {scene} | {renderer} | {setting} | {time.wall:.2f} | {time.processor:.2f} | {caustic:.2g} | {floor:.2g} | {energy:.3f} |", flush=True)
    if arguments.plot:
        from plot import draw

        draw(rows, arguments.plot)
    return 0


if __name__ == "__main__":
    sys.exit(main())
