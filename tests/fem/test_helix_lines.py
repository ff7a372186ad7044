"""Cells on lines of contact of a helical gear without ends: waves, symmetry, cells, and a long solid."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from base import Array
from fem.elasticity.free_ends import half_face
from fem.elasticity.line_load import flank_points
from fem.elasticity.prism import prism
from fem.elasticity.section import Face, section
from fem.influence.gear_face import ENDS_SIZES, solid_of
from fem.influence.gear_shape import GearShape, MeshedShape
from fem.influence.helix_lines import ContactLine, along_line, between_lines
from fem.influence.helix_waves import HelixHarmonics, helix_harmonics
from gears import BasicRack, Gear
from meshes import Sizes, mesh_sector
from tests.even_helices import even_answer, in_plane, waves_of

TWIST = 0.025
SHAPE = GearShape(Gear(teeth=30, bore_radius=8.0), BasicRack(), 0.3 / 0.7)


MESHED = MeshedShape(SHAPE, Sizes(), 1)


class _Case(NamedTuple):
    straight: HelixHarmonics
    twisted: HelixHarmonics


@pytest.fixture(scope="module")
def case() -> _Case:
    return _Case(waves_of(MESHED, 0.0), waves_of(MESHED, TWIST))


def _along(waves: HelixHarmonics, line: ContactLine, half_width: float = 0.0) -> Array:
    return along_line(waves, SHAPE.poisson, line, in_plane(MESHED, line.rho), half_width)


def _line(cells: int, width: float, rho: float, slope: float = 0.0, tooth: int = 0) -> ContactLine:
    z = width * ((np.arange(cells) + 0.5) / cells - 0.5)
    return ContactLine(tooth, z, rho + slope * z, width / cells)


@pytest.mark.parametrize("wavenumber", [0.2, 1.0])
def test_a_wave_on_a_straight_line_is_that_of_the_prism(case: _Case, wavenumber: float) -> None:
    """Far from where the load ends; steps of cells of 0.125 modules are not quite the wave."""
    line, k = _line(480, 60.0, 5.0), np.array([wavenumber])
    moved = _along(case.straight, line) @ np.cos(wavenumber * line.z)
    exact = (
        even_answer(case.straight, MESHED, np.array([5.0]))
        + case.straight.own_at(np.array(5.0), np.array(5.0), k).real
    )
    middle = slice(200, 280)
    assert np.allclose(moved[middle], exact * np.cos(wavenumber * line.z[middle]), atol=4e-3 * exact[0])


def test_an_even_load_on_a_straight_line_is_the_plane(case: _Case) -> None:
    line = _line(240, 60.0, 5.0)
    moved = _along(case.straight, line).sum(axis=0)
    assert moved[120] == pytest.approx(
        float(even_answer(case.straight, MESHED, np.array([5.0]))[0]), rel=1e-3
    )


def _two_lines(waves: HelixHarmonics, cells: int) -> Array:
    """Compliance of two lines that cross two flanks, over a face of 8 modules (2 cells, 2 cells)."""
    slope, pitch = waves.base_radius * waves.twist, 2 * np.pi * waves.base_radius / 30
    first = _line(cells, 8.0, 4.0, slope)
    second = _line(cells, 8.0, 4.0 + 0.5 * pitch, slope, tooth=1)
    forth, back = between_lines(waves, first, second), between_lines(waves, second, first)
    own = [_along(waves, line) for line in (first, second)]
    return np.block([[own[0], forth], [back, own[1]]])


def test_cells_answer_each_other_alike(case: _Case) -> None:
    """Maxwell and Betti."""
    matrix = _two_lines(case.twisted, 24)
    assert np.abs(matrix - matrix.T).max() < 1e-9 * np.abs(matrix).max()
    # under a pressure 0.02 modules wide
    local = -2.0 / np.pi * case.twisted.cos_base * np.log(0.02)
    assert np.linalg.eigvalsh(matrix + local * np.eye(len(matrix))).min() > 0.0


def test_smaller_cells_have_the_same_mean(case: _Case) -> None:
    """An even load, whose displacement is a mean over the lines."""
    coarse, fine = (_two_lines(case.twisted, cells).sum() / cells for cells in (24, 48))
    assert coarse == pytest.approx(fine, rel=1e-3)


def test_cells_of_two_lengths_answer_each_other_alike(case: _Case) -> None:
    """Maxwell and Betti by forces: a line load over the length of its cell."""
    slope, pitch = case.twisted.base_radius * TWIST, 2 * np.pi * case.twisted.base_radius / 30
    first, second = _line(24, 8.0, 4.0, slope), _line(15, 5.0, 4.0 + 0.5 * pitch, slope, tooth=1)
    forth = between_lines(case.twisted, first, second) / first.length
    back = between_lines(case.twisted, second, first) / second.length
    assert np.abs(forth - back.T).max() < 1e-9 * np.abs(forth).max()


def test_a_strip_much_narrower_than_cells_is_a_line(case: _Case) -> None:
    """It takes from cells what it gives to their neighbours."""
    line = _line(24, 8.0, 5.0)
    strip, thin = _along(case.twisted, line, 1e-4), _along(case.twisted, line)
    assert np.abs(strip - thin).max() < 2e-3 * np.abs(thin).max()


def test_strips_keep_narrow_cells_definite(case: _Case) -> None:
    """With a local law that is about that of a pressure 0.1 modules wide."""
    line = _line(200, 4.0, 5.0)
    local = -case.twisted.cos_base / np.pi * (2.0 * np.log(0.05) + 1.0 + SHAPE.poisson) * np.eye(200)
    least = [np.linalg.eigvalsh(_along(case.twisted, line, width) + local).min() for width in (0.0, 0.1)]
    assert least[0] < 0.0 < least[1]


def test_the_other_hand_is_the_mirror(case: _Case) -> None:
    """By waves that are solved for it, and by those of this hand run backwards."""
    slope = case.twisted.base_radius * TWIST
    line = _line(16, 6.0, 5.0, slope)
    solved = _along(helix_harmonics(MESHED, -TWIST), _line(16, 6.0, 5.0, -slope))
    turned = _along(case.twisted.mirrored, _line(16, 6.0, 5.0, -slope))
    assert np.allclose(turned, solved, atol=1e-9)
    assert np.allclose(turned[::-1, ::-1], _along(case.twisted, line), atol=1e-9)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("twist", [TWIST, -0.03])
def test_another_tooth_yields_as_a_long_solid_does(twist: float) -> None:
    """An even load on a line of 6 modules in the middle of a solid of 20 with free ends, on neighbours' lines."""
    shape = GearShape(Gear(teeth=30, bore_radius=11.0), BasicRack(), 0.3 / 0.7)
    waves, cells = helix_harmonics(MeshedShape(shape, Sizes(), 1), twist), 12
    slope, pitch = waves.base_radius * twist, 2 * np.pi * waves.base_radius / 30
    load = _line(cells, 6.0, 4.9, slope)
    seen = {tooth: _line(cells, 6.0, 4.9 + tooth * 0.3 * pitch, slope, tooth) for tooth in (1, -1)}
    exact = _by_long_solid(shape, twist, load, seen)
    for tooth, line in seen.items():
        mine = between_lines(waves, load, line).sum(axis=0)
        print(tooth, np.round(mine, 5), np.round(exact[tooth], 5))
        assert np.abs(mine - exact[tooth]).max() < 0.01 * np.abs(exact[tooth]).max()


def _by_long_solid(
    shape: GearShape, twist: float, load: ContactLine, seen: dict[int, ContactLine]
) -> dict[int, Array]:
    """Displacements at the middles of cells by an even load, of a solid with polynomials along a face of 20 modules."""
    mesh = mesh_sector(shape.profile, ENDS_SIZES, 0)
    whole = half_face(20.0, 1.0, last=2.0, growth=1.0)
    count = len(whole.mass)
    functions = np.ix_(*2 * [np.tile(np.arange(count), 2)])
    face = Face(count, count, *(table[functions] for table in (whole.mass, whole.mixed, whole.stiffness)))
    solid = prism(section(mesh, solid_of(shape.poisson), twist), face)
    pull = whole.values(load.z + 10.0) * load.length
    moved = {}
    for tooth, line in seen.items():
        answer = solid.across(flank_points(mesh, load.rho), flank_points(mesh, line.rho), [tooth])[0]
        moved[tooth] = np.einsum("pl,lprq,qr->r", pull, answer, whole.values(line.z + 10.0), optimize=True)
    return moved
