"""Compliance between cells of front and back flanks of a pair: the plane, walls, free ends, the mirror, wider gears."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

import fem
import fem.influence.back_face
import fem.pair.face_across
from base import Array
from fem.contact.cell_matrix import cell_matrix, cross_matrix
from fem.contact.contact_sides import between
from fem.contact.loaded_flanks import LoadedFlanks, loaded_flanks
from fem.influence.gear_store import GearStore
from fem.laws.corner_laws import CornerLaws
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_across import (
    PlacesAcross,
    back_ends_of,
    back_waves_of,
    even_loads_across,
    gear_waves_across,
    places_across,
)
from fem.pair.face_setting import FREE_ENDS, SLICES, WALLS, FaceSetting
from fem.pair.pair_compliance import PairCompliance
from fem.pair.unequal_widths import overhang_across
from gears import Alignment, Gear, GearPair

PAIR = GearPair(Gear(22, 0.2), Gear(31, -0.1), 2e-3, 0.012)
NARROW = replace(PAIR, face_width=1.4e-3)
CELLS = 8


class _Sides(NamedTuple):
    setup: MeshSetup
    bodies: PairCompliance
    front: LoadedFlanks
    back: LoadedFlanks


def _sides(bodies: PairCompliance, position: Array | None = None) -> _Sides:
    setup = MeshSetup(bodies.pair, 5)
    setup = setup if position is None else setup.at(position)
    corner_laws = CornerLaws(setup, bodies)
    front, back = (loaded_flanks(side, bodies, None, 0.6, corner_laws) for side in (setup, setup.opposite))
    return _Sides(setup, bodies, front, back)


@pytest.fixture(scope="module")
def sides() -> _Sides:
    return _sides(fem.compliance(PAIR, tolerance=0.01))


def _plane(sides: _Sides) -> Array:
    return between(sides.setup, sides.bodies, sides.front.candidates, sides.back.candidates)


def _cross(sides: _Sides, face: FaceSetting, gears: tuple[int, ...] = (0, 1)) -> Array:
    """(positions, pairs, cells, others, cells)."""
    front, back = sides.front, sides.back
    plane = _plane(sides)
    matrix = cross_matrix(face, sides.bodies, front.candidates, back.candidates, plane, gears)
    positions, pairs, others = plane.shape
    return matrix.reshape(positions, pairs, face.cells, others, face.cells)


def _places(sides: _Sides) -> PlacesAcross:
    front, back = (side.candidates for side in (sides.front, sides.back))
    return places_across(sides.bodies.pair, front.rho, back.rho, front.teeth, back.teeth)


def test_one_cell_is_the_plane(sides: _Sides) -> None:
    plane = _plane(sides)
    for model in (WALLS, SLICES):
        assert np.array_equal(_cross(sides, FaceSetting(1, model=model))[:, :, 0, :, 0], plane)


def test_even_loads_between_walls_are_the_plane(sides: _Sides) -> None:
    plane = _plane(sides)
    cells = _cross(sides, FaceSetting(CELLS, model=WALLS))
    even = np.repeat(plane[:, :, None], CELLS, axis=2)
    np.testing.assert_allclose(cells.sum(axis=-1) / CELLS, even, rtol=0, atol=1e-13 * np.abs(plane).max())
    slices = _cross(sides, FaceSetting(CELLS, model=SLICES))
    diagonal = np.einsum("picjc->pijc", slices)
    np.testing.assert_allclose(diagonal, np.repeat(CELLS * plane[..., None], CELLS, axis=-1), rtol=1e-13)
    assert np.abs(slices.sum() - diagonal.sum()) < 1e-10 * np.abs(slices).sum()


def test_even_loads_of_both_gears_are_the_plane(sides: _Sides) -> None:
    """Steps between the teeth, gear by gear, where forces lie along the flanks' normals."""
    bodies, places = sides.bodies, _places(sides)
    plane = _plane(sides)
    moved = sum(even_loads_across(bodies, gear, places) for gear in (0, 1)) / PAIR.face_width
    on_path = [side.candidates.touchable & ~side.candidates.edge for side in (sides.front, sides.back)]
    chosen = on_path[0][:, :, None] & on_path[1][:, None, :]
    assert chosen.sum() > 10
    np.testing.assert_allclose(
        (moved + bodies.common_across)[chosen], plane[chosen], rtol=0, atol=1e-12 * np.abs(plane).max()
    )


def _least(sides: _Sides, face: FaceSetting, across: FaceSetting) -> float:
    """Smallest eigenvalue of what both sides yield on their flanks, with Hertz's slope under 500 N [m/N]."""
    both, chosen = [], []
    for side in (sides.front, sides.back):
        matrix = cell_matrix(face, sides.bodies, side.candidates.rho, side.matrix)
        slope = CELLS * side.laws.slope(np.full(side.candidates.touchable.shape, 500.0))
        both.append(matrix + np.repeat(slope, CELLS, axis=-1)[..., None] * np.eye(matrix.shape[-1]))
        chosen.append(np.repeat(side.candidates.touchable & ~side.candidates.edge, CELLS, axis=-1))
    cross = _cross(sides, across).reshape(len(both[0]), both[0].shape[1], both[1].shape[1])
    smallest = []
    for first, second, between_them, here, there in zip(*both, cross, *chosen, strict=True):
        across_here = between_them[np.ix_(here, there)]
        joint = np.block(
            [[first[np.ix_(here, here)], across_here], [across_here.T, second[np.ix_(there, there)]]]
        )
        smallest.append(np.linalg.eigvalsh(joint)[0])
    return float(min(smallest))


@pytest.mark.parametrize("model", [WALLS, pytest.param(FREE_ENDS, marks=pytest.mark.slow)])
def test_both_sides_together_are_positive_definite(sides: _Sides, model: str) -> None:
    """No loads give energy; they would if short waves crossed the teeth as even loads do."""
    face = FaceSetting(CELLS, model=model)
    assert _least(sides, face, face) > 0.0
    assert _least(sides, face, FaceSetting(CELLS, model=SLICES)) < 0.0


def _same(here: LoadedFlanks, there: LoadedFlanks, row: int) -> list[tuple[int, int]]:
    """Columns of contacts that stand at the same place of the pinion's flank."""
    rho = here.candidates.rho[0, row], there.candidates.rho[0, row]
    alike = np.isclose(rho[0][:, None], rho[1], rtol=1e-9)
    alike &= here.candidates.touchable[row][:, None] & there.candidates.touchable[row]
    return [(int(i), int(j)) for i, j in np.argwhere(alike)]


@pytest.mark.parametrize("model", [WALLS, FREE_ENDS])
def test_the_mirror_lets_both_sides_change_places(sides: _Sides, model: str) -> None:
    """At mirrored positions front flanks stand as back flanks did, and the reverse; over a narrow face."""
    position = np.array([0.17, 0.62])
    mirrored = (sides.setup.mirror - position) % 1.0
    bodies, face = replace(sides.bodies, pair=NARROW), FaceSetting(CELLS, model=model)
    here, there = (_sides(bodies, at) for at in (position, mirrored))
    forth, back = (_cross(of, face) for of in (here, there))
    back = np.transpose(back, (0, 3, 4, 1, 2))
    size, compared = np.abs(forth).max(), 0
    for row in range(len(position)):
        for i, its_back in _same(here.front, there.back, row):
            for j, its_front in _same(here.back, there.front, row):
                np.testing.assert_allclose(
                    forth[row, i, :, j], back[row, its_back, :, its_front], rtol=0, atol=1e-9 * size
                )
                compared += 1
    assert compared >= 6


def test_waves_and_free_ends_of_both_gears(sides: _Sides) -> None:
    """Contact by contact, from the tables of the gears, at tip edges too."""
    bodies, count = replace(sides.bodies, pair=NARROW), 4
    mine, width, module = _sides(bodies), NARROW.face_width, NARROW.module
    slices, walls, free = (
        _cross(mine, FaceSetting(count, model=name)) for name in (SLICES, WALLS, FREE_ENDS)
    )
    edges, wavenumber = (
        np.linspace(-0.5, 0.5, count + 1) * width / module,
        np.arange(count) * np.pi * module / width,
    )
    modes = np.sqrt(2.0 / count) * np.cos(
        np.pi * np.arange(count)[:, None] * (np.arange(count) + 0.5) / count
    )
    front, back = mine.front.candidates, mine.back.candidates
    at_edges = 0
    for row, i, j in np.argwhere(front.touchable[:, :, None] & back.touchable[:, None, :]):
        by_wave, by_ends = np.zeros(count), np.zeros((count, count))
        for gear, (meshed, flexible) in enumerate(
            zip(bodies.meshed, (bodies.pinion, bodies.wheel), strict=True)
        ):
            step = int((-1, 1)[gear] * (back.teeth[gear, row, j] - front.teeth[gear, row, i]))
            teeth = (PAIR.pinion.teeth, PAIR.wheel.teeth)[gear]
            step -= teeth * round(step / teeth)
            load, point = (side.rho[gear, row, [k]] / module for side, k in ((front, i), (back, j)))
            modulus = flexible.law.plane_modulus
            waves, ends = (
                back_waves_of(meshed, GearStore()),
                back_ends_of(meshed, width / module, GearStore()),
            )
            by_wave += waves.across(np.array([step]), load, point, wavenumber)[0] / (modulus * width)
            by_ends += ends.over(edges)[step].at(load, point)[0] / (modulus * module)
        at_edges += front.edge[row, i] | back.edge[row, j]
        by_wave = count * modes.T @ (by_wave[:, None] * modes)
        for mine_added, added in ((walls - slices, by_wave), (free - walls, by_ends)):
            size = np.abs(mine_added).max()
            np.testing.assert_allclose(mine_added[row, i, :, j], added, rtol=0, atol=1e-11 * size)
    assert at_edges > 3


def test_shorter_waves_reach_less(sides: _Sides) -> None:
    places, wavenumber = _places(sides), np.array([0.0, 0.1, 0.5, 2.0, 12.0])
    for gear in (0, 1):
        flexible = (sides.bodies.pinion, sides.bodies.wheel)[gear]
        even = even_loads_across(sides.bodies, gear, places)
        whole = even[..., None] + gear_waves_across(sides.bodies, gear, places, wavenumber)
        size = np.abs(whole).max(axis=(0, 1, 2))
        assert np.all(np.diff(size) < 0.0)
        assert size[-1] < 2e-3 * size[0]
        # a tooth on the far side of the gear turns with the body by even loads, and by nothing else
        far = replace(places, steps=np.full_like(places.steps, 9))
        whole = even_loads_across(sides.bodies, gear, far)[..., None]
        whole = whole + gear_waves_across(sides.bodies, gear, far, wavenumber)
        np.testing.assert_allclose(whole[..., 0], -flexible.hub_windup)
        assert np.abs(whole[..., 1:]).max() < 1e-12 * flexible.hub_windup


def test_a_wheel_that_is_twice_as_wide(sides: _Sides) -> None:
    """Its cells beside the contact take no load: a part of the matrix of a face with all of them."""
    width = PAIR.face_width
    wide = replace(PAIR, wheel=replace(PAIR.wheel, face_width=2.0 * width, face_offset=0.5 * width))
    assert wide.face_width == width
    bodies, places = replace(sides.bodies, pair=wide), _places(sides)
    even = even_loads_across(bodies, 1, places)
    face = FaceSetting(CELLS, model=WALLS)

    def cells(of: PairCompliance, count: int) -> Array:
        modes = np.cos(np.pi * np.arange(count)[:, None] * (np.arange(count) + 0.5) / count)
        modes *= np.sqrt(np.where(np.arange(count)[:, None], 2.0, 1.0) / count)
        wave = np.arange(count) * np.pi * of.pair.module / (count * width / CELLS)
        answer = even[..., None] + gear_waves_across(of, 1, places, wave)
        return np.einsum("mc,pijm,md->picjd", modes, answer, modes) * CELLS / width

    added = overhang_across(bodies, 1, places, face)
    of_wide, of_contact = cells(bodies, 2 * CELLS), cells(bodies, CELLS)
    offset = wide.face_offsets[1] - wide.face_offsets[0]
    part = slice(None, CELLS) if offset > 0 else slice(CELLS, None)
    np.testing.assert_allclose(
        of_contact + added, of_wide[:, :, part, :, part], rtol=0, atol=1e-11 * np.abs(of_wide).max()
    )
    assert np.abs(added).max() > 1e-3 * np.abs(of_contact).max()


def test_nothing_is_solved_before_it_is_asked_for(
    monkeypatch: pytest.MonkeyPatch, no_gear_solved: None
) -> None:
    def refused(*_: object) -> None:
        raise AssertionError

    for name in ("back_harmonics", "back_end_correction"):
        monkeypatch.setattr(fem.pair.face_across, name, refused)
    pair = PAIR.with_backlash(60e-6)
    bodies = fem.compliance(pair, tolerance=0.05)
    cycle = fem.mesh_cycle(pair, 20.0, 2, bodies, alignment=Alignment(5e-6), cells=4, face_model="walls")
    assert cycle.face is not None
    sides = _sides(bodies)
    with pytest.raises(AssertionError):
        _cross(sides, FaceSetting(4, model=WALLS))
    _cross(sides, FaceSetting(4, model=SLICES))
    _cross(sides._replace(bodies=bodies.without("coupling")), FaceSetting(4, model=FREE_ENDS))
