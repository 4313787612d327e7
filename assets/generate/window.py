"""A stained-glass window: a rose of twelve petals in lead, as the share of light that passes."""

import numpy as np

import png
from tiles import places

LEAD = 0.012
"""Half the width of the lead between panes, in sides of the picture."""

PETALS = 12
RINGS = (0.10, 0.27, 0.44)
"""Radii of the rings of lead."""

CORE = np.array([0.98, 0.80, 0.12])
INNER = (np.array([0.92, 0.10, 0.08]), np.array([0.95, 0.42, 0.06]))
OUTER = (np.array([0.08, 0.20, 0.90]), np.array([0.06, 0.62, 0.30]))
FRAME = np.array([0.42, 0.12, 0.60])
"""Linear tints."""


def build():
    """The tints."""
    u, v = places()
    radius, turn = np.hypot(u - 0.5, v - 0.5), np.arctan2(v - 0.5, u - 0.5) / (2 * np.pi)
    petal = np.floor(turn * PETALS).astype(int) % 2
    half = np.floor(turn * PETALS + 0.5).astype(int) % 2
    tint = np.broadcast_to(FRAME, (*u.shape, 3))
    for ring, colors, which in ((RINGS[2], OUTER, half), (RINGS[1], INNER, petal)):
        tint = np.where((radius < ring)[:, :, None], np.array(colors)[which], tint)
    tint = np.where((radius < RINGS[0])[:, :, None], CORE, tint)
    return png.srgb(np.where(lead(u, v, radius, turn)[:, :, None], 0.0, tint))


def lead(u, v, radius, turn):
    """Where there is lead: rings, spokes, and the frame about them."""
    is_lead = np.any([np.abs(radius - ring) < LEAD for ring in RINGS], axis=0)
    for start, end, shift in ((0, 1, 0.0), (1, 2, 0.5)):
        beside = np.abs((turn * PETALS + shift + 0.5) % 1 - 0.5) * radius * 2 * np.pi / PETALS
        is_lead |= (radius > RINGS[start]) & (radius < RINGS[end]) & (beside < 0.6 * LEAD)
    from_edge = np.minimum(0.5 - np.abs(u - 0.5), 0.5 - np.abs(v - 0.5))
    return is_lead | (from_edge < 1.5 * LEAD)
