"""A glowing sign: a cup with steam in a ring, drawn in light."""

import numpy as np

import png
from tiles import places

AMBER = np.array([1.0, 0.42, 0.08])
TEAL = np.array([0.10, 0.85, 0.80])
"""Linear light, 1 at most."""

TUBE = 0.016
"""Half the width of a lit tube, in sides of the picture."""


def glow(distance):
    """A tube's light at a distance from its middle."""
    return np.clip(1.6 - distance / TUBE, 0, 1) + 0.12 * np.exp(-((distance / 0.06) ** 2))


def build():
    """The light."""
    u, v = places()
    ring = np.abs(np.hypot(u - 0.5, v - 0.5) - 0.44)
    light = glow(ring)[:, :, None] * TEAL + glow(cup(u, v))[:, :, None] * AMBER
    for column in (0.38, 0.50, 0.62):
        steam = np.abs(u - column - 0.025 * np.sin(2 * np.pi * (v - 0.58) / 0.16))
        beyond = np.maximum(0, np.abs(v - 0.68) - 0.09)
        light = light + glow(np.hypot(steam, beyond))[:, :, None] * TEAL
    return png.srgb(light)


def cup(u, v):
    """The distance from a cup's outline: a bowl, its rim, a handle and a saucer."""
    bowl = np.where(v < 0.50, np.abs(np.hypot(u - 0.47, v - 0.50) - 0.20), 1.0)
    rim = segment(u, v, 0.27, 0.67, 0.50)
    handle = np.where(u > 0.63, np.abs(np.hypot(u - 0.66, v - 0.43) - 0.07), 1.0)
    return np.minimum.reduce([bowl, rim, handle, segment(u, v, 0.27, 0.67, 0.24)])


def segment(u, v, left, right, height):
    """The distance from a level line."""
    return np.hypot(np.maximum(0, np.maximum(left - u, u - right)), v - height)
