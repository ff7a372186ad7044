"""Root stress over the face: even loads are the plane's, mirrors, resultants, waves, free ends, widths."""

from __future__ import annotations

import importlib
from dataclasses import replace

import numpy as np
import pytest
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

import fem
from fem.elasticity.fillet_strain import fillet_strains, von_mises
from fem.elasticity.line_load import flank_points
from fem.elasticity.plane_elasticity import PlaneElasticity, physical_gradients
from fem.elasticity.prism import prism
from fem.elasticity.section import Face, section
from fem.influence.fillet_waves import _stress, solid_of
from fem.influence.gear_face import between_waves, solved_waves
from fem.influence.gear_store import GearStore
from fem.pair.pair_fillets import fillets
from fem.stress.face_fillets import EVEN, face_fillets, root_influences
from fem.stress.root_peaks import LOADED, OTHER
from fem.stress.tooth_root import root_stress
from fem.stress.tooth_stress import CellLoads, ToothStress
from gears import Alignment, Gear, GearPair, Lead
from meshes.triangle import shape

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
TORQUE, CELLS = 100.0, 8


@pytest.fixture(scope="module")
def bodies():
    return fem.compliance(PAIR, tolerance=0.05)


@pytest.fixture(scope="module")
def roots():
    return fillets(PAIR, tolerance=0.02)


@pytest.fixture(scope="module")
def walls(roots):
    return root_influences(roots, PAIR, "walls")


def _found(bodies, roots, pair=PAIR, cells=CELLS, face_model="walls", torque=TORQUE, **more):
    own = replace(bodies, pair=pair)
    cycle = fem.mesh_cycle(pair, torque, 6, own, cells=cells, face_model=face_model, **more)
    return root_stress(pair, cycle, replace(roots, pair=pair)), cycle


def test_even_loads_between_walls_are_the_plane_s(walls, roots):
    z = np.linspace(-0.5, 0.5, 7) * PAIR.face_width
    for gear, over, even in zip((0, 1), walls, (roots.pinion, roots.wheel), strict=True):
        start = (PAIR.points.A, PAIR.line_of_action - PAIR.points.E)[gear]
        rho = start + np.array([0.1, 0.5, 0.9]) * (PAIR.points.E - PAIR.points.A)
        for tooth in sorted(even.series):
            found = over.tangential(tooth, rho, np.full((3, CELLS), 1e5), z)
            plane = 1e5 * even.stress(tooth, rho)
            np.testing.assert_allclose(found, plane[:, None] + 0 * found, atol=1e-10 * np.abs(plane).max())


def test_a_single_cell_is_the_plane(walls, roots):
    """To the last bit by the wave without length, to rounding by all waves; nothing is cleared beside contacts."""
    z = np.array([-0.5, 0.1, 0.5]) * PAIR.face_width
    rho, load = np.array([PAIR.points.C, PAIR.points.D]), np.array([[1e5], [3e4]])
    even = root_influences(roots, PAIR, EVEN)
    for over, solved, plane in zip(even, walls, (roots.pinion, roots.wheel), strict=True):
        stress = np.repeat((load[:, :, None] * plane.stress(0, rho))[:, None], len(z), axis=1)
        np.testing.assert_array_equal(over.tangential(0, rho, load, z), stress)
        size = np.abs(stress).max()
        np.testing.assert_allclose(solved.tangential(0, rho, load, z), stress, atol=1e-13 * size)
        compared = over.von_mises([over.components(0, rho, load, z)])
        np.testing.assert_allclose(compared, 0.79**0.5 * np.abs(stress.sum(axis=0)), atol=1e-14 * size)
        assert over.disturbed == 0.0 < solved.disturbed


def test_cells_add_up_to_the_plane_and_each_load_keeps_its_mean(walls, roots):
    """The influence of a cell, summed over cells or averaged over the face, is that of an even load."""
    over, rho = walls[0], np.array([PAIR.points.C])
    z = (np.arange(400) + 0.5) / 400 * PAIR.face_width - 0.5 * PAIR.face_width
    each = np.array([over.tangential(0, rho, row[None], z)[0] for row in np.eye(CELLS)])
    plane = roots.pinion.stress(0, rho)[0]
    size = np.abs(plane).max()
    np.testing.assert_allclose(each.sum(axis=0), plane + 0 * z[:, None, None], atol=1e-10 * size)
    np.testing.assert_allclose(each.mean(axis=1), plane / CELLS + 0 * each[:, 0], atol=1e-9 * size)
    # mid-face is a plane of symmetry
    np.testing.assert_allclose(each[::-1, ::-1], each, atol=1e-11 * size)
    # the root feels a cell less, and over a longer part of the face, than the flank does
    tension = each[0, :, 0].max(axis=-1) / plane[0].max()
    assert 0.3 < tension[0] < 0.9
    assert tension[0] > tension[60] > tension[130] > 0.0


def test_waves_by_themselves_are_what_is_interpolated(walls):
    """A wave between those that are solved, at a place between those that are loaded, on the same mesh."""
    over, wave = walls[0], 0.4
    loaded = face_shapes()[0]
    influence = loaded.solved(GearStore()).influence
    mesh, law = loaded.mesh(), solid_of(influence.law.plane_poisson)
    section_, strains = section(mesh, law), fillet_strains(mesh, influence.profile, influence.line)
    low, high = influence.rho_range
    rho = low + np.array([0.35, 0.8]) * (high - low)
    at = flank_points(mesh, rho)
    even, found = (_stress(prism(section_, Face.wave(k)), at, [0, 1], strains, k, law) for k in (0.0, wave))
    weights = between_waves(np.array([wave]))[0]
    for i, tooth in enumerate((0, 1)):
        ours = np.einsum("w,lwcsn->lcsn", weights, over.waves.beyond(tooth, rho))
        # beside the flank, where loads are near, the series over their places are less exact
        off = np.abs(ours - (found[i] - even[i]))[..., :72]
        assert off.max() < 2e-3 * np.abs(even).max()
    assert np.abs(found[0, :, 1]).max() > 0.02 * np.abs(even).max()
    assert solved_waves()[1][-1] == 0.0


def face_shapes():
    return fillets(PAIR, tolerance=0.02).shapes


def test_strains_of_a_free_surface_give_hookes_stress():
    """Any displacement whose surface stress vanishes: stretched along the fillet's chord and along z."""
    loaded = face_shapes()[0]
    influence = loaded.solved(GearStore()).influence
    mesh = loaded.mesh()
    strains = fillet_strains(mesh, influence.profile, influence.line)
    high = np.abs(mesh.points).max()
    rng = np.random.default_rng(5)
    slope = rng.normal(size=(3, 2))
    u = (mesh.points @ slope[:2].T).ravel()
    w = mesh.points @ slope[2]
    for one, side in zip(strains, (True, False), strict=True):
        points, tangents, _ = influence.line.side(side)
        size = np.abs(slope).max()
        inside = slice(8, -8)
        np.testing.assert_allclose(
            (one.along @ u)[inside],
            np.einsum("pa,ab,pb->p", tangents, slope[:2], tangents)[inside],
            atol=2e-2 * size,
        )
        np.testing.assert_allclose(one.value @ w, points @ slope[2], atol=1e-3 * size * high)
        np.testing.assert_allclose((one.slope @ w)[inside], (tangents @ slope[2])[inside], atol=2e-2 * size)
        moved = np.einsum("pa,pa->p", points @ slope[:2].T, tangents)
        np.testing.assert_allclose(one.moved @ u, moved, atol=1e-3 * size * high)
    along, across, shear = 100.0, 30.0, 20.0
    tensor = np.array([[along, shear, 0.0], [shear, across, 0.0], [0.0, 0.0, 0.0]])
    away = tensor - np.trace(tensor) / 3 * np.eye(3)
    assert von_mises(*map(np.array, (along, across, shear))) == pytest.approx(np.sqrt(1.5 * np.sum(away**2)))


@pytest.mark.parametrize("wave", [0.15, 0.6])
def test_a_section_through_the_tooth_bears_what_a_wave_puts_on_it(wave):
    """Resultants: force of the tractions on a tooth cut free, and shear on its slices, are the load's at every wave.

    Div sigma = 0 over the part of the sector above a circle, weighted with cos kz: what the circle's elements pull at
    (their nodal forces) and k times the integral of tau_xz over the part are the load.
    """
    loaded = face_shapes()[0]
    influence = loaded.solved(GearStore()).influence
    mesh, law = loaded.mesh(), solid_of(influence.law.plane_poisson)
    over = section(mesh, law)
    at = flank_points(mesh, np.array([0.5 * sum(influence.rho_range)]))
    moved = prism(over, Face.wave(wave)).displacements(at, [0])[0, ..., 0]
    radius = np.linalg.norm(mesh.points, axis=1)
    form = np.linalg.norm(influence.line.points[40])
    above = np.flatnonzero(radius[mesh.triangles].min(axis=1) > form)
    elements = over.elements(Face.wave(wave), above).reshape(len(above), 6, 3, 6, 3)
    nodal = np.einsum("kiajb,kjb->kia", elements, moved[mesh.triangles[above]])
    pull = np.zeros_like(moved)
    np.add.at(pull, mesh.triangles[above], nodal)
    # nodes on the cut: those that other triangles have too
    cut = np.intersect1d(
        mesh.triangles[above], mesh.triangles[np.setdiff1d(np.arange(len(mesh.triangles)), above)]
    )
    # the energy of a rigid shift along x or y, weighted with cos kz, is of the shear along z alone
    gradient, area = physical_gradients(mesh.points, mesh.triangles[above], *_points())
    dw = np.einsum("kqia,ki->kqa", gradient, moved[mesh.triangles[above], 2])
    values = _shape()
    u = np.einsum("qi,kia->kqa", values, moved[mesh.triangles[above], :2])
    shear = law.shear_modulus * (dw - wave * u)
    through = -wave * np.einsum("kqa,kq,q->a", shear, area, _weights())
    load = at.direction[0]
    np.testing.assert_allclose(pull[cut, :2].sum(axis=0) + load, through, atol=1e-10)
    assert np.abs(pull[cut, :2].sum(axis=0) + load).max() > 1e-2  # shear between slices bears some of it


def _points():
    (xi, eta), _ = get_quadrature(RefTri, 4)
    return xi, eta


def _weights():
    return get_quadrature(RefTri, 4)[1]


def _shape():
    return shape(*_points())


@pytest.mark.slow
def test_the_greatest_is_the_plane_s_where_the_load_is_even(bodies, roots):
    plane = root_stress(PAIR, fem.mesh_cycle(PAIR, TORQUE, 6, bodies), roots)
    found, _ = _found(bodies, roots)
    for one, other in ((found.pinion, plane.pinion), (found.wheel, plane.wheel)):
        assert plane.pinion.face is None
        assert one.greatest_tension_Pa == pytest.approx(other.greatest_tension_Pa, rel=1e-9)
        assert one.greatest_compression_Pa == pytest.approx(other.greatest_compression_Pa, rel=1e-9)
        assert one.greatest_tension.von_mises_Pa == pytest.approx(
            other.greatest_tension.von_mises_Pa, rel=1e-9
        )
        np.testing.assert_allclose(
            one.tangential_Pa, other.tangential_Pa, atol=1e-9 * other.greatest_tension_Pa
        )
        assert one.face.face_factor == pytest.approx(1.0, abs=1e-9)
        assert np.isnan(other.greatest_tension.face_position)


def test_out_of_parallel_stresses_an_end_less_than_the_load_and_mirrors(bodies, roots):
    one, cycle = _found(bodies, roots, alignment=Alignment(15e-6))
    other, _ = _found(bodies, roots, alignment=Alignment(-15e-6))
    for here, there in ((one.pinion, other.pinion), (one.wheel, other.wheel)):
        np.testing.assert_allclose(here.face.cycle_tension, there.face.cycle_tension[::-1], rtol=1e-8)
        assert here.greatest_tension.face_position == pytest.approx(-there.greatest_tension.face_position)
        assert here.greatest_tension.face_position < -0.25 * PAIR.face_width
        assert 1.1 < here.face.face_factor < cycle.face.greatest_face_load_factor
        most = here.face.cycle_tension.max()
        assert here.greatest_tension_Pa == pytest.approx(most, rel=0.01)
        assert here.face.tangential.max() == pytest.approx(most, rel=0.01)
        assert here.face.tension.max() <= most * (1 + 1e-12)
        assert here.errors["greatest_tension_Pa"] > here.face.tension_error > 0.0


def test_what_a_contact_does_next_to_itself_is_no_root_stress(walls):
    """A load on one cell at A, close above the fillet: the root's greatest is that of bending, lower down."""
    over, count = walls[0], 64
    stress = ToothStress(over, np.array([0]), 0)
    low = np.array([PAIR.points.A])
    loads, z = CellLoads(1e5 * np.eye(count)[None, :1], low[None]), over.edges(count)[:1]
    everywhere = stress.at(loads, z)
    own = stress.teeth.tolist().index(0)
    raw, clear = everywhere[0, own, 0], stress.clear(everywhere, loads)[0, own, 0]
    away = np.linalg.norm(over.influence.line.points - over.influence.profile.involute(low), axis=-1)
    far = away >= 0.5 * PAIR.module
    assert not far[np.argmax(raw[LOADED])]
    np.testing.assert_array_equal(clear[OTHER], raw[OTHER])
    np.testing.assert_array_equal(clear[LOADED, far], raw[LOADED, far])
    assert clear[LOADED].max() == raw[LOADED, far].max() < 0.8 * raw[LOADED].max()
    assert stress.greatest(loads, z)[LOADED, 0, own, 0] == pytest.approx(clear[LOADED].max(), rel=0.02)
    # high on the flank the contact is far from all of the fillet
    high = CellLoads(loads.load, np.array([[PAIR.points.E]]))
    there = stress.at(high, z)
    np.testing.assert_array_equal(stress.clear(there, high), there)


@pytest.mark.slow
def test_crowning_moves_the_greatest_to_the_middle_and_more_cells_are_within_the_error(bodies, roots):
    pair = replace(PAIR, wheel=replace(PAIR.wheel, lead=Lead(crowning=15e-6)))
    (few, _), (more, _) = (_found(bodies, roots, pair, cells) for cells in (8, 24))
    assert abs(few.pinion.greatest_tension.face_position) < 1e-6
    apart = abs(few.pinion_tension_Pa / more.pinion_tension_Pa - 1.0)
    assert apart < few.pinion.face.tension_error < max(20 * apart, 0.02)


@pytest.mark.slow
def test_a_wide_gear_is_stressed_beyond_the_face_in_contact(bodies, roots):
    pair = replace(PAIR, wheel=replace(PAIR.wheel, face_width=26e-3, face_offset=1e-3))
    found, _ = _found(bodies, roots, pair)
    face = found.wheel.face
    assert face.face_position[[0, -1]] == pytest.approx([-12e-3, 14e-3])
    assert found.pinion.face.face_position[[0, -1]] == pytest.approx([-10e-3, 10e-3])
    beyond, within = face.cycle_tension[-1], face.cycle_tension[len(face.face_position) // 2]
    assert 0.0 < beyond < 0.6 * within


def test_free_ends_are_those_of_each_gear_and_its_own_face(roots, monkeypatch):
    module = importlib.import_module("fem.stress.face_fillets")
    monkeypatch.setattr(module, "_ends", lambda loaded, width, gears: (loaded.shape, width))
    pair = replace(PAIR, wheel=replace(PAIR.wheel, face_width=PAIR.face_width + 3e-3))
    ends = face_fillets(roots, pair).ends
    assert ends == tuple((one.shape, width) for one, width in zip(roots.shapes, (10.0, 11.5), strict=True))


@pytest.mark.slow
def test_free_ends_draw_less_at_the_very_end_and_little_inside(bodies, roots):
    """Nothing holds the end along the face: sigma_z vanishes there, and the stress along the fillet falls."""
    held, free = (root_influences(roots, PAIR, model)[0] for model in ("walls", "free-ends"))
    z, rho = np.array([0.0, 0.25, 0.45, 0.5]) * PAIR.face_width, np.array([PAIR.points.C])
    load = np.full((1, CELLS), 1e5)
    one, other = (some.components(0, rho, load, z) for some in (held, free))
    ratio = (free.tangential(0, rho, load, z)[0, :, 0].max(-1)) / held.tangential(0, rho, load, z)[
        0, :, 0
    ].max(-1)
    assert ratio[0] == pytest.approx(1.0, abs=0.03)
    assert 0.6 < ratio[3] < 0.8 < ratio[2] < 1.03
    sample = int(np.argmax(one[0][0, 0, 0]))
    across = [some[1] + free.nu * some[0] for some in (one, other)]
    assert across[0][0, 3, 0, sample] > 0.25 * one[0][0, 3, 0, sample]  # walls push
    assert abs(across[1][0, 3, 0, sample]) < 0.03 * one[0][0, 3, 0, sample]


def test_the_plane_law_is_the_solid_s():
    law = solid_of(PlaneElasticity("strain", 206e9, 0.3).plane_poisson)
    assert law.plane_modulus == pytest.approx(1.0)
    assert law.nu == pytest.approx(0.3)
