"""Load sharing: equilibrium, complementarity, exact tangent, closed solutions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gears import LoadSharingError
from gears.sharing.independent_pairs import independent_pairs
from gears.sharing.load_sharing import share_load


class Spring:
    """Linear local deflection."""

    def __init__(self, compliance):
        self.compliance = compliance

    def approach(self, force):
        return self.compliance * force

    def slope(self, force):
        return np.full_like(force, self.compliance)


class Hertz:
    """c F [ln(K / F) + 1]: the logarithmic law of a line contact, with an infinite slope at zero."""

    def __init__(self, c=1.6e-10, K=1e9):
        self.c, self.K = c, K

    def approach(self, force):
        safe = np.where(force > 0, force, 1.0)
        return np.where(force > 0, self.c * safe * (np.log(self.K / safe) + 1.0), 0.0)

    def slope(self, force):
        safe = np.where(force > 0, force, 1.0)
        return np.where(force > 0, self.c * np.log(self.K / safe), np.inf)


class Film:
    """h = h0 (1 + F / F0)^-0.13."""

    def __init__(self, h0=3e-6, F0=10.0):
        self.h0, self.F0 = h0, F0

    def approach(self, force):
        return self.h0 * (1.0 + force / self.F0) ** -0.13

    def slope(self, force):
        return -0.13 * self.h0 / self.F0 * (1.0 + force / self.F0) ** -1.13


class Together(Hertz):
    """The same law, which gives deflection and slope together, and has been asked for neither alone."""

    def value_and_slope(self, force):
        return Hertz.approach(self, force), Hertz.slope(self, force)

    def approach(self, force):
        raise AssertionError

    slope = approach


def random_bulk(seed, n, scale=1e-9):
    rng = np.random.default_rng(seed)
    a = rng.normal(size=(n, n))
    return scale * (a @ a.T / n + 0.5 * np.eye(n))


def residual(share, bulk, hertz, gaps, film=None):
    F = share.forces
    out = (bulk @ F[..., None])[..., 0] + hertz.approach(F) + gaps - share.transmission_error[..., None]
    return out if film is None else out - film.approach(F)


problems = {
    "seed": st.integers(0, 10**6),
    "pairs": st.integers(1, 5),
    "force": st.floats(-9, 7).map(lambda e: 10.0**e),
    "gap": st.floats(-9, 0).map(lambda e: 10.0**e),
    "oil": st.booleans(),
}


@settings(max_examples=300, deadline=None)
@given(**problems)
def test_equilibrium_and_complementarity(seed, pairs, force, gap, oil):
    bulk = random_bulk(seed, pairs)
    gaps = gap * np.random.default_rng(seed).uniform(size=pairs)
    film = Film() if oil else None
    share = share_load(force, bulk, Hertz(), gaps, film)
    off = residual(share, bulk, Hertz(), gaps, film)
    size = np.abs(share.transmission_error) + gaps.max() + (3e-6 if oil else 0.0)
    assert share.forces.sum() == pytest.approx(force, rel=1e-10)
    assert np.all(share.forces >= 0.0)
    assert np.all(np.abs(off[share.forces > 0.0]) <= 1e-9 * size)
    assert np.all(off[share.forces == 0.0] >= -1e-9 * size)


@settings(max_examples=150, deadline=None)
@given(**problems)
def test_tangent_is_the_slope_of_force_over_approach(seed, pairs, force, gap, oil):
    bulk = random_bulk(seed, pairs)
    gaps = gap * np.random.default_rng(seed).uniform(size=pairs)
    film = Film() if oil else None
    low, mid, high = (share_load(force * s, bulk, Hertz(), gaps, film) for s in (1 - 1e-4, 1.0, 1 + 1e-4))
    if np.array_equal(low.forces > 0, high.forces > 0):
        rise = high.transmission_error - low.transmission_error
        rounding = 1e-14 * (np.abs(mid.transmission_error) + gaps.max() + 3e-6)
        # the local laws bend on the scale of each pair's own force: truncation is the square of the step over it
        truncation = 1e-6 + (1e-4 * force / mid.forces[mid.forces > 0].min()) ** 2
        assert abs(rise - 2e-4 * force / mid.stiffness) <= truncation * rise + rounding


@settings(max_examples=100, deadline=None)
@given(**problems)
def test_renumbering_the_pairs_renumbers_the_forces(seed, pairs, force, gap, oil):
    bulk = random_bulk(seed, pairs)
    rng = np.random.default_rng(seed)
    gaps, order = gap * rng.uniform(size=pairs), rng.permutation(pairs)
    film = Film() if oil else None
    plain = share_load(force, bulk, Hertz(), gaps, film)
    swapped = share_load(force, bulk[np.ix_(order, order)], Hertz(), gaps[order], film)
    assert np.allclose(swapped.forces, plain.forces[order], rtol=1e-8, atol=1e-10 * force)


def test_two_equal_springs_share_equally_and_a_gap_shifts_the_difference():
    bulk, gap, force = np.diag([2e-9, 2e-9]), 1e-6, 5e3
    share = share_load(force, bulk, Spring(1e-9), np.array([0.0, gap]))
    difference = gap / 3e-9
    assert np.allclose(share.forces, [(force + difference) / 2, (force - difference) / 2], rtol=1e-13)
    assert share.stiffness == pytest.approx(2 / 3e-9, rel=1e-13)


def test_a_pair_that_just_touches_carries_nothing():
    bulk, force = np.diag([2e-9, 2e-9]), 5e3
    share = share_load(force, bulk, Spring(1e-9), np.array([0.0, 3e-9 * force]))
    assert share.forces[1] <= 1e-9 * force
    assert share.transmission_error == pytest.approx(3e-9 * force)


def test_one_pair_and_huge_gap_and_absent_pair():
    alone = share_load(1e3, [[1e-9]], Hertz(), [0.0])
    for gap in (1.0, 1e6, np.inf):
        bulk = random_bulk(1, 3)
        bulk[0, 0] = 1e-9
        share = share_load(1e3, bulk, Hertz(), [0.0, gap, gap])
        assert np.allclose(share.forces, [1e3, 0, 0], rtol=1e-12)
        assert share.transmission_error == pytest.approx(float(alone.transmission_error), rel=1e-12)
        assert share.stiffness == pytest.approx(float(alone.stiffness), rel=1e-12)


def test_zero_force_touches_without_stiffness():
    share = share_load(0.0, random_bulk(2, 2), Hertz(), [1e-6, 0.0])
    assert np.array_equal(share.forces, [0.0, 0.0])
    assert share.transmission_error == 0.0
    assert share.stiffness == 0.0
    with_spring = share_load(0.0, np.diag([1e-9, 2e-9]), Spring(1e-9), [1e-6, 0.0])
    assert with_spring.stiffness == pytest.approx(1 / 3e-9)


def test_many_positions_at_once_equal_each_alone():
    rng = np.random.default_rng(0)
    bulk = np.stack([random_bulk(s, 3) for s in range(20)])
    gaps = rng.uniform(0, 2e-5, (20, 3)) * (rng.uniform(size=(20, 3)) > 0.3)
    together = share_load(17736.0, bulk, Hertz(), gaps, Film())
    for i in range(20):
        alone = share_load(17736.0, bulk[i], Hertz(), gaps[i], Film())
        assert np.allclose(together.forces[i], alone.forces, rtol=1e-10, atol=1e-8)
        assert together.transmission_error[i] == pytest.approx(float(alone.transmission_error), rel=1e-10)
        assert together.stiffness[i] == pytest.approx(float(alone.stiffness), rel=1e-8)


def test_many_forces_at_once_equal_each_alone():
    """Bulk and gaps depend on the position only, the force on the torque only, the gaps on the pitch too."""
    rng = np.random.default_rng(0)
    bulk = np.stack([random_bulk(s, 3) for s in range(5)])
    gaps = rng.uniform(0, 2e-5, (4, 5, 3))
    forces = np.array([1e-3, 30.0, 17736.0])
    together = share_load(forces[:, None, None], bulk, Hertz(), gaps)
    assert together.forces.shape == (3, 4, 5, 3)
    assert together.transmission_error.shape == together.stiffness.shape == (3, 4, 5)
    for k, force in enumerate(forces):
        alone = share_load(force, bulk, Hertz(), gaps)
        np.testing.assert_allclose(together.forces[k], alone.forces, rtol=1e-9, atol=1e-10 * force)
        np.testing.assert_allclose(together.transmission_error[k], alone.transmission_error, rtol=1e-9)
        np.testing.assert_allclose(together.stiffness[k], alone.stiffness, rtol=1e-7)


def test_levers_balance_the_moment_and_tilt_the_tangent():
    bulk, gaps = random_bulk(4, 3), np.array([0.0, 1e-6, 2e-6])
    levers, force = np.array([0.9, 1.0, 1.2]), 5e3
    share = share_load(force, bulk, Hertz(), gaps, levers=levers)
    assert levers @ share.forces == pytest.approx(force, rel=1e-12)
    assert np.abs(residual(share, bulk, Hertz(), gaps)).max() < 1e-9 * share.transmission_error
    step = 1e-4 * force
    low, high = (share_load(force + s, bulk, Hertz(), gaps, levers=levers) for s in (-step, step))
    rise = high.transmission_error - low.transmission_error
    assert 2 * step / rise == pytest.approx(float(share.stiffness), rel=1e-6)
    # one pair alone: a lever only scales its force
    one = share_load(1e3, [[1e-9]], Hertz(), [0.0], levers=[0.8])
    assert one.forces[0] == pytest.approx(1250.0, rel=1e-12)
    at_rest = share_load(0.0, np.diag([1e-9, 2e-9]), Spring(1e-9), [1e-6, 0.0], levers=[1.0, 0.5])
    assert at_rest.stiffness == pytest.approx(0.5 / 3e-9)


def test_normals_that_lean_are_other_coordinates_of_the_same_forces():
    """In forces kappa F gaps are gap/kappa, laws kappa F -> law(F)/kappa, compliances bulk/(kappa kappa')."""
    bulk, gaps, force = random_bulk(7, 3), np.array([0.5e-6, 1e-6, 0.2e-6]), 5e3
    kappa, tilted = np.array([0.9, 1.0, 0.97]), np.array([0.95, 1.02, 0.9])

    class Turned:
        def approach(self, force):
            return Hertz().approach(force / kappa) / kappa

        def slope(self, force):
            return Hertz().slope(force / kappa) / kappa**2

    turned = share_load(force, bulk / np.outer(kappa, kappa), Turned(), gaps / kappa, levers=tilted / kappa)
    share = share_load(force, bulk, Hertz(), gaps, levers=tilted, reach=kappa)
    np.testing.assert_allclose(share.forces, turned.forces / kappa, rtol=1e-12)
    np.testing.assert_allclose(share.pair_stiffness, turned.pair_stiffness / kappa, rtol=1e-12)
    assert share.transmission_error == pytest.approx(float(turned.transmission_error), rel=1e-12)
    assert share.stiffness == pytest.approx(float(turned.stiffness), rel=1e-12)
    plain = share_load(force, bulk, Hertz(), gaps, reach=kappa)
    assert kappa @ plain.forces == pytest.approx(force, rel=1e-12)
    at_rest = share_load(0.0, bulk, Spring(1e-9), [1e-6, 0.99e-6, 2e-6], levers=tilted, reach=[1.0, 0.9, 1.0])
    assert at_rest.transmission_error == pytest.approx(1e-6)
    assert at_rest.stiffness == pytest.approx(0.95 / (bulk[0, 0] + 1e-9))


def test_film_in_series_equals_a_softer_spring():
    """A film whose approach falls linearly with the force is a spring in series and a preload of the gap."""

    class LinearFilm(Spring):
        def approach(self, force):
            return 1e-5 - self.compliance * force

        def slope(self, force):
            return np.full_like(force, -self.compliance)

    bulk, gaps = random_bulk(3, 3), np.array([0.0, 1e-6, 2e-6])
    wet = share_load(2e3, bulk, Spring(1e-9), gaps, LinearFilm(3e-10))
    dry = share_load(2e3, bulk, Spring(1.3e-9), gaps)
    assert np.allclose(wet.forces, dry.forces, rtol=1e-12)
    assert wet.transmission_error == pytest.approx(float(dry.transmission_error) - 1e-5, rel=1e-9)
    assert wet.stiffness == pytest.approx(float(dry.stiffness), rel=1e-12)


def test_all_faults_of_the_input_at_once():
    with pytest.raises(LoadSharingError) as caught:
        share_load(np.nan, np.full((2, 2), np.nan), Hertz(), [-1.0, 0.0])
    assert {f.where for f in caught.value.faults} == {"force", "gaps", "bulk"}
    with pytest.raises(LoadSharingError, match="bulk, gaps"):
        share_load(1.0, np.eye(3), Hertz(), [0.0, 0.0])
    with pytest.raises(LoadSharingError, match="levers"):
        share_load(1.0, np.eye(2), Hertz(), [0.0, 0.0], levers=[1.0, -0.1])
    with pytest.raises(LoadSharingError, match="reach"):
        share_load(1.0, np.eye(2), Hertz(), [0.0, 0.0], reach=[1.0, 0.0])
    with pytest.raises(LoadSharingError, match="all above 0"):
        share_load(np.array([[1.0], [0.0]]), np.eye(2), Hertz(), [0.0, 0.0])
    with pytest.raises(LoadSharingError, match="bulk, gaps"):
        share_load(np.ones((3, 4)), np.zeros((5, 2, 2)), Hertz(), np.zeros((5, 2)))
    with pytest.raises(LoadSharingError, match="inf for all"):
        share_load(1.0, np.eye(2), Hertz(), [np.inf, np.inf])


def test_independent_pairs_share_in_proportion():
    k = np.array([[4e8, 2e8], [5e8, 0.0]])
    share = independent_pairs(600.0, k)
    assert np.allclose(share.forces, [[400, 200], [600, 0]])
    assert np.allclose(share.stiffness, [6e8, 5e8])
    film = independent_pairs(600.0, k, np.array([[4e8, np.inf], [5e8, 1.0]]))
    assert np.allclose(film.stiffness, [4e8, 2.5e8])
    broken = independent_pairs(600.0, k[0], np.array([0.0, np.inf]))  # a film that bears nothing
    assert np.allclose(broken.forces, [0, 600])
    with pytest.raises(LoadSharingError):
        independent_pairs(600.0, [[0.0, 0.0]])


@pytest.mark.parametrize("overlap", [1e-15, 1e-14, 1e-12, 1e-10])
def test_a_pair_about_to_touch_is_taken_in_with_next_to_nothing(overlap):
    """Any start is more than it will bear: it was released for ever, since its neighbour then bears too much."""
    bulk, levers, hertz = (
        np.array([[5.0e-8, 4.96e-8], [4.96e-8, 5.0e-8]]),
        np.array([0.9795, 1.0352]),
        Hertz(1.6e-9),
    )
    alone = np.array([264.0 / levers[1]])
    whole = float(bulk[1, 1] * alone[0] + hertz.approach(alone)[0])
    gaps = np.array([whole - bulk[0, 1] * alone[0] - overlap, 0.0])
    found = share_load(264.0, bulk, hertz, gaps, levers=levers)
    assert found.forces @ levers == pytest.approx(264.0, rel=1e-12)
    assert 0.0 <= found.forces[0] < 100 * overlap / (bulk[0, 0] - bulk[0, 1])
    assert found.transmission_error == pytest.approx(whole, rel=1e-4)


def test_a_law_that_gives_deflection_and_slope_together_is_asked_once():
    gaps, bulk = np.array([0.0, 1e-6, 2e-6]), random_bulk(4, 3)
    apart, together = (share_load(1e4, bulk, law, gaps) for law in (Hertz(), Together()))
    np.testing.assert_array_equal(together.forces, apart.forces)
