"""Load sharing among flanks on both sides of the teeth: rigid limits, mirror, minimum of the energy, faults."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from gears import LoadSharingError
from gears.sharing.both_flanks import share_between


class Nothing:
    def approach(self, force):
        return 0.0 * force

    def slope(self, force):
        return 0.0 * force


class Hertz:
    """Indentation that is concave in the force, as of flanks."""

    def approach(self, force):
        return force * (2e-10 - 1e-11 * np.log(np.maximum(force, 1e-9)))

    def slope(self, force):
        inside = np.where(force > 1e-9, 1e-11, 0.0)
        return 2e-10 - 1e-11 * np.log(np.maximum(force, 1e-9)) - inside


def random_problem(seed, pairs=8):
    rng = np.random.default_rng(seed)
    some = rng.normal(size=(pairs, pairs))
    bulk = 1e-10 * (some @ some.T + 0.1 * np.eye(pairs))
    sides = np.repeat([1.0, -1.0], pairs // 2)
    gaps = rng.uniform(-1e-5, 2e-5, size=pairs)
    force = float(rng.choice([0.0, 1e3, 1e5, -2e3]))
    if force == 0.0:  # both sides pressed together by 1 um
        gaps[sides < 0] -= gaps[sides > 0].min() + gaps[sides < 0].min() + 1e-6
    return force, bulk, gaps, sides


@pytest.mark.parametrize("overlap", [1e-6, 3e-4])
def test_equal_springs_share_the_overlap(overlap):
    k = 5e8
    found = share_between(0.0, np.eye(2) / k, Nothing(), [0.0, -overlap], [1, -1])
    np.testing.assert_allclose(found.forces, 0.5 * k * overlap, rtol=1e-12)
    assert found.transmission_error == pytest.approx(
        0.5 * overlap, rel=1e-12
    )  # mean approach of both sides: 0
    assert found.stiffness == pytest.approx(2 * k, rel=1e-12)
    loaded = share_between(0.5 * k * overlap, np.eye(2) / k, Nothing(), [0.0, -overlap], [1, -1])
    np.testing.assert_allclose(loaded.forces, [0.75 * k * overlap, 0.25 * k * overlap], rtol=1e-12)
    free = share_between(2 * k * overlap, np.eye(2) / k, Nothing(), [0.0, -overlap], [1, -1])
    np.testing.assert_allclose(free.forces, [2 * k * overlap, 0.0], rtol=1e-12)


@pytest.mark.parametrize("leaning", [False, True])
@pytest.mark.parametrize("seed", range(40))
def test_conditions_of_the_minimum_hold(seed, leaning):
    force, bulk, gaps, sides = random_problem(seed)
    reach = np.random.default_rng(seed).uniform(0.9, 1.0, len(sides)) if leaning else None
    found = share_between(force, bulk, Hertz(), gaps, sides, reach=reach)
    sides = sides * reach if leaning else sides
    left = bulk @ found.forces + Hertz().approach(found.forces) + gaps - sides * found.transmission_error
    size = np.abs(gaps).max()
    assert found.forces.min() >= 0.0
    assert left.min() > -1e-11 * size
    assert np.all(np.abs(left[found.forces > 0]) < 1e-11 * size)
    assert np.sum(sides * found.forces) == pytest.approx(force, abs=1e-10 * found.forces.max())


@pytest.mark.parametrize("seed", range(6))
def test_forces_are_those_of_a_quadratic_program(seed):
    force, bulk, gaps, sides = random_problem(seed)
    found = share_between(force, bulk, Nothing(), gaps, sides)
    size = found.forces.max()
    length = np.abs(gaps).max()

    def energy(x):
        return (0.5 * size * x @ bulk @ x + gaps @ x) / length

    by_scipy = minimize(
        energy,
        np.full(len(gaps), 0.5),
        jac=lambda x: (size * bulk @ x + gaps) / length,
        bounds=[(0.0, None)] * len(gaps),
        constraints={"type": "eq", "fun": lambda x: sides @ x - force / size, "jac": lambda x: sides},
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 500},
    )
    np.testing.assert_allclose(by_scipy.x, found.forces / size, atol=2e-5)
    assert energy(found.forces / size) <= energy(by_scipy.x) + 1e-9


def test_the_mirror_turns_the_sign():
    force, bulk, gaps, sides = random_problem(3)
    found = share_between(force, bulk, Hertz(), gaps, sides)
    mirrored = share_between(-force, bulk, Hertz(), gaps, -sides)
    np.testing.assert_allclose(mirrored.forces, found.forces, rtol=1e-12, atol=1e-9)
    assert mirrored.transmission_error == pytest.approx(-found.transmission_error, rel=1e-12)
    assert mirrored.stiffness == pytest.approx(found.stiffness, rel=1e-12)


def test_tangent_is_the_derivative():
    _, bulk, gaps, sides = random_problem(5)
    less, here, more = (share_between(1e3 + step, bulk, Hertz(), gaps, sides) for step in (-0.1, 0.0, 0.1))
    slope = 0.2 / (more.transmission_error - less.transmission_error)
    assert here.stiffness == pytest.approx(slope, rel=1e-6)
    each = (more.forces - less.forces) / (more.transmission_error - less.transmission_error)
    np.testing.assert_allclose(here.pair_stiffness, each, rtol=1e-5, atol=1e-3 * here.stiffness)
    assert np.sum(sides * here.pair_stiffness) == pytest.approx(here.stiffness)


def test_a_pair_that_hardly_touches_is_found():
    # the second pair overlaps by less than a thousandth of a nanometre once the first one bears
    bulk = np.diag([1e-9, 1e-9, 1e-9])
    for overlap in 10.0 ** np.arange(-18.0, -10.0):
        gaps = [0.0, 1e-9 * 1e3 + Hertz().approach(1e3) - overlap, 1.0]
        found = share_between(1e3, bulk, Hertz(), gaps, [1, 1, -1])
        assert found.forces[0] + found.forces[1] == pytest.approx(1e3, rel=1e-12)
        assert found.forces[2] == 0.0


def test_without_force_and_with_play_there_is_no_answer():
    with pytest.raises(LoadSharingError, match="must not be 0 where the gaps leave backlash"):
        share_between(0.0, 1e-9 * np.eye(2), Nothing(), [1e-6, 1e-6], [1, -1])


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"force": np.nan}, "force"),
        ({"sides": [1, 2]}, "sides"),
        ({"gaps": [np.inf, np.inf]}, "gaps"),
        ({"bulk": np.full((2, 2), np.nan)}, "bulk"),
        ({"bulk": np.eye(3)}, "bulk, gaps, sides"),
    ],
)
def test_faults(changed, said):
    asked = {"force": 1.0, "bulk": np.eye(2), "gaps": [0.0, 0.0], "sides": [1, -1], **changed}
    with pytest.raises(LoadSharingError, match=said):
        share_between(asked["force"], asked["bulk"], Nothing(), asked["gaps"], asked["sides"])
