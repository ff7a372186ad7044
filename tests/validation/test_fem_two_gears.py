"""Loaded contact against two whole gears whose contacts are all resolved by their elements.

Reference: benchmarks/studies/fem_two_gears.py (docs/validation/two_gears.md), which uses nothing of the
compliance, of the local laws or of the tip strips: pressures on element edges of 3 um at the tip corners and 8 um on
the flanks, exact complementarity, gaps and directions of the deformed flanks. Its own error is a few hundredths of a
per cent, at C with the edges free a tenth (15.613 with edges of 3 um and deformed flanks, 15.625 with edges of 1 um,
undeformed).
"""

from __future__ import annotations

import numpy as np
import pytest

import fem
from tests.validation.article import PAIR

C = (PAIR.points.C - PAIR.points.A) / PAIR.base_pitch

FREE = {C: (15.613, -1, 30.0), 0.75: (19.340, 1, 148.8), 0.95: (19.414, -1, 147.2)}
"""Position in base pitches after A: N/(mm um), pair whose tip edge presses, its force in N/mm."""

NEAR_A = {0.98: (20.141, 165.3), 0.99: (20.313, 169.5), 0.9975: (20.420, 172.2)}
"""The same, the wheel's edge pressing a little before A (gaps and directions of the undeformed flanks)."""

INSIDE_A = {0.0025: (20.480, 269.6), 0.01: (20.559, 267.5), 0.04: (20.744, 262.0)}
"""The same a little after A, with the force on the pair ahead, inside the path."""

HELD = {C: 14.857, 0.75: 14.790, 0.95: 14.800, 0.25: 21.221, 0.10: 20.942}
"""Contact held to the path of contact."""


@pytest.fixture(scope="module")
def bodies():
    return fem.compliance(PAIR, tolerance=1e-4)


@pytest.fixture(scope="module")
def free(bodies):
    return fem.mesh_cycle(PAIR, 600.0, 1000, bodies, reference="bore")


def at(cycle, place, values):
    return float(np.interp(place, cycle.position, values))


def stiffness(cycle, place):
    """By the approach, which is smoother along the path than its inverse."""
    return cycle.force / PAIR.face_width / at(cycle, place, cycle.transmission_error) / 1e9


def edge_force(cycle, place, offset):
    return at(cycle, place, cycle.forces[:, list(cycle.pair_offset).index(offset)]) / 40.0


@pytest.mark.parametrize("place", list(FREE))
def test_tip_edges_free(free, place):
    k, offset, force = FREE[place]
    assert stiffness(free, place) == pytest.approx(k, rel=1e-3)
    assert edge_force(free, place, offset) == pytest.approx(force, rel=0.01)


def test_where_an_edge_just_touches_the_finest_corner_agrees_best(free):
    """Edges of 1 um at the corners, undeformed: 15.625; 29.8 and 0.9 N/mm on the pairs behind and ahead."""
    assert stiffness(free, C) == pytest.approx(15.625, rel=2e-4)
    assert edge_force(free, C, -1) == pytest.approx(29.8, rel=0.01)
    assert edge_force(free, C, 1) == pytest.approx(0.9, abs=0.4)


@pytest.mark.parametrize("place", list(NEAR_A))
def test_edge_that_presses_close_to_A(free, place):
    k, force = NEAR_A[place]
    assert stiffness(free, place) == pytest.approx(k, rel=1e-3)
    assert edge_force(free, place, -1) == pytest.approx(force, rel=3e-3)


@pytest.mark.parametrize("place", list(INSIDE_A))
def test_flank_that_the_corner_cuts_off(free, place):
    """Within a half-width of A, inside the path; a flank's law without the corner is 0.2 to 0.5 % softer there."""
    k, force = INSIDE_A[place]
    assert stiffness(free, place) == pytest.approx(k, rel=5e-4)
    assert edge_force(free, place, 0) == pytest.approx(443.4 - force, rel=3e-3)


@pytest.mark.parametrize("place", list(HELD))
def test_contact_held_to_the_path(bodies, place):
    """0.1 % of the 0.2 with two pairs is unexplained."""
    held = fem.mesh_cycle(PAIR, 600.0, 1000, bodies, beyond_path=False, reference="bore")
    assert stiffness(held, place) == pytest.approx(HELD[place], rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("radius", "k", "force"), [(20e-6, 15.474, 24.9), (50e-6, 15.229, 15.3)])
def test_rounded_edges_at_the_pitch_point(bodies, radius, k, force):
    cycle = fem.mesh_cycle(PAIR, 600.0, 1000, bodies, tip_rounding=radius, reference="bore")
    assert stiffness(cycle, C) == pytest.approx(k, rel=1e-3)
    assert edge_force(cycle, C, -1) == pytest.approx(force, rel=0.015)


def test_mean_and_spread_over_a_cycle(bodies):
    cycle = fem.mesh_cycle(PAIR, 600.0, 10, bodies, reference="bore")
    assert np.mean(cycle.force / 0.04 / cycle.transmission_error) / 1e9 == pytest.approx(20.176, rel=2e-3)
    assert np.ptp(cycle.transmission_error) * 1e6 == pytest.approx(7.579, rel=5e-3)
