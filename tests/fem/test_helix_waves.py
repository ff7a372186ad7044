"""Waves of load on a helical gear: between samples, spur gears as their limit, symmetry, short waves."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from base import Array
from fem.elasticity.line_load import flank_points
from fem.elasticity.prism import prism
from fem.elasticity.section import Face, section
from fem.influence.gear_face import axial_harmonics, solid_of
from fem.influence.gear_shape import GearShape, MeshedShape
from fem.influence.helix_waves import HelixHarmonics
from gears import BasicRack, Gear
from meshes import Sizes, mesh_sector
from tests.even_helices import waves_of

TWIST = 0.025
"""[rad/module]: 19 degrees on the base circle."""


class _Case(NamedTuple):
    meshed: MeshedShape
    waves: HelixHarmonics


@pytest.fixture(scope="module")
def case() -> _Case:
    shape = GearShape(Gear(teeth=30, bore_radius=8.0), BasicRack(), 0.3 / 0.7)
    meshed = MeshedShape(shape, Sizes(), 1)
    return _Case(meshed, waves_of(meshed, TWIST))


def _solved(case: _Case, twist: float, rho: Array, wavenumber: float) -> Array:
    """S (teeth, loads, points) straight from the solid, complex."""
    mesh = mesh_sector(case.meshed.shape.profile, case.meshed.sizes, case.meshed.refinements)
    over, at = section(mesh, solid_of(case.meshed.shape.poisson), twist), flank_points(mesh, rho)
    moved, still = (
        prism(over, Face.wave(k, twisted=True)).across(at, at, [0, 1, -1]) for k in (wavenumber, 0.0)
    )
    return np.asarray(moved[:, :, 0, :, 0] - 1j * moved[:, :, 0, :, 1] - still[:, :, 0, :, 0])


@pytest.mark.parametrize("wavenumber", [0.07, 0.9, 4.0])
def test_between_the_solved_places_and_waves(case: _Case, wavenumber: float) -> None:
    low, high = case.meshed.shape.profile.flank_rho
    rho = low + np.array([0.13, 0.4, 0.55, 0.83]) * (high - low)
    exact = _solved(case, TWIST, rho, wavenumber)
    k = np.array([wavenumber])
    own = case.waves.own_at(rho[:, None], rho, k)[..., 0]
    ahead, behind = (case.waves.cross_at(tooth, rho[:, None], rho, k)[..., 0] for tooth in (1, -1))
    size = np.abs(case.waves.own_at(rho, rho, np.array([4.0]))).max()
    for series, solved in zip((own, ahead, behind), exact, strict=True):
        assert np.abs(series - solved).max() < (1.5e-3 if wavenumber > 1.0 else 2e-4) * size


def test_no_twist_is_the_spur_gear(case: _Case) -> None:
    spur, straight = axial_harmonics(case.meshed), waves_of(case.meshed, 0.0)
    low, high = case.meshed.shape.profile.flank_rho
    rho, k = low + np.linspace(0.1, 0.95, 9) * (high - low), np.array([0.05, 0.5, 3.0, 12.0])
    own = straight.own_at(rho, rho, k)
    assert np.abs(own.imag).max() < 1e-12
    assert np.abs(own.real - spur.own_at(rho, k)).max() < 5e-3 * np.abs(spur.own_at(rho, k)).max()
    cross = straight.cross_at(1, rho, rho[::-1], k)
    assert np.abs(cross - spur.cross_at(1, rho, rho[::-1], k)).max() < 1e-3


def test_answers_are_hermitian(case: _Case) -> None:
    low, high = case.meshed.shape.profile.flank_rho
    rho, k = low + np.linspace(0.05, 0.95, 7) * (high - low), np.array([0.3, 2.0])
    answer = case.waves.own_at(rho[:, None], rho, k)
    assert np.abs(answer - np.conj(np.swapaxes(answer, 0, 1))).max() < 1e-12
    assert np.abs(answer.imag).max() > 1e-3


def test_short_waves_are_those_of_a_half_space(case: _Case) -> None:
    """Near the load: what is left of its imaginary part, which says on which side of the load a point yields more."""
    low, high = case.meshed.shape.profile.flank_rho
    rho, k = low + np.array([0.4, 0.46]) * (high - low), np.array([6.0])
    exact = _solved(case, TWIST, rho, 6.0)[0, 0, 1]
    assert case.waves._half_space(rho[:1], rho[1:], k)[0, 0].imag == pytest.approx(exact.imag, rel=0.4)
