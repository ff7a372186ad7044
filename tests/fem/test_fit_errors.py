"""Errors that contain what is fitted along flanks, and what a load at a tip corner means, which has no limit there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.elasticity import flank_samples
from fem.elasticity.nonlinear_energy import NOMINAL
from fem.influence import flank_motion, gear_store
from gears import Gear, GearPair, Material

PAIR = GearPair(Gear(teeth=20), Gear(teeth=20), module=2e-3, face_width=20e-3).with_backlash(100e-6)
PLASTIC = replace(PAIR, material=(Material(206e9, 0.3, 7850.0), Material(2.8e9, 0.36, 1410.0))).with_backlash(
    600e-6
)
TIGHT = replace(PAIR, centre_distance=PAIR.centre_distance_of_backlash(-5e-6), tight=True)
CURVES = ("stiffness", "secant_stiffness", "transmission_error")
FIGURES = ("mean_stiffness", "mean_secant_stiffness", "transmission_error_range", "greatest_stiffness")
FEW, USUAL, MANY = 5, 9, 33


def moves(cycle, other):
    """Largest moves of curves and figures over the errors that the first one reports."""
    curves = [np.max(np.abs(getattr(other, n) / getattr(cycle, n) - 1.0)) / cycle.error for n in CURVES]
    return curves, [abs(getattr(other, n) / getattr(cycle, n) - 1.0) / cycle.errors[n] for n in FIGURES]


def motions(bodies, level, places, monkeypatch):
    """Flanks' motion by loads at so many places, on one of the meshes."""
    monkeypatch.setattr(flank_motion, "PLACES", places)
    store = gear_store.GearStore()
    return bodies._sized(lambda meshed: flank_motion.flank_motion(store.rings(meshed)[level]))


def test_errors_contain_what_the_motion_of_flanks_is_off_by(monkeypatch):
    """Against loads at many places on the finer mesh, under a pressure as wide as the contacts are."""
    bodies = fem.compliance(PLASTIC, 0.02)
    cycles = {}
    for places in (USUAL, FEW):
        moved = replace(bodies, flank_motions=motions(bodies, "coarse", places, monkeypatch))
        cycles[places] = fem.mesh_cycle(PLASTIC, 10.0, 8, moved)
    width = np.nanmax(cycles[USUAL].half_width) / PLASTIC.module / NOMINAL
    assert 0.5 < width < 1.0
    assert np.nanmax(cycles[FEW].half_width) / PLASTIC.module / NOMINAL == pytest.approx(width, rel=0.02)
    energies = flank_motion.third_order
    monkeypatch.setattr(flank_motion, "third_order", lambda loads, size: energies(loads, width * size))
    true = replace(bodies, flank_motions=motions(bodies, "fine", MANY, monkeypatch))
    best = fem.mesh_cycle(PLASTIC, 10.0, 8, true)
    for places, cycle in cycles.items():
        curves, figures = moves(cycle, best)
        assert max(*curves, *figures) < 1.0, places
        # what errors would be without it is less than that
        assert max(curves) * cycle.error > 1.5 * bodies.error, places


def test_errors_contain_what_back_flanks_are_off_by(monkeypatch, no_gear_solved):
    """Against loads at four times as many places, on a much finer mesh."""
    cycles = []
    for samples, tolerance in ((10, 0.02), (40, 1e-5)):
        fem.forget_gears()
        monkeypatch.setattr(gear_store, "BACK_SAMPLES", samples)
        cycles.append(fem.mesh_cycle(TIGHT, 20.0, 8, fem.compliance(TIGHT, tolerance)))
    assert cycles[0].opposite is not None
    curves, figures = moves(*cycles)
    assert max(*curves, *figures) < 1.0


def test_a_load_at_a_tip_corner_is_one_a_hundredth_of_a_module_before_it():
    """A line load at the corner itself has no compliance: a wedge yields as the distance's logarithm."""
    bodies = fem.compliance(PAIR, 0.01)
    gear, m = bodies.pinion, PAIR.module
    assert gear.rho_range[1] == pytest.approx(gear.rho_end - 0.01 * m, rel=1e-12)
    ends = gear.own(gear.rho_end - np.array([0.0, 0.01, 0.02]) * m)
    assert ends[0] == pytest.approx(ends[1], rel=1e-12)
    assert ends[1] - ends[2] == pytest.approx(-gear.logarithm * np.log(2.0), rel=0.1)


def test_the_distance_of_that_load_decides_the_compliance_there_alone(monkeypatch, no_gear_solved):
    """Farther from the corner, and in cycles, whose corners have laws of their own, it moves less than the errors."""
    near, cycles = [], []
    for clearance in (0.005, 0.01, 0.02):
        fem.forget_gears()
        monkeypatch.setattr(flank_samples, "CORNER_CLEARANCE", clearance)
        bodies = fem.compliance(PAIR, 0.01)
        gear = bodies.pinion
        inside = gear.rho_end - np.geomspace(0.02, 1.0, 9) * PAIR.module
        near.append((gear.own(inside), gear.own(np.array([gear.rho_end]))[0]))
        cycles.append(fem.mesh_cycle(PAIR, 50.0, 3, bodies))
    (_, nearest), (usual, at_corner), (_, farthest) = near
    for inside, _ in near:
        assert np.max(np.abs(inside / usual - 1.0)) < bodies.error
    for change in (nearest - at_corner, at_corner - farthest):
        assert change == pytest.approx(-gear.logarithm * np.log(2.0), rel=0.1)
    for cycle in cycles:
        curves, figures = moves(cycles[1], cycle)
        assert max(*curves, *figures) < 0.1
