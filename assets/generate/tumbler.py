"""A tumbler: a heavy bottom, hollow underneath, and a wall that leans out a little."""

from lathe import rounded, turned

HEIGHT = 0.42
BASE_RADIUS = 0.128
RIM_RADIUS = 0.158
WALL = 0.010
"""Thickness of the wall, measured along the radius, in metres."""
FLOOR = 0.034
"""Height of the floor inside."""
FLOOR_ROUNDING = 0.03

LEAN = (RIM_RADIUS - BASE_RADIUS) / HEIGHT


def inside_radius(height):
    """Radius of the hollow."""
    return BASE_RADIUS - WALL + LEAN * height


def build():
    """The tumbler, its edge standing on y = 0."""
    return turned(
        rounded(
            [
                ((0.0, 0.007), 0, 0, 6),
                ((0.085, 0.007), 0.03, 6, 1),
                ((0.104, 0.0), 0.02, 5, 1),
                ((BASE_RADIUS, 0.0), 0.013, 8, 12),
                ((RIM_RADIUS, HEIGHT), 0.0045, 6, 1),
                ((inside_radius(HEIGHT), HEIGHT), 0.0045, 6, 12),
                ((inside_radius(FLOOR), FLOOR), FLOOR_ROUNDING, 10, 6),
                ((0.0, FLOOR), 0, 0, 0),
            ]
        )
    )
