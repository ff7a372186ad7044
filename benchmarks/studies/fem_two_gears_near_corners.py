"""Near A and E: the two gears of ``fem_two_gears`` with tip relief, and with a plastic wheel.

Run with ``python benchmarks/studies/fem_two_gears_near_corners.py --what relief`` (ten minutes) or ``--what
plastic`` (two). Relief is missing from the gaps of the two gears, whose meshes are those of involutes. Their teeth are
linear, on deformed and turned flanks: of a plastic wheel they know how contacts move, but not the energy of the third
order of strained gears, which is left out of the solver of ``fem.mesh_cycle`` in one of the rows.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace

import fem_two_gears as two
import numpy as np
from fem_moving_contact import PLASTIC

import fem
from fem.contact import moving_contact
from fem.contact.solver import solve_contact
from fem.laws.corner_laws import CornerLaws
from fem.laws.mesh_setup import MeshSetup
from gears import TipRelief

RELIEFS = (TipRelief(10e-6, 2e-3, "linear"), TipRelief(20e-6, 3e-3, "parabolic"))
PLACES = (-0.02, -0.0025, 0.0025, 0.02, 0.06, 0.12, 0.30)
TORQUE = 20.0
COARSE = {"growth": 0.25, "coarse": 1.6, "torque": TORQUE, "near": 260e-6, "half": 0.45e-3}


def relieved(relief):
    """Article's pair with a relief on both gears."""
    gears = (replace(gear, tip_relief=relief) for gear in (two.PAIR.pinion, two.PAIR.wheel))
    return replace(two.PAIR, **dict(zip(("pinion", "wheel"), gears, strict=True)))


def ours(bodies, position, torque, moving=False, strained=True):
    """Deflection [m] and forces [N/mm] by the solver of ``fem.mesh_cycle``."""
    energies = moving_contact._energies
    try:
        if not strained:
            moving_contact._energies = lambda parts, law: np.zeros((2, *np.shape(parts)[1:]))
        given = MeshSetup(bodies.pair, 1, moving_contact=moving).at(np.array([position % 1.0]))
        force = np.array([torque / bodies.pair.base_radii[0]])
        found = solve_contact(given, bodies, force, None, CornerLaws(given, bodies))
    finally:
        moving_contact._energies = energies
    share = found.share.forces[0, 0, 0] / bodies.pair.face_width / 1e3
    approach = found.share.transmission_error[0, 0, 0] + found.touch[0, 0]
    return float(approach), dict(zip(found.candidates.offset.tolist(), share.tolist(), strict=True))


def show(place, name, approach, per_mm, wanted=None):
    """A row."""
    forces = " ".join(f"{per_mm.get(o, 0.0):7.2f}" for o in (-1, 0, 1, 2))
    off = "" if wanted is None else f"{100 * (approach / wanted - 1):+.3f} %"
    print(f"{place:+.4f} {name:44s} {1e6 * approach:9.4f} um  {forces}  {off}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--what", choices=("relief", "plastic"), default="relief")
    parser.add_argument("--places", type=float, nargs="*", help="base pitches after A")
    parser.add_argument("--relief", type=int, nargs="*", default=range(len(RELIEFS)))
    given = parser.parse_args()
    if given.what == "plastic":
        pair = PLASTIC.with_backlash(400e-6)
        end = (pair.points.E - pair.points.A) / pair.base_pitch
        bodies = fem.compliance(pair)
        for place in given.places or (-0.02, 0.005, end - 0.036, end - 0.01, end + 0.02):
            found = two.solve(pair, place % 1.0, 20e-6, 50e-6, 0.0, True, True, **COARSE)
            show(place, "two gears, deformed", found.approach, found.per_mm)
            for name, options in (
                ("contacts that stay", {}),
                ("contacts that move, no strained gears", {"moving": True, "strained": False}),
                ("contacts that move", {"moving": True}),
            ):
                show(place, name, *ours(bodies, place, TORQUE, **options), found.approach)
        return 0
    for k in given.relief:
        pair = relieved(RELIEFS[k])
        print(RELIEFS[k])
        bodies = fem.compliance(pair, tolerance=1e-4)
        for place in given.places or PLACES:
            found = two.solve(pair, place % 1.0, 3e-6, 8e-6, 0.0, True, True)
            show(place, "two gears, deformed", found.approach, found.per_mm)
            show(place, "fem.mesh_cycle", *ours(bodies, place, two.TORQUE), found.approach)
    return 0


if __name__ == "__main__":
    sys.exit(main())
