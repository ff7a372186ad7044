"""Sweeps from many starts against basins, which know nothing of sweeps."""

from __future__ import annotations

import numpy as np
import pytest

from base import InputError
from dynamics import FourierStiffness, GearOscillator, basins, multi_sweep, sweep
from tests.validation.article_motion import lubricated

VALUES = np.linspace(0.575, 0.615, 9)


def test_motions_that_no_sweep_from_rest_meets():
    """All values lie in the hysteresis: from rest both directions stay on one motion, and miss the other."""
    alone = {
        label for d in ("up", "down") for label in sweep(lubricated(), values=VALUES, direction=d).labels
    }
    assert alone == {"1-0-0"}
    found = multi_sweep(lubricated(), values=VALUES, seeds=1)
    assert found.ranges("1-1-1") == [(VALUES[0], VALUES[-1])]
    assert found.ranges("1-0-0") == [(VALUES[0], VALUES[-1])]
    assert max(len(here) for here in found.motions) == 2
    for value in VALUES[[0, 4, 8]]:
        grid = basins(lubricated(value), (-1.0, 1.0, 8), (-1.0, 1.0, 8))
        assert {m.label for m in found.at(value)} == {a.label for a in grid.attractors}
        for motion in found.at(value):
            orbit = next(a for a in grid.attractors if a.label == motion.label).orbit
            assert motion.states[-1] == pytest.approx(orbit.state, abs=1e-5)


def test_directions_are_told():
    """Over the whole hysteresis each sweep keeps to its motion until that ends."""
    found = multi_sweep(lubricated(), values=np.linspace(0.55, 0.68, 27), seeds=0)
    here = {m.label: m.directions for m in found.at(0.6)}
    assert here == {"1-0-0": frozenset({"up"}), "1-1-1": frozenset({"down"})}


def test_motion_without_bound():
    """In the principal resonance of the stiffness (kappa > 4 zeta at omega = 2) none is bounded."""
    osc = GearOscillator(FourierStiffness(1.0, (0.5,), (0.0,)), 0.01, 0.1, 0.2, 2.0, 0.01)
    found = multi_sweep(osc, values=[1.98, 2.0, 2.02], seeds=0)
    assert not found.converged
    assert {m.label for here in found.motions for m in here} == {"diverged"}
    assert "without bound" in found.message


def test_bad_input():
    with pytest.raises(InputError) as error:
        multi_sweep(lubricated(), values=[], seeds=-1, starts=0)
    assert {f.where for f in error.value.faults} == {"values", "seeds", "starts"}
