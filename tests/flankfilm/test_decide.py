"""Models chosen by what they cost and change: the cheapest within the tolerance, never one that might miss it."""

from __future__ import annotations

import json
import math
from html import unescape
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

from base import Cost, SolverError
from dynamics import FourierStiffness
from flankfilm.building.pair import gear_pair
from flankfilm.coupling.vibration.series import LeftOut, MeshSeries, least_order, left_out
from flankfilm.files.cache import Cache
from flankfilm.plan.decide import Plan, decide
from flankfilm.plan.decisions import Decision, order_decision
from flankfilm.plan.film_choice import FORMULA_OFF, MOST_OF_FORESEEN, FilmChange
from flankfilm.plan.stiffness_choice import LARGEST_DIFFERENCE
from flankfilm.runs.check import check_scene
from flankfilm.runs.report import summary
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import Scene, parse_scene, read_scene, template
from flankfilm.scene.reader import validated
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import BODIES, DRY_CYCLE, FILM, FILM_FORESEEN, PLAN

TOLERANCES = (0.4, 0.2, 0.05, 0.01, 0.005, 0.001, 1e-4)


def scene(tolerance: float = 0.005, **changes) -> Scene:
    """Ordinary pair with an oil; every model to be decided on."""
    raw = {
        "wants": ["stiffness"],
        "tolerance": tolerance,
        "pair": {
            "module_mm": 2.0,
            "face_width_mm": 40.0,
            "pinion": {"teeth": 36, "bore_mm": 33.5},
            "wheel": {"teeth": 40, "bore_mm": 37.5},
        },
        "material": {"youngs_modulus_GPa": 206.0, "poisson_ratio": 0.3},
        "operating": {"pinion_torque_Nm": 300.0, "pinion_speed_rpm": 2000.0},
        "lubricant": {"viscosity_Pa_s": 0.075, "pressure_viscosity_per_GPa": 19.6},
        "stiffness": {"model": "auto"},
        "film": {"model": "auto"},
    }
    return validated(raw | changes)


def plan(of: Scene, film_change: float = -0.003) -> Plan:
    """Plan of a scene whose film is foreseen to change the stiffness by so much."""
    return decide(of, gear_pair(of), lambda: FilmChange(film_change, 0.02))


@pytest.mark.parametrize(
    ("pairs", "tolerance", "model"),
    [
        ("independent", 0.2, "potential-energy"),
        ("independent", 0.1, "fem"),
        ("coupled", 0.2, "fem"),
        ("coupled", 0.4, "potential-energy"),
        ("coupled", 0.005, "fem"),
    ],
)
def test_a_closed_form_serves_where_the_tolerance_is_wider_than_its_error(pairs, tolerance, model):
    found = plan(scene(tolerance, stiffness={"model": "auto", "pairs": pairs}, film={"model": "none"}))
    assert found.stiffness.choice == model
    bound = LARGEST_DIFFERENCE["potential-energy", pairs]
    assert f"{100 * bound:g} %" in found.stiffness.reason
    assert (bound < tolerance) == (model != "fem")


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"wants": ["stiffness", "root-stress"]}, "root-stress"),
        ({"operating": {"pinion_torque_Nm": 300.0, "friction": 0.05}}, "friction"),
        ({"operating": {"pinion_torque_Nm": 1.0}}, "force over face width"),
        ({"material": {"youngs_modulus_GPa": 206.0, "poisson_ratio": 0.45}}, "Poisson"),
    ],
)
def test_outside_what_was_compared_finite_elements_are_taken_and_it_is_said_why(changes, expected):
    found = plan(scene(0.4, **({"film": {"model": "none"}} | changes)))
    assert found.stiffness.choice == "fem"
    assert expected in found.stiffness.reason


def test_thick_rims_alone_were_compared():
    thin = scene(0.4).model_dump(exclude_none=True)
    thin["pair"]["wheel"]["bore_mm"] = 70.0
    found = plan(validated(thin | {"film": {"model": "none"}}))
    assert found.stiffness.choice == "fem"
    assert "bore" in found.stiffness.reason


@pytest.mark.parametrize("change", [-1e-4, -0.003, -0.1])
def test_films_get_better_models_as_the_tolerance_narrows(change):
    order = ["none", "dowson", "ehl"]
    found = [plan(scene(t), change) for t in TOLERANCES]
    places = [order.index(p.film.choice) for p in found]
    assert places == sorted(places)
    for tolerance, p in zip(TOLERANCES, found, strict=True):
        assert p.film.choice == "ehl" or (p.film.effect is not None and p.film.effect < tolerance)
        if MOST_OF_FORESEEN * abs(change) > tolerance:
            assert p.film.choice != "none"
        if FORMULA_OFF * abs(change) > tolerance:
            assert p.film.choice == "ehl"
    assert f"-{100 * abs(change):g} %" in found[0].film.reason


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_errors_sum_to_the_tolerance_and_no_other_pair_of_models_costs_less(tolerance):
    dynamics = {"fourier_order": "auto"}
    found = plan(scene(tolerance, wants=["stiffness", "fourier"], dynamics=dynamics))
    simple = [d.effect or 0.0 for d in found.decisions]
    assert math.fsum([*simple, *found.shares.values()]) == pytest.approx(tolerance, rel=1e-12)
    assert found.series is not None
    for decision in found.decisions:
        expected = [c.seconds for c in decision.candidates if c.seconds is not None]
        assert decision.seconds == min(expected)
        assert decision.seconds in [c.seconds for c in decision.candidates if c.name == decision.choice]
    assert all(f"{name}" in found.line for name in found.shares)


def test_what_the_scene_names_is_taken():
    found = plan(scene(0.4, stiffness={"model": "ishikawa"}, film={"model": "dowson"}))
    assert (found.stiffness.choice, found.film.choice) == ("ishikawa", "dowson")
    assert found.stiffness.asked
    assert found.stiffness.effect is None
    wanted = plan(scene(0.4, wants=["film"]))
    assert wanted.film.choice == "ehl"
    assert wanted.film_tolerance <= 0.1


def test_only_what_the_scene_says_is_said_to_be_asked_for():
    raw = scene(0.4, stiffness={}).model_dump(exclude_unset=True)
    silent = plan(validated({name: section for name, section in raw.items() if name != "film"}))
    assert silent.stiffness.reason == 'finite elements; stiffness.model = "fem" is the default'
    assert silent.film.reason == 'left out; film.model = "none" is the default'
    assert not silent.stiffness.asked
    assert not silent.film.asked
    named = plan(scene(0.4, stiffness={"model": "fem"}, film={"model": "none"}))
    assert named.stiffness.reason == 'finite elements; the scene asks for stiffness.model = "fem"'
    assert named.film.reason == 'left out; the scene asks for film.model = "none"'


def test_the_order_is_found_unless_the_scene_says_one():
    for dynamics in ({}, {"fourier_order": "auto"}):
        assert plan(scene(0.01, wants=["fourier"], dynamics=dynamics)).series is not None
    assert plan(scene(0.01, wants=["fourier"])).series is not None  # no [dynamics] at all
    assert plan(scene(0.01, wants=["fourier"], dynamics={"fourier_order": 3})).series is None


def test_the_template_has_no_error_but_that_of_the_teeth():
    dynamics = parse_scene(template()).dynamics
    assert dynamics.error_amplitude_um == (0.0,)
    assert dynamics.fourier_order == "auto"


def test_a_wanted_film_is_solved_to_the_scenes_tolerance_one_for_the_stiffness_to_its_share():
    for tolerance in (0.01, 0.001):
        assert plan(scene(tolerance, wants=["stiffness", "film"])).film_tolerance <= tolerance
    alone = plan(scene(0.001))
    assert alone.film.choice == "ehl"
    assert alone.film_tolerance > 0.001
    assert alone.film_tolerance * alone.film_change <= alone.shares["film"] * (1 + 1e-9)


def test_another_oil_changes_films_and_leaves_the_teeth_as_they_are():
    """The key of what is kept of the teeth does not know the oil, nor a little of the tolerance."""
    keys = []
    for viscosity, tolerance in ((0.075, 0.005), (0.03, 0.005), (0.075, 0.0048)):
        oil = {"viscosity_Pa_s": viscosity, "pressure_viscosity_per_GPa": 19.6}
        engine = Engine(scene(tolerance, lubricant=oil, film={"model": "ehl"}), Cache(None))
        keys.append((json.dumps(engine.inputs(BODIES)), json.dumps(engine.inputs(FILM), default=str)))
    assert keys[0][0] == keys[1][0] == keys[2][0]
    assert len({film for _, film in keys}) == 3


def test_a_finer_tolerance_asks_for_finer_teeth():
    asked = [plan(scene(t, film={"model": "none"})).resolution.compliance for t in (0.005, 0.001, 1e-4, 2e-5)]
    assert asked == sorted(asked, reverse=True)
    assert asked[-1] < 0.1 * asked[0]


@pytest.mark.slow
def test_the_closed_form_taken_is_as_near_as_was_said():
    """On a pair that no comparison had."""
    raw = scene(0.2, stiffness={"model": "auto", "pairs": "independent"}, film={"model": "none"}).model_dump(
        exclude_none=True
    )
    raw["pair"]["pinion"] |= {"teeth": 23, "profile_shift": 0.3, "bore_mm": 20.0}
    rough = Engine(validated(raw), Cache(None))
    fine = Engine(validated(raw | {"tolerance": 0.01}), Cache(None))
    assert (rough[PLAN].stiffness.choice, fine[PLAN].stiffness.choice) == ("potential-energy", "fem")
    off = rough[DRY_CYCLE].mean_secant_stiffness / fine[DRY_CYCLE].mean_secant_stiffness - 1
    assert 0.001 < abs(off) < 0.2


def test_a_cut_series_leaves_what_the_dropped_harmonics_are():
    kappa = np.array([0.1, 0.05, 0.02, 0.01])
    tau = 2 * np.pi * np.arange(64) / 64
    found = left_out(kappa, None, 0.05)
    for order in range(5):
        dropped = sum((kappa[j] * np.cos((j + 1) * tau + j) for j in range(order, 4)), np.zeros(64))
        assert found.curve[order] == pytest.approx(np.sqrt(np.mean(dropped**2)), abs=1e-15)
    assert found.motion is None


@pytest.mark.parametrize("frequency", [0.13, 0.2, 0.3334, 0.45, 0.8])
def test_what_a_dropped_harmonic_does_to_the_motion(frequency):
    """Against the motion itself, integrated with and without it: to first order, so within a fifth at these sizes."""
    kappa, zeta = np.array([0.04, 0.02, 0.01]), 0.05

    def settled(order):
        def law(tau, y):
            k = 1 + sum(kappa[j] * np.cos((j + 1) * frequency * tau) for j in range(order))
            return [y[1], 1.0 - 2 * zeta * y[1] - k * y[0]]

        period = 2 * np.pi / frequency
        start = np.ceil(150 / period) * period
        times = start + np.linspace(0, period, 200)
        return solve_ivp(law, (0, times[-1]), [1.0, 0.0], t_eval=times, rtol=1e-8, atol=1e-10).y[0]

    apart = settled(3) - settled(2)
    true = np.ptp(apart) / 2
    expected = left_out(kappa, (frequency, frequency * (1 + 1e-9)), zeta).motion
    assert expected is not None
    assert expected[2] == pytest.approx(true, rel=0.2)


def chosen(found: LeftOut, share: float, train: bool = False) -> tuple[int, Decision]:
    order = least_order(found, share)
    stiffness = FourierStiffness(1.0, (0.0,) * order, (0.0,) * order)
    series = MeshSeries("secant", "", stiffness, None, None, None, found, share, Cost(0.0))
    decision = order_decision(series, None, train)
    assert decision is not None
    return order, decision


def test_a_drive_train_takes_the_order_of_the_pair_and_says_so():
    found = left_out(0.1 / np.arange(1, 90) ** 2, None, 0.05)
    (order, plain), (same, decision) = (chosen(found, 0.005, train) for train in (False, True))
    assert same == order
    assert "of the pair on rigid shafts" in decision.reason
    assert decision.reason.startswith(plain.reason)


def test_the_least_order_is_found_and_said():
    kappa = 0.1 / np.arange(1, 90) ** 2
    found = left_out(kappa, None, 0.05)
    for share in (0.02, 0.005, 1e-3):
        order, decision = chosen(found, share)
        assert found.curve[order] <= share < found.curve[order - 1]
        assert f"order {order - 1} would leave" in decision.reason
        assert decision.choice == str(order)
        assert "rigid shafts" not in decision.reason
    order, decision = chosen(found, 1e-6)
    assert order == 50
    assert "no series of up to 50" in decision.reason
    assert decision.effect is not None
    assert decision.effect > 1e-6


def test_a_run_says_what_it_decided(tmp_path):
    """On the terminal, in the results' file and in the report."""
    wanted = scene(
        0.02,
        wants=["fourier", "report"],
        dynamics={"fourier_order": "auto", "damping_ratio": 0.05},
        stiffness={"model": "ishikawa"},
        film={"model": "none"},
    )
    results = run_scene(wanted, tmp_path, use_cache=False)
    fourier, plan = results.values["fourier"], results.plan
    assert plan is not None
    assert [d.subject for d in results.decisions] == ["stiffness", "film", "Fourier order"]
    assert results.decisions[-1].choice == str(len(fourier.stiffness.amplitudes))
    assert fourier.fit.remainder_rms <= plan.series
    lines = [*(d.line for d in results.decisions), plan.line]
    assert set(lines) <= set(summary(results))
    with xr.open_dataset(tmp_path / "results.nc", engine="h5netcdf") as held:
        assert json.loads(held.attrs["decisions_json"]) == [
            d.plain() | {"candidates": [c.__dict__ for c in d.candidates]} for d in results.decisions
        ]
    page = unescape((tmp_path / "report.html").read_text(encoding="utf-8")).replace("\u00a0", " ")
    assert [d.reason for d in results.decisions if d.reason not in page] == []


def test_check_says_what_a_run_would_decide():
    path = Path(__file__).parents[2] / "examples" / "auto.toml"
    expected = check_scene(read_scene(path))
    found = Engine(read_scene(path), Cache(None))[PLAN]
    assert {found.stiffness.line, found.film.line, found.line} <= set(expected)
    assert "split by cost" in found.line


def test_a_film_whose_part_cannot_be_foreseen_is_solved(monkeypatch):
    def fails(*given, **options):
        raise SolverError("no agreement")

    monkeypatch.setattr("flankfilm.coupling.lubricated_cycle", fails)
    found = Engine(scene(0.05), Cache(None))[PLAN]
    assert found.film.choice == "ehl"
    assert "no answer" in found.film.reason


def test_relief_does_not_hinder_the_foreseeing():
    relief = {"amount_um": 20.0, "length_mm": 2.0}
    raw = scene(0.05).model_dump(exclude_none=True)
    raw["pair"]["pinion"] |= {"teeth": 17, "profile_shift": 0.4, "bore_mm": 12.0, "tip_relief": relief}
    raw["pair"]["wheel"] |= {"teeth": 60, "profile_shift": 0.1, "tip_relief": relief}
    change = Engine(validated(raw), Cache(None))[FILM_FORESEEN]
    assert -0.05 < change.mean < 0.0
