"""Writes what other readers of glTF find in public files: numbers that the tests compare. Of PyPI, trimesh 5.2.0 reads meshes, and pygltflib 1.16
materials.

    python3 reference.py FOLDER > reference.json
"""

import json
import pathlib
import sys

import numpy
import pygltflib
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


def of_meshes(path):
    scene = trimesh.load_scene(path, process=False)
    objects = {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        objects[node] = of_object(scene.geometry[geometry], transform)
    return objects


def of_material(material):
    """Its numbers, those that the file leaves out by their defaults, and which pictures it has."""
    model = material.pbrMetallicRoughness or pygltflib.PbrMetallicRoughness()
    extensions = {name.removeprefix("KHR_materials_"): value for name, value in (material.extensions or {}).items()}
    volume = extensions.get("volume", {})
    transmission = extensions.get("transmission", {})
    pictures = {
        "color": model.baseColorTexture,
        "metal": model.metallicRoughnessTexture,
        "normal": material.normalTexture,
        "emission": material.emissiveTexture,
        "transmission": transmission.get("transmissionTexture"),
    }
    return {
        "name": material.name,
        "color": rounded(model.baseColorFactor),
        "metallic": model.metallicFactor,
        "roughness": model.roughnessFactor,
        "emission": rounded(material.emissiveFactor),
        "alpha_mode": material.alphaMode,
        "alpha_cutoff": material.alphaCutoff,
        "transmission": transmission.get("transmissionFactor", 0),
        "ior": extensions.get("ior", {}).get("ior", 1.5),
        "dispersion": extensions.get("dispersion", {}).get("dispersion", 0),
        "thickness": volume.get("thicknessFactor", 0),
        "attenuation_color": rounded(volume.get("attenuationColor", [1, 1, 1])),
        "attenuation_distance": volume.get("attenuationDistance", 0),
        "pictures": sorted(name for name, picture in pictures.items() if picture),
    }


def of_file(path):
    materials = pygltflib.GLTF2().load(path).materials
    return {"objects": of_meshes(path), "materials": [of_material(material) for material in materials]}


def main():
    files = sorted(pathlib.Path(sys.argv[1]).glob("*.glb"))
    json.dump({path.name: of_file(path) for path in files}, sys.stdout, indent=1, sort_keys=True)
    print()


main()
