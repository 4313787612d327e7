"""Tiles with mortar between them, four of two colours: a picture of colour, of roughness and of normals.

They fit edge to edge, as pictures that are repeated must.
"""

import numpy as np

import png
from relief import normals, waves

SIZE = 256

TILES = 2
"""Tiles along a side."""

JOINT = 0.022
"""Half the width of the mortar, in tiles."""

EDGE = 0.03
"""Width of a tile's rounded edge, in tiles."""

LIGHT = np.array([0.66, 0.61, 0.52])
DARK = np.array([0.30, 0.38, 0.40])
MORTAR = np.array([0.24, 0.22, 0.20])
"""Linear albedo."""


def places():
    """The middle of every texel, from 0 to 1: along u, and along v from below."""
    along = (np.arange(SIZE) + 0.5) / SIZE
    return np.meshgrid(along, along[::-1])


def cover():
    """1 on a tile, 0 on mortar, between them on a tile's rounded edge."""
    u, v = places()
    inside = [0.5 - np.abs(place * TILES % 1 - 0.5) for place in (u, v)]
    rise = np.clip((np.minimum(*inside) - JOINT) / EDGE, 0, 1)
    return rise * rise * (3 - 2 * rise)


def color():
    """Albedo: tiles of two colours like a chessboard's, clouded."""
    u, v = places()
    is_dark = (np.floor(u * TILES) + np.floor(v * TILES)) % 2 == 1
    tile = np.where(is_dark[:, :, None], DARK, LIGHT) * (1 + 0.10 * waves(u, v, 7)[:, :, None])
    shown = (cover() > 0.02)[:, :, None]
    return png.srgb(np.where(shown, tile, MORTAR))


def roughness():
    """Roughness: glossy tiles with matt patches, from 0.34, and matt mortar."""
    u, v = places()
    tile = 0.42 + 0.08 * waves(u, v, 11)
    return png.share(0.85 + (tile - 0.85) * cover())[:, :, None]


def relief():
    """Normals of the tiles' rounded edges."""
    depth = 0.35 * EDGE / TILES
    return normals(depth * cover())
