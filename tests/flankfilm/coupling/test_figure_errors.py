"""Errors of figures against the truth: more cells, more samples, more films, tighter tolerances, on random scenes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

import dynamics
import ehl
import fem
import gears
from flankfilm.coupling import FilmAlongPath, LoadedTeeth, MeshLosses, face_load_models, lubricate, mesh_cycle
from flankfilm.coupling.films import films
from flankfilm.coupling.films.films import FilmModel
from flankfilm.coupling.mesh.extreme_errors import of_sampled_greatest
from flankfilm.coupling.mesh.flanks import Flanks
from flankfilm.coupling.mesh.resolution import Resolution
from flankfilm.coupling.vibration.resonance import SAMPLES, vibration, vibrations

OIL = ehl.Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
SPEED = 150.0

EASY = Resolution(0.005, 0.002, 0.005, 0.005, 1e-3)


def held(estimates: Sequence[float], truths: Sequence[float]) -> tuple[float, float]:
    """Part of the estimates within 0.5 to 5 of the truth, and the least ratio; exact figures count as held."""
    estimate, truth = np.array(estimates), np.array(truths)
    rounding = 1e-9
    ratio = np.where(truth <= rounding, 1.0, estimate / np.maximum(truth, rounding))
    return float(np.mean((ratio >= 0.5) & (ratio <= 5.0))), float(ratio.min())


def random_pair(chance: np.random.Generator, **of_pinion: object) -> gears.GearPair:
    first = int(chance.integers(18, 40))
    second = int(chance.integers(first, 60))
    width = float(chance.uniform(12e-3, 40e-3))
    return gears.GearPair(gears.Gear(first, **of_pinion), gears.Gear(second), module=2e-3, face_width=width)


def along_path(teeth: LoadedTeeth, positions: int, monkeypatch: pytest.MonkeyPatch) -> FilmAlongPath:
    monkeypatch.setattr(films, "FILM_POSITIONS", positions)
    dry = teeth.cycle(positions)
    return lubricate(teeth, dry, SPEED, OIL, EASY, FilmModel("dowson"), profiles=False).film


def test_largest_pressure_along_the_path(monkeypatch: pytest.MonkeyPatch):
    chance, estimates, truths = np.random.default_rng(11), [], []
    for _ in range(10):
        pair = random_pair(chance)
        teeth = LoadedTeeth(pair, 4000.0 * pair.face_width * pair.base_radii[0] / 0.02, model="ishikawa")
        found, fine = (along_path(teeth, n, monkeypatch) for n in (40, 800))
        estimates.append(found.greatest_pressure_error)
        truths.append(abs(found.greatest_pressure / fine.greatest_pressure - 1.0))
    part, least = held(estimates, truths)
    assert part >= 0.8
    assert least >= 0.5


def test_maximum_of_a_curve_by_its_samples():
    """Steps and corners, wherever the samples lie: at least half of the truth."""
    offsets = (np.arange(40) + 0.5) / 40.0
    for curve, most in (
        (lambda x: np.where(x < 3.0, 5.0, 10.0 - 0.2 * (x - 3.0)), 10.0),
        (lambda x: 10.0 - 0.3 * np.abs(x - 4.0), 10.0),
        (lambda x: np.where(x > 5.0, 4.0, 8.0 + 0.1 * x), 8.5),
    ):
        estimates, truths = [], []
        for offset in offsets:
            values = np.asarray(curve(np.arange(9) + offset))
            estimates.append(of_sampled_greatest(values))
            truths.append(most / values.max() - 1.0)
        part, least = held(estimates, truths)
        assert part >= 0.8
        assert least >= 0.49


@pytest.mark.slow
def test_time_without_contact():
    chance, estimates, truths = np.random.default_rng(7), [], []
    while len(truths) < 12:
        amplitudes = (float(chance.uniform(0.05, 0.3)), float(chance.uniform(0.0, 0.1)))
        law = dynamics.FourierStiffness(1.0, amplitudes, (0.0, float(chance.uniform(0.0, 6.0))))
        damping, force, error, frequency, half = chance.uniform(
            (0.03, 0.05, 0.0, 0.3, 0.05), (0.1, 0.3, 0.3, 1.3, 0.5)
        )
        osc = dynamics.GearOscillator(law, damping, force, error, frequency, half_backlash=half)
        swept = dynamics.sweep(osc, "frequency", [frequency])
        state, periods = swept.states[0][-1], int(swept.periods[0])
        if not periods or not np.all(np.isfinite(state)):
            continue
        found = vibration(osc.with_parameter("frequency", float(swept.values[0])), state, periods)
        gap = finely(osc.with_parameter("frequency", float(swept.values[0])), state, periods)
        if 0.0 < found.separated < 1.0:
            estimates.append(found.separated_error)
            truths.append(abs(found.separated / gap - 1.0))
    part, least = held(estimates, truths)
    assert part >= 0.8
    assert least >= 0.5


def finely(osc: dynamics.GearOscillator, state: np.ndarray, periods: int) -> float:
    """Time without contact by 32 times as many samples."""
    from dynamics.flow.motions import trajectory
    from dynamics.flow.samples import share_below

    motion = trajectory(osc, state, periods=periods, points_per_period=32 * SAMPLES)
    return float(share_below(motion.x - osc.half_backlash))


def test_motions_that_never_part_have_no_error_of_it():
    osc = dynamics.GearOscillator(dynamics.FourierStiffness(1.0), 0.05, 0.1, 0.0, 0.5, half_backlash=0.2)
    (found,) = vibrations(osc, [dynamics.sweep(osc, "frequency", [0.5])])
    assert found.separated.tolist() == found.separated_error.tolist() == [0.0]


@pytest.mark.slow
def test_pressure_and_factor_at_the_pitch_point_over_the_face():
    chance = np.random.default_rng(1)
    pressures, factors = ([], []), ([], [])
    for k in range(8):
        pair = random_pair(chance, lead=gears.Lead(crowning=float(chance.uniform(0.0, 15e-6))))
        bodies = fem.compliance(pair, tolerance=0.05)
        torque = float(chance.uniform(50.0, 300.0)) * pair.face_width / 0.02
        flanks = Flanks(
            alignment=gears.Alignment(float(chance.uniform(0.0, 30e-6))),
            face_model=["walls", "slices"][k % 2],
        )
        by_cells = {}
        for cells in (12, 24, 96):
            own = Flanks(
                flanks.beyond_path, alignment=flanks.alignment, cells=cells, face_model=flanks.face_model
            )
            teeth = LoadedTeeth(pair, torque, compliance=bodies, flanks=own)
            cycle = teeth.cycle(8)
            assert cycle.contact is not None
            by_cells[cells] = cycle.contact.face, face_load_models(teeth, cycle)
        fine, fine_models = by_cells[96]
        for cells in (12, 24):
            face, models = by_cells[cells]
            pressures[0].append(face.greatest_hertz_pressure_error)
            pressures[1].append(abs(face.greatest_hertz_pressure / fine.greatest_hertz_pressure - 1.0))
            factors[0].append(models.face_load_factor_error[0])
            factors[1].append(abs(models.pitch_point_factor[0] / fine_models.pitch_point_factor[0] - 1.0))
    for found in (pressures, factors):
        part, least = held(*found)
        assert part >= 0.8
        assert least >= 0.5


@pytest.mark.slow
def test_contact_pattern():
    chance, estimates, truths = np.random.default_rng(5), [], []
    for k in range(8):
        pair = random_pair(chance, lead=gears.Lead(crowning=float(chance.uniform(5e-6, 60e-6))))
        bodies = fem.compliance(pair, tolerance=0.05)
        torque = float(chance.uniform(10.0, 100.0)) * pair.face_width / 0.02
        setting = {
            "compliance": bodies,
            "positions": 8,
            "alignment": gears.Alignment(float(chance.uniform(0.0, 60e-6))),
            "face_model": ["walls", "slices"][k % 2],
        }
        fine, *coarse = (
            fem.mesh_cycle(pair, torque=torque, cells=n, **setting).face for n in (250, 12, 18, 26)
        )
        estimates += [face.contact_pattern_error for face in coarse]
        truths += [abs(face.contact_pattern / fine.contact_pattern - 1.0) for face in coarse]
    part, least = held(estimates, truths)
    assert part >= 0.8
    assert least >= 0.5


def test_bulk_temperatures_err_as_the_losses_that_they_balance():
    """Given ones are exact; balanced ones rise above the oil by the heat over its transfer, and err as it does."""
    bulk, heat, transfer = np.array([350.0, 345.0]), np.array([100.0, 80.0]), np.array([5.0, 8.0])
    balanced, given = object.__new__(MeshLosses), object.__new__(MeshLosses)
    for record, conducted in ((balanced, transfer), (given, None)):
        held_there = {"heat_transfer": conducted, "heat": heat, "error": 0.02}
        for name, value in {**held_there, "temperature_mismatch": 0.1, "bulk_temperatures": bulk}.items():
            object.__setattr__(record, name, value)
    np.testing.assert_allclose(
        balanced.bulk_temperatures_error, (0.1 + 0.02 * heat / transfer) / bulk, rtol=1e-12
    )
    assert given.bulk_temperatures_error.tolist() == [0.0, 0.0]


def test_a_figure_is_estimated_when_it_is_asked_for():
    """A study of one figure needs no other; names of all errors are there."""
    pair = gears.GearPair(gears.Gear(36), gears.Gear(40), module=2e-3, face_width=40e-3)
    cycle = mesh_cycle(pair, 600.0, model="potential-energy")
    assert cycle.transmission_error_range > 0.0
    assert set(cycle._estimates._known) == {"transmission_error_range"}
    assert "greatest_load_share" in set(cycle.errors)
    assert len(cycle.errors) == len(cycle._estimates) > 1
