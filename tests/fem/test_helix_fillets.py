"""Stress along the fillets of helical gears: strains of a helicoid, waves, free ends, and lines of contact."""

from __future__ import annotations

import numpy as np
import pytest

from fem.elasticity.fillet import fillet_line
from fem.elasticity.free_ends import pieces_between
from fem.elasticity.helix_fillet import ACROSS, ALONG, SHEAR, helix_fillets, principal
from fem.elasticity.lengthened import FacePieces
from fem.elasticity.line_load import flank_points
from fem.elasticity.prism import prism
from fem.elasticity.ring import ring_of
from fem.elasticity.section import section
from fem.influence.fillet_influence import fillet_influence
from fem.influence.fillet_waves import fillet_waves
from fem.influence.gear_face import solid_of
from fem.influence.gear_shape import MeshedShape, shapes
from fem.influence.helix_fillet_ends import SECTION, helix_fillet_ends
from fem.influence.helix_fillet_waves import CellLoad, away_from, helix_fillet_waves
from gears import Gear, GearPair
from meshes import Sizes, mesh_sector, refined

GEAR = Gear(teeth=18, profile_shift=0.2, bore_radius=8e-3)
PAIR = GearPair(GEAR, GEAR, module=2e-3, face_width=12e-3, helix_angle=0.35)
SHAPE = shapes(PAIR, PAIR.teeth_profiles, "strain")[0]
PROFILE, LAW = SHAPE.profile, solid_of(SHAPE.poisson)
TWIST = PAIR.helix.base_tangent / PROFILE.base_radius
COARSE = Sizes(fillet=0.3, root=0.4, flank=0.3, corner=0.3)
RHO = np.linspace(*PROFILE.flank_rho, 7)[2:-1]


@pytest.fixture(scope="module")
def mesh():
    return mesh_sector(PROFILE, COARSE)


@pytest.fixture(scope="module")
def waves(mesh):
    return helix_fillet_waves(mesh, PROFILE, TWIST, SHAPE.poisson, 1, PROFILE.flank_rho[0])


@pytest.mark.parametrize("side", [0, 1])
def test_stress_of_any_field_is_that_of_its_strain_tensor(mesh, side):
    """Of quadratic fields in the section, by all nine derivatives, projected on the helicoid."""
    rng = np.random.default_rng(5)
    line = fillet_line(PROFILE)
    points, tangents, normals = line.side(side == 0)
    size = PROFILE.root_radius
    value, slope = rng.normal(size=(2, 3, 6))

    def field(of, x, y):
        x, y = x / size, y / size
        return of @ np.stack([np.ones_like(x), x, y, x * x, x * y, y * y])

    def gradient(of, x, y):
        x, y, none, one = x / size, y / size, 0.0 * x, 1.0 + 0.0 * x
        by_x = of @ np.stack([none, one, none, 2 * x, y, none]) / size
        by_y = of @ np.stack([none, none, one, none, x, 2 * y]) / size
        return by_x, by_y

    def recovered(on):
        at = on.points.T
        fillet = helix_fillets(on, PROFILE, line, LAW, TWIST)[side]
        return fillet.stress(field(value, *at).T[..., None], field(slope, *at).T[..., None])[..., 0]

    x, y = points.T
    by_x, by_y = gradient(value, x, y)
    moved = field(value, x, y)
    turned = np.stack([-moved[1], moved[0], 0.0 * x])
    by_z = field(slope, x, y) - TWIST * (x * by_y - y * by_x - turned)
    tensor = np.stack([by_x, by_y, by_z])  # [direction, component, place]
    strain = 0.5 * (tensor + tensor.swapaxes(0, 1))
    normal = np.stack([*normals.T, -TWIST * np.sum(normals * np.stack([-y, x], axis=1), axis=1)])
    normal /= np.linalg.norm(normal, axis=0)
    t = np.stack([*tangents.T, 0.0 * x])
    b = np.cross(normal, t, axis=0)
    b *= np.sign(b[2])

    def strained(p, q):
        return np.einsum("as,abs,bs->s", p, strain, q)

    e, nu = LAW.plane_modulus, LAW.nu
    expected = np.stack(
        [
            e * (strained(t, t) + nu * strained(b, b)),
            e * (strained(b, b) + nu * strained(t, t)),
            2.0 * LAW.shear_modulus * strained(t, b),
        ]
    )
    coarse, fine = (recovered(on) - expected for on in (mesh, refined(mesh)))
    print(np.abs(coarse).max(), np.linalg.norm(coarse), np.linalg.norm(fine))
    # second order or better: edges are curved, and their strains are joined by cubics
    assert np.linalg.norm(fine) < 0.35 * np.linalg.norm(coarse)
    assert np.abs(coarse).max() < 0.01 * np.abs(expected).max()


def test_a_turn_about_the_axis_has_no_stress(mesh):
    fillet = helix_fillets(mesh, PROFILE, fillet_line(PROFILE), LAW, TWIST)[0]
    x, y = mesh.points.T
    turn = np.stack([-y, x, 0.0 * x], axis=1)[..., None]
    still = fillet.stress(turn, 0.0 * turn)
    shift = fillet.stress(np.zeros_like(turn) + np.array([[0.0], [0.0], [1.0]]), 0.0 * turn)
    # by degrees of twist the helix is as long as the turn is wide
    assert np.max(np.abs(still)) < 3e-3 * TWIST * PROFILE.root_radius * PROFILE.root_radius
    assert np.max(np.abs(shift)) < 1e-12


def test_nearly_without_a_twist_waves_are_those_of_the_spur_gear(mesh):
    helical = helix_fillet_waves(mesh, PROFILE, 1e-6, SHAPE.poisson, 1, PROFILE.flank_rho[0])
    even = fillet_influence(ring_of(mesh, SHAPE.law), PROFILE, 1, PROFILE.flank_rho[0])
    spur = fillet_waves(mesh, even)
    apart = away_from(PROFILE, even.line, RHO) >= 0.8
    for tooth, within in ((-1, 2e-3), (1, 2e-3), (0, 0.03)):
        p, q = np.moveaxis(helical.beyond(tooth, RHO), 1, 0)
        beyond, plane = spur.beyond(tooth, RHO), even.stress(tooth, RHO)[:, None]
        along, across = plane + beyond[:, :, 0], beyond[:, :, 1]
        expected = along + LAW.nu * across, across + LAW.nu * along, beyond[:, :, 2]
        for found, value in zip((p[:, :, ALONG], p[:, :, ACROSS], q[:, :, SHEAR]), expected, strict=True):
            off = np.where(apart[:, None, None], np.abs(found - value), 0.0)[
                :, 3:
            ]  # waves that the root feels
            assert off.max() < within * np.abs(along).max()
        assert np.abs(q[:, :, ALONG]).max() < 1e-4 * np.abs(along).max()


def test_the_other_hand_is_the_axis_counted_the_other_way(mesh, waves):
    other = helix_fillet_waves(mesh, PROFILE, -TWIST, SHAPE.poisson, 1, PROFILE.flank_rho[0])
    for tooth in (-1, 0, 1):
        expected = other.beyond(tooth, RHO)
        np.testing.assert_allclose(
            waves.mirrored.beyond(tooth, RHO), expected, atol=1e-7 * np.abs(expected).max(), rtol=0
        )
    assert waves.mirrored.twist == -TWIST


def test_a_force_is_felt_as_much_over_the_whole_face_as_an_even_load(waves):
    """The sum along the axis is the answer without a wave, whatever the twist."""
    z = np.linspace(-30.0, 30.0, 1201)
    for tooth in (-1, 0, 1):
        load = CellLoad(RHO[1:2], np.array([0.3]), 0.8, np.ones(1))
        stress = waves.on(tooth, waves.felt(load, z))
        whole = np.trapezoid(stress, z, axis=0)
        even = waves.beyond(tooth, RHO[1:2])[0, 0, -1]
        assert np.max(np.abs(whole - even)) < 5e-3 * np.max(np.abs(even))


def test_cells_together_are_the_cell_that_they_make(waves):
    z = np.linspace(-4.0, 4.0, 9)
    one = waves.on(0, waves.felt(CellLoad(RHO[:1], np.zeros(1), 1.0, np.ones(1)), z))
    half = CellLoad(np.repeat(RHO[:1], 2), np.array([-0.25, 0.25]), 0.5, np.full(2, 0.5))
    np.testing.assert_allclose(waves.on(0, waves.felt(half, z)), one, atol=1e-4 * np.abs(one).max(), rtol=0)


def test_principal_stress_is_by_the_tensor_s_eigenvalues():
    tensor = np.array([[3.0, -1.5], [-1.5, -2.0]])
    one, other = principal(np.array(3.0), np.array(-2.0), np.array(-1.5))
    assert [float(other), float(one)] == pytest.approx(np.linalg.eigvalsh(tensor), rel=1e-14)


@pytest.mark.slow
@pytest.mark.long
def test_waves_and_ends_are_a_solid_with_free_ends():
    """Forces on cells of a face of 6 modules, of a solid of many pieces: peaks within 3 % where they count."""
    width, coarse = 6.0, mesh_sector(PROFILE, SECTION)
    fillets = helix_fillets(coarse, PROFILE, fillet_line(PROFILE), LAW, TWIST)
    pieces = FacePieces(np.array([-3.0, -2.7, -2.0, -1.0, 0.0, 1.0, 2.0, 2.7, 3.0]))
    at, along = flank_points(coarse, RHO), pieces_between(pieces.ends)
    solid = prism(section(coarse, LAW, TWIST), pieces.face())
    moved = solid.displacements(at, [0, 1])
    endless = helix_fillet_waves(coarse, PROFILE, TWIST, SHAPE.poisson, 1, PROFILE.flank_rho[0])
    ends = helix_fillet_ends(MeshedShape(SHAPE, Sizes(), 0), TWIST, width)
    count, places = pieces.functions, np.array([-3.0, -2.5, -1.0, 0.0, 1.5, 3.0])
    far = 50  # samples lower down than any load
    off, without = [], []
    for tooth, middle, load in (
        (0, -2.5, 0),
        (0, -1.0, 2),
        (0, 0.5, 1),
        (0, 2.5, 2),
        (1, -2.5, 1),
        (1, 0.5, 1),
    ):
        weights = pieces.means(np.array([middle]), 1.0)[0]
        nodes = moved[tooth].reshape(-1, 3 * count, len(RHO), count)[:, :, load] @ weights
        functions = np.concatenate(
            [nodes[:, : 2 * count].reshape(-1, count, 2), nodes[:, 2 * count :, None]], axis=2
        )
        still, sloped = (
            np.einsum("nfc,fz->ncz", functions, of) for of in (along.values(places), along.slopes(places))
        )
        direct = np.stack([fillet.stress(still, sloped) for fillet in fillets], axis=1)  # (3, 2, samples, z)
        cell = CellLoad(RHO[load : load + 1], np.array([middle]), 1.0, np.ones(1))
        by_waves = endless.on(tooth, endless.felt(cell, places))
        whole = by_waves + ends.on(tooth, ends.felt(cell), places, direct.shape[2])
        true, mine, alone = (
            principal(*of)[0][..., :far].max(axis=(1, 2))
            for of in (np.moveaxis(direct, 3, 1), np.moveaxis(whole, 1, 0), np.moveaxis(by_waves, 1, 0))
        )
        counts = true > 0.25 * true.max()
        off.append(np.abs(mine / true - 1.0)[counts].max())
        without.append(np.abs(alone / true - 1.0)[counts].max())
    print("with ends", np.round(off, 3), "without", np.round(without, 2))
    assert max(off) < 0.03
    assert max(without) > 0.3
