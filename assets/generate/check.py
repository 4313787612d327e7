"""Check the written meshes: closed, one piece, facing outward, with sound normals; panoramas and textures.

    python assets/generate/check.py

prints one line for each file and leaves with status 1 if any fails.
"""

import sys
from pathlib import Path

import numpy as np

import drink
import hdr
import obj
import png
from mesh import facet_crosses, index_rows, signed_volume

ASSETS = Path(__file__).resolve().parent.parent
MESHES = ASSETS / "meshes"
PANORAMAS = ASSETS / "environments"
TEXTURES = ASSETS / "textures"

LEAST_HEIGHT = 2e-6
"""The least height of a triangle over its longest edge, in metres."""

WIDEST_NORMAL = 60.0
"""The most that a corner's normal may lean from its facet's, in degrees."""

MOST_BYTES = 4_000_000

EXPECTED = {
    "teapot": {"genus": 1, "triangles": (30_000, 60_000), "size": (1.0, 0.49, 0.62)},
    "crystal": {"genus": 0, "triangles": (100, 300), "size": (0.6, 0.367, 0.6)},
    "ball": {"genus": 0, "triangles": (20_480, 20_480), "size": (0.6, 0.6, 0.6)},
    "wine-glass": {"genus": 0, "triangles": (25_000, 40_000), "size": (0.34, 0.8, 0.34)},
    "tumbler": {"genus": 0, "triangles": (15_000, 30_000), "size": (0.316, 0.42, 0.316)},
    "drink": {
        "genus": 0,
        "triangles": (5_000, 30_000),
        "size": (0.285, 0.269, 0.285),
        "bottom": drink.FLOOR - drink.OVERLAP,
    },
    "ice-cube": {"genus": 0, "triangles": (1_000, 5_000), "size": (0.1, 0.1, 0.1)},
    "ring": {"genus": 1, "triangles": (5_000, 30_000), "size": (0.6, 0.12, 0.6)},
    "tube": {"genus": 1, "triangles": (1_000, 5_000), "size": (0.44, 0.04, 0.44)},
}
"""Handles, range of triangle counts, size along x, y, z in metres (to 1 cm), and height of the lowest point."""

PANORAMA_TEXELS = (64, 128)

BRIGHTEST = 100.0
"""The most radiance of a panorama's texel, W/(m² sr): smaller lights belong into the scene file."""

TEXTURE_TEXELS = (256, 256)

MOST_TEXTURE_BYTES = 100_000

HEADINGS = (
    "mesh",
    "triangles",
    "vertices",
    "genus",
    "size x y z, m",
    "volume, m3",
    "least h",
    "lean",
    "MB",
    "verdict",
)
COLUMNS = "{:<11} {:>9} {:>8} {:>5} {:>17} {:>10} {:>8} {:>5} {:>5}  {}"


def unpaired_edges(triangles):
    """How many directed edges lack their one opposite: 0 for a closed oriented surface."""
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    count = triangles.max() + 1
    forward, times = np.unique(edges[:, 0] * count + edges[:, 1], return_counts=True)
    backward = np.unique(edges[:, 1] * count + edges[:, 0])
    return int((times > 1).sum() + len(np.setxor1d(forward, backward)))


def pinched_vertices(triangles):
    """How many vertices touch more than one fan of triangles: 0 for a 2-manifold."""
    spokes = {}
    for triangle in triangles.tolist():
        for corner in range(3):
            a, b, c = (triangle[(corner + side) % 3] for side in range(3))
            spokes.setdefault(a, {})[b] = c
    pinched = 0
    for after in spokes.values():
        start = here = next(iter(after))
        length = 0
        while length < len(after) and here in after:
            here, length = after[here], length + 1
            if here == start:
                break
        pinched += length != len(after)
    return pinched


def pieces(triangles):
    """How many connected pieces the surface has."""
    label = np.arange(triangles.max() + 1)
    while True:
        least = label[triangles].min(axis=1)
        lower = label.copy()
        np.minimum.at(lower, triangles.reshape(-1), np.repeat(least, 3))
        lower = lower[lower]
        if np.array_equal(lower, label):
            return len(np.unique(label[triangles]))
        label = lower


def genus(triangles):
    """Handles of a closed surface in one piece, from Euler's V - E + F = 2 - 2g."""
    vertices, edges, faces = len(np.unique(triangles)), len(triangles) * 3 // 2, len(triangles)
    return (2 - (vertices - edges + faces)) // 2


def least_height(positions, triangles):
    """The least height of any triangle over its longest edge, in metres."""
    corners = positions[triangles]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    return (np.linalg.norm(facet_crosses(positions, triangles), axis=1) / longest).min()


def widest_normal(mesh):
    """The most any corner's normal leans from its facet's, in degrees."""
    crosses = facet_crosses(mesh.positions, mesh.triangles)
    facets = crosses / np.linalg.norm(crosses, axis=1, keepdims=True)
    cosines = np.einsum("tcx,tx->tc", mesh.normals[mesh.normal_triangles], facets)
    return np.degrees(np.arccos(np.clip(cosines.min(), -1, 1)))


def normal_faults(mesh):
    """What is wrong with the mesh's normals, if it has any."""
    if mesh.normals is None:
        return
    lengths = np.linalg.norm(mesh.normals, axis=1)
    if np.abs(lengths - 1).max() > 2e-5:
        yield "a normal is not of unit length"
    if (widest := widest_normal(mesh)) > WIDEST_NORMAL:
        yield f"a normal leans {widest:.0f} degrees from its facet"


def faults(mesh, triangles, expected):
    """What is wrong with a mesh; triangles index its welded positions."""
    if (unpaired := unpaired_edges(triangles)) > 0:
        yield f"{unpaired} edges are not shared by two triangles running opposite ways"
    elif (pinched := pinched_vertices(triangles)) > 0:
        yield f"{pinched} vertices join separate fans"
    if (count := pieces(triangles)) != 1:
        yield f"{count} pieces"
    if (found := genus(triangles)) != expected["genus"]:
        yield f"genus {found}, not {expected['genus']}"
    if signed_volume(mesh.positions, mesh.triangles) <= 0:
        yield "it is inside out"
    if (height := least_height(mesh.positions, mesh.triangles)) < LEAST_HEIGHT:
        yield f"a triangle is {height:.1e} m high"
    fewest, most = expected["triangles"]
    if not fewest <= len(triangles) <= most:
        yield f"{len(triangles)} triangles, not {fewest} to {most}"
    size = np.ptp(mesh.positions, axis=0)
    if np.abs(size - expected["size"]).max() > 0.01:
        yield f"its size is {size.round(3)}"
    if abs(mesh.positions[:, 1].min() - (bottom := expected.get("bottom", 0.0))) > 1e-9:
        yield f"it does not stand on y = {bottom:g}"
    yield from normal_faults(mesh)


def check_file(name):
    """Print a mesh's figures and faults; true if it has none."""
    path = MESHES / f"{name}.obj"
    mesh = obj.read(path)
    _, welded = index_rows(mesh.positions, obj.POSITION_DECIMALS)
    triangles = welded[mesh.triangles]
    found = list(faults(mesh, triangles, EXPECTED[name]))
    if path.stat().st_size > MOST_BYTES:
        found.append("the file is too large")
    print(
        COLUMNS.format(
            name,
            len(triangles),
            len(np.unique(triangles)),
            genus(triangles),
            " ".join(f"{length:.3f}" for length in np.ptp(mesh.positions, axis=0)),
            f"{signed_volume(mesh.positions, mesh.triangles):.5f}",
            f"{least_height(mesh.positions, mesh.triangles):.1e}",
            "flat" if mesh.normals is None else f"{widest_normal(mesh):.1f}",
            f"{path.stat().st_size / 1e6:.2f}",
            "; ".join(found) or "ok",
        )
    )
    return not found


def check_panorama(path):
    """Print a panorama's figures and faults; true if it has none."""
    pixels = hdr.read(path)
    found = []
    if pixels.shape != (*PANORAMA_TEXELS, 3):
        found.append(f"its shape is {pixels.shape}")
    if not (pixels.min() > 0 and pixels.max() < BRIGHTEST):
        found.append(f"its radiance goes from {pixels.min():g} to {pixels.max():g}")
    height, width, _ = pixels.shape
    brightest = ", ".join(f"{channel:.2f}" for channel in pixels.max(axis=(0, 1)))
    print(f"{path.stem}: {width} x {height} texels, radiance up to {brightest}; {'; '.join(found) or 'ok'}")
    return not found


def check_texture(path):
    """Print a texture's figures and faults; true if it has none."""
    pixels = png.read(path)
    found = []
    if pixels.shape[:2] != TEXTURE_TEXELS:
        found.append(f"its shape is {pixels.shape}")
    if np.ptp(pixels) == 0:
        found.append("it is empty")
    if (size := path.stat().st_size) > MOST_TEXTURE_BYTES:
        found.append("the file is too large")
    height, width, channels = pixels.shape
    figures = f"{width} x {height} texels, {channels} channels, {size / 1e3:.0f} kB"
    print(f"{path.stem}: {figures}; {'; '.join(found) or 'ok'}")
    return not found


def main():
    """Check every mesh, panorama and texture; the exit status."""
    print(COLUMNS.format(*HEADINGS))
    sound = [check_file(name) for name in EXPECTED]
    sound += [check_panorama(path) for path in sorted(PANORAMAS.glob("*.hdr"))]
    sound += [check_texture(path) for path in sorted(TEXTURES.glob("*.png"))]
    return 0 if all(sound) else 1


if __name__ == "__main__":
    sys.exit(main())
