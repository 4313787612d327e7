"""Wavefront OBJ files: v, vn, s off and f only, rounded so that the files stay small."""

import numpy as np

from mesh import Mesh, index_rows

POSITION_DECIMALS = 7
NORMAL_DECIMALS = 5


def number(value, decimals):
    """A number in as few characters as its rounded value needs."""
    return f"{value:.{decimals}f}".rstrip("0").rstrip(".")


def lines(keyword, rows, decimals):
    """One OBJ line for each row of numbers."""
    return [" ".join([keyword, *(number(value, decimals) for value in row)]) for row in rows]


def write(path, mesh, title):
    """Write a mesh; the same mesh always gives the same bytes."""
    positions, at = index_rows(mesh.positions, POSITION_DECIMALS)
    corners = (at[mesh.triangles] + 1).astype(str)
    text = [f"# {title}", "# Written by assets/generate/generate.py; metres, y up."]
    text += lines("v", positions, POSITION_DECIMALS)
    if mesh.normals is not None:
        normals, normal_at = index_rows(mesh.normals, NORMAL_DECIMALS)
        text += lines("vn", normals, NORMAL_DECIMALS)
        normal_corners = (normal_at[mesh.normal_triangles] + 1).astype(str)
        corners = np.strings.add(np.strings.add(corners, "//"), normal_corners)
    else:
        text.append("s off")
    text += ["f " + " ".join(row) for row in corners]
    path.write_text("\n".join(text) + "\n", encoding="ascii")


def read(path):
    """Read a mesh that write() wrote."""
    rows = {"v": [], "vn": [], "f": []}
    for line in path.read_text(encoding="ascii").splitlines():
        keyword, *fields = line.split()
        if keyword in rows:
            rows[keyword].append(fields)
    corners = np.array([[corner.split("//") for corner in face] for face in rows["f"]], dtype=int) - 1
    positions = np.array(rows["v"], dtype=float)
    if not rows["vn"]:
        return Mesh(positions, corners[:, :, 0])
    return Mesh(positions, corners[:, :, 0], np.array(rows["vn"], dtype=float), corners[:, :, 1])
