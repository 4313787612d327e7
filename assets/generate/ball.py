"""A glass ball: an icosahedron, subdivided and blown up onto the sphere."""

import numpy as np

from mesh import Mesh, unit

RADIUS = 0.3
"""Radius of the ball, in metres."""

SUBDIVISIONS = 5
"""Times that every triangle is split in four: 20 * 4**5 = 20480 triangles."""


def icosahedron():
    """The twelve unit vertices and twenty outward triangles of an icosahedron."""
    golden = (1 + 5**0.5) / 2
    vertices = [(0, a, b * golden) for a in (-1, 1) for b in (-1, 1)]
    vertices = unit(np.array([np.roll(vertex, turn) for turn in range(3) for vertex in vertices]))
    edge = 2 / np.sqrt(1 + golden**2)
    near = np.linalg.norm(vertices[:, None] - vertices[None], axis=2) < 1.01 * edge
    triangles = []
    for a in range(12):
        for b in range(a + 1, 12):
            for c in range(b + 1, 12):
                if near[a, b] and near[b, c] and near[c, a]:
                    outward = np.linalg.det(vertices[[a, b, c]]) > 0
                    triangles.append((a, b, c) if outward else (a, c, b))
    return vertices, np.array(triangles)


def subdivide(vertices, triangles):
    """Each triangle split in four at its edges' middles, which are put on the unit sphere."""
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    distinct, edge_at = np.unique(edges, axis=0, return_inverse=True)
    middles = unit(vertices[distinct].sum(axis=1))
    ab, bc, ca = (edge_at.reshape(-1, 3) + len(vertices)).T
    a, b, c = triangles.T
    split = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return np.concatenate([vertices, middles]), np.concatenate([np.stack(t, axis=1) for t in split])


def build():
    """The ball, resting on y = 0, with the sphere's own normals."""
    directions, triangles = icosahedron()
    for _ in range(SUBDIVISIONS):
        directions, triangles = subdivide(directions, triangles)
    positions = RADIUS * (directions + (0.0, 1.0, 0.0))
    return Mesh(positions, triangles, directions, triangles)
