#!/usr/bin/env python3
"""Whether a still part of an animation's picture flickers.

    scripts/flicker.py SCENE --region X0,Y0,X1,Y1 [--frames 48] [--set KEY=VALUE]... [--keep FOLDER]      (pip install numpy OpenEXR)

Renders frames 1 to N three times with target/release/diacaustic: with the scene's seed in all of them ("fixed"), with a seed of each frame
("per_frame"), and so with every track held at its first value ("still"), which shows the noise alone. In the region, pixels from X0 to X1 and Y0 to Y1
without the last, it compares the variance over time, as mean over pixels, with the one that the layer `variance` states. Moving light that
grows or fades slowly is no flicker: the variance is that of (x[t-1] - 2 x[t] + x[t+1]) / sqrt(6), which independent noise keeps. What is left of it with
the same seed is the light that moves. Two of the frames are rendered again alone and compared byte by byte. Prints a table in Markdown; the
status is 1 if a frame differs, or if noise and moving light together do not explain the variance with a seed of each frame to a tenth.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile
import tomllib

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = REPOSITORY / "target" / "release" / "diacaustic"


def render(scene, frames, output, overrides):
    sets = [flag for override in ('output.layers=["variance"]', *overrides) for flag in ("--set", override)]
    command = [PROGRAM, scene, "--quiet", "--frames", f"{frames[0]}..{frames[1]}", "--output", output, *sets]
    subprocess.run(command, check=True)


def held(scene):
    """What keeps each track at its first value."""
    for number, track in enumerate(tomllib.loads(scene.read_text())["animation"]["tracks"]):
        key = "values" if "values" in track else "degrees"
        yield f"animation.tracks.{number}.{key}={[track[key][0]] * len(track[key])}"


def green(path, region):
    """Radiance and its stated variance in the region."""
    import numpy
    import OpenEXR

    x0, y0, x1, y1 = region
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = file.channels()
        return [numpy.asarray(channels[name].pixels, numpy.float64)[y0:y1, x0:x1] for name in ("G", "variance.G")]


def variances(folder, frames, region):
    """Means over pixels of the variance over time, of the one stated, and of the radiance."""
    import numpy

    values, stated = (numpy.array(a) for a in zip(*(green(folder / f"a.{k:04}.exr", region) for k in range(1, frames + 1))))
    flicker = (values[:-2] - 2 * values[1:-1] + values[2:]) / numpy.sqrt(6)
    return (flicker**2).mean(), stated.mean(), values.mean()


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
        print("| seeds | standard deviation over time | stated | share of the radiance |\n|---|---:|---:|---:|")
        measured = {}
        for name, overrides in runs.items():
            (folder / name).mkdir(parents=True, exist_ok=True)
            render(scene, (1, frames), folder / name / "a.exr", [*arguments.sets, *overrides])
            flicker, stated, mean = variances(folder / name, frames, arguments.region)
            measured[name] = flicker
            print(f"| {name} | {flicker ** 0.5:.2e} | {stated ** 0.5:.2e} | {flicker ** 0.5 / mean:.2%} |", flush=True)
        ratio = measured["per_frame"] / (measured["still"] + measured["fixed"])
        print(f"\nvariance per_frame / (still + fixed): {ratio:.3f}")
        same = True
        for frame in (2, frames - 1):
            render(scene, (frame, frame), folder / "alone.exr", arguments.sets)
            name = f"{frame:04}.exr"
            alone, together = ((folder / path).read_bytes() for path in (f"alone.{name}", f"fixed/a.{name}"))
            same &= alone == together
            print(f"frame {frame} alone: {'the same bytes' if alone == together else 'DIFFERS'}")
    return 0 if same and abs(ratio - 1) < 0.1 else 1


if __name__ == "__main__":
    sys.exit(main())
