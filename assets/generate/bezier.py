"""Cubic Bézier curves and bicubic patches: points, derivatives, normals."""

import numpy as np

from mesh import unit

POLE_NUDGE = 1e-6
"""How far, in parameter, a normal is taken from a patch's edge: a collapsed edge has none."""


def weights(t):
    """The four Bernstein weights at each parameter: (len(t), 4)."""
    s = 1.0 - t
    return np.stack([s**3, 3 * s**2 * t, 3 * s * t**2, t**3], axis=1)


def slopes(t):
    """Derivatives of the Bernstein weights at each parameter: (len(t), 4)."""
    s = 1.0 - t
    return np.stack([-3 * s**2, 3 * s**2 - 6 * s * t, 6 * s * t - 3 * t**2, 3 * t**2], axis=1)


def patch_points(patch, u, v):
    """Points of a (4, 4, 3) patch on the grid u x v: (len(u), len(v), 3)."""
    return np.einsum("ui,vj,ijk->uvk", weights(u), weights(v), patch)


def patch_normals(patch, u, v):
    """Unit normals of a (4, 4, 3) patch, along d/du x d/dv, on the grid u x v."""
    u = np.clip(u, POLE_NUDGE, 1.0 - POLE_NUDGE)
    v = np.clip(v, POLE_NUDGE, 1.0 - POLE_NUDGE)
    along_u = np.einsum("ui,vj,ijk->uvk", slopes(u), weights(v), patch)
    along_v = np.einsum("ui,vj,ijk->uvk", weights(u), slopes(v), patch)
    return unit(np.cross(along_u, along_v))


def ruled_patch(start, end):
    """The (4, 4, 3) patch of straight lines from one control row to another."""
    steps = np.linspace(0.0, 1.0, 4)[:, None, None]
    return (1.0 - steps) * np.asarray(start) + steps * np.asarray(end)
