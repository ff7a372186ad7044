"""The mesh in the plane: stiffness of one pair, mesh cycles of steel and plastic, root stress."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

import fem
import gears
from fem import mesh_cycle

from .case import Cases, take
from .pairs import PAIR, PLASTIC, RELIEVED, SHIFTED, SMALL, TORQUE

case = Cases("fem")
CURVES = (
    "position rho1 forces load_share transmission_error stiffness secant_stiffness half_width hertz_pressure "
    "dense_position dense_stiffness dense_secant_stiffness dense_transmission_error event_position"
)
FIGURES = (
    "mean_stiffness mean_secant_stiffness least_stiffness greatest_stiffness least_secant_stiffness "
    "greatest_secant_stiffness transmission_error_range greatest_load_share stiffness_harmonics "
    "secant_stiffness_harmonics transmission_error_harmonics model_error error errors converged message"
)


def cycle_figures(cycle: Any, more: str = "") -> dict[str, Any]:
    """Curves and figures of a mesh cycle."""
    return take(cycle, f"{CURVES} {FIGURES} {more}")


@cache
def article() -> Any:
    """Bodies of the pair of several cases."""
    return fem.compliance(PAIR, tolerance=0.001)


@case(quick=True)
def single_pair() -> dict[str, Any]:
    """Stiffness of one pair of teeth along the path against every reference, tips included; bodies alone."""
    rho1, force = PAIR.path_of_contact(n=41).rho1, PAIR.normal_force(TORQUE)
    bodies = article()
    stiffness = {
        reference: fem.single_pair_stiffness(PAIR, force, rho1, bodies, reference=reference)
        for reference in ("body", "bore", "teeth")
    }
    coarse = fem.single_pair_stiffness(SHIFTED, 1e4, SHIFTED.path_of_contact(n=21).rho1, tolerance=0.01)
    stress = fem.single_pair_stiffness(PAIR, force, rho1[::8], tolerance=0.01, plane="stress")
    return {
        **stiffness,
        "shifted": coarse,
        "plane stress": stress,
        "bodies": take(bodies, "error gain fit_error"),
    }


@case(quick=True)
def steel() -> dict[str, Any]:
    """Steel: held to the path and with tips free, several torques, every reference, both ways of the sequence."""
    bodies = article()
    several = mesh_cycle(PAIR, [5.0, 100.0, 600.0, 1500.0], positions=40, compliance=bodies)
    cycles: dict[str, Any] = {f"tips/{k}": cycle_figures(cycle) for k, cycle in enumerate(several)}
    back = mesh_cycle(PAIR, [1500.0, 100.0], positions=40, compliance=bodies)
    cycles |= {f"falling/{k}": cycle_figures(cycle) for k, cycle in enumerate(back)}
    for reference in ("body", "bore", "teeth"):
        held = mesh_cycle(PAIR, TORQUE, 40, bodies, beyond_path=False, reference=reference)
        cycles[f"path, {reference}"] = cycle_figures(held)
    return cycles


@case()
def meshes_of_their_own() -> dict[str, Any]:
    """Nothing given but the pair: tolerances, plane stress, inertia of the bores, supports."""
    supported = fem.compliance(
        SMALL, 0.01, supports=(fem.Support(hub_radius=11e-3), fem.Support(hub_radius=16e-3))
    )
    return {
        "coarse": cycle_figures(mesh_cycle(SHIFTED, 150.0, positions=20, tolerance=0.01)),
        "plane stress": cycle_figures(mesh_cycle(SMALL, 80.0, positions=20, tolerance=0.01, plane="stress")),
        "supported": cycle_figures(mesh_cycle(SMALL, 80.0, 20, supported, reference="bore")),
    }


@case()
def relief() -> dict[str, Any]:
    """Tip relief, rounded tips, friction, from hardly loaded to heavily loaded."""
    bodies = fem.compliance(RELIEVED, 0.005)
    cycles = mesh_cycle(RELIEVED, [20.0, 200.0, 800.0], 40, bodies)
    rounded = mesh_cycle(RELIEVED, 300.0, 40, bodies, tip_rounding=20e-6)
    rubbing = mesh_cycle(RELIEVED, 300.0, 40, bodies, friction=0.06)
    stays = mesh_cycle(RELIEVED, 300.0, 20, bodies, beyond_path=False, moving_contact=True)
    return {
        **{f"torque {k}": cycle_figures(cycle) for k, cycle in enumerate(cycles)},
        "rounded": cycle_figures(rounded),
        "friction": cycle_figures(rubbing, "efficiency"),
        "steel moves": cycle_figures(stays),
        "unloaded": fem.unloaded_transmission_error(RELIEVED, 40, tip_rounding=20e-6),
    }


@case()
def deviations() -> dict[str, Any]:
    """Profiles and pitches that deviate, over several pitches."""
    rho = tuple(np.linspace(7e-3, 15e-3, 9))
    gear = gears.GearDeviations(
        profile=gears.ProfileDeviation(rho, tuple(1e-6 * np.sin(np.arange(9.0)))),
        pitch=gears.PitchDeviations(tuple(1e-6 * np.cos(0.5 * np.arange(36.0)))),
    )
    cycle = mesh_cycle(PAIR, 200.0, 16, article(), deviations=(gear, None), pitches=3, first_teeth=(4, 1))
    unloaded = fem.unloaded_transmission_error(PAIR, 24, deviations=(gear, None), pitches=3)
    return {"loaded": cycle_figures(cycle), "unloaded": unloaded}


@case(quick=True)
def plastic() -> dict[str, Any]:
    """Steel on plastic: contacts that move and that stay, with and without tips, torques up to back contact."""
    bodies = fem.compliance(PLASTIC, 0.005, motion=True)
    figures: dict[str, Any] = {}
    for beyond in (True, False):
        cycles = mesh_cycle(PLASTIC, [1.0, 5.0, 12.0, 30.0], 24, bodies, beyond)
        figures |= {f"beyond {beyond}/{k}": cycle_figures(cycle) for k, cycle in enumerate(cycles)}
    stays = mesh_cycle(PLASTIC, 5.0, 24, bodies, moving_contact=False, reference="bore")
    return {**figures, "stays": cycle_figures(stays)}


@case()
def back_flanks() -> dict[str, Any]:
    """Small backlash and none: teeth that bear on both flanks."""
    tight = PAIR.with_backlash(2e-6)
    none = replace(PAIR.with_backlash(0.0), tight=True)
    bodies = fem.compliance(none, 0.005)
    figures: dict[str, Any] = {}
    for name, pair, torques in (("tight", tight, [100.0, 1200.0]), ("none", none, [50.0, 600.0])):
        for beyond in (True, False):
            cycles = mesh_cycle(pair, torques, 24, bodies if pair is none else None, beyond)
            figures |= {
                f"{name}, beyond {beyond}/{k}": cycle_figures(c, "back_gap") for k, c in enumerate(cycles)
            }
            opposite = {
                k: None if c.opposite is None else take(c.opposite, "forces") for k, c in enumerate(cycles)
            }
            figures[f"{name}, beyond {beyond}/opposite"] = opposite
    return figures


@case(quick=True)
def root_stress() -> dict[str, Any]:
    """Stress of the roots over the cycle, of steel and of a wheel of plastic."""
    figures: dict[str, Any] = {}
    for name, pair, torque in (
        ("steel", PAIR, TORQUE),
        ("plastic", PLASTIC, 8.0),
        ("relieved", RELIEVED, 300.0),
    ):
        cycle = mesh_cycle(pair, torque, 24, article() if pair is PAIR else None, tolerance=0.005)
        stress = fem.root_stress(pair, cycle, tolerance=0.02)
        figures[name] = take(stress, "pinion_tension_Pa wheel_tension_Pa error errors converged message")
        figures[name]["gears"] = {gear: getattr(stress, gear) for gear in ("pinion", "wheel")}
    return figures
