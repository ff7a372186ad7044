"""The mesh over the face width: cells, leads, alignment, shafts, unequal widths, root stress."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import fem
from fem import mesh_cycle
from gears import Alignment, Gear, GearPair, Lead

from .case import Cases, take
from .cases_fem import cycle_figures
from .pairs import CROWNED, PAIR, PLASTIC, SHAFTS, SMALL, STEEL

case = Cases("face")
OVER_FACE = "face_position line_load face_load_factor"
SAMPLED = "position forces load_share transmission_error stiffness secant_stiffness"
LOADS = "contact_pattern greatest_face_load_factor greatest_line_load error tilt_stiffness moment_stiffness"
ASKEW = Alignment(in_plane=15e-6, out_of_plane=5e-6)


def face_figures(cycle: Any) -> dict[str, Any]:
    """Curves and figures of a mesh cycle over the face."""
    return {**cycle_figures(cycle, OVER_FACE), "face": take(cycle.face, LOADS)}


@cache
def bodies() -> Any:
    """Bodies of the small pair."""
    return fem.compliance(SMALL, 0.01)


@case()
def cells() -> dict[str, Any]:
    """4, 8 and 64 cells, straight and askew; slices and walls beside free ends."""
    figures: dict[str, Any] = {}
    for number in (4, 8):
        cycle = mesh_cycle(SMALL, 100.0, 12, bodies(), alignment=ASKEW, cells=number)
        figures[f"{number} cells"] = face_figures(cycle)
    many = mesh_cycle(SMALL, 100.0, 12, bodies(), alignment=ASKEW, cells=64)
    figures["64 cells"] = face_figures(many)
    figures["straight"] = face_figures(mesh_cycle(SMALL, 100.0, 12, bodies(), alignment=Alignment(), cells=8))
    walls = mesh_cycle(SMALL, 100.0, 12, bodies(), alignment=ASKEW, cells=8, face_model="walls")
    slices = mesh_cycle(SMALL, 100.0, 12, bodies(), alignment=ASKEW, cells=16, face_model="slices")
    figures |= {"walls": face_figures(walls), "slices": take(slices, f"{SAMPLED} {OVER_FACE}")}
    held = mesh_cycle(SMALL, [10.0, 100.0, 300.0], 12, bodies(), False, alignment=ASKEW, cells=16)
    return {**figures, **{f"path/{k}": face_figures(held_cycle) for k, held_cycle in enumerate(held)}}


@case()
def leads() -> dict[str, Any]:
    """Crowning, slope, end relief and an axis askew; the article's pair with 64 cells."""
    ended = replace(PAIR, pinion=replace(PAIR.pinion, lead=Lead(end_relief=8e-6, end_relief_length=5e-3)))
    crowned = mesh_cycle(CROWNED, [30.0, 150.0], 8, alignment=ASKEW, cells=24, tolerance=0.02)
    return {
        **{f"crowned/{k}": face_figures(cycle) for k, cycle in enumerate(crowned)},
        "ended": face_figures(
            mesh_cycle(ended, 600.0, 6, cells=64, alignment=Alignment(20e-6), tolerance=0.02)
        ),
    }


@case(quick=True)
def widths() -> dict[str, Any]:
    """A wider pinion, off the middle."""
    wide = Gear(20, face_width=26e-3, face_offset=1e-3)
    pair = GearPair(wide, Gear(30), module=2e-3, face_width=20e-3, material=STEEL).with_backlash(100e-6)
    return {"wide": face_figures(mesh_cycle(pair, 100.0, 12, alignment=ASKEW, cells=12, tolerance=0.01))}


@case()
def shafts() -> dict[str, Any]:
    """Shafts that bend and twist under their gears."""
    cycle = mesh_cycle(SMALL, [40.0, 100.0], 12, bodies(), cells=16, shafts=SHAFTS)
    more = "shaft_misalignment shaft_deflection shaft_transmission_error tilt_transmission_error mesh_matrix"
    return {
        f"{k}": {**face_figures(of_torque), "shafts": take(of_torque.face, more)}
        for k, of_torque in enumerate(cycle)
    }


@case()
def plastic() -> dict[str, Any]:
    """Contacts that move, over the face."""
    cycles = mesh_cycle(PLASTIC, [2.0, 8.0], 4, cells=4, alignment=Alignment(20e-6), tolerance=0.02)
    return {f"{k}": face_figures(cycle) for k, cycle in enumerate(cycles)}


@case()
def small_backlash() -> dict[str, Any]:
    """Cells with teeth that nearly bear on both flanks."""
    pair = SMALL.with_backlash(20e-6)
    return {"tight": face_figures(mesh_cycle(pair, 100.0, 4, cells=4, alignment=ASKEW, tolerance=0.02))}


@case()
def root_stress() -> dict[str, Any]:
    """Root stress over the face, with few cells and more."""
    figures: dict[str, Any] = {}
    for number in (4, 12):
        cycle = mesh_cycle(SMALL, 100.0, 12, bodies(), alignment=ASKEW, cells=number)
        stress = fem.root_stress(SMALL, cycle, tolerance=0.02)
        figures[f"{number}"] = take(stress, "pinion_tension_Pa wheel_tension_Pa error")
        for gear in ("pinion", "wheel"):
            face = getattr(getattr(stress, gear), "face", None)
            figures[f"{number}"][gear] = take(
                getattr(stress, gear) if face is None else face,
                "tension compression tension_error compression_error",
            )
    return figures
