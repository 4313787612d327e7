#!/usr/bin/env python3
"""Whether a still part of an animation's picture flickers.

    scripts/flicker.py SCENE --region X0,Y0,X1,Y1 [--frames 48] [--set KEY=VALUE]... [--keep FOLDER]      (pip install numpy OpenEXR)

Renders frames 1 to N three times with target/release/diacaustic: with the scene's seed in all of them ("fixed"), with a seed of each frame
("per_frame"), and so with every track held at its first value ("still"), which shows the noise alone. The region is of pixels from X0 to X1 and Y0
to Y1, without the last. A row of the table has the standard deviation over time, as root of the mean over pixels, of direct light (the layer
`direct`), of all light, and the one that the layer `variance` states. Light that grows or fades slowly is no flicker: the deviation is that
of (x[t-1] - 2 x[t] + x[t+1]) / sqrt(6), which independent noise keeps. Two frames are rendered again alone and compared byte by byte.

The status is 1 if a frame differs, if direct light varies with a fixed seed by more than with seeds of each frame, or if its variance with these
is not that of the still scene to a tenth: choose a region whose direct light stands still.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile
import tomllib

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = REPOSITORY / "target" / "release" / "diacaustic"
CHANNELS = ("direct.G", "G", "variance.G")


def render(scene, frames, output, overrides):
    sets = [flag for override in ('output.layers=["direct", "variance"]', *overrides) for flag in ("--set", override)]
    command = [PROGRAM, scene, "--quiet", "--frames", f"{frames[0]}..{frames[1]}", "--output", output, *sets]
    subprocess.run(command, check=True)


def held(scene):
    """What keeps each track at its first value."""
    for number, track in enumerate(tomllib.loads(scene.read_text())["animation"]["tracks"]):
        key = "values" if "values" in track else "degrees"
        yield f"animation.tracks.{number}.{key}={[track[key][0]] * len(track[key])}"


def channels(path, region):
    """The region's direct light, all light, and the variance stated of it; green."""
    import numpy
    import OpenEXR

    x0, y0, x1, y1 = region
    with OpenEXR.File(str(path), separate_channels=True) as file:
        found = file.channels()
        return [numpy.asarray(found[name].pixels, numpy.float64)[y0:y1, x0:x1] for name in CHANNELS]


def deviations(folder, frames, region):
    """Of direct light over time, of all light, and as stated; the mean of all light."""
    import numpy

    direct, light, stated = map(numpy.array, zip(*(channels(folder / f"a.{k:04}.exr", region) for k in range(1, frames + 1))))
    over_time = lambda x: (((x[:-2] - 2 * x[1:-1] + x[2:]) / numpy.sqrt(6)) ** 2).mean() ** 0.5
    return over_time(direct), over_time(light), stated.mean() ** 0.5, light.mean()


def main():
    numbers = lambda text: [int(number) for number in text.split(",")]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--region", type=numbers, required=True)
    parser.add_argument("--frames", type=int, default=48)
    parser.add_argument("--set", action="append", default=[], dest="sets", metavar="KEY=VALUE")
    parser.add_argument("--keep")
    arguments = parser.parse_args()
    scene, frames = arguments.scene, arguments.frames
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(arguments.keep or temporary)
        per_frame = 'animation.seed="per_frame"'
        runs = {"fixed": [], "per_frame": [per_frame], "still": [per_frame, *held(scene)]}
        print("| seeds | direct light | all light | stated | all light, share of its mean |\n|---|---:|---:|---:|---:|")
        direct = {}
        for name, overrides in runs.items():
            (folder / name).mkdir(parents=True, exist_ok=True)
            render(scene, (1, frames), folder / name / "a.exr", [*arguments.sets, *overrides])
            direct[name], light, stated, mean = deviations(folder / name, frames, arguments.region)
            print(f"| {name} | {direct[name]:.2e} | {light:.2e} | {stated:.2e} | {light / mean:.2%} |", flush=True)
        ratio = (direct["per_frame"] / direct["still"]) ** 2
        print(f"\nvariance of direct light, per_frame / still: {ratio:.3f}")
        same = True
        for frame in (2, frames - 1):
            render(scene, (frame, frame), folder / "alone.exr", arguments.sets)
            name = f"{frame:04}.exr"
            alone, together = ((folder / path).read_bytes() for path in (f"alone.{name}", f"fixed/a.{name}"))
            same &= alone == together
            print(f"frame {frame} alone: {'the same bytes' if alone == together else 'DIFFERS'}")
    return 0 if same and abs(ratio - 1) < 0.1 and direct["fixed"] < direct["per_frame"] else 1


if __name__ == "__main__":
    sys.exit(main())
