"""A wide ring: a band with rounded edges, its wall upright inside and outside."""

from lathe import rounded, turned

INSIDE_RADIUS = 0.286
OUTSIDE_RADIUS = 0.30
HEIGHT = 0.12
ROUNDING = 0.005
"""Radius of its edges, in metres."""


def build():
    """The ring, lying on y = 0."""
    middle = (INSIDE_RADIUS + OUTSIDE_RADIUS) / 2
    return turned(
        rounded(
            [
                ((middle, 0.0), 0, 0, 1),
                ((OUTSIDE_RADIUS, 0.0), ROUNDING, 8, 4),
                ((OUTSIDE_RADIUS, HEIGHT), ROUNDING, 8, 2),
                ((INSIDE_RADIUS, HEIGHT), ROUNDING, 8, 4),
                ((INSIDE_RADIUS, 0.0), ROUNDING, 8, 1),
                ((middle, 0.0), 0, 0, 0),
            ]
        )
    )
