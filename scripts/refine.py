#!/usr/bin/env python3
"""Error of the caustics of tests/scenes/reference-*.toml over the size of the floor's energy map and the number of photons.

    scripts/refine.py [--sizes 64,128,...] [--photons 1e5,...] [--plot FILE.png]      (pip install numpy OpenEXR matplotlib)

Needs target/release/diacaustic and, beside the repository, the folder shared/reference with the meshes and pictures of an independent tracer;
without them it says so and ends with status 0. Each map is read at the floor points of the brighter half of the caustic: pixels of at least the mean
of those that the reference calls the caustic, which no direct light reaches, and which indirect light makes brighter by a per cent at most. There are 8 x 8
points a pixel, so that no camera noise is measured. A square of 2 m around the caustic is all the floor there is, so that both sides' maps of the
finest size fit into bindings of 128 MiB. Each coarser map follows from the finest of the same photons without loss: a texel's bilinear weight is a
sum of those of the finer texels around it. The error is that of the reference's compare.py: the mean of min(1, (i - r)^2 / (r^2 + 0.01 mean(r)^2)). Prints a table in Markdown.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile
import tomllib

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
REFERENCE = REPOSITORY.parent / "shared" / "reference"
PROGRAM = REPOSITORY / "target" / "release" / "diacaustic"
POINTS = 8
# Direct light that a pixel of the umbra may have, against the mean of the caustic.
UMBRA = 0.001
FLOOR = "center = [0, 0, 0], edge_u = [4, 0, 0], edge_v = [0, 0, -4]"
# Share of the floor's side that there is.
PART = 0.5


def channel(path, name):
    import numpy
    import OpenEXR

    with OpenEXR.File(str(path)) as file:
        channels = file.channels()
        if name in channels:
            return numpy.asarray(channels[name].pixels, numpy.float64)
        group, index = (name.rsplit(".", 1)[0] + ".", name[-1]) if "." in name else ("", name)
        for packed in (group.rstrip(".") + suffix for suffix in ("", "RGB", "RGBA", ".RGB")):
            if packed in channels:
                return numpy.asarray(channels[packed].pixels[..., "RGB".index(index)], numpy.float64)
    raise KeyError(f"{path} has no channel {name}")


def floor_around(points):
    """A part of the floor, as a scene has it, with the middle of some points on it as its own; and where on it the points lie, 0 to 1."""
    middles = [(axis.min() + axis.max()) / 2 for axis in points]
    places = [(axis - middle) / PART + 0.5 for axis, middle in zip(points, middles)]
    assert all(axis.min() >= 0 and axis.max() <= 1 for axis in places), "the caustic is larger than that part of the floor"
    x, z = 4 * (middles[0] - 0.5), -4 * (middles[1] - 0.5)
    return f"center = [{x}, 0, {z}], edge_u = [{4 * PART}, 0, 0], edge_v = [0, 0, {-4 * PART}]", places


def halved(flux):
    """What falls on texels of twice the width, of that on an odd number of texels along each axis."""
    import numpy

    for _ in range(2):
        coarse = flux[::2].copy()
        coarse[:-1] += flux[1::2] / 2
        coarse[1:] += flux[1::2] / 2
        flux = coarse.T
    return numpy.ascontiguousarray(flux)


def run(scene, settings, folder, photons, samples, layers="false", floor=FLOOR):
    assert FLOOR in scene.read_text()
    text = scene.read_text().replace(FLOOR, floor).replace("[render]", "[render]\n" + settings).replace("../../../shared/reference", str(REFERENCE))
    copy = folder / "scene.toml"
    copy.write_text(f"{text}\n[output]\nlayers = {layers}\n")
    picture = folder / "picture.exr"
    flags = ["--photons", str(photons), "--samples", str(samples), "--output", str(picture), "--energy-maps", str(folder)]
    subprocess.run([PROGRAM, copy, *flags], check=True, capture_output=True)
    return picture


def floor_points(scene):
    """For each pixel and each of POINTS x POINTS points in it, the place on the floor's rectangle, 0 to 1."""
    import numpy

    def unit(v):
        return v / numpy.linalg.norm(v)

    camera, render = scene["camera"], scene["render"]
    position, look_at = numpy.array(camera["position"], float), numpy.array(camera["look_at"], float)
    forward = unit(look_at - position)
    right = unit(numpy.cross(forward, [0.0, 1.0, 0.0]))
    up = numpy.cross(right, forward)
    half = numpy.tan(numpy.radians(camera["vertical_fov"]) / 2)
    width, height = render["width"], render["height"]
    offsets = (numpy.arange(POINTS) + 0.5) / POINTS
    x = (2 * (numpy.arange(width)[:, None] + offsets).ravel() / width - 1) * half * width / height
    y = (1 - 2 * (numpy.arange(height)[:, None] + offsets).ravel() / height) * half
    rays = forward + x[None, :, None] * right + y[:, None, None] * up
    floor = next(o for o in scene["objects"] if o["name"] == "floor")["rectangle"]
    t = (floor["center"][1] - position[1]) / numpy.minimum(rays[..., 1], -1e-9)
    points = position + t[..., None] * rays - floor["center"]
    edges = [numpy.array(floor[edge], float) for edge in ("edge_u", "edge_v")]
    return [points @ edge / (edge @ edge) + 0.5 for edge in edges]


def bilinear(texels, u, v):
    import numpy

    height, width = texels.shape
    x, y = u * (width - 1), v * (height - 1)
    i, j = (numpy.clip(numpy.floor(a).astype(int), 0, n - 2) for a, n in ((x, width), (y, height)))
    f, g = x - i, y - j
    row = lambda j: texels[j, i] * (1 - f) + texels[j, i + 1] * f
    return row(j) * (1 - g) + row(j + 1) * g


def errors(name, sizes, counts):
    """The squared relative error for each size and number of photons."""
    import numpy

    path = REPOSITORY / "tests" / "scenes" / f"reference-{name}.toml"
    scene = tomllib.loads(path.read_text())
    albedo = scene["materials"]["floor"]["albedo"]
    picture = REFERENCE / f"{name}.exr"
    reference, mask = channel(picture, "radiance"), channel(picture, "caustic_mask") > 0.5
    table = {}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        run(path, "map_size = 64\nmax_bounces = 0\nmap_filter = false", folder, 1000, 32, '["direct"]')
        direct = channel(folder / "picture.exr", "direct.G")
        mean = reference[mask].mean()
        mask &= (direct <= UMBRA * mean) & (reference >= mean)
        direct = direct[mask]
        u, v = (a.reshape(mask.shape[0], POINTS, mask.shape[1], POINTS).swapaxes(1, 2)[mask] for a in floor_points(scene))
        r = reference[mask]
        floor, (u, v) = floor_around((u, v))
        for photons in counts:
            cells = int(sizes[-1] * PART)
            run(path, f"map_size = {cells + 1}\nmax_bounces = 0\nmap_filter = false", folder, photons, 1, floor=floor)
            areas = numpy.ones((cells + 1, cells + 1))
            for border in (areas[0], areas[-1], areas[:, 0], areas[:, -1]):
                border /= 2
            flux = channel(folder / "floor.exr", "G") * areas
            for size in reversed(sizes):
                while cells > size * PART:
                    cells, flux, areas = cells // 2, halved(flux), halved(areas)
                seen = direct + albedo / numpy.pi * bilinear(flux / areas, u, v).mean((1, 2))
                error = (seen - r) ** 2 / (r**2 + 0.01 * r.mean() ** 2)
                table[size, photons] = float(numpy.minimum(error, 1).mean())
                print(f"{name}: {size} texels, {photons} photons: {table[size, photons]:.2e}", file=sys.stderr, flush=True)
    return table


def plot(tables, sizes, counts, path):
    import matplotlib

    matplotlib.use("svg" if path.endswith(".svg") else "agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, len(tables), figsize=(4.5 * len(tables), 3.6), sharey=True)
    for axis, (name, table) in zip(axes, tables.items()):
        for photons in counts:
            axis.loglog(sizes, [table[size, photons] for size in sizes], marker="o", label=f"{photons:,} photons")
        first = sizes[0]
        axis.loglog(sizes[:3], [table[first, counts[-1]] * (first / size) ** 4 for size in sizes[:3]], "k:", label="bias²: h⁴")
        last = sizes[-3:]
        axis.loglog(last, [table[last[-1], counts[0]] * (size / last[-1]) ** 2 for size in last], "k--", label="variance: 1/h²")
        axis.set(title=name, xlabel="texels along the floor of 4 m", xticks=sizes, xticklabels=sizes)
        axis.minorticks_off()
    axes[0].set_ylabel("squared relative error of the caustic")
    axes[0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=100)


def main():
    numbers = lambda text: [int(float(number)) for number in text.split(",")]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=numbers, default=[64, 128, 256, 512, 1024, 2048, 4096], help="powers of two, ascending")
    parser.add_argument("--photons", type=numbers, default=[100_000, 1_000_000, 10_000_000])
    parser.add_argument("--plot")
    arguments = parser.parse_args()
    missing = [path for path in (PROGRAM, REFERENCE / "ball.exr") if not path.exists()]
    if missing:
        print(f"skipped: there is no {missing[0]}")
        return 0
    sizes, counts = arguments.sizes, arguments.photons
    tables = {name: errors(name, sizes, counts) for name in ("ball", "teapot")}
    print("| scene | photons |" + "".join(f" {size}² |" for size in sizes))
    print("|---" * (2 + len(sizes)) + "|")
    for name, table in tables.items():
        for photons in counts:
            print(f"| {name} | {photons:,} |" + "".join(f" {table[size, photons]:.1e} |" for size in sizes))
    if arguments.plot:
        plot(tables, sizes, counts, arguments.plot)
    return 0


if __name__ == "__main__":
    sys.exit(main())
