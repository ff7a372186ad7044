"""Two special points of one kind between neighbouring points of a branch are not passed over."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from dynamics import FourierStiffness, GearOscillator, continue_branch, find_orbit
from dynamics.branches.step_rules import hides
from dynamics.model.options import OPTIONS
from tests.dynamics.test_drives import same_as

# period doublings at .51265 and .52297, between which the multiplier reaches -1.036
PAIR = GearOscillator(
    FourierStiffness(1.0, (0.2077893435088659, 0.2468305999862243), (2.3218779778572527, 6.084898419305955)),
    0.07503184714357937, 0.09442314644049528, 0.17177032336890952, 0.518, half_backlash=0.3819458982258971,
    free_damping_ratio=0.06823745461174659,
)  # fmt: skip
START = (0.065, 0.3265)


def test_a_cubic_that_changes_its_sign_twice_is_seen():
    """Against the cubic itself at many places."""
    r = np.random.default_rng(7)
    t = np.linspace(0.0, 1.0, 2001)
    seen, dip = [0, 0, 0], OPTIONS.hidden_dip
    for _ in range(3000):
        f0, f1, d0, d1 = r.normal(size=4) * [0.3, 0.3, 1.0, 1.0]
        length = r.uniform(0.1, 3.0)
        values = (
            f0 * (1 + 2 * t) * (1 - t) ** 2 + f1 * t**2 * (3 - 2 * t)
            + length * (d0 * t * (1 - t) ** 2 - d1 * t**2 * (1 - t))
        )  # fmt: skip
        changes = np.count_nonzero(np.diff(np.sign(values)))
        said = hides(f0, d0, f1, d1, length)
        near = np.min(np.abs(values)) < dip / (1.0 + dip) * min(abs(f0), abs(f1)) * (1 + 1e-3)
        if changes > 1:
            assert said
            seen[0] += 1
        elif said:  # near enough
            assert f0 * f1 > 0.0
            assert near
            seen[1] += 1
        else:
            seen[2] += 1
    assert min(seen) > 20


def test_a_pair_of_doublings_between_steps_is_located():
    orbit = find_orbit(PAIR, START)
    start = continue_branch(orbit, "frequency", (0.5, 0.6))
    beside = find_orbit(PAIR.with_parameter("frequency", 0.6), start.states[-1])
    coarse, fine = (
        continue_branch(beside, "frequency", (0.45, 2.0), max_step=step).special("period-doubling")
        for step in (0.02, 0.005)
    )
    assert [p.parameter for p in coarse] == pytest.approx([p.parameter for p in fine], abs=1e-11)
    assert [round(p.parameter, 4) for p in coarse][:2] == [0.5127, 0.5230]


@pytest.mark.parametrize("train", [False, True])
def test_a_pair_that_is_about_to_merge_is_located(train: bool):
    """At a damping ratio of .07645 the two merge; at .07643 they lie .0013 apart, a seventh of a step."""
    gear = replace(PAIR, damping_ratio=0.07643)
    near = continue_branch(find_orbit(gear, START), "frequency", (0.51, 0.55))
    gear = gear.with_parameter("frequency", 0.55)
    start = find_orbit(gear, near.states[-1])
    if train:  # q is X and e
        start = find_orbit(same_as(gear), start.state + np.array([gear.error_amplitude, 0.0]))
    found = continue_branch(start, "frequency", (0.5075, 2.5), max_points=16)
    assert [round(p.parameter, 4) for p in found.special("period-doubling")] == [0.5169, 0.5182]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_random_branches_have_the_points_of_branches_with_an_eighth_of_the_step(seed: int):
    r = np.random.default_rng(seed)
    size = r.integers(1, 3)
    osc = GearOscillator(
        FourierStiffness(1.0, tuple(r.uniform(0, 0.35, size)), tuple(r.uniform(-3, 3, size))),
        10 ** r.uniform(-1.6, -0.8), r.uniform(0.02, 0.4), r.uniform(0, 0.4), 1.3, r.uniform(0.02, 0.6),
        free_damping_ratio=10 ** r.uniform(-1.6, -0.8),
    )  # fmt: skip
    orbit = find_orbit(osc, osc.rest_state(), transient=300)
    coarse, fine = (
        continue_branch(orbit, "frequency", (0.45, 1.6), max_step=step, max_points=40_000)
        for step in (0.02, 0.0025)
    )
    assert coarse.converged
    assert fine.converged
    assert [p.kind for p in coarse.points] == [p.kind for p in fine.points]
    assert [p.parameter for p in coarse.points] == pytest.approx(
        [p.parameter for p in fine.points], abs=1e-10
    )


def test_saddle_nodes_on_either_side_of_a_grazing_are_located():
    """Folds at .760516 and 2e-7 beyond the grazing at .760494: at the grazing itself the orbit is unstable."""
    r = np.random.default_rng(16)
    size = r.integers(1, 3)
    osc = GearOscillator(
        FourierStiffness(1.0, tuple(r.uniform(0, 0.35, size)), tuple(r.uniform(-3, 3, size))),
        10 ** r.uniform(-1.6, -0.8), r.uniform(0.02, 0.4), r.uniform(0, 0.4), 1.3, r.uniform(0.02, 0.6),
        free_damping_ratio=10 ** r.uniform(-1.6, -0.8) if r.uniform() < 0.5 else None,
    )  # fmt: skip
    orbit = find_orbit(osc, osc.rest_state(), transient=300)
    found = continue_branch(orbit, "frequency", (0.7, 1.6))
    kinds = [p.kind for p in found.points if 0.7604 < p.parameter < 0.7606]
    assert kinds == ["saddle-node", "grazing", "saddle-node"]


@pytest.mark.parametrize("one_sided", [False, True])
@pytest.mark.parametrize("excess", [1e-5, 3e-3])
def test_a_pair_of_grazings_at_the_top_of_a_resonance_is_located(one_sided: bool, excess: float):
    """A linear motion, whose amplitude is known: it just takes the flanks apart beside its resonance, for no longer
    than a part of a step."""
    damping, error = 0.1, 0.05
    peak = error / (2.0 * damping * np.sqrt(1.0 - damping**2))
    force = peak * (1.0 - excess)
    osc = GearOscillator(
        FourierStiffness(1.0, (), ()), damping, force, error, 0.5, half_backlash=0.3, one_sided=one_sided
    )
    orbit = find_orbit(osc, osc.rest_state(), transient=300)
    found = continue_branch(orbit, "frequency", (0.5, 1.6), max_step=0.05).special("grazing")
    # amplitude^2 = force^2 in w = frequency^2: (error/force)^2 w^2 = (1 - w)^2 + 4 damping^2 w
    ratio = (error / force) ** 2
    middle = (1.0 - 2.0 * damping**2) / (1.0 - ratio)
    apart = np.sqrt(middle**2 - 1.0 / (1.0 - ratio))
    expected = np.sqrt([middle - apart, middle + apart])
    assert [p.parameter for p in found] == pytest.approx(expected.tolist(), abs=1e-9)
