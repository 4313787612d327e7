#!/usr/bin/env python3
"""What a scene costs over its number of triangles: seconds of each phase, memory, rays a second.

    benches/race/scene_size.py [--triangles 10000,100000,1000000,10000000] [--folder FOLDER] [--plot FILE.png] [--program target/release/diacaustic]

Needs target/release/diacaustic (cargo build --release) and `pip install numpy matplotlib`. Writes a bumpy ball of glass for each number into the folder (180 MB for ten million
triangles; a temporary one that is removed, if left out), renders it over a floor under a small lamp, and prints a table in Markdown.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from glass_mesh import write_bumpy_ball

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent.parent
# What comes before the first photon, in the order of the program.
PHASES = ["load", "bvh", "maps", "upload", "pilot"]
SCENE = """
camera = {{ position = [0.9, 1.1, 1.9], look_at = [0.05, 0.3, 0], vertical_fov = 38 }}
render = {{ width = 128, height = 128, samples = 4, photons = 100_000 }}
materials.glass = {{ type = "dielectric", ior = 1.5 }}
materials.floor = {{ type = "diffuse", albedo = 0.7 }}
[[lights]]
type = "sphere"
center = [-0.6, 2.2, 0.5]
radius = 0.03
flux = 35
[[objects]]
mesh = "{mesh}"
material = "glass"
[[objects]]
rectangle = {{ center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4] }}
material = "floor"
"""


def measured(program, folder, triangles):
    """Renders a ball of about so many triangles; what the statistics say, with the peak of memory in bytes."""
    mesh, scene, stats = (folder / name for name in ("ball.ply", "scene.toml", "stats.json"))
    write_bumpy_ball(mesh, triangles)
    scene.write_text(SCENE.format(mesh=mesh.name))
    command = [program, scene, "--stats", stats, "--output", folder / f"ball-{triangles}.png", "--quiet"]
    process = subprocess.Popen([str(part) for part in command])
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(map(str, command))} failed")
    mesh.unlink()
    return {**json.loads(stats.read_text()), "peak": 1024 * usage.ru_maxrss}


def first_photon(seconds):
    """Seconds from the start of the program to the first photon that counts."""
    return seconds["total"] - seconds["photons"] - seconds["samples"] - seconds["write"]


def row(run):
    seconds, size, count = run["seconds"], run["size"], run["size"]["triangles"]
    phases = [f"{seconds[phase]:.2f}" for phase in PHASES]
    rates = [f"{run[kind]['rays_per_second'] / 1e6:.2f}" for kind in ("photons", "camera")]
    memory = [f"{size['device_bytes'] / 1e6:,.0f}", f"{run['peak'] / 1e6:,.0f}", f"{size['device_bytes'] / count:,.0f}", f"{run['peak'] / count:,.0f}"]
    return [f"{count:,}", *phases, f"{first_photon(seconds):.2f}", *memory, *rates]


def draw(runs, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    counts = [run["size"]["triangles"] for run in runs]
    figure, (time, memory, rate) = pyplot.subplots(1, 3, figsize=(12, 3.8))
    for phase in PHASES:
        time.loglog(counts, [max(run["seconds"][phase], 1e-3) for run in runs], "o-", label=phase, linewidth=1, markersize=4)
    time.loglog(counts, [first_photon(run["seconds"]) for run in runs], "ks-", label="to the first photon")
    time.set(ylabel="seconds", ylim=(5e-3, 1e3))
    memory.loglog(counts, [run["peak"] / 1e6 for run in runs], "s-", label="peak of the process")
    memory.loglog(counts, [run["size"]["device_bytes"] / 1e6 for run in runs], "o-", label="on the device")
    memory.set(ylabel="MB")
    for kind, label in (("photons", "photons"), ("camera", "camera")):
        rate.loglog(counts, [run[kind]["rays_per_second"] / 1e6 for run in runs], "o-", label=label)
    rate.set(ylabel="million rays a second", ylim=(0.1, 10))
    for panel in (time, memory, rate):
        panel.set(xlabel="triangles")
        panel.grid(True, which="both", alpha=0.2)
        panel.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=100)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--triangles", default="10000,100000,1000000,10000000")
    parser.add_argument("--folder", type=pathlib.Path)
    parser.add_argument("--plot", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, default=REPOSITORY / "target" / "release" / "diacaustic")
    arguments = parser.parse_args()
    heads = ["triangles", *(f"{phase} s" for phase in PHASES), "first photon s", "device MB", "peak MB", "device B/triangle", "peak B/triangle"]
    heads += ["photons' Mrays/s", "camera's Mrays/s"]
    print(f"| {' | '.join(heads)} |\n|{'---:|' * len(heads)}")
    runs = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.folder or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for triangles in arguments.triangles.split(","):
            runs.append(measured(arguments.program.resolve(), folder, int(triangles)))
            print(f"| {' | '.join(row(runs[-1]))} |", flush=True)
    if arguments.plot:
        draw(runs, arguments.plot)


if __name__ == "__main__":
    main()
