"""What a solver says to do where it did not converge: done as worded, it converges."""

from __future__ import annotations

import re
import warnings
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import fem
from base import InputError, SolverError
from dynamics import FourierStiffness, GearOscillator, basins, continue_branch, find_orbit
from ehl import LineContact, Lubricant, solve
from flankfilm.coupling import lubricated_cycle
from flankfilm.coupling.mesh.resolution import resolution_of
from gears import Gear, GearDeviations, GearPair, Material, PitchDeviations

THIN = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
THICK = Lubricant(viscosity=90.0, pressure_viscosity=19.6e-9, density=910.0)
LONG = LineContact.from_moes(200.0, 10.0)
BRITTLE = LineContact.from_moes(20.0, 10.0, compressible=False)

solved, lubricated = cache(solve), cache(lubricated_cycle)
"""What several remedies begin or end with, computed once."""


@pytest.mark.parametrize(
    ("contact", "asked", "words", "follow"),
    [
        (LONG, {"tolerance": 1e-5}, "allow a larger tolerance", lambda film: {"tolerance": 1.01 * film.error}),
        (LONG, {"tolerance": 1e-5}, "give more nodes", lambda film: {"nodes": film.x.size + 1}),
        (LONG, {"tolerance": 2e-4, "grid": "uniform"}, "use the graded grid",
         lambda film: {"tolerance": 2e-4, "grid": "graded"}),
        (LONG, {"tolerance": 2e-4, "grid": "uniform"}, "give more nodes",
         lambda film: {"nodes": film.x.size + 1, "grid": "uniform"}),
        (BRITTLE, {"spike": 0.01}, "leave out spike", lambda film: {}),
    ],
    ids=["tolerance", "nodes", "grid", "nodes of a uniform grid", "spike"],
)  # fmt: skip
def test_films(contact, asked, words, follow):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        film = solved(contact, **asked)
        assert film.converged == ("spike" not in asked)
        assert words in film.message
        better = solve(contact, **follow(film))
    assert better.converged, better.message
    assert np.isfinite(better.central_thickness)
    assert better.message == "converged" or "nodes" in follow(film)


def article(**changes):
    return replace(
        GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 1.22, half_backlash=0.2),
        **changes,
    )


RESONANT = GearOscillator(FourierStiffness(1.0), 0.0, 0.1, 0.2, 1.0, half_backlash=0.0)


@pytest.mark.parametrize(
    ("oscillator", "asked", "words", "other", "follow"),
    [
        (article(), {"periods": 3, "transient": 300}, "try another number of periods", {},
         {"periods": 4, "transient": 300}),
        (article(), {"periods": 4, "max_iterations": 1}, r"for an attractor with transient=(\d+)", {},
         {"periods": 4, "transient": -1}),
        (RESONANT, {}, "change frequency", {"frequency": 1.1}, {}),
        (RESONANT, {}, "or damping", {"damping_ratio": 0.05}, {}),
    ],
    ids=["periods", "transient", "frequency", "damping"],
)  # fmt: skip
def test_orbits(oscillator, asked, words, other, follow):
    orbit = find_orbit(oscillator, (0.4, 0.0), **asked)
    assert not orbit.converged
    said = re.search(words, orbit.message)
    assert said, orbit.message
    if follow.get("transient") == -1:  # as said
        follow = {**follow, "transient": int(said[1])}
    better = find_orbit(replace(oscillator, **other), (0.4, 0.0), **follow)
    assert better.converged, better.message


def test_branches_and_basins():
    begin = find_orbit(article(frequency=0.5), (0.35, 0.0))
    short = continue_branch(begin, "frequency", (0.3, 0.6), max_points=5)
    assert not short.converged
    assert "5 points: raise max_points" in short.message
    assert continue_branch(begin, "frequency", (0.3, 0.6), max_points=500).converged
    slow = GearOscillator(FourierStiffness(1.0), 1e-3, 2.0, 0.1, 0.7, half_backlash=0.1)
    early, late = (basins(slow, x=(1.5, 3.0, 3), v=(-0.5, 0.5, 2), limit=n) for n in (5, 5000))
    assert "unsettled: raise limit" in early.message
    assert (early.converged, late.converged) == (False, True), late.message


@pytest.fixture(scope="module")
def steel():
    pair = GearPair(Gear(36), Gear(40), 2e-3, 0.04)
    return pair, fem.compliance(pair, tolerance=0.02)


def test_a_torque_beyond_the_tip_edges(steel):
    pair, bodies = steel
    refused = fem.mesh_cycle(pair, 2e6, 4, bodies)
    assert not refused.converged
    assert "reduce the torque" in refused.message
    assert fem.mesh_cycle(pair, 600.0, 4, bodies).converged


def test_gaps_closed_outside_the_path(steel):
    pair, bodies = steel

    def cycle(late, torque=10.0):
        cumulative = np.zeros(36)
        cumulative[2:6] = late
        deviations = (GearDeviations(pitch=PitchDeviations(cumulative)), None)
        return fem.mesh_cycle(pair, torque, 8, bodies, deviations=deviations, pitches=8)

    refused = cycle(3e-3)
    assert not refused.converged
    assert "reduce the torque or the deviations" in refused.message
    assert cycle(3e-5).converged


def test_contacts_that_move_too_far():
    plastic = Material(youngs_modulus=2.5e9, poisson_ratio=0.4, density=1400.0)
    pair = GearPair(Gear(24), Gear(36), 2e-3, 0.02, material=plastic)
    bodies = fem.compliance(pair, tolerance=0.02)

    def cycle(torque, moving):
        return fem.mesh_cycle(pair, torque, 4, bodies, beyond_path=False, moving_contact=moving)

    refused = cycle(5000.0, True)
    assert not refused.converged
    assert "reduce the torque, or let contacts stay" in refused.message
    assert cycle(5.0, True).converged
    assert cycle(5000.0, False).converged


def test_a_compliance_beyond_the_finest_mesh_is_kept_with_its_error(steel):
    pair, _ = steel
    coarse = fem.Options(finest=1)
    bodies = fem.compliance(pair, 2e-6, options=coarse)
    assert bodies.converged
    said = re.search(
        r"error ([\d.e-]+) above the tolerance .*: the mesh is the finest allowed$", bodies.message
    )
    assert said, bodies.message
    assert bodies.error == pytest.approx(float(said[1]), rel=0.1)
    assert "tolerance" not in fem.compliance(pair, 1.1 * float(said[1]), options=coarse).message


def test_teeth_that_jam_by_their_pitch():
    loose = GearPair(Gear(12, 0.3), Gear(24), 2e-3, 0.02).with_backlash(8e-6)
    cumulative = np.zeros(12)
    cumulative[5] = 20e-6
    deviations = (GearDeviations(None, PitchDeviations(tuple(cumulative))), None)

    def message(pair):
        bodies = fem.compliance(pair, tolerance=0.02)
        return fem.mesh_cycle(pair, 2.0, 4, bodies, deviations=deviations, pitches=12).message

    assert "which is left out; give more backlash, or a tight pair" in message(loose)
    assert "left out" not in message(loose.with_backlash(50e-6))
    assert "left out" not in message(replace(loose, tight=True))


def test_a_torque_of_zero_with_play(steel):
    pair, bodies = steel[0].with_backlash(50e-6), steel[1]
    bodies = fem.compliance(pair, tolerance=0.02)
    with pytest.raises(InputError, match="Leave it out, or give less backlash"):
        fem.mesh_cycle(pair, [-10.0, 0.0, 10.0], 4, bodies)
    assert len(fem.mesh_cycle(pair, [-10.0, 10.0], 4, bodies)) == 2
    pressed = replace(pair, centre_distance=pair.centre_distance_of_backlash(-4e-6), tight=True)
    assert fem.mesh_cycle(pressed, [-10.0, 0.0, 10.0], 4, fem.compliance(pressed, tolerance=0.02))[
        1
    ].converged


def test_a_tolerance_that_no_resolution_meets():
    with pytest.raises(SolverError, match="no resolution meets a tolerance of 1e-07; raise it"):
        resolution_of(1e-7)
    assert resolution_of(1e-3)


@pytest.mark.parametrize(
    ("teeth", "torque", "oil", "follow"),
    [
        ({"model": "ishikawa", "pairs": "independent"}, 10.0, THIN, (600.0, THIN)),
        ({"model": "ishikawa", "pairs": "independent"}, 600.0, THICK, (600.0, THIN)),
        ({}, 0.001, THIN, (600.0, THIN)),
    ],
    ids=["a light load", "a thick oil", "a light load on coupled teeth"],
)
def test_films_softer_than_the_teeth(teeth, torque, oil, follow):
    pair = GearPair(Gear(36), Gear(40), 2e-3, 0.04).with_backlash(50e-6)
    with pytest.raises(SolverError, match="raise the torque, or lower speed and viscosity"):
        lubricated_cycle(pair, torque, 209.44, oil, tolerance=0.02, **teeth)
    assert lubricated(pair, follow[0], 209.44, follow[1], tolerance=0.02, **teeth).converged
