"""An ice cube: a cube whose edges and corners are rounded."""

import numpy as np

from mesh import Mesh, grid_triangles, index_rows, unit

EDGE = 0.1
"""Length of the cube's edge, in metres."""

ROUNDING = 0.014
"""Radius of the rounded edges, in metres."""

STEPS = 7
"""Steps from the end of a flat face to the middle of its edge."""


def build():
    """The ice cube, lying on y = 0."""
    half = EDGE / 2
    bend = half - ROUNDING + ROUNDING * np.tan(np.pi / 4 * np.linspace(0, 1, STEPS + 1))
    along = np.concatenate([-bend[::-1], bend])
    u, v = (grid.reshape(-1) for grid in np.meshgrid(along, along, indexing="ij"))
    grid = grid_triangles(len(along), len(along))
    points, triangles = [], []
    for axis in range(3):
        for side in (-1, 1):
            face = np.stack([np.full_like(u, half), u, v], axis=1) * (side, 1, 1)
            triangles.append(grid[:, ::side] + len(points) * len(u))
            points.append(np.roll(face, axis, axis=1))
    cube, at = index_rows(np.concatenate(points), 9)
    core = np.clip(cube, ROUNDING - half, half - ROUNDING)
    normals = unit(cube - core)
    triangles = at[np.concatenate(triangles)]
    return Mesh(core + ROUNDING * normals + (0.0, half, 0.0), triangles, normals, triangles)
