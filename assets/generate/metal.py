"""Painted metal, scratched and worn: roughness in green and the share of metal in blue, as glTF packs them."""

import numpy as np

import png
from relief import waves
from tiles import places


def build():
    """Red is unused and 1."""
    u, v = places()
    wear = waves(u, v, 5, count=40, highest=9)
    bare = np.clip(0.5 + 6 * (wear - 0.18), 0, 1)
    roughness = 0.55 - 0.33 * bare + 0.04 * waves(u, v, 6)
    return png.share(np.stack([np.ones_like(u), roughness, bare], axis=2))
