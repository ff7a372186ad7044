"""Waves of load along the face: energy by three-dimensional strains, plane strain without a wave, limits."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from numpy.polynomial import legendre

from base import Array
from fem.elasticity.line_load import FlankPoints, flank_points
from fem.elasticity.plane_elasticity import PlaneElasticity, physical_gradients
from fem.elasticity.prism import prism
from fem.elasticity.section import Face, Section, section
from gears import Gear, GearPair
from meshes import SectorMesh, Sizes, mesh_sector
from meshes.sector import refined
from meshes.triangle import shape

LAW = PlaneElasticity("strain", 206e9, 0.3)


class _Case(NamedTuple):
    mesh: SectorMesh
    over: Section
    at: FlankPoints


@pytest.fixture(scope="module")
def case() -> _Case:
    pair = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=40e-3)
    profile = pair.teeth_profiles[0]
    mesh = mesh_sector(profile, Sizes(), 1)
    low, high = profile.flank_rho
    at = flank_points(mesh, low + np.array([0.2, 0.5, 0.9]) * (high - low))
    return _Case(mesh, section(mesh, LAW), at)


def _answer(over: Section, wavenumber: float, at: FlankPoints, reach: int) -> tuple[Array, Array]:
    own, cross = prism(over, Face.wave(wavenumber)).influence(at, reach)
    return own[:, 0, 0], cross[:, :, 0, :, 0]


def test_energy_is_that_of_the_strains_in_space(case: _Case) -> None:
    """One element's energy over a wave length by Hooke's law in three dimensions, strains at points of a volume."""
    rng = np.random.default_rng(3)
    k, lam, mu = 700.0, *LAW.lame
    one = case.mesh.triangles[:1]
    unknown = rng.normal(size=(6, 3))
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefTri

    (xi, eta), weight = get_quadrature(RefTri, 6)
    gradient, determinant = physical_gradients(case.mesh.points, one, xi, eta)
    values = shape(xi, eta)
    turns, share = legendre.leggauss(12)
    energy = 0.0
    for z, part in zip(np.pi * (turns + 1) / k, np.pi * share / k, strict=True):
        wave = np.array([np.cos(k * z), np.cos(k * z), np.sin(k * z)])
        slope = np.array([-k * np.sin(k * z), -k * np.sin(k * z), k * np.cos(k * z)])
        by_plane = np.einsum("qic,ia->qac", gradient[0], unknown) * wave[:, None]
        by_face = (values @ unknown) * slope
        strain = np.concatenate([by_plane, by_face[..., None]], axis=2)
        strain = 0.5 * (strain + np.swapaxes(strain, 1, 2))
        density = 0.5 * lam * np.trace(strain, axis1=1, axis2=2) ** 2 + mu * np.sum(strain**2, axis=(1, 2))
        energy += part * float(np.sum(density * determinant[0] * weight))
    matrix = case.over.elements(Face.wave(k), np.array([0]))[0]
    flat = unknown.ravel()
    # the mean of cos^2 over a wave length is a half
    assert 0.5 * flat @ matrix @ flat * np.pi / k == pytest.approx(energy, rel=1e-9)


def test_a_wave_as_long_as_can_be_is_plane_strain(case: _Case) -> None:
    plane, long = (_answer(case.over, k, case.at, 1) for k in (0.0, 1e-6))
    for one, other in zip(plane, long, strict=True):
        assert np.abs(one - other).max() < 1e-11 * np.abs(one).max()


def test_answer_is_symmetric_and_shorter_waves_yield_less(case: _Case) -> None:
    """Maxwell and Betti between teeth; energy falls as the wave's shear and pressure along z come in."""
    owns = []
    for k in (0.0, 50.0, 400.0, 3000.0):
        own, _ = _answer(case.over, k, case.at, 0)
        owns.append(own)
    assert (np.diff(np.array(owns), axis=0) < 0.0).all()
    mirrored = flank_points(case.mesh, case.at.rho, "right")
    forth = _answer(case.over, 400.0, case.at, 1)
    back = _answer(case.over, 400.0, mirrored, case.mesh.teeth - 1)
    # the same tooth mirrored, with neighbours counted the other way round
    assert np.allclose(forth[0], back[0], rtol=1e-4)
    assert np.allclose(forth[1][0], back[1][-1], rtol=1e-4)


@pytest.mark.parametrize("wavenumber", [0.0, 400.0])
def test_matrices_are_those_of_triangles_taken_one_by_one(
    case: _Case, wavenumber: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Made at once, or few at a time where there are too many of them; either way the ring answers alike."""
    face, some = Face.wave(wavenumber), np.array([0, 7, 8, 100])
    alone = np.concatenate([case.over.elements(face, np.array([one])) for one in some])
    np.testing.assert_allclose(case.over.elements(face, some), alone, rtol=1e-13)
    at_once = prism(case.over, face).condensed.stiffness
    monkeypatch.setattr("fem.elasticity.prism.TOGETHER", 0)
    few = prism(case.over, face).condensed.stiffness
    np.testing.assert_allclose(few, at_once, rtol=0.0, atol=1e-12 * np.abs(at_once).max())


def test_waves_share_the_groups_of_their_mesh_and_nothing_else(case: _Case) -> None:
    """Whatever was condensed on it before, a wave is that of a mesh by itself; what is shared refuses writing."""
    waves = [prism(case.over, Face.wave(k)).condensed for k in (400.0, 50.0, 400.0)]
    np.testing.assert_array_equal(waves[0].stiffness, waves[2].stiffness)
    assert not np.allclose(waves[0].stiffness, waves[1].stiffness, rtol=1e-3)
    other = section(replace(case.mesh), LAW)
    np.testing.assert_array_equal(prism(other, Face.wave(50.0)).condensed.stiffness, waves[1].stiffness)
    for front in waves[0].fronts:
        assert not front.done.flags.writeable
        assert not front.shared.flags.writeable


def test_short_waves_grow_as_the_half_space_does(case: _Case) -> None:
    """Far below the tooth's thickness, and above the elements' length, u falls as 2 ln k/(pi E*)."""
    mesh = refined(case.mesh)
    over, at = section(mesh, LAW), flank_points(mesh, case.at.rho[:2])
    own = [_answer(over, k, at, 0)[0] for k in (1500.0, 3000.0)]
    fall = (own[0] - own[1]) * np.pi * LAW.plane_modulus / (2 * np.log(2.0))
    assert np.allclose(fall, 1.0, atol=0.02)


def test_neighbours_do_not_feel_short_waves(case: _Case) -> None:
    plane, short = (_answer(case.over, k, case.at, 1)[1] for k in (0.0, 3000.0))
    assert np.abs(short).max() < 1e-3 * np.abs(plane).max()
