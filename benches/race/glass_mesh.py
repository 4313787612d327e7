"""Bumpy balls of glass with as many triangles as are asked for, as binary PLY."""
import numpy

RADIUS = 0.3
CENTER = numpy.array([0.0, 0.4, 0.0])


def side_for(triangles):
    """Squares along a side of the cube that the ball is blown up from; it has twelve triangles for each of their square."""
    return max(1, round((triangles / 12) ** 0.5))


def surface_grid(side):
    """The points of a cube's surface in a grid of side³ cells, each once, and two triangles for each square, counter-clockwise from outside."""
    first, second = (grid.ravel() for grid in numpy.meshgrid(numpy.arange(side + 1), numpy.arange(side + 1), indexing="ij"))
    keys, squares = [], []
    corner = (numpy.arange(side)[:, None] * (side + 1) + numpy.arange(side)).ravel()
    square = numpy.stack([corner, corner + side + 1, corner + side + 2, corner + 1])
    for axis in range(3):
        for end in (0, side):
            point = [None] * 3
            point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3] = numpy.full_like(first, end), first, second
            squares.append((square if end else square[::-1]) + len(keys) * (side + 1) ** 2)
            keys.append((point[0] * (side + 1) + point[1]) * (side + 1) + point[2])
    unique, index = numpy.unique(numpy.concatenate(keys), return_inverse=True)
    a, b, c, d = index[numpy.concatenate(squares, axis=1)]
    points = numpy.stack([unique // (side + 1) ** 2, unique // (side + 1) % (side + 1), unique % (side + 1)], axis=1)
    return points, numpy.concatenate([numpy.stack([a, b, c], axis=1), numpy.stack([a, c, d], axis=1)])


def write_bumpy_ball(path, triangles):
    """Writes a ball with shallow waves, the same surface at every number of triangles, and returns how many it has. It has no normals."""
    side = side_for(triangles)
    points, faces = surface_grid(side)
    directions = numpy.tan((points / side - 0.5) * (numpy.pi / 2))
    directions /= numpy.linalg.norm(directions, axis=1, keepdims=True)
    waves = numpy.sin(11 * directions + 3 * numpy.roll(directions, 1, axis=1)).sum(axis=1, keepdims=True)
    positions = (CENTER + RADIUS * (1 + 0.004 * waves) * directions).astype("<f4")
    records = numpy.empty(len(faces), dtype=[("count", "u1"), ("vertices", "<u4", 3)])
    records["count"], records["vertices"] = 3, faces
    with open(path, "wb") as file:
        header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(positions)}", *(f"property float {axis}" for axis in "xyz")]
        header += [f"element face {len(faces)}", "property list uchar uint vertex_indices", "end_header", ""]
        file.write("\n".join(header).encode())
        positions.tofile(file)
        records.tofile(file)
    return len(faces)
