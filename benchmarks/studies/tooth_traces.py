"""Numbers of docs/validation/contact.md: traces of each tooth and wear.

Run it from the repository: ``python benchmarks/studies/tooth_traces.py``.
"""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import numpy as np

import fem
from flankfilm.building.flanks import deviations
from flankfilm.building.pair import gear_pair, tip_roundings
from flankfilm.scene import read_scene
from gears import Gear, GearDeviations, GearPair, TipRelief, WearDepth

EXAMPLE = Path(__file__).parents[2] / "examples" / "worn_flanks.toml"


def apart(one: fem.MeshCycle, two: fem.MeshCycle) -> str:
    """Greatest difference of transmission errors and of stiffness."""
    error = np.max(np.abs(one.transmission_error - two.transmission_error))
    stiffness = np.max(np.abs(one.stiffness / two.stiffness - 1))
    return f"transmission error {1e9 * error:.3g} nm, tangent stiffness {100 * stiffness:.3g} %"


def main() -> None:
    """Print all."""
    scene = read_scene(EXAMPLE)
    pair = gear_pair(scene)
    pinion, wheel = deviations(scene, pair, every_tooth=True)
    bodies = fem.compliance(pair)
    given = {"positions": 40, "compliance": bodies, "pitches": 36, "tip_rounding": tip_roundings(scene)}
    cycle = fem.mesh_cycle(pair, 300.0, deviations=(pinion, wheel), **given)
    print(
        f"example: {1e6 * np.ptp(cycle.transmission_error):.2f} um loaded, "
        f"{1e6 * np.ptp(cycle.unloaded_transmission_error):.2f} um unloaded"
    )

    trace = pinion.profile[11]
    alike = replace(pinion, profile=trace), replace(pinion, profile=(trace,) * 36)
    one, each = (fem.mesh_cycle(pair, 300.0, deviations=(gear, wheel), **given) for gear in alike)
    print("equal traces against one profile:", apart(one, each))

    # laws of tip edges by another trace than the mean; the flanks themselves stay as they are
    for tooth in (0, 11, 20):
        other = replace(pinion)
        other.__dict__["mean"] = GearDeviations(pinion.profile[tooth])
        print(
            f"tip edges with the law of tooth {tooth}:",
            apart(fem.mesh_cycle(pair, 300.0, deviations=(other, wheel), **given), cycle),
        )
    held = fem.mesh_cycle(pair, 300.0, beyond_path=False, deviations=(pinion, wheel), **given)
    print("without tip edges outside the path:", apart(held, cycle))

    relief = TipRelief(12e-6, 1.9e-3)
    eased, plain = (
        GearPair(Gear(36, tip_relief=r), Gear(40, tip_relief=r), 2e-3, 0.04) for r in (relief, None)
    )
    worn = []
    for profile in eased.teeth_profiles:
        low, high = profile.flank_rho
        worn.append(
            GearDeviations(wear=WearDepth([low, high - relief.length, high], [0, 0, relief.amount], "linear"))
        )
    cycles = (
        fem.mesh_cycle(eased, 400.0, 40, fem.compliance(eased)),
        fem.mesh_cycle(plain, 400.0, 40, fem.compliance(plain), deviations=worn),
    )
    print("wear like linear tip relief:", apart(*cycles))

    for pitches, both in (
        (36, (replace(pinion, profile=None), None)),
        (36, (pinion, wheel)),
        (360, (pinion, wheel)),
    ):
        start = time.perf_counter()
        fem.mesh_cycle(pair, 300.0, deviations=both, **{**given, "pitches": pitches})
        kind = "pitches alone" if both[1] is None else "traces and wear"
        print(f"{pitches} base pitches, {kind}: {1e3 * (time.perf_counter() - start):.0f} ms")


if __name__ == "__main__":
    main()
