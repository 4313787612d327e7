"""A pinnate leaf, its colour and where it is: stem down, tip up."""

import numpy as np

import png
from tiles import places

LEAFLETS = 7
"""Leaflets on each side, and one at the tip."""

BLADE = np.array([0.13, 0.36, 0.07])
VEIN = np.array([0.34, 0.50, 0.16])
"""Linear albedo."""


def build():
    """Colour and, as coverage, 1 on the leaf and 0 beside it."""
    u, v = places()
    middle = np.abs(u - 0.5)
    stem = (middle < 0.010 + 0.012 * (1 - v)) & (v > 0.02) & (v < 0.92)
    is_leaf, is_vein = stem.copy(), stem.copy()
    for leaflet in range(LEAFLETS):
        base = 0.16 + 0.66 * leaflet / (LEAFLETS - 1)
        length = 0.44 * np.sin(np.pi * (0.28 + 0.60 * leaflet / (LEAFLETS - 1)))
        blade, vein = ellipse(middle, v - base, np.radians(33), length)
        is_leaf, is_vein = is_leaf | blade, is_vein | (blade & vein)
    blade, vein = ellipse(u - 0.5, v - 0.80, np.radians(90), 0.18)
    is_leaf, is_vein = is_leaf | blade, is_vein | (blade & vein)
    color = np.where(is_vein[:, :, None], VEIN, BLADE * (0.8 + 0.4 * v[:, :, None]))
    return np.concatenate([png.srgb(color), png.share(is_leaf)[:, :, None]], axis=2)


def ellipse(x, y, turn, length):
    """Where a pointed blade is that begins at the origin, and where its vein is."""
    along = (x * np.cos(turn) + y * np.sin(turn)) / length
    across = (y * np.cos(turn) - x * np.sin(turn)) / length
    width = 0.62 * np.clip(along, 0, 1) * np.clip(1 - along, 0, 1)
    is_blade = (np.abs(across) < width) & (along > 0) & (along < 1)
    return is_blade, np.abs(across) * length < 0.006
