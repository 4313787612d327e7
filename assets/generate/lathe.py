"""Solids of revolution: an outline of cubic Bézier pieces, turned about the y axis.

A piece is a pair: its four control points (radius, height) in metres, and the steps along
it. An outline runs with the solid on its left: outwards along the bottom, up the outside
and back to the axis, or round to where it began.
"""

import numpy as np

from bezier import slopes, weights
from mesh import Mesh, grid_triangles, index_rows, unit, without_collapsed

AROUND = 128
"""Steps around the axis."""

QUARTER_ARC = 0.5522847
"""Length of a Bézier quarter circle's handles, in radii."""

CREASE_DEGREES = 40.0
"""Pieces that meet at less than this share one normal."""


def line(start, end, steps):
    """The piece of a straight line."""
    start, end = np.array(start), np.array(end)
    return [start, start + (end - start) / 3, end - (end - start) / 3, end], steps


def rounding(corner, before, after, radius, steps):
    """The piece of an arc that rounds a corner between the points before and after it."""
    corner = np.array(corner)
    backward, forward = unit(np.array(before) - corner), unit(np.array(after) - corner)
    half_corner = np.arccos(backward @ forward) / 2
    reach = radius / np.tan(half_corner)
    handle = 4 / 3 * np.tan((np.pi / 2 - half_corner) / 2) * radius
    ends = [corner + reach * backward, corner + reach * forward]
    return [ends[0], ends[0] - handle * backward, ends[1] - handle * forward, ends[1]], steps


def rounded(corners):
    """The pieces of a polygon through corners (point, radius, steps, steps of the line after it).

    A corner of radius 0 is sharp; the first and the last are the outline's ends.
    """
    pieces = []
    here = np.array(corners[0][0])
    for at, (point, radius, steps, _) in enumerate(corners[1:], start=1):
        line_steps = corners[at - 1][3]
        if radius == 0:
            pieces.append(line(here, point, line_steps))
            here = np.array(point)
            continue
        arc = rounding(point, corners[at - 1][0], corners[at + 1][0], radius, steps)
        if line_steps > 0:
            pieces.append(line(here, arc[0][0], line_steps))
        pieces.append(arc)
        here = arc[0][-1]
    return pieces


def profile(pieces):
    """Points (radius, height) along the outline, and for each step its two end normals.

    Returns (n + 1, 2) points and (n, 2, 2) normals pointing out of the solid.
    """
    points, normals = [np.array([pieces[0][0][0]])], []
    for controls, steps in pieces:
        t = np.linspace(0, 1, steps + 1)
        tangents = unit(slopes(t) @ np.array(controls))
        outward = np.stack([tangents[:, 1], -tangents[:, 0]], axis=1)
        points.append((weights(t) @ np.array(controls))[1:])
        normals.append(np.stack([outward[:-1], outward[1:]], axis=1))
    return np.concatenate(points), smooth_joints(np.concatenate(normals))


def smooth_joints(normals):
    """The steps' end normals, averaged where neighbours differ by less than the crease."""
    ends, starts = normals[:-1, 1], normals[1:, 0]
    smooth = np.sum(ends * starts, axis=1) > np.cos(np.radians(CREASE_DEGREES))
    mean = unit(ends[smooth] + starts[smooth])
    ends[smooth] = mean
    starts[smooth] = mean
    return normals


def turned(pieces):
    """The solid of revolution of an outline."""
    points, step_normals = profile(pieces)
    turns = 2 * np.pi * np.arange(AROUND + 1) / AROUND
    circle = np.stack([np.cos(turns), np.zeros_like(turns), -np.sin(turns)], axis=1)
    up = np.array([0.0, 1.0, 0.0])

    def revolve(flat):
        return flat[:, None, :1] * circle + flat[:, None, 1:] * up

    strip = grid_triangles(2, AROUND + 1)[:, ::-1].reshape(-1)
    positions, normals = [], []
    for step, ends in enumerate(step_normals):
        positions.append(revolve(points[step : step + 2]).reshape(-1, 3)[strip])
        normals.append(revolve(ends).reshape(-1, 3)[strip])

    distinct, at = index_rows(np.concatenate(positions), 9)
    distinct_normals, normal_at = index_rows(np.concatenate(normals), 6)
    triangles = at.reshape(-1, 3)
    kept = without_collapsed(triangles)
    return Mesh(distinct, triangles[kept], unit(distinct_normals), normal_at.reshape(-1, 3)[kept])
