"""An indexed triangle mesh, and how to index one from loose corners."""

from dataclasses import dataclass

import numpy as np


@dataclass
class Mesh:
    """A triangle mesh with positions and normals indexed apart, as in OBJ.

    positions         (n, 3) metres, y up
    triangles         (m, 3) indices into positions, counter-clockwise from outside
    normals           (k, 3) unit vectors, or None for a mesh of flat facets
    normal_triangles  (m, 3) indices into normals, or None
    """

    positions: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray | None = None
    normal_triangles: np.ndarray | None = None


def unit(vectors):
    """The vectors of the last axis, scaled to length one."""
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def facet_crosses(positions, triangles):
    """Each triangle's normal, its length twice the triangle's area."""
    a, b, c = (positions[triangles[:, corner]] for corner in range(3))
    return np.cross(b - a, c - a)


def signed_volume(positions, triangles):
    """Volume enclosed, in cubic metres; positive when the facets face outward."""
    corners = positions[triangles]
    return np.linalg.det(corners).sum() / 6.0


def index_rows(rows, decimals):
    """Distinct rows after rounding, and for each row its index among them."""
    rounded = np.round(rows, decimals) + 0.0  # "+ 0.0" turns -0.0 into 0.0
    distinct, indices = np.unique(rounded, axis=0, return_inverse=True)
    return distinct, indices.reshape(-1)


def grid_triangles(rows, columns):
    """Triangles of a grid of rows x columns points, numbered row by row."""
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    corner = (row * columns + column).reshape(-1)
    lower = np.stack([corner, corner + columns, corner + 1], axis=1)
    upper = np.stack([corner + 1, corner + columns, corner + columns + 1], axis=1)
    return np.concatenate([lower, upper])


def without_collapsed(triangles):
    """Which triangles have three distinct corners."""
    a, b, c = triangles.T
    return (a != b) & (b != c) & (c != a)
