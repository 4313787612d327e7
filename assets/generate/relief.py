"""Heights over a square whose opposite edges fit, and their normal maps."""

import numpy as np

import png


def normals(heights):
    """A normal map of heights, which are in sides of the square: red along u, green along v, blue outward."""
    size = len(heights)
    along_u = (np.roll(heights, -1, axis=1) - np.roll(heights, 1, axis=1)) * size / 2
    along_v = (np.roll(heights, 1, axis=0) - np.roll(heights, -1, axis=0)) * size / 2
    normal = np.stack([-along_u, -along_v, np.ones_like(heights)], axis=2)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    return png.share(0.5 + 0.5 * normal)


def waves(u, v, seed, count=24, highest=6):
    """Waves of several directions that fit edge to edge, from about -1 to 1."""
    random = np.random.Generator(np.random.PCG64(seed))
    turns = random.integers(-highest, highest + 1, (count, 2))
    phases = random.random(count)
    total = np.zeros_like(u)
    for (along_u, along_v), phase in zip(turns, phases):
        strength = 1 / (1 + np.hypot(along_u, along_v))
        total += strength * np.cos(2 * np.pi * (along_u * u + along_v * v + phase))
    return total / np.abs(total).max()
