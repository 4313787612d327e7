"""An upright prism on an equilateral triangle, its apex edge toward +z, standing on y = 0."""

import numpy as np

from mesh import Mesh

SIDE = 0.30
"""Edge of the triangle, in metres."""

HEIGHT = 0.30
"""Length of the prism, in metres."""


def build():
    inner = SIDE / np.sqrt(12.0)
    section = [(-SIDE / 2, -inner), (SIDE / 2, -inner), (0.0, 2 * inner)]
    points = np.array([(x, y, z) for y in (0.0, HEIGHT) for x, z in section])
    sides = [t for a, b in ((0, 1), (1, 2), (2, 0)) for t in ((a, b + 3, b), (a, a + 3, b + 3))]
    triangles = np.array([(0, 1, 2), (3, 5, 4), *sides])
    return Mesh(points, triangles)
