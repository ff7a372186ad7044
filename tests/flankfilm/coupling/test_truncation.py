"""What a series leaves out of jump speeds, sweeps and ranges, against 32 harmonics."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import dynamics
from flankfilm.coupling import (
    jump_speeds,
    jumps_to_tolerance,
    mesh_cycle,
    mesh_series,
    pair_oscillator,
    speed_sweep,
)
from flankfilm.coupling.speeds import truncation
from flankfilm.coupling.speeds.jumps import jump_points
from flankfilm.coupling.speeds.truncation import Longer, longer_motion, missed_jumps, with_order
from flankfilm.coupling.vibration import series as series_module
from flankfilm.coupling.vibration.harmonics import harmonics_of
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.series import MeshSeries
from gears import Gear, GearPair

PAIR = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3).with_backlash(
    50e-6
)
RANGE = (0.75, 0.95)
TRUE = 32


@pytest.fixture(scope="module")
def cycle():
    return mesh_cycle(PAIR, 600.0, model="potential-energy", pairs="independent")


def motion_of(series: MeshSeries) -> PairOscillator:
    return pair_oscillator(PAIR, series, 600.0, 800.0, error_amplitude=5e-6)


def branches(oscillator: dynamics.GearOscillator, **options) -> dynamics.Diagram:
    return dynamics.diagram(
        oscillator, "frequency", RANGE, periods=(1,), searches=1, swept=0, max_period=1, **options
    )


def jumps_of(found: dynamics.Diagram) -> list[tuple[float, bool]]:
    return [
        (point.parameter, stretch.high - point.parameter < point.parameter - stretch.low)
        for stretch, point in jump_points(found)
    ]


@pytest.fixture(scope="module")
def whole(cycle) -> dynamics.Diagram:
    """Branches with 32 harmonics, the one in contact found by a sweep."""
    there = with_order(motion_of(mesh_series(cycle, order=1)), TRUE)
    swept = dynamics.sweep(there, "frequency", np.linspace(0.751, 0.757, 3))
    starts = [(v, states[-1], 1) for v, states in zip(swept.values, swept.states, strict=True)]
    return branches(there, starts=starts)


@pytest.mark.parametrize("order", [1, 2, 3, 6])
def test_the_error_of_a_jump_covers_what_its_series_leaves_out(cycle, whole, order: int):
    motion = motion_of(mesh_series(cycle, order=order))
    longer = longer_motion(motion, RANGE)
    assert longer is not None
    judged = 0
    for stretch, point in jump_points(branches(motion.oscillator)):
        error = longer.truncation(point, longer.carried(motion.oscillator, point))
        rising = stretch.high - point.parameter < point.parameter - stretch.low
        off = min(abs(point.parameter / at - 1) for at, way in jumps_of(whole) if way is rising)
        # 32 harmonics of a stiffness with steps are 8e-5 off themselves
        assert off <= error + 1e-4
        assert error <= 5 * off + 1e-4
        judged += 1
    assert judged >= 2


def test_one_harmonic_is_said_to_be_far_off(cycle):
    found = jump_speeds(
        motion_of(mesh_series(cycle, order=1)), frequency=(0.76, 0.88), searches=1, max_period=1
    )
    assert found.jump_error.max() > 0.01
    worst = max(found.jumps, key=lambda jump: jump.error)
    assert worst.budget["truncation"] > 0.9 * worst.error
    assert found.truncation["greatest_force"] > 0.01


def test_a_jump_that_more_harmonics_do_not_have_is_of_unknown_error():
    """A mesh of constant stiffness without error does not move, however far its folds are carried."""
    osc = dynamics.GearOscillator(
        dynamics.FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.0, 0.9, half_backlash=0.2
    )
    points = [point for _, point in jump_points(branches(osc))]
    assert len(points) == 2
    calm = replace(osc, stiffness=dynamics.FourierStiffness(1.0, (0.0,), (0.0,)))
    longer = Longer(calm, calm, ())
    for point in points:
        carried = longer.carried(osc, point)
        assert carried is None
        assert math.isinf(longer.truncation(point, carried))


def test_jumps_that_only_the_longer_series_has_are_named(whole):
    own = [(point, stretch.label, True) for stretch, point in jump_points(whole)]
    assert missed_jumps(whole, own, [point.parameter for point, _, _ in own]) == ()
    kept = [point.parameter for point, _, _ in own[1:]]
    (missed,) = missed_jumps(whole, own, kept)
    assert missed.frequency == own[0][0].parameter
    assert missed.width > 0.0


def test_a_sweep_says_what_its_series_leaves_out(cycle):
    motion = motion_of(mesh_series(cycle, order=3))
    values = np.array([0.3, 0.62, 0.66])
    found = speed_sweep(motion, frequency=values)
    finer = speed_sweep(motion_of(mesh_series(cycle, order=TRUE)), frequency=values)
    assert found.force_change is not None
    assert found.spread_change is not None
    assert np.array_equal(found.checked, values)
    judged = 0
    for way in found.labels:
        for row in range(len(values)):
            if found.labels[way][row] != finer.labels[way][row]:
                continue
            for change, name in ((found.force_change, "force_factor"), (found.spread_change, "spread")):
                one, other = (getattr(swept, name)[way][row] for swept in (found, finer))
                assert change[way][row] == pytest.approx(abs(one / other - 1), rel=0.1, abs=1e-3)
            judged += 1
    assert judged >= 3


def test_small_motions_far_above_resonance_are_judged_too(cycle):
    """The force is the mean's there and hardly moves; the change of its small spread is told."""
    values = np.array([4.0, 4.5])
    found, finer = (
        speed_sweep(pair_oscillator(PAIR, mesh_series(cycle, order=n), 600.0, 800.0), frequency=values)
        for n in (1, TRUE)
    )
    for way, spread in found.spread.items():
        assert np.all(spread < 0.01)
        assert found.spread_change[way] == pytest.approx(
            abs(spread / finer.spread[way] - 1.0), rel=0.1, abs=1e-6
        )


@pytest.mark.slow
def test_the_order_is_raised_until_the_jumps_are_as_exact_as_asked(cycle, whole):
    first = mesh_series(cycle, order=1)
    found = jumps_to_tolerance(motion_of, first, 0.01, frequency=RANGE, searches=2, max_period=1)
    assert found.order > 1
    assert found.tried[0][0] == 1
    assert found.tried[0][1] > 0.01
    assert found.worst <= 0.01
    for jump in found.diagram.jumps:
        near = [at for at, way in jumps_of(whole) if way is jump.rising]
        assert min(abs(jump.frequency / at - 1) for at in near) <= 2.0 * jump.error + 1e-4  # an estimate


def test_harmonics_of_a_curve_are_integrated_once_for_all_orders(cycle, monkeypatch):
    asked: list[str] = []

    def counted(cycle, kind):
        asked.append(kind)
        return harmonics_of(cycle, kind)

    for user in (series_module, truncation):
        monkeypatch.setattr(user, "harmonics_of", counted)
    found = mesh_series(cycle, share=0.01)
    assert sorted(asked) == ["secant", "tangent"]
    asked.clear()
    assert longer_motion(motion_of(found), RANGE) is not None
    assert asked == [found.kind]
