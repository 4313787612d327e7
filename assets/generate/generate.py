"""Write every mesh, panorama and texture of the project's scenes, and check them.

    pip install -r assets/generate/requirements.txt
    python assets/generate/generate.py

The files come out the same, byte for byte, at every run; assets/README.md tells what
each one is.
"""

import sys

import ball
import check
import crystal
import drink
import hdr
import ice_cube
import leaf
import metal
import obj
import png
import prism
import ring
import ripples
import sign
import sky
import teapot
import tiles
import tube
import tumbler
import window
import wine_glass

BUILDERS = {
    "teapot": (teapot.build, "Utah teapot, solid: Newell's patches joined into one closed surface"),
    "crystal": (crystal.build, "Round brilliant, flat facets"),
    "ball": (ball.build, "Ball, a subdivided icosahedron"),
    "wine-glass": (wine_glass.build, "Empty wine glass, a solid of revolution"),
    "tumbler": (tumbler.build, "Empty tumbler, a solid of revolution"),
    "drink": (drink.build, "What is in the tumbler; reaches a little into its wall and floor"),
    "ice-cube": (ice_cube.build, "Ice cube with rounded edges"),
    "ring": (ring.build, "Wide ring with rounded edges, a solid of revolution"),
    "prism": (prism.build, "Prism on an equilateral triangle, standing"),
    "tube": (tube.build, "Ring of round cross-section, such as a neon tube"),
}

PANORAMAS = {
    "sky": (sky.build, "Clear sky with the glow about the sun, without its disc"),
}

TEXTURES = {
    "tiles": tiles.color,
    "tiles-roughness": tiles.roughness,
    "tiles-normal": tiles.relief,
    "ripples-normal": ripples.build,
    "window": window.build,
    "leaf": leaf.build,
    "sign": sign.build,
    "worn-metal": metal.build,
}


def main():
    """Write and check all; the exit status."""
    check.MESHES.mkdir(parents=True, exist_ok=True)
    for name, (build, title) in BUILDERS.items():
        obj.write(check.MESHES / f"{name}.obj", build(), title)
    check.PANORAMAS.mkdir(parents=True, exist_ok=True)
    for name, (build, title) in PANORAMAS.items():
        hdr.write(check.PANORAMAS / f"{name}.hdr", build(), title)
    check.TEXTURES.mkdir(parents=True, exist_ok=True)
    for name, build in TEXTURES.items():
        png.write(check.TEXTURES / f"{name}.png", build())
    return check.main()


if __name__ == "__main__":
    sys.exit(main())
