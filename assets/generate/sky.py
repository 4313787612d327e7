"""A panorama of a clear sky with a glow about the sun, over bare ground.

The sun's own disc is not in it: it is smaller than a texel. Add it with a light of the
type "sun" whose direction is the opposite of SUN.
"""

import numpy as np

from mesh import unit

WIDTH, HEIGHT = 128, 64

SUN = unit(np.array([-0.62, 0.62, -0.48]))
"""Direction toward the sun."""

ZENITH = np.array([0.10, 0.22, 0.52])
HORIZON = np.array([0.62, 0.74, 0.90])
GROUND = np.array([0.17, 0.145, 0.12])
"""Radiance, W/(m² sr)."""

GLOW = [(5.0, np.array([9.0, 8.4, 7.2])), (22.0, np.array([0.50, 0.45, 0.36]))]
"""Width in degrees and peak radiance of what surrounds the sun."""


def directions():
    """The direction of every texel's middle: the top is +y, the columns begin at +z and go by -x."""
    polar = np.pi * (np.arange(HEIGHT) + 0.5)[:, None] / HEIGHT
    turn = 2 * np.pi * (np.arange(WIDTH) + 0.5)[None, :] / WIDTH
    across = np.sin(polar)
    return np.stack(
        [-across * np.sin(turn), np.cos(polar) + 0 * turn, across * np.cos(turn)], axis=2
    )


def build():
    """The panorama: (HEIGHT, WIDTH, 3), from the top row down."""
    toward = directions()
    height = toward[:, :, 1:2]
    share = (1 - np.clip(height, 0, 1)) ** 3.5
    sky = ZENITH + (HORIZON - ZENITH) * share
    angle = np.degrees(np.arccos(np.clip(toward @ SUN, -1, 1)))[:, :, None]
    for width, peak in GLOW:
        sky = sky + peak * np.exp(-((angle / width) ** 2))
    ground = GROUND * (1 + 0.6 * (1 - np.clip(-height, 0, 1)) ** 6)
    return np.where(height > 0, sky, ground)
