"""Contacts that go round in circles in Newton's method: the central path leads to the minimum of their energy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import nnls

from gears.sharing.active_set import share_forces
from gears.sharing.central_path import share_forces_by_path
from gears.sharing.load_coupling import DenseCoupling
from gears.sharing.staying_contacts import StayingContacts

CELLS, TEETH, TILT = 16, 1e-9, 4e-8
SIDE = np.repeat([1.0, -1.0], CELLS)


class Springs:
    """What teeth yield by themselves [m/N]."""

    def approach(self, force):
        return TEETH * force

    def slope(self, force):
        return np.full_like(force, TEETH)


def pressed(seed, tilt=TILT):
    """Cells of both sides, pressed together over shafts that shift and tilt by far more than the teeth yield."""
    rng = np.random.default_rng(seed)
    z = np.linspace(-1.0, 1.0, CELLS)
    shift = np.where(SIDE > 0.0, 1.0, -rng.uniform(0.7, 1.0))
    moves = np.stack([shift, SIDE * np.tile(z, 2)])
    compliance = tilt * (moves.T * rng.uniform(0.2, 2.0, 2)) @ moves
    gaps = rng.uniform(-15e-6, 15e-6, (2, 1)) * z
    gaps = gaps - gaps.min(axis=1, keepdims=True) - np.array([[0.0], [15e-6]])
    return compliance, gaps.ravel(), rng.choice([0.0, 40.0, 400.0])


def contacts_of(compliance, gaps):
    return StayingContacts(DenseCoupling(compliance), Springs(), None, gaps, SIDE, SIDE)


def minimum(compliance, gaps, force):
    """Forces of the least energy: F.C F/2 + F.g, by least squares of forces that are not negative."""
    root = np.linalg.cholesky(compliance + TEETH * np.eye(len(gaps)))
    weight = 1e3 * np.sqrt(np.diagonal(compliance).max())
    rows = np.vstack([root.T, weight * SIDE])
    return nnls(rows, np.append(-np.linalg.solve(root, gaps), weight * force), maxiter=10000)[0]


def in_balance(share, compliance, gaps, force):
    forces = share.forces
    left = compliance @ forces + TEETH * forces + gaps - SIDE * share.transmission_error
    size = max(np.ptp(gaps), 1e-3 * compliance[0, 0] * forces.max())
    assert SIDE @ forces == pytest.approx(force, abs=1e-9 * forces.max())
    assert np.all(np.abs(left[forces > 0.0]) < 1e-11 * size)
    assert np.all(left[forces == 0.0] >= -1e-11 * size)
    return forces


@pytest.mark.parametrize("seed", range(10))
def test_the_path_leads_to_the_minimum_where_contacts_go_round_in_circles(seed):
    compliance, gaps, force = pressed(seed)
    share = share_forces_by_path(contacts_of(compliance, gaps), np.array(force), np.full(gaps.shape, 1e3))
    forces = in_balance(share, compliance, gaps, force)
    np.testing.assert_allclose(forces, minimum(compliance, gaps, force), atol=3e-6 * forces.max())


@pytest.mark.parametrize("tilt", [1e-5, 1e-3])
@pytest.mark.parametrize("seed", range(5))
def test_shafts_that_give_way_by_metres_under_the_load_at_hand(seed, tilt):
    """They leave a small part of it: sizes of forces and gaps are found on the way."""
    compliance, gaps, _ = pressed(seed, tilt)
    share = share_forces_by_path(contacts_of(compliance, gaps), np.array(0.0), np.full(gaps.shape, 4e3))
    assert in_balance(share, compliance, gaps, 0.0).max() > 0.0


def test_newtons_method_alone_goes_round_in_circles():
    """Else these problems would say nothing of the path."""
    lost = 0
    for seed in range(10):
        compliance, gaps, force = pressed(seed)
        start = np.full(gaps.shape, 1e3)
        lost += share_forces(contacts_of(compliance, gaps), np.array(force), start, None) is None
    assert lost > 5
