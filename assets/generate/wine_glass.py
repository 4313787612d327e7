"""An empty wine glass: foot, stem and bowl, blown in one piece.

A closed solid of revolution. Its outline starts under the middle of the foot, goes
round the foot, up the stem and the outside of the bowl, over the rounded rim, and down
the inside of the bowl to the axis. Every piece meets the next with the same tangent,
so that the surface is smooth throughout.
"""

import numpy as np

from lathe import QUARTER_ARC, turned
from mesh import unit

# Pieces as control points (radius, height) in metres, and the steps along each.
FOOT_AND_STEM = [
    ([(0.0, 0.012), (0.06, 0.012), (0.115, 0.0), (0.137, 0.0)], 12),
    ([(0.137, 0.0), (0.1425, 0.0), (0.1465, 0.003), (0.1465, 0.007)], 6),
    ([(0.1465, 0.007), (0.1465, 0.011), (0.1425, 0.0135), (0.137, 0.0145)], 6),
    ([(0.137, 0.0145), (0.06, 0.0285), (0.0115, 0.04), (0.0115, 0.12)], 18),
    ([(0.0115, 0.12), (0.0115, 0.19), (0.0115, 0.26), (0.0115, 0.33)], 6),
    ([(0.0115, 0.33), (0.0115, 0.385), (0.05, 0.395), (0.095, 0.425)], 14),
]
BOWL_OUTSIDE = [
    ([(0.095, 0.425), (0.14, 0.455), (0.17, 0.505), (0.17, 0.57)], 12),
    ([(0.17, 0.57), (0.17, 0.65), (0.1456, 0.7275), (0.133, 0.7975)], 14),
]
BOWL_INSIDE = [
    ([(0.1635, 0.57), (0.1635, 0.511), (0.1338, 0.4605), (0.0906, 0.4317)], 12),
    ([(0.0906, 0.4317), (0.0606, 0.4117), (0.03, 0.404), (0.0, 0.404)], 10),
]
RIM_RADIUS = 0.003


def rim(outer_end, direction):
    """The two quarter circles, with steps, over the rim from the outside to the inside."""
    inward = np.array([-direction[1], direction[0]])
    middle = outer_end + RIM_RADIUS * inward
    top = middle + RIM_RADIUS * direction
    inner_end = middle + RIM_RADIUS * inward
    arc = QUARTER_ARC * RIM_RADIUS
    yield [outer_end, outer_end + arc * direction, top - arc * inward, top], 6
    yield [top, top + arc * inward, inner_end + arc * direction, inner_end], 6


def outline_pieces():
    """All pieces of the outline in order, with the steps along each."""
    outer = np.array(BOWL_OUTSIDE[-1][0])
    direction = unit(outer[3] - outer[2])
    over_rim = list(rim(outer[3], direction))
    inner_end = over_rim[-1][0][-1]
    widest = np.array(BOWL_INSIDE[0][0][0])
    inner_wall = [inner_end, inner_end - 0.07 * direction, widest + (0.0, 0.075), widest]
    return FOOT_AND_STEM + BOWL_OUTSIDE + over_rim + [(inner_wall, 14)] + BOWL_INSIDE


def build():
    """The wine glass: 0.8 m tall, its foot standing on y = 0."""
    return turned(outline_pieces())
