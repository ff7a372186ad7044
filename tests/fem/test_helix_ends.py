"""Free ends of a helical gear: spur gears as the limit, symmetry, hands, whole solids, and finer choices."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from base import Array
from fem.elasticity.lengthened import FacePieces, answers
from fem.elasticity.line_load import flank_points
from fem.elasticity.prism import prism
from fem.influence import helix_ends as subject
from fem.influence.gear_face import ENDS_SIZES, axial_harmonics, end_correction, section_of
from fem.influence.gear_shape import GearShape, MeshedShape
from fem.influence.helix_ends import HelixEnds, helix_ends
from fem.influence.helix_lines import ContactLine, along_line, between_lines
from fem.influence.helix_waves import helix_harmonics
from gears import BasicRack, Gear
from meshes import Sizes
from tests.even_helices import by_ends, even_answer, in_plane, of_half_space, without_ends

TEETH, WIDTH = 36, 20.0
PINION = MeshedShape(GearShape(Gear(teeth=TEETH, bore_radius=8.375), BasicRack(), 0.3 / 0.7), Sizes(), 1)
BASE = PINION.shape.profile.base_radius
PITCH = 2.0 * np.pi * BASE / TEETH
TWIST = float(np.tan(np.radians(18.75))) / BASE
"""Helix angle of 20 degrees."""
ACTIVE = 4.3, 8.4
"""Curvature radii on lines of contact."""


def _straight(cells: int, width: float, rho: float, tooth: int = 0) -> ContactLine:
    z: Array = width * ((np.arange(cells, dtype=float) + 0.5) / cells - 0.5)
    return ContactLine(tooth, z, np.full(cells, rho), width / cells)


def _contact(width: float, size: float, twist: float = TWIST) -> list[ContactLine]:
    """Lines of contact on three teeth, each between the ends of the flank or of the face, of cells of about a size."""
    slope, lines = BASE * twist, []
    for tooth in (-1, 0, 1):
        middle = 6.2 + tooth * PITCH
        low, high = sorted((place - middle) / slope for place in ACTIVE)
        low, high = max(low, -0.5 * width), min(high, 0.5 * width)
        if high - low > 0.5:
            cells = round((high - low) / size)
            length = (high - low) / cells
            z: Array = low + length * (np.arange(cells, dtype=float) + 0.5)
            lines.append(ContactLine(tooth, z, middle + slope * z, length))
    return lines


def _by_all(ends: HelixEnds, lines: list[ContactLine]) -> list[Array]:
    """Displacements of each line's cells by an even load on all lines."""
    return [sum(ends.between(load, point).sum(axis=0) for load in lines) for point in lines]


def test_means_over_cells_are_exact() -> None:
    """Cells that straddle pieces and the ends of the face, polynomials of third degree."""
    pieces = FacePieces(np.array([0.0, 0.3, 1.0, 2.7]))
    z, length = np.array([-0.1, 0.25, 1.35, 2.6, 3.5]), 0.9
    nodes = np.concatenate(
        [0.5 * (low + high) + 0.5 * (high - low) * _lobatto() for low, high in _pairs(pieces.ends)]
    )
    nodes = np.unique(np.round(nodes, 12))
    found = pieces.means(z, length) @ (nodes**3 - nodes)
    low, high = np.clip(z - 0.45, 0.0, 2.7), np.clip(z + 0.45, 0.0, 2.7)
    exact = (high**4 - low**4) / 4 - (high**2 - low**2) / 2
    assert np.allclose(found, exact / length, atol=1e-12)


def _lobatto() -> Array:
    return np.array([-1.0, -np.sqrt(0.2), np.sqrt(0.2), 1.0])


def _pairs(ends: Array) -> list[tuple[float, float]]:
    return list(zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True))


def test_a_lengthened_body_has_the_same_pieces() -> None:
    longer = FacePieces(np.array([0.0, 1.0, 3.0])).lengthened(np.array([0.5, 2.0]), np.array([4.0]))
    assert longer.ends.tolist() == [-2.5, -0.5, 0.0, 1.0, 3.0, 7.0]


class _Case(NamedTuple):
    ends: HelixEnds
    lines: list[ContactLine]


@pytest.fixture(scope="module")
def case() -> _Case:
    return _Case(helix_ends(PINION, TWIST, WIDTH), _contact(WIDTH, 0.4))


@pytest.mark.slow
def test_answers_are_reciprocal(case: _Case) -> None:
    """Maxwell and Betti, between cells of the same length."""
    for load in case.lines:
        for point in case.lines:
            forth, back = case.ends.between(load, point), case.ends.between(point, load)
            assert np.allclose(forth / load.length, back.T / point.length, atol=1e-9)


@pytest.mark.slow
def test_half_as_long_cells_have_the_same_mean(case: _Case) -> None:
    """Along the axis means are exact; along the flank a cell is at its middle."""
    coarse, fine = (_by_all(case.ends, _contact(WIDTH, size)) for size in (0.4, 0.2))
    for few, many in zip(coarse, fine, strict=True):
        assert many.mean() == pytest.approx(few.mean(), rel=5e-3)
    lines = [_straight(cells, WIDTH, 5.5) for cells in (5, 35)]
    few, many = (case.ends.between(line, line).sum(axis=0) for line in lines)
    assert np.allclose(few, many.reshape(5, 7).mean(axis=1), atol=1e-10 * few.max())


@pytest.mark.slow
def test_the_other_hand_has_its_ends_exchanged(case: _Case) -> None:
    other = helix_ends(PINION, -TWIST, WIDTH)
    mirrored = [ContactLine(line.tooth, -line.z[::-1], line.rho[::-1], line.length) for line in case.lines]
    for load, load_there in zip(case.lines, mirrored, strict=True):
        for point, point_there in zip(case.lines, mirrored, strict=True):
            there = other.between(load_there, point_there)[::-1, ::-1]
            assert np.allclose(case.ends.between(load, point), there, atol=1e-10)


@pytest.mark.slow
def test_the_upper_end_is_the_lower_end_of_the_other_hand() -> None:
    """Both solved for themselves, the upper end by a half turn: on the right flank, whose mesh is another one."""
    shape = GearShape(Gear(teeth=24, bore_radius=9.95), BasicRack(), 0.3 / 0.7)
    meshed, twist = MeshedShape(shape, Sizes(), 1), float(np.tan(0.33)) / shape.profile.base_radius
    pieces, place, _, upper = subject._single_ends(meshed, twist)
    _, _, lower, _ = subject._single_ends(meshed, -twist)
    low, high = shape.profile.flank_rho
    z: Array = 0.3 * (np.arange(15, dtype=float) + 0.5)
    rho = np.linspace(high - 0.2, low + 0.6, 15)
    lines = ContactLine(0, z, rho, 0.3), ContactLine(1, z, rho[::-1], 0.3)
    turned, exact = (subject._Effect(0.0, 1, pieces, place, tables) for tables in (upper, lower))
    for load in lines:
        for point in lines:
            tooth = point.tooth - load.tooth
            mine, solved = (each.between(each.on(load), each.on(point), tooth) for each in (turned, exact))
            assert np.abs(mine - solved).max() < 5e-3 * max(np.abs(solved).max(), 0.1)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("load", ["even", "eccentric"])
def test_no_twist_is_the_spur_gear(load: str) -> None:
    """Endless and free ends against walls and what they leave out, of one gear."""
    width, cells, rho = 12.0, 48, 5.6
    line = _straight(cells, width, rho)
    pull = np.ones(cells) if load == "even" else 1.0 + line.z / width
    waves, poisson = helix_harmonics(PINION, 0.0), PINION.shape.poisson
    own = along_line(waves, poisson, line, in_plane(PINION, line.rho))
    mine = (own + helix_ends(PINION, 0.0, width).between(line, line)).T @ pull
    numbers = np.arange(cells)
    modes = np.sqrt(2.0 / cells) * np.cos(np.pi * numbers[:, None] * (numbers + 0.5) / cells)
    modes[0] /= np.sqrt(2.0)
    wavenumber: Array = np.pi * numbers[1:].astype(float) / width
    place = np.array([rho])
    beyond = axial_harmonics(PINION).own_at(place, wavenumber)[0]
    answer = even_answer(waves, PINION, place) + np.concatenate([[0.0], beyond])
    own, _ = end_correction(PINION, width).over(np.linspace(-0.5, 0.5, cells + 1) * width)
    spur = (modes.T * answer) @ modes @ pull + line.length * own.at(place)[0] @ pull
    print(load, np.round(mine[::6], 4), np.round(spur[::6], 4), mine.mean() / spur.mean() - 1)
    assert mine.mean() == pytest.approx(spur.mean(), rel=3e-3)
    inside = slice(2, -2)
    assert np.abs(mine - spur)[inside].max() < 5e-3 * np.abs(spur).max()


@pytest.mark.slow
@pytest.mark.long
def test_a_whole_solid_with_free_ends(case: _Case) -> None:
    """A finer section and pieces over the whole face at once, without a lengthened body.

    An even load along a helix, whose mean displacement has the same local part in both, and one on a line of contact,
    whose neighbours' lines are looked at.
    """
    solid = _Solid(WIDTH, TWIST)
    waves = helix_harmonics(PINION, TWIST)
    for rho in (4.6, 6.2, 7.9):
        endless = without_ends(waves, PINION, rho, WIDTH)
        mine = endless + by_ends(case.ends, rho, WIDTH)
        exact = solid.even_helix(rho)
        print(f"rho {rho}: endless {endless / exact - 1:+.4f}, with free ends {mine / exact - 1:+.4f}")
        assert mine == pytest.approx(exact, rel=0.01)
    before, middle, after = case.lines
    for load, point in ((middle, before), (middle, after), (before, after)):
        without = between_lines(waves, load, point)
        moved, solved = without + case.ends.between(load, point), solid.between(load, point)
        print(load.tooth, point.tooth, without.mean() / solved.mean() - 1, moved.mean() / solved.mean() - 1)
        assert moved.mean() == pytest.approx(solved.mean(), rel=0.01)


class _Solid:
    """A gear with free ends over its whole face."""

    def __init__(self, width: float, twist: float) -> None:
        near = np.array([0.3, 0.8, 1.7, 3.2])
        rest = 0.5 * width - near.sum()
        self.pieces = FacePieces(np.cumsum(np.concatenate([[0.0], near, [rest, rest], near[::-1]])))
        self.width, self.over = width, section_of(PINION, ENDS_SIZES, 0, twist)
        self.solved = prism(self.over, self.pieces.face())

    def even_helix(self, rho: float) -> float:
        at = flank_points(self.over.mesh, np.array([rho]))
        own = self.solved.across(at, at, [0])[0, 0, :, 0]
        even = self.pieces.means(np.array([0.5 * self.width]), self.width)[0]
        return self.width * float(even @ own @ even) + of_half_space(self.over, PINION.shape, rho)

    def between(self, load: ContactLine, point: ContactLine) -> Array:
        """Means of the cells of another tooth's line by loads on cells (loads, points)."""
        mesh, tooth = self.over.mesh, point.tooth - load.tooth
        answer = self.solved.across(flank_points(mesh, load.rho), flank_points(mesh, point.rho), [tooth])[0]
        first, second = (self.pieces.means(line.z + 0.5 * self.width, line.length) for line in (load, point))
        return np.asarray(load.length * np.einsum("lp,lprq,rq->lr", first, answer, second, optimize=True))


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("width", [3.0, 8.0, WIDTH])
def test_ends_together_are_the_face_solved_at_once(width: float) -> None:
    """Both ends free less both lengthened, in one: what one end does to the effect of the other."""
    near = np.cumsum([0.0, *(each for each in (0.4, 1.3, 3.5) if each < 0.3 * width)])
    pieces = FacePieces(np.concatenate([near, width - near[::-1]]))
    longer = np.array([0.6, 2.5, 8.0, 20.0])
    solve = subject._Solver(PINION, TWIST, subject.SECTION)
    bodies = pieces, pieces.lengthened(longer, longer)
    left = flank_points(solve.over.mesh, solve.rho)
    free, without = (answers(solve.over, body, pieces, left, solve.teeth) for body in bodies)
    whole = HelixEnds((subject._Effect(-0.5 * width, 1, pieces, solve.place, solve.tables(free - without)),))
    lines = _contact(width, 0.3)
    mine, exact = (_by_all(ends, lines) for ends in (helix_ends(PINION, TWIST, width), whole))
    size = max(each.max() for each in exact)
    for found, solved in zip(mine, exact, strict=True):
        print(width, found.mean() / solved.mean() - 1, np.abs(found - solved).max() / size)
        assert found.mean() == pytest.approx(solved.mean(), rel=0.02)
        assert np.abs(found - solved).max() < 0.02 * size
