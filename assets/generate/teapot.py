"""The Utah teapot as one solid piece of glass.

Newell's patches are open sheets that pass through one another. Here the body (lid,
rim, body, bottom), the handle and the spout are each closed into a solid, and the
three solids are united. Normals are those of the patches, carried through the union,
so that they are smooth within each part and sharp where two parts meet.
"""

import numpy as np
from manifold3d import Manifold, Mesh64

import newell
from bezier import patch_normals, patch_points, ruled_patch
from mesh import Mesh, grid_triangles, index_rows, signed_volume, unit, without_collapsed

METRES_PER_UNIT = 0.155
"""Newell's teapot is 6.43 units from handle to spout; this makes it 1.0 m."""

QUARTER_STEPS = 32
"""Steps around a quarter of the body."""

TUBE_STEPS = 25
"""Steps around half of the handle or the spout; 25 leaves the union free of slivers."""

SUNK = 0.3
"""How far, in Newell's units, the tubes' ends are drawn on into the body."""

MERGE_DISTANCE = 1e-5
"""Edges shorter than this, in metres, are collapsed after the union."""


def ring(radius, height, offset):
    """The four control points of a quarter ring, in Newell's units, z up."""
    return [(radius, 0, height), (radius, offset, height), (offset, radius, height), (0, radius, height)]


def quarters(outline, steps):
    """The four patches, with their steps, that an outline of control rings sweeps out."""
    patch = np.array([ring(*control) for control in outline], dtype=float)
    quarter_turn = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]], dtype=float)
    for _ in range(4):
        yield patch, steps, QUARTER_STEPS
        patch = patch @ quarter_turn


def halves(half, steps):
    """A half patch and its mirror image in y, turned to face the same side, with steps."""
    patch = np.asarray(half, dtype=float)
    yield patch, steps, TUBE_STEPS
    yield patch[:, ::-1] * (1, -1, 1), steps, TUBE_STEPS


def flat_cap(loop):
    """A half patch that closes half a tube's end: from its half loop to the middle."""
    middle = (loop[0] + loop[-1]) / 2
    return ruled_patch(loop, np.broadcast_to(middle, loop.shape))


def sunk_end(loop, direction):
    """Half patches that draw a tube's end on into the body, and close it there."""
    deep = loop + SUNK * unit(np.asarray(direction))
    return ruled_patch(loop, deep), flat_cap(deep)


def body_patches():
    """Lid, rim, body and bottom, with the lid seated flat against the rim."""
    (lid_radius, height, lid_offset), (rim_radius, _, rim_offset) = newell.LID[-1], newell.RIM[0]
    thirds = np.linspace(0, 1, 4)
    seat = [
        (lid_radius + t * (rim_radius - lid_radius), height, lid_offset + t * (rim_offset - lid_offset))
        for t in thirds
    ]
    yield from quarters(newell.KNOB, 28)
    yield from quarters(newell.LID, 20)
    yield from quarters(seat, 1)
    yield from quarters(newell.RIM, 20)
    yield from quarters(newell.UPPER_BODY, 24)
    yield from quarters(newell.LOWER_BODY, 24)
    yield from quarters(newell.BOTTOM, 20)


def handle_patches():
    """The handle, with both its ends drawn on into the body along its course."""
    top, foot = np.array(newell.HANDLE_TOP), np.array(newell.HANDLE_FOOT)
    top_end, top_cap = sunk_end(top[0], (top[0] - top[1]).mean(axis=0))
    foot_end, foot_cap = sunk_end(foot[3], (foot[3] - foot[2]).mean(axis=0))
    yield from halves(top_cap[::-1], 1)
    yield from halves(top_end[::-1], 1)
    yield from halves(top, 32)
    yield from halves(foot, 32)
    yield from halves(foot_end, 1)
    yield from halves(foot_cap, 1)


def spout_patches():
    """The spout, its base drawn on into the body and its mouth closed inside the lip."""
    spout, lip = np.array(newell.SPOUT), np.array(newell.SPOUT_LIP)
    base_end, base_cap = sunk_end(spout[0], (-1, 0, 0))
    yield from halves(base_cap[::-1], 1)
    yield from halves(base_end[::-1], 1)
    yield from halves(spout, 36)
    yield from halves(lip, 48)
    yield from halves(flat_cap(lip[3]), 1)


def corners(patches):
    """All patches' triangles, loose: corner positions in metres, y up, and normals."""
    to_file = METRES_PER_UNIT * np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], dtype=float)
    positions, normals = [], []
    for patch, along, around in patches:
        u, v = np.linspace(0, 1, along + 1), np.linspace(0, 1, around + 1)
        triangles = grid_triangles(along + 1, around + 1).reshape(-1)
        placed = patch @ to_file
        positions.append(patch_points(placed, u, v).reshape(-1, 3)[triangles])
        normals.append(patch_normals(placed, u, v).reshape(-1, 3)[triangles])
    return np.concatenate(positions), np.concatenate(normals)


def solid(patches):
    """The closed solid that the patches bound, each vertex holding position and normal."""
    loose_positions, loose_normals = corners(patches)
    positions, at = index_rows(loose_positions, 9)
    rows, row_at = index_rows(np.column_stack([positions[at], np.round(loose_normals, 5)]), 9)

    triangles, row_triangles = at.reshape(-1, 3), row_at.reshape(-1, 3)
    kept = without_collapsed(triangles)
    triangles, row_triangles = triangles[kept], row_triangles[kept]
    if signed_volume(positions, triangles) < 0:
        row_triangles = row_triangles[:, ::-1]
        rows[:, 3:] *= -1

    _, first, same = np.unique(rows[:, :3], axis=0, return_index=True, return_inverse=True)
    twins = np.flatnonzero(first[same.reshape(-1)] != np.arange(len(rows)))
    manifold = Manifold(
        Mesh64(
            np.ascontiguousarray(rows),
            np.ascontiguousarray(row_triangles).astype(np.uint64),
            merge_from_vert=twins.astype(np.uint64),
            merge_to_vert=first[same.reshape(-1)][twins].astype(np.uint64),
        )
    )
    if manifold.is_empty():
        raise ValueError(f"a part of the teapot is not closed: {manifold.status()}")
    return manifold


def build():
    """The teapot: 1.0 m wide, spout towards +x, handle towards -x, standing on y = 0."""
    union = solid(body_patches()) + solid(handle_patches()) + solid(spout_patches())
    united = union.simplify(MERGE_DISTANCE).to_mesh64()
    rows = np.asarray(united.vert_properties)
    row_triangles = np.asarray(united.tri_verts).astype(int)

    merged = np.arange(len(rows))
    merged[np.asarray(united.merge_from_vert, dtype=int)] = united.merge_to_vert
    used, triangles = np.unique(merged[row_triangles], return_inverse=True)
    return Mesh(
        positions=rows[used, :3],
        triangles=triangles.reshape(-1, 3),
        normals=unit(rows[:, 3:]),
        normal_triangles=row_triangles,
    )
