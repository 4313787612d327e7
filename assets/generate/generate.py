"""Write every mesh of the project's scenes to assets/meshes, and check them.

    pip install -r assets/generate/requirements.txt
    python assets/generate/generate.py

The files come out the same, byte for byte, at every run; assets/README.md tells what
each one is.
"""

import sys

import ball
import check
import crystal
import obj
import teapot
import wine_glass

BUILDERS = {
    "teapot": (teapot.build, "Utah teapot, solid: Newell's patches joined into one closed surface"),
    "crystal": (crystal.build, "Round brilliant, flat facets"),
    "ball": (ball.build, "Ball, a subdivided icosahedron"),
    "wine-glass": (wine_glass.build, "Empty wine glass, a solid of revolution"),
}


def main():
    """Write and check all meshes; the exit status."""
    check.MESHES.mkdir(parents=True, exist_ok=True)
    for name, (build, title) in BUILDERS.items():
        obj.write(check.MESHES / f"{name}.obj", build(), title)
    return check.main()


if __name__ == "__main__":
    sys.exit(main())
