"""A bent tube, such as a neon sign's: a closed ring of round cross-section."""

import numpy as np

from mesh import Mesh, grid_triangles, index_rows

RADIUS = 0.2
"""Radius of the tube's middle line, in metres."""

THICKNESS = 0.02
"""Radius of its cross-section, in metres."""

AROUND = 64
ACROSS = 16


def build():
    """The ring, lying on y = 0."""
    turn = 2 * np.pi * np.arange(AROUND + 1)[:, None] / AROUND
    tilt = 2 * np.pi * np.arange(ACROSS + 1) / ACROSS
    normals = np.stack(
        [np.cos(tilt) * np.cos(turn), np.sin(tilt) + 0 * turn, -np.cos(tilt) * np.sin(turn)], axis=2
    ).reshape(-1, 3)
    middle = np.stack([np.cos(turn), 0 * turn, -np.sin(turn)], axis=2) + 0 * tilt[:, None]
    positions = RADIUS * middle.reshape(-1, 3) + THICKNESS * (normals + (0.0, 1.0, 0.0))
    distinct, at = index_rows(positions, 9)
    distinct_normals, normal_at = index_rows(normals, 9)
    grid = grid_triangles(AROUND + 1, ACROSS + 1)
    return Mesh(distinct, at[grid], distinct_normals, normal_at[grid])
