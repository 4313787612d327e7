"""Writes what another reader of glTF, trimesh 5.2.0 of PyPI, finds in public files: numbers that the tests compare.

    python3 reference.py FOLDER > reference.json
"""

import json
import pathlib
import sys

import numpy
import trimesh


def rounded(numbers):
    return [float(f"{number:.6g}") for number in numpy.ravel(numbers)]


def of_object(mesh, transform):
    """Means over the corners of all triangles; normals in the mesh's frame, all else in the world's."""
    corners = mesh.faces.ravel()
    positions = trimesh.transform_points(mesh.vertices, transform)[corners]
    material = mesh.visual.material
    found = {
        "triangles": len(mesh.faces),
        "position": rounded(positions.mean(axis=0)),
        "extent": rounded(positions.max(axis=0) - positions.min(axis=0)),
        "normal": rounded(mesh.vertex_normals[corners].mean(axis=0)),
        "material": material.name,
    }
    if mesh.visual.uv is not None:
        found["uv"] = rounded(mesh.visual.uv[corners].mean(axis=0))
    return found


def of_file(path):
    scene = trimesh.load_scene(path, process=False)
    objects = {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        objects[node] = of_object(scene.geometry[geometry], transform)
    return objects


def main():
    files = sorted(pathlib.Path(sys.argv[1]).glob("*.glb"))
    json.dump({path.name: of_file(path) for path in files}, sys.stdout, indent=1, sort_keys=True)
    print()


main()
