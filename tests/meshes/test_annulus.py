"""The joined annulus must be one watertight ring of the right area, every tooth accounted for."""

from __future__ import annotations

import numpy as np
import pytest

from base import InputError
from meshes import Sizes, gear_mesh, mesh_sector
from tests.meshes.conftest import area, exact_area


def test_whole_ring(article_profile):
    z = article_profile.teeth
    sector = mesh_sector(article_profile)
    gear = gear_mesh(sector)
    assert len(gear.points) == z * (len(sector.points) - len(sector.side_nodes("left")))
    edges = np.sort(gear.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    unique, uses = np.unique(edges, axis=0, return_counts=True)
    corners = len(np.unique(gear.triangles[:, :3]))
    assert corners - len(unique) + len(gear.triangles) == 0  # Euler's number of a ring
    assert np.sum(uses == 1) == sum(len(facets) for facets in gear.facets.values())
    assert area(gear.points, gear.triangles) == pytest.approx(z * exact_area(article_profile), rel=2e-5)
    np.testing.assert_array_equal(np.bincount(gear.tooth), np.full(z, len(sector.triangles)))
    for name, facets in gear.facets.items():
        assert len(facets) == len(gear.facet_tooth[name])
        assert not name.startswith("side")


def test_teeth_are_counted_anticlockwise(article_profile):
    gear = gear_mesh(mesh_sector(article_profile))
    top = gear.points[gear.facets["top"][gear.facet_tooth["top"] == 1]].reshape(-1, 2)
    angle = np.arctan2(-top[:, 0], top[:, 1])
    assert 0.5 * (angle.min() + angle.max()) == pytest.approx(2 * np.pi / article_profile.teeth, rel=1e-12)


def test_some_teeth_and_a_finer_one_among_them(article_profile):
    sector = mesh_sector(article_profile)
    fine = mesh_sector(article_profile, Sizes(flank=0.1))
    gear = gear_mesh(sector, teeth=range(-1, 2), others={0: fine})
    assert set(gear.tooth.tolist()) == {-1, 0, 1}
    np.testing.assert_allclose(gear.points[gear.nodes[0]], fine.points, rtol=0, atol=1e-15)
    assert area(gear.points, gear.triangles) == pytest.approx(3 * exact_area(article_profile), rel=2e-5)


def test_cuts_that_do_not_fit_are_refused(article_profile):
    sector = mesh_sector(article_profile)
    with pytest.raises(InputError, match="cut"):
        gear_mesh(sector, teeth=range(3), others={1: mesh_sector(article_profile, Sizes(root=0.2, rim=0.4))})
