"""What is in the tumbler, in the tumbler's own frame: it stands where the tumbler stands.

It reaches a little into the glass, so that no air lies between the two. The glass must
have the higher priority.
"""

from lathe import rounded, turned
from tumbler import FLOOR, FLOOR_ROUNDING, inside_radius

LEVEL = 0.30
"""Height of the surface, in metres."""

OVERLAP = 0.003
"""How far it reaches into wall and floor, in metres."""


def radius(height):
    """Radius of its side."""
    return inside_radius(height) + OVERLAP


def build():
    """The drink, with a flat surface."""
    bottom = FLOOR - OVERLAP
    return turned(
        rounded(
            [
                ((0.0, bottom), 0, 0, 6),
                ((radius(bottom), bottom), FLOOR_ROUNDING + OVERLAP, 10, 10),
                ((radius(LEVEL), LEVEL), 0, 0, 10),
                ((0.0, LEVEL), 0, 0, 0),
            ]
        )
    )
