"""Ripples of water, as a normal map that fits edge to edge."""

from relief import normals, waves
from tiles import places

HEIGHT = 0.011
"""The highest ripple, in sides of the picture."""


def build():
    """The normal map."""
    return normals(HEIGHT * waves(*places(), seed=3, highest=4))
