"""Which stiffness model a scene may have: what each leaves out, and what each costs.

A closed form has no error bound. Known is only how far it was from finite elements over many
pairs (``python benchmarks/studies/closed_form_scatter.py``); inside the ranges of that comparison the largest
difference found stands for its error. A comparison for the pair at hand, as ``flankfilm verify`` makes it, needs the
same mesh and factors as the finite elements themselves: 0.35 s of which the loaded contact is the smallest part, so
that nothing could be saved after it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import gears
from flankfilm.building.pair import pinion_torque
from flankfilm.coupling.mesh.resolution import stiffness_laws
from flankfilm.plan.decisions import said
from flankfilm.plan.options import Option, Options
from flankfilm.scene.needs import needs_of_finite_elements

if TYPE_CHECKING:
    from flankfilm.scene import Scene

LARGEST_DIFFERENCE = {
    ("potential-energy", "coupled"): 0.37,
    ("potential-energy", "independent"): 0.17,
    ("ishikawa", "coupled"): 1.58,
    ("ishikawa", "independent"): 0.88,
    ("weber-banaschek", "coupled"): 1.53,
    ("weber-banaschek", "independent"): 0.84,
}
"""Root mean square of the difference from finite elements over the mesh cycle, over the mean; largest of 200 pairs."""

RANGES = {
    "teeth": (17, 150),
    "profile shift": (-0.5, 0.5),
    "bore over root radius": (0.2, 0.7),
    "force over face width, module and Young's modulus": (20e6 / 206e9, 300e6 / 206e9),
    "Poisson's ratio": (0.25, 0.35),
}
"""Where the comparison holds: gears of one material, cut by the rack ISO 53 A, with plain tips, in plane strain."""


def teeth(scene: Scene, pair: gears.GearPair) -> Options:
    """Models of the teeth that a scene may have; the last is what all are compared with."""
    asked, pairs = scene.stiffness.model, scene.stiffness.pairs
    elements = Option("fem", 0.0, stiffness_laws("fem", pairs), text="finite elements")
    if asked == "fem":
        return Options((elements,), f"finite elements; {said(scene, 'stiffness', 'model')}")
    if asked != "auto":
        reason = f"{said(scene, 'stiffness', 'model')}; its error is unknown until verified"
        return Options((Option(asked, None, stiffness_laws(asked, pairs)),), reason)
    if needed := needs_of_finite_elements(scene.as_given, set(scene.wants)):
        return Options((elements,), f"finite elements, which {' and '.join(needed)} needs")
    if outside := _outside(scene, pair):
        return Options((elements,), f"finite elements; closed forms were not compared where {outside}")
    closed = tuple(
        Option(model, effect, stiffness_laws(model, pairs), text=f"closed form ({model})")
        for (model, kind), effect in LARGEST_DIFFERENCE.items()
        if kind == pairs
    )
    return Options((*closed, elements))


def _outside(scene: Scene, pair: gears.GearPair) -> str:
    """Where a scene lies outside the comparison; empty where it does not."""
    modulus = min(m.youngs_modulus for m in pair.materials)
    force = abs(pair.normal_force(pinion_torque(scene)))
    members = (pair.pinion, pair.wheel)
    of_gears: dict[str, list[float]] = {
        "teeth": [gear.teeth for gear in members],
        "profile shift": [gear.profile_shift for gear in members],
        "bore over root radius": [b / r for b, r in zip(pair.bore_radii, pair.root_radii, strict=True)],
        "force over face width, module and Young's modulus": [
            force / (pair.face_width * pair.module * modulus)
        ],
        "Poisson's ratio": [m.poisson_ratio for m in pair.materials],
    }
    for name, values in of_gears.items():
        low, high = RANGES[name]
        astray = [value for value in values if not low <= value <= high]
        if astray:
            return f"{name} is {astray[0]:.3g}, outside {low:.3g} to {high:.3g}"
    assert scene.pair is not None
    sections = (scene.pair.pinion, scene.pair.wheel)
    if scene.pair.rack != "ISO 53 A" or scene.pair.tool is not None:
        return 'the rack is not "ISO 53 A"'
    if any(s.tip_relief is not None or s.tip_chamfer_mm for s in sections) or any(
        gear.tip_alteration for gear in members
    ):
        return "tips are relieved, altered or chamfered"
    if any(gear.generating_shift is not None for gear in members):
        return "a gear is cut at a generating shift"
    if any(profile.steps for profile in pair.teeth_profiles):
        return "a gear has a web"
    if pair.materials[0] != pair.materials[1]:
        return "the gears are of two materials"
    if scene.stiffness.plane != "strain":
        return "the stress is plane"
    return ""
