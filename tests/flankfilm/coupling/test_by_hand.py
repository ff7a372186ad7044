"""What stages hand on, against numbers worked out beside them: scales, curves over torque, the teeth at C."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import dynamics
import ehl
import fem
import flankfilm as ff
from ehl import Lubricant
from flankfilm import coupling
from flankfilm.coupling import given_series
from flankfilm.coupling.films.film_points import stiffness_rows
from flankfilm.coupling.films.films import PathFilms, contacts_of
from flankfilm.coupling.mesh.flanks import Flanks
from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth
from flankfilm.coupling.mesh.torque_curves import torque_curves
from flankfilm.coupling.speeds import jumps
from flankfilm.coupling.vibration.oscillator import pair_inertias
from gears import Gear, GearPair

PAIR = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
R_1, R_2 = 36e-3 * math.cos(math.radians(20)), 40e-3 * math.cos(math.radians(20))
"""Base radii [m]."""


def test_every_scale_of_a_pair_s_oscillator():
    series = given_series(8e8, [0.1, 0.02], [0.3, -0.2])
    motion = ff.pair_oscillator(
        PAIR.with_backlash(50e-6), series, 600.0, 200.0, damping_ratio=0.07, error_amplitude=10e-6, error_phase=0.4,
        extra_inertia=(1e-3, 2e-3),
    )  # fmt: skip
    force = 600.0 / R_1
    length = force / (0.1 * 8e8)
    # steel discs as large as the pitch circles have the gears' inertia within a few parts of a hundred
    inertias = [0.5 * 7850.0 * math.pi * r**4 * 40e-3 for r in (36e-3, 40e-3)]
    own = np.array(motion.inertias) - (1e-3, 2e-3)
    assert own == pytest.approx(inertias, rel=0.05)
    mass = 1 / (R_1**2 / motion.inertias[0] + R_2**2 / motion.inertias[1])
    natural = math.sqrt(8e8 / mass)
    oscillator = motion.oscillator
    assert motion.force == pytest.approx(force, rel=1e-12)
    assert motion.natural_frequency == pytest.approx(natural / (2 * math.pi), rel=1e-12)
    assert motion.frequency == oscillator.frequency == pytest.approx(36 * 200.0 / natural, rel=1e-12)
    assert motion.half_backlash == oscillator.half_backlash == pytest.approx(25e-6 / length, rel=1e-9)
    assert motion.mean_force == oscillator.mean_force == pytest.approx(0.1, rel=1e-12)
    assert oscillator.error_amplitude == pytest.approx(10e-6 / length, rel=1e-12)
    assert (oscillator.error_phase, oscillator.damping_ratio) == (0.4, 0.07)
    assert oscillator.stiffness.mean == pytest.approx(1.0, rel=1e-12)
    assert oscillator.stiffness.amplitudes == pytest.approx((0.1, 0.02), rel=1e-12)
    assert oscillator.stiffness.phases == (0.3, -0.2)
    back = ff.pair_oscillator(
        PAIR.with_backlash(50e-6), series, -600.0, 200.0, error_phase=0.4, length_scale=1e-4
    )
    assert back.oscillator.error_phase == pytest.approx(0.4 + math.pi)
    assert back.oscillator.half_backlash == pytest.approx(0.25, rel=1e-9)
    assert back.oscillator.mean_force == pytest.approx(force / (8e8 * 1e-4), rel=1e-12)


def test_what_turns_with_a_gear_is_given():
    assert pair_inertias(PAIR) == PAIR.moments_of_inertia
    assert pair_inertias(PAIR, (1e-3, 2e-3)) == tuple(np.add(PAIR.moments_of_inertia, (1e-3, 2e-3)))


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, tolerance=0.05)


def test_independent_pairs_err_as_their_teeth_do(bodies: fem.PairCompliance):
    by_elements = coupling.mesh_cycle(PAIR, 600.0, model="fem", pairs="independent", compliance=bodies)
    closed = coupling.mesh_cycle(PAIR, 600.0, model="potential-energy", pairs="independent")
    assert by_elements.error == bodies.error > 0.0
    assert closed.error is None


def test_curves_over_torque_are_those_of_many_positions(bodies: fem.PairCompliance):
    found = torque_curves(LoadedTeeth(PAIR, 150.0, compliance=bodies), [], positions=4)
    many = fem.mesh_cycle(PAIR, 150.0, 240, bodies)
    secant, turns = many.secant_stiffness, np.exp(-2j * math.pi * many.position)
    assert found.torque.tolist() == [150.0]
    assert found.secant_stiffness[0] == pytest.approx(secant.mean(), rel=5e-4)
    assert found.stiffness[0] == pytest.approx(many.stiffness.mean(), rel=5e-3)
    assert found.transmission_error[0] == pytest.approx(np.ptp(many.transmission_error), rel=5e-3)
    first = 2 * abs(np.mean(secant * turns)) / secant.mean()
    assert found.harmonic_1[0] == pytest.approx(first, rel=5e-3)


@pytest.mark.filterwarnings("ignore:Hertz pressure")
def test_the_teeth_beside_the_film_at_the_pitch_point_are_their_tangent(bodies: fem.PairCompliance):
    """What a little more torque deflects them by; the secant is 5 % less, since Hertzian contacts stiffen."""
    oil = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
    less, cycle, more = fem.mesh_cycle(PAIR, (597.0, 600.0, 603.0), 8, bodies, beyond_path=False)
    held = Flanks(beyond_path=False)
    dry = LoadedTeeth(PAIR, 600.0, compliance=bodies, flanks=held).cycle(8)
    rho1, contacts = contacts_of(PAIR, dry, 209.44, oil)
    nearest = int(np.argmin(np.abs(rho1 - PAIR.points.C)))
    film = ehl.solve(contacts[nearest], tolerance=0.05)
    rows = stiffness_rows(PAIR, cycle, PathFilms(rho1[[nearest]], (film,)))
    at = int(np.flatnonzero(np.any(cycle.rho1 == rho1[nearest], axis=1))[0])
    assert cycle.load_share[at].max() == 1.0
    tangent = 6.0 / R_1 / abs(more.transmission_error[at] - less.transmission_error[at])
    assert tangent > 1.03 * cycle.secant_stiffness[at]
    assert [row.definition for row in rows] == list(ehl.DEFINITIONS)
    for row in rows:
        assert row.stiffness == pytest.approx(40e-3 * film.stiffness(row.definition), rel=1e-12)
        assert row.stiffness * row.loss / (1 - row.loss) == pytest.approx(tangent, rel=2e-3)


def test_a_jump_s_speed_errs_by_what_another_stiffness_makes_of_it(monkeypatch: pytest.MonkeyPatch):
    """One per cent more stiffness: forces over it are one per cent less, the natural frequency half of one more."""
    monkeypatch.setattr(jumps, "stiffness_errors", lambda series: (0.01, np.zeros(series.order)))
    cycle = ff.mesh_cycle(PAIR, 600.0, model="potential-energy", pairs="independent")
    motion = ff.pair_oscillator(
        PAIR.with_backlash(50e-6), cycle, 600.0, 800.0, error_amplitude=10e-6, fourier_order=1
    )

    def fold(stiffer: float) -> dynamics.SpecialPoint:
        here = replace(motion.oscillator, frequency=0.5, mean_force=motion.oscillator.mean_force / stiffer)
        branch = dynamics.continue_branch(
            dynamics.find_orbit(here, here.rest_state()), "frequency", (0.5, 0.9)
        )
        return branch.special("saddle-node")[0]

    less, point, more = (fold(stiffer) for stiffer in (0.995, 1.0, 1.005))
    change = math.sqrt(1.005) * more.parameter - math.sqrt(0.995) * less.parameter
    stretch = SimpleNamespace(low=0.5, high=point.parameter, label=point.label)
    nothing = SimpleNamespace(truncation=lambda point, carried: 0.0)  # left out by the series
    jump = jumps._jump(motion, nothing, stretch, point, None)
    assert jump.rising
    assert jump.budget["stiffness"] == pytest.approx(abs(change) / point.parameter, rel=1e-3)
