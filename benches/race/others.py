"""The other renderers of the race, each as a generator of settings, times and pictures."""
import importlib.util
import math
import os
import pathlib
import re
import shutil
import sys
import tomllib

from scoring import read_rgb
from timing import timed

# Renderers whose light has no units: their pictures are exposed so that the plain floor is as bright as the reference's.
UNCALIBRATED = {"pov-ray"}


def available():
    found = {}
    if shutil.which("povray"):
        found["pov-ray"] = pov_ray
    if importlib.util.find_spec("mitsuba"):
        found["mitsuba"] = mitsuba
    return found


def newest_llvm():
    """Mitsuba 3.9 fails on some processors with an LLVM before 16, which it takes if it is not told of another."""
    if "DRJIT_LIBLLVM_PATH" in os.environ:
        return {}
    # libLLVM-15.so.1 of old, libLLVM.so.19.1 of late.
    numbered = [(re.search(r"\d+", path.name), path) for path in pathlib.Path("/usr/lib").glob("*/libLLVM*.so*")]
    libraries = [(int(number.group()), str(path)) for number, path in numbered if number]
    return {"DRJIT_LIBLLVM_PATH": max(libraries)[1]} if libraries else {}


# Where light comes from all around or from far to the sides, paths from the camera find it, and may do better than light tracing.
WIDE = {"environment"}
WIDE_RADIUS = 0.2


def mitsuba(scene, folder, quick):
    """Light tracing, the fastest of its integrators on caustics; where the light is wide, path tracing too."""
    picture = folder / "mitsuba.exr"
    lamp = tomllib.loads(scene.read_text())["lights"][0]
    is_wide = lamp["type"] in WIDE or lamp.get("radius", 0) >= WIDE_RADIUS
    for integrator in ["ptracer", "path"] if is_wide else ["ptracer"]:
        for samples in [16, 64] if quick else [32, 128, 512, 1024]:
            command = [sys.executable, __file__, "mitsuba", integrator, scene, str(samples), picture]
            yield f"{integrator}, {samples} samples", timed(command, **newest_llvm()), read_rgb(picture)


def mitsuba_light(scene, lamp, to_world):
    if lamp["type"] == "directional":
        return {"type": "directional", "direction": lamp["direction"], "irradiance": {"type": "rgb", "value": lamp["irradiance"]}}
    if lamp["type"] == "environment":
        # Its pictures begin at -z, and those of the scene files at +z.
        return {"type": "envmap", "filename": str(scene.parent / lamp["image"]), "to_world": to_world.rotate([0, 1, 0], 180)}
    # A sphere of this radius sends the flux stated if its radiance is flux / (pi * area).
    radiance = lamp["flux"] / (math.pi * 4 * math.pi * lamp["radius"] ** 2)
    return {"type": "sphere", "center": lamp["center"], "radius": lamp["radius"], "emitter": {"type": "area", "radiance": radiance}}


def mitsuba_glass(glass):
    indices = {"int_ior": glass["ior"], "ext_ior": 1.0}
    if "roughness" not in glass:
        return {"type": "dielectric", **indices}
    return {"type": "roughdielectric", "distribution": "ggx", "alpha": glass["roughness"] ** 2, **indices}


def render_with_mitsuba(integrator, scene, samples, picture):
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    read = tomllib.loads(scene.read_text())
    camera, glass = read["camera"], read["objects"][0]
    to_world = mi.ScalarTransform4f()
    mesh = scene.parent / glass["mesh"]
    image = mi.render(
        mi.load_dict(
            {
                "type": "scene",
                "integrator": {"type": integrator, "max_depth": 66},
                "sensor": {
                    "type": "perspective",
                    "fov": camera["vertical_fov"],
                    "to_world": to_world.look_at(camera["position"], camera["look_at"], [0, 1, 0]),
                    "film": {"type": "hdrfilm", "width": 512, "height": 512, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
                    "sampler": {"type": "independent", "sample_count": samples},
                },
                "lamp": mitsuba_light(scene, read["lights"][0], to_world),
                "glass": {
                    "type": "obj",
                    "filename": str(mesh),
                    "face_normals": "\nvn " not in mesh.read_text(),
                    "to_world": to_world.translate(glass["translate"]),
                    "bsdf": mitsuba_glass(read["materials"]["glass"]),
                },
                "floor": {
                    "type": "rectangle",
                    "to_world": to_world.rotate([1, 0, 0], -90).scale([2, 2, 1]),
                    "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.8}},
                },
            }
        )
    )
    mi.Bitmap(image).write(str(picture))


def pov_ray(scene, folder, quick):
    """Its photon map, over the spacing of photons; the lamp as an area light. It has no light from a picture and no frosted glass that refracts."""
    read = tomllib.loads(scene.read_text())
    if read["lights"][0]["type"] == "environment" or "roughness" in read["materials"]["glass"]:
        return
    picture = folder / "pov-ray.exr"
    for photons in [20_000, 100_000] if quick else [20_000, 200_000, 1_000_000, 4_000_000]:
        source = folder / "race.pov"
        source.write_text(pov_scene(scene, photons))
        yield f"{photons:,} photons", timed(["povray", f"+I{source}", f"+O{picture}", "+FE", "+W512", "+H512", "+A0.1", "+R2", "-D", "-GA"]), read_rgb(picture)


def pov_scene(scene, photons):
    read = tomllib.loads(scene.read_text())
    camera, lamp, glass = read["camera"], read["lights"][0], read["objects"][0]
    flipped = lambda v: f"<{v[0]}, {v[1]}, {-v[2]}>"
    # POV-Ray's z axis points the other way.
    return f"""#version 3.7;
global_settings {{ assumed_gamma 1.0 max_trace_level 24 photons {{ count {photons} autostop 0 jitter 0.4 max_trace_level 24 }} }}
camera {{ perspective location {flipped(camera["position"])} right x up y angle {camera["vertical_fov"]} look_at {flipped(camera["look_at"])} }}
{pov_light(lamp, flipped)}
{pov_mesh(scene.parent / glass["mesh"])}
object {{ Glass translate {flipped(glass["translate"])} pigment {{ rgbt 1 }} interior {{ ior {read["materials"]["glass"]["ior"]} }}
  finish {{ ambient 0 diffuse 0 reflection {{ 0 1 fresnel on }} conserve_energy }} photons {{ target refraction on reflection on collect off }} }}
polygon {{ 5, <-2, 0, -2>, <2, 0, -2>, <2, 0, 2>, <-2, 0, 2>, <-2, 0, -2> pigment {{ rgb 0.8 }} finish {{ ambient 0 diffuse 1 }} }}
"""


def pov_light(lamp, flipped):
    if lamp["type"] == "directional":
        far = [-100 * component for component in lamp["direction"]]
        return f"light_source {{ {flipped(far)} color rgb 1 parallel point_at <0, 0, 0> photons {{ refraction on reflection on }} }}"
    # Its lights fade by 2 / (1 + (d/D)^2).
    width = 1.6 * lamp["radius"]
    return f"""light_source {{ {flipped(lamp["center"])} color rgb 4 area_light x*{width}, y*{width}, 5, 5 circular orient adaptive 1 jitter
  fade_distance 0.01 fade_power 2 photons {{ refraction on reflection on area_light }} }}"""


def pov_mesh(path):
    """The mesh with its normals, if it has some."""
    places, normals, faces = [], [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            places.append(words[1:4])
        elif words[:1] == ["vn"]:
            normals.append(words[1:4])
        elif words[:1] == ["f"]:
            faces.append([[int(index) - 1 if index else -1 for index in corner.split("/")] for corner in words[1:4]])
    vectors = lambda rows: ",".join(f"<{x},{y},{-float(z):.7g}>" for x, y, z in rows)
    triples = lambda at: ",".join("<" + ",".join(str(corner[at]) for corner in face) + ">" for face in faces)
    parts = [f"vertex_vectors {{ {len(places)}, {vectors(places)} }}"]
    if normals:
        parts.append(f"normal_vectors {{ {len(normals)}, {vectors(normals)} }}")
    parts.append(f"face_indices {{ {len(faces)}, {triples(0)} }}")
    if normals:
        parts.append(f"normal_indices {{ {len(faces)}, {triples(2)} }}")
    return f"#declare Glass = mesh2 {{ {' '.join(parts)} inside_vector y }}"


if __name__ == "__main__":
    render_with_mitsuba(sys.argv[2], pathlib.Path(sys.argv[3]), int(sys.argv[4]), sys.argv[5])
