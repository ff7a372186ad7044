"""A scene's run and the call with plain arguments are the same computation, to the last digit."""

from __future__ import annotations

import math
import warnings
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

import fem
import flankfilm as ff
from base import InputError
from ehl import Meniscus, OilLayer, Roughness
from flankfilm.building.film import lubricant
from flankfilm.building.pair import gear_pair, pinion_speed
from flankfilm.coupling import FilmModel, Flanks, LoadedTeeth, LubricatedCycle, MeshCycle, torque_curves
from flankfilm.files.cache import Cache
from flankfilm.products.closed_forms import VERIFICATION
from flankfilm.products.diagram import DIAGRAM
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import COMPLIANCE, DRY_CYCLE, FILM
from flankfilm.stages.motion import FOURIER, SCALING, SWEEP
from tests.flankfilm.scenes import ARTICLE

HEAD = """
wants = [WANTS]
tolerance = 0.01
"""
MODELS = """
[stiffness]
model = "MODEL"
[film]
model = "FILM"
[dynamics]
fourier_order = 1
error_amplitude_um = 10
sweep = { speed_rpm = [15000, 16000], points = 3 }
diagram = { speed_rpm = [15000, 16000], max_period = 1, searches = 2 }
"""
SCENE = HEAD + ARTICLE.replace("[material]", "backlash_um = 50\n[material]") + MODELS


def scene_of(model: str, film: str) -> ff.Scene:
    wants = '"stiffness", "sweep"' if film == "none" else '"stiffness", "film", "sweep"'
    text = SCENE.replace("WANTS", wants).replace("MODEL", model).replace("FILM", film)
    return ff.parse_scene(text)


PAIR, OIL, SPEED = (of(scene_of("ishikawa", "ehl")) for of in (gear_pair, lubricant, pinion_speed))
"""Of the scenes: numbers converted from a scene's units may differ from those written in SI in their last digit."""


def run_of(model: str, film: str) -> Engine:
    return Engine(scene_of(model, film), Cache(None))


def same(one: MeshCycle, other: MeshCycle) -> None:
    for field in fields(MeshCycle):
        value = getattr(one, field.name)
        if isinstance(value, np.ndarray):
            assert np.array_equal(value, getattr(other, field.name), equal_nan=True), field.name


@pytest.fixture(scope="module")
def run() -> Engine:
    return run_of("potential-energy", "dowson")


@pytest.fixture(scope="module")
def cycle() -> LubricatedCycle:
    formula = ff.FilmModel("dowson")
    return ff.lubricated_cycle(
        PAIR, 600.0, SPEED, OIL, tolerance=0.01, model="potential-energy", film=formula
    )


def test_a_dry_cycle_by_finite_elements_is_that_of_the_scene():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = ff.mesh_cycle(PAIR, 600.0, tolerance=0.01)
    same(found, run_of("fem", "none")[DRY_CYCLE])
    assert found.converged
    assert found.error is not None


def test_a_lubricated_cycle_is_that_of_the_scene(run: Engine, cycle: LubricatedCycle):
    other = run[FILM]
    same(cycle, other)
    same(cycle.dry, run[DRY_CYCLE])
    assert np.array_equal(cycle.least_film, other.least_film, equal_nan=True)
    assert np.array_equal(cycle.film.central_thickness, other.film.central_thickness)


def test_the_least_film_of_the_pairs_is_that_of_the_path(cycle: LubricatedCycle):
    assert cycle.least_film.shape == cycle.forces.shape
    assert np.array_equal(np.isnan(cycle.least_film), ~(cycle.forces > 0.0))
    assert cycle.thinnest_film == pytest.approx(cycle.film.least_film, rel=0.01)


@pytest.mark.slow
def test_oscillator_sweep_and_jumps_are_those_of_the_scene(run: Engine, cycle: LubricatedCycle):
    motion = ff.pair_oscillator(PAIR, cycle, 600.0, SPEED, error_amplitude=1e-6 * 10, fourier_order=1)
    assert motion.oscillator == run[SCALING].oscillator
    speeds = np.linspace(15000, 16000, 3) * math.pi / 30.0
    swept = ff.speed_sweep(motion, speeds)
    for direction, states in swept.states.items():
        assert np.array_equal(states, run[SWEEP].states[direction])
    found = ff.jump_speeds(motion, (speeds[0], speeds[-1]), searches=2, max_period=1)
    assert np.array_equal(found.jump_frequency, run[DIAGRAM].jump_frequency)
    assert np.array_equal(found.jump_error, run[DIAGRAM].jump_error)


def test_harmonics_of_the_stiffness_are_as_many_by_default_as_in_scenes():
    text = SCENE.replace("WANTS", '"stiffness", "sweep"').replace("fourier_order = 1\n", "")
    text = text.replace("MODEL", "fem").replace("FILM", "none")
    low, high = (rpm * math.pi / 30.0 for rpm in (1000, 16000))
    scene = Engine(ff.parse_scene(text.replace("[15000, 16000]", "[1000, 16000]")), Cache(None))
    series, cycle = scene[FOURIER], scene[DRY_CYCLE]
    motion = ff.pair_oscillator(PAIR, cycle, 600.0, SPEED, tolerance=series.share, speeds=(high, low))
    assert motion.series.stiffness == series.stiffness
    alone = ff.pair_oscillator(PAIR, cycle, 600.0, SPEED)
    assert alone.series.share == 0.005
    assert alone.series.remainder <= 0.005  # of the stiffness; the motion of no range
    assert 1 < alone.series.order < motion.series.order < 50
    assert ff.pair_oscillator(PAIR, cycle, 600.0, SPEED, fourier_order=2).series.order == 2


@pytest.mark.parametrize(
    ("options", "where"),
    [
        ({"fourier_order": 0}, "fourier_order"),
        ({"fourier_order": "all"}, "fourier_order"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"speeds": (0.0, 100.0)}, "speeds[0]"),
        ({"speeds": (10.0, "100")}, "speeds[1]"),
    ],
)
def test_faults_of_the_harmonics_are_named(cycle: LubricatedCycle, options: dict, where: str):
    with pytest.raises(InputError) as raised:
        ff.pair_oscillator(PAIR, cycle, 600.0, SPEED, **options)
    assert [fault.where for fault in raised.value.faults] == [where]


def test_the_verification_is_that_of_the_scene():
    found = ff.compare_closed_forms(PAIR, 600.0, tolerance=0.01)
    assert found.differences == run_of("fem", "none")[VERIFICATION].differences
    with pytest.raises(LookupError, match="no comparison"):
        found.difference("Ishikawa", "no such reference")


def test_every_result_says_itself_in_one_line(cycle: LubricatedCycle, tmp_path: Path):
    motion = ff.pair_oscillator(PAIR, cycle, 600.0, SPEED)
    results = ff.run(scene_of("ishikawa", "dowson"), cache=False)
    for found in (cycle, cycle.dry, cycle.film, motion, results):
        assert len(repr(found)) <= 200
        assert "\n" not in repr(found)
    assert results.files == ()
    assert results.folder is None
    assert results.get(DRY_CYCLE) is not None
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("options", "where"),
    [
        ({"torque": 0.0}, "torque"),
        ({"speed": -1.0}, "speed"),
        ({"tolerance": 2.0}, "tolerance"),
        ({"model": "magic"}, "model"),
        ({"pairs": "some"}, "pairs"),
    ],
)
def test_faults_of_arguments_are_named(options: dict, where: str):
    given = {"torque": 600.0, "speed": SPEED, "lubricant": OIL, "model": "ishikawa"} | options
    with pytest.raises(InputError) as raised:
        ff.lubricated_cycle(PAIR, **given)
    assert [fault.where for fault in raised.value.faults] == [where]


def test_formulas_are_refused_for_starved_and_rough_films():
    rough = Roughness(deviation=0.3e-6, density=25e9, tip_radius=10e-6)
    with pytest.raises(InputError) as raised:
        ff.FilmModel("dowson", supply=OilLayer(1e-7), roughness=rough)
    assert [fault.where for fault in raised.value.faults] == ["film.supply", "film.roughness"]


def test_a_meniscus_inside_a_contact_is_refused():
    held = ff.FilmModel(supply=Meniscus(-0.1e-3))
    with pytest.raises(InputError, match="half-width of a contact"):
        ff.lubricated_cycle(PAIR, 600.0, SPEED, OIL, model="ishikawa", film=held)


def test_speeds_need_scales_and_one_range():
    from dynamics import GearOscillator
    from flankfilm.coupling import PairOscillator, given_series

    series = given_series(1.0, [0.18], [0.0])
    motion = PairOscillator(GearOscillator(series.stiffness, 0.05, 0.1, 0.2, 0.5, 0.2), None, series)
    for ranges in ({}, {"speed": (1.0, 2.0)}, {"speed": (1.0, 2.0), "frequency": (0.5, 0.6)}):
        with pytest.raises(InputError, match="speed"):
            ff.jump_speeds(motion, **ranges)


@pytest.mark.slow
def test_contacts_of_plastics_move_unless_they_are_told_to_stay():
    """With a plastic wheel it counts; scene, plain call and finite elements mean the same."""
    text = HEAD.replace("WANTS", '"stiffness"') + ARTICLE.replace(
        "pinion_torque_Nm = 600", "pinion_torque_Nm = 50"
    )
    plastic = text.replace("[material]", "[material.pinion]", 1) + (
        "[material.wheel]\nyoungs_modulus_GPa = 3\npoisson_ratio = 0.4\n[stiffness]\nmodel = 'fem'\n# MOVES\n"
    )
    cycles = {}
    for moves in (True, False):
        run = Engine(
            ff.parse_scene(plastic.replace("# MOVES", "" if moves else "moving_contact = false")), Cache(None)
        )
        cycles[moves] = cycle = run[DRY_CYCLE]
        flanks = Flanks() if moves else Flanks(moving_contact=False)
        plain = ff.mesh_cycle(gear_pair(run.scene), 50.0, tolerance=0.01, flanks=flanks)
        np.testing.assert_allclose(plain.stiffness, cycle.stiffness, rtol=1e-12)
        assert cycle.contact is not None
        assert cycle.contact.moving_contact is moves
        assert cycle.model_error == cycle.contact.model_error
        bodies, asked = run[COMPLIANCE], None if moves else False
        given = {"compliance": bodies, "moving_contact": asked}
        pair, count = gear_pair(run.scene), len(cycle.position)
        one = fem.mesh_cycle(pair, 50.0, count, **given)
        _, among = fem.mesh_cycle(pair, (20.0, 50.0), count, **given)
        teeth = LoadedTeeth(pair, 50.0, compliance=bodies, flanks=flanks)
        curves = torque_curves(teeth, (20.0,), count)
        whole = run[VERIFICATION].references[0]
        assert whole.label == "finite elements"
        for found in (one, among):
            assert found.moving_contact is moves
            np.testing.assert_allclose(found.stiffness, cycle.stiffness, rtol=1e-9)
        figures = curves.secant_stiffness[1], 1e9 * pair.face_width * whole.figures["mesh, mean"].value
        np.testing.assert_allclose(figures, cycle.mean_secant_stiffness, rtol=1e-3)
        oil = lubricant(scene_of("ishikawa", "ehl"))
        wet = ff.lubricated_cycle(
            pair, 50.0, 20.0, oil, tolerance=0.05, film=FilmModel("dowson"), compliance=bodies, flanks=flanks
        )
        assert wet.contact is not None
        assert wet.contact.moving_contact is moves
    secant = {moves: cycle.secant_stiffness for moves, cycle in cycles.items()}
    # near A and E the corners count too, whose law takes contacts that stay
    change = np.median(np.abs(secant[True] / secant[False] - 1))
    assert 1e-3 < change < cycles[False].model_error
    assert cycles[True].model_error < 0.6 * cycles[False].model_error
