"""Surfaces of plane teeth, and triangles that meet along whole edges; those of solids are checked with their fields."""

from __future__ import annotations

import numpy as np
import pytest

from fem import compliance, mesh_cycle
from fem.fields.tooth_surfaces import conforming, outline
from gears import Gear, GearPair
from tests.tooth_surfaces import blocks_of, check_closed, check_loads, check_values, surfaces_of

PAIR = GearPair(Gear(teeth=18), Gear(teeth=20), module=2e-3, face_width=40e-3)
TORQUE, ROWS = 100.0, 4


@pytest.fixture(scope="module")
def blocks():
    bodies = compliance(PAIR, tolerance=0.05)
    cycle = mesh_cycle(PAIR, TORQUE, ROWS, bodies)
    return [blocks_of(PAIR, cycle, row, bodies) for row in range(ROWS)]


def test_surfaces_are_closed_and_their_triangles_point_outwards(blocks):
    check_closed(PAIR, blocks[0])


def test_values_are_those_of_the_fields_at_the_same_places(blocks):
    for held in blocks:
        check_values(PAIR, held)


def test_loads_take_the_torque_and_are_where_the_flanks_touch(blocks):
    counts = [len(check_loads(PAIR, held, TORQUE).load) for held in blocks]
    assert sorted(set(counts)) == [1, 2]


def test_colours_can_end_at_the_stress_of_the_fillets(blocks):
    surfaces = surfaces_of(PAIR, blocks[0])
    frames = [surfaces.frame(held) for held in blocks]
    shown = [max(gear.von_mises.max() for gear in frame.gears) for frame in frames]
    assert all(0.0 < frame.fillet_stress <= largest for frame, largest in zip(frames, shown, strict=True))


def test_a_cell_beside_smaller_ones_has_their_points():
    """A square of two triangles, one of them divided twice: the other one gets four edges on the diagonal."""
    corners = [np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)])]
    for _ in range(2):
        corners = [part for one in corners for part in quarters(one)]
    cells = [np.array([(0.0, 0.0), (1.0, 1.0), (0.0, 1.0)]), *corners]
    places = np.concatenate([np.concatenate([one, 0.5 * (one + np.roll(one, -1, axis=0))]) for one in cells])
    points, numbers = np.unique(places, axis=0, return_inverse=True)
    points = np.column_stack([points, np.zeros(len(points))])
    found = conforming(points, numbers.reshape(-1, 6))
    a, b, c = (points[found[:, k]] for k in range(3))
    area = 0.5 * np.cross(b - a, c - a)[:, 2]
    assert (area > 0.0).all()
    assert area.sum() == pytest.approx(1.0, rel=1e-14)
    on_sides = [
        np.any((ends == 0.0).all(axis=0) | (ends == 1.0).all(axis=0))
        for ends in points[outline(found)][..., :2]
    ]
    assert all(on_sides)  # nothing is left open inside the square
    assert np.sum(points[:, 0] == points[:, 1]) == 9  # the smallest cells have eight edges on the diagonal


def quarters(corners):
    a, b, c = corners
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    return [np.array(part) for part in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
