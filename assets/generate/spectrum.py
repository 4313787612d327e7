#!/usr/bin/env python3
"""Writes crates/scene/src/spectrum/tables.rs: colour matching, daylight, and the spectra of the three primaries.

Needs `pip install numpy scipy colour-science`; the package colour-science holds the CIE's tables. Run from the repository.
"""

import colour
import numpy as np
from scipy.optimize import minimize

STEP = 5.0
RGB_FROM_XYZ = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]])


def tables():
    shape = colour.SpectralShape(380, 780, STEP)
    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(shape).values
    daylight = colour.SDS_ILLUMINANTS["D65"].copy().align(shape).values
    return shape.wavelengths, observer, daylight


def primaries(observer, daylight):
    """The smoothest three spectra from 0 to 1 that sum to 1 and have the colours of the primaries under daylight."""
    count = len(daylight)
    steps = np.full(count, STEP)
    steps[[0, -1]] *= 0.5
    response = (observer @ RGB_FROM_XYZ.T) * (daylight * steps)[:, None]
    response /= response.sum(0)
    curvature = np.diff(np.eye(count), 2, axis=0)
    square = curvature.T @ curvature

    def split(x):
        return x[:count], x[count:], 1 - x[:count] - x[count:]

    def roughness(x):
        return sum(v @ square @ v for v in split(x))

    def slope(x):
        red, green, blue = split(x)
        return 2 * np.concatenate([square @ (red - blue), square @ (green - blue)])

    colours = np.zeros((6, 2 * count))
    colours[:3, :count] = colours[3:, count:] = response.T
    wanted = np.array([1, 0, 0, 0, 1, 0])
    sums = np.hstack([np.eye(count), np.eye(count)])
    nm = 380 + STEP * np.arange(count)
    start = np.concatenate([1 / (1 + np.exp((590 - nm) / 15)), np.exp(-(((nm - 540) / 45) ** 2))])
    found = minimize(
        roughness, start, jac=slope, method="SLSQP", bounds=[(0, 1)] * (2 * count),
        constraints=[
            {"type": "eq", "fun": lambda x: colours @ x - wanted, "jac": lambda x: colours},
            {"type": "ineq", "fun": lambda x: 1 - sums @ x, "jac": lambda x: -sums},
        ],
        options={"maxiter": 2000, "ftol": 1e-14},
    )
    assert found.success, found.message
    red, green, _ = split(found.x)
    return np.clip(red, 0, 1), np.clip(green, 0, 1)


def main():
    nm, observer, daylight = tables()
    red, green = primaries(observer, daylight)
    with open("crates/scene/src/spectrum/tables.rs", "w") as file:
        file.write("//! Made by `assets/generate/spectrum.py`; every 5 nm from 380 to 780 nm.\n\n")
        file.write("/// x̄, ȳ, z̄ of the CIE 1931 standard observer, and the relative power of the illuminant D65 (CIE 015:2018).\n")
        file.write("#[rustfmt::skip]\n")
        file.write(f"pub(super) const OBSERVER_AND_DAYLIGHT: [[f64; 4]; {len(nm)}] = [\n")
        for row, power in zip(observer, daylight):
            file.write("    [" + ", ".join(f"{x:.12g}" if "." in f"{x:.12g}" or "e" in f"{x:.12g}" else f"{x:.1f}" for x in (*row, power)) + "],\n")
        file.write("];\n\n/// Spectra of the red and the green primary; that of the blue one is the rest to 1.\n")
        file.write("#[rustfmt::skip]\n")
        file.write(f"pub(super) const RED_AND_GREEN: [[f64; 2]; {len(nm)}] = [\n")
        for r, g in zip(red, green):
            file.write(f"    [{r:.9f}, {g:.9f}],\n")
        file.write("];\n")


if __name__ == "__main__":
    main()
