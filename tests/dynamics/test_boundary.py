"""Boundaries of basins against the saddle's stable manifold, an independent way to them; shares and intervals."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from base import InputError
from dynamics import basin_boundary, basins, find_orbits, manifold
from dynamics.attraction.boundary import share_interval
from tests.validation.article_motion import lubricated

OSC = lubricated(0.6)
BOX = ((-0.2, 0.9), (-0.5, 0.7))


@pytest.fixture(scope="module")
def found():
    coarse = basins(OSC, (*BOX[0], 12), (*BOX[1], 12))
    assert {a.label for a in coarse.attractors} == {"1-0-0", "1-1-1"}
    return coarse, basin_boundary(OSC, coarse.attractors, BOX, levels=5)


def test_boundary_lies_on_the_stable_manifold(found):
    _, boundary = found
    (saddle,) = (o for o in find_orbits(OSC, (1,)).orbits if not o.stable)
    curves = np.concatenate(manifold(saddle, "stable", BOX, length=60.0, spacing=0.003).curves)
    gaps, _ = cKDTree(curves / boundary.cell).query(boundary.points / boundary.cell, p=np.inf)
    assert len(gaps) > 500
    assert np.max(gaps) < 1.5  # half a cell and half a spacing


def test_smooth_boundary_has_dimension_one(found):
    _, boundary = found
    assert abs(boundary.dimension - 1.0) < 4.0 * boundary.dimension_error + 0.02
    assert boundary.dimension_error < 0.05


def test_shares_add_up_and_agree_with_random_starts(found):
    coarse, boundary = found
    assert boundary.shares.sum() == pytest.approx(1.0, abs=1e-12)
    fine = basins(OSC, (*BOX[0], 60), (*BOX[1], 60))
    labels = {a.label: a.share for a in fine.attractors}
    for attractor, share in zip(coarse.attractors, boundary.shares, strict=False):
        assert abs(share - labels[attractor.label]) < boundary.error + 0.02


def test_wilsons_interval():
    """Worked by hand: 8 of 10 at 95 %: 0.4902 to 0.9433; no hits keep zero."""
    assert share_interval(8, 10) == pytest.approx((0.49016, 0.94332), abs=1e-5)
    assert share_interval(0, 50)[0] == 0.0
    with pytest.raises(InputError):
        share_interval(3, 2)
