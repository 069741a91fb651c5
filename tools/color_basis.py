"""Works out what share of light red, green and blue things send back, for `crates/cloakroom/src/color/standard.rs`.

Of all functions of the wavelength that are not negative, sum to one, and look under D65 to the CIE's
observer of 1931 as linear sRGB says, those with the least sum of squared steps. The tables of the
standard are read from that file; its last table is printed anew:

    pip install cvxpy numpy
    python tools/color_basis.py          # prints it
    python tools/color_basis.py --check  # compares it with the one in the file
"""

import argparse
import re
import sys
from pathlib import Path

import cvxpy
import numpy as np

STANDARD = Path(__file__).parents[1] / "crates/cloakroom/src/color/standard.rs"

# Chromaticities of the primaries of sRGB (IEC 61966-2-1); its white is that of the tables themselves.
PRIMARIES = np.array([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]])


def table(name, columns):
    """A table of numbers of the standard's file, one row a wavelength."""
    text = STANDARD.read_text()
    body = text[text.index(f"pub const {name}:") :].split(" = [", 1)[1].split("];", 1)[0]
    return np.array([float(number) for number in re.findall(r"[\d.]+(?:e-?\d+)?", body)]).reshape(-1, columns)


def basis():
    """The shares of a red, a green and a blue thing, in columns."""
    observer, daylight = table("OBSERVER", 3), table("D65", 1)
    ends = np.ones_like(daylight)
    ends[[0, -1]] = 0.5
    weights = observer * daylight * ends
    weights /= weights[:, 1].sum()
    directions = np.column_stack([PRIMARIES, 1 - PRIMARIES.sum(axis=1)]).T
    primaries = directions * np.linalg.solve(directions, weights.sum(axis=0))

    shares = cvxpy.Variable((len(observer), 3), nonneg=True)
    roughness = cvxpy.sum_squares(cvxpy.diff(shares))
    limits = [weights.T @ shares == primaries, cvxpy.sum(shares, axis=1) == 1]
    cvxpy.Problem(cvxpy.Minimize(roughness), limits).solve(
        solver="CLARABEL", tol_gap_abs=1e-12, tol_gap_rel=1e-12, tol_feas=1e-12
    )
    return shares.value


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--check", action="store_true", help="compare with the table in the file")
    found = basis()[:, :2].clip(0, 1)
    if parser.parse_args().check:
        off = np.abs(found - table("RED_AND_GREEN", 2)).max()
        print(f"largest difference: {off:.1e}")
        return int(off > 2e-5)
    rows = [f"[{red:.5f}, {green:.5f}]" for red, green in found]
    for first in range(0, len(rows), 3):
        print("    " + ", ".join(rows[first : first + 3]) + ",")
    return 0


if __name__ == "__main__":
    sys.exit(main())
