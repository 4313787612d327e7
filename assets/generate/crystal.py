"""A round brilliant: 57 polished facets, pointed below, and a thin girdle of 16 flats.

The stone is the set of points behind every facet's plane. The planes follow from the
proportions alone, near those of M. Tolkowsky, "Diamond Design", 1919; lengths here are
in girdle radii, with y = 0 at the girdle's upper edge, until build() scales the stone.
"""

import numpy as np

from mesh import Mesh, unit

DIAMETER = 0.6
"""Across the girdle's corners, in metres."""

TABLE = 0.53
"""The table's width, corner to corner, in girdle diameters."""

CROWN_ANGLE = np.radians(34.5)
PAVILION_ANGLE = np.radians(40.75)
GIRDLE = 0.04
"""Height of the girdle, in girdle radii."""

STAR_LENGTH = 0.5
"""How far the stars reach from the table's edge towards the girdle, seen from above."""

LOWER_HALF_LENGTH = 0.77
"""How far the lower girdle facets reach from the girdle towards the tip."""

EIGHTH = np.radians(45.0)
WELD = 1e-9
"""Points nearer than this, in girdle radii, are one."""


def at(turn, radius, height):
    """The point at an angle about the y axis, in girdle radii."""
    return np.array([radius * np.cos(turn), height, -radius * np.sin(turn)])


def plane(a, b, c):
    """The plane through three points as (outward unit normal, offset), the stone's middle inside."""
    normal = unit(np.cross(b - a, c - a))
    middle = np.array([0.0, -GIRDLE / 2, 0.0])
    if normal @ (a - middle) < 0:
        normal = -normal
    return normal, normal @ a


def crown_planes(turn):
    """The kite at an angle, the star beside it, and the two upper girdle facets under the star."""
    slope, half = np.tan(CROWN_ANGLE), EIGHTH / 2
    table_height = slope * (1 - TABLE)
    table_edge = TABLE * np.cos(half)
    star_radius = table_edge + STAR_LENGTH * (1 - table_edge)
    star_height = slope * (1 - star_radius * np.cos(half))

    corner, next_corner = at(turn, TABLE, table_height), at(turn + EIGHTH, TABLE, table_height)
    star_tip, star_before = (at(turn + side * half, star_radius, star_height) for side in (1, -1))
    tip, between, next_tip = (at(turn + side * half, 1, 0) for side in (0, 1, 2))
    yield plane(corner, star_tip, star_before)
    yield plane(corner, next_corner, star_tip)
    yield plane(star_tip, tip, between)
    yield plane(star_tip, between, next_tip)


def pavilion_planes(turn):
    """The main facet at an angle, and the two lower girdle facets beside it."""
    slope, half = np.tan(PAVILION_ANGLE), EIGHTH / 2
    inner_radius = 1 - LOWER_HALF_LENGTH
    inner_height = -GIRDLE - slope * (1 - inner_radius * np.cos(half))

    point = at(turn, 0, -GIRDLE - slope)
    inner, inner_before = (at(turn + side * half, inner_radius, inner_height) for side in (1, -1))
    tip, between, next_tip = (at(turn + side * half, 1, -GIRDLE) for side in (0, 1, 2))
    yield plane(point, inner, inner_before)
    yield plane(inner, tip, between)
    yield plane(inner, between, next_tip)


def girdle_planes(turn):
    """The two upright flats of the girdle that follow an angle."""
    for start in (turn, turn + EIGHTH / 2):
        yield plane(at(start, 1, 0), at(start + EIGHTH / 2, 1, 0), at(start, 1, -GIRDLE))


def facet_planes():
    """All 73 planes: table, then crown, girdle and pavilion eighth by eighth."""
    planes = [(np.array([0.0, 1.0, 0.0]), np.tan(CROWN_ANGLE) * (1 - TABLE))]
    for eighth in range(8):
        for family in (crown_planes, girdle_planes, pavilion_planes):
            planes.extend(family(eighth * EIGHTH))
    return planes


def clip(polygon, normal, offset):
    """What of a convex polygon lies behind a plane."""
    heights = polygon @ normal - offset
    kept = []
    for here, point in enumerate(polygon):
        after = (here + 1) % len(polygon)
        if heights[here] <= WELD:
            kept.append(point)
        if min(heights[here], heights[after]) < -WELD and max(heights[here], heights[after]) > WELD:
            share = heights[here] / (heights[here] - heights[after])
            kept.append(point + share * (polygon[after] - point))
    return np.array(kept)


def facet(number, planes):
    """One facet's polygon, counter-clockwise from outside: its plane cut by all others."""
    normal, offset = planes[number]
    across = unit(np.cross(normal, np.roll(np.abs(normal), 1) + (0.1, 0.2, 0.3)))
    up = np.cross(normal, across)
    polygon = normal * offset + 10 * np.array([across, up, -across, -up])
    for other, (other_normal, other_offset) in enumerate(planes):
        if other != number:
            polygon = clip(polygon, other_normal, other_offset)
    return polygon


def weld(point, vertices):
    """The index of the vertex at a point, which is added if it is new."""
    for index, vertex in enumerate(vertices):
        if np.linalg.norm(vertex - point) < 100 * WELD:
            return index
    vertices.append(point)
    return len(vertices) - 1


def build():
    """The stone: 0.6 m across, table up, its tip at the origin."""
    planes = facet_planes()
    vertices, triangles = [], []
    for number in range(len(planes)):
        loop = list(dict.fromkeys(weld(point, vertices) for point in facet(number, planes)))
        triangles += [(loop[0], loop[i], loop[i + 1]) for i in range(1, len(loop) - 1)]
    positions = DIAMETER / 2 * np.array(vertices)
    positions[:, 1] -= positions[:, 1].min()
    return Mesh(positions, np.array(triangles))
