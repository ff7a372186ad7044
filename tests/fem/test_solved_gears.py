"""Gears kept in modules and E*: the same to the last bit as solved anew, whatever the pair that asked first."""

from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields, replace

import numpy as np
import pytest

import fem
from fem.elasticity.flank_samples import sample_places, sampled
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.elasticity.ring import mesh_and_factor, ring_of
from fem.elasticity.support import FIXED, Support, held_profiles
from fem.influence.fillet_influence import fillet_influence
from fem.influence.gear_compliance import gear_compliance
from fem.influence.gear_shape import FINE, MeshedShape, shapes
from fem.influence.gear_store import MOST_RECORDS, GearStore
from fem.influence.memo import Memo
from fem.influence.tip_strips import tip_strips
from gears import BasicRack, Blank, Gear, GearPair, Lead, Material, TipRelief
from meshes import Sizes, mesh_sector

COARSE = Sizes().scaled(1.5)
STEEL, PLASTIC = Material(206e9, 0.3, 7850.0), Material(2.5e9, 0.4, 1140.0)
PINION = Gear(24, 0.1, bore_radius=0.008, thickness_allowance=2e-5, tip_chamfer=1e-4)
PAIR = GearPair(PINION, Gear(31), 2e-3, 0.04, material=STEEL)


def of_size(factor, pair=PAIR, **others):
    """The same shapes, all lengths times a factor."""

    def grown(gear):
        bore = None if gear.bore_radius is None else gear.bore_radius * factor
        return replace(
            gear,
            bore_radius=bore,
            thickness_allowance=gear.thickness_allowance * factor,
            tip_chamfer=gear.tip_chamfer * factor,
        )

    return replace(
        pair,
        pinion=grown(pair.pinion),
        wheel=grown(pair.wheel),
        module=pair.module * factor,
        face_width=pair.face_width * factor,
        **others,
    )


def solved(pair, **options):
    return fem.compliance(pair, 0.01, sizes=COARSE, refinements=1, **options)


def numbers(bodies):
    """All that a compliance is made of."""
    for gear, tip in zip((bodies.pinion, bodies.wheel), bodies.tips, strict=True):
        yield np.array([gear.logarithm, gear.hub_windup, gear.fit_error])
        for series in (gear.own_series, *gear.cross_series.values(), *gear.corner_series.values()):
            yield series.coefficients
        yield from (tip.distance, tip.kernel, tip.mixed, tip.tangential)


def same(first, second):
    for one, other in zip(numbers(first), numbers(second), strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_kept_gear_is_that_solved_anew_to_the_last_bit(no_gear_solved):
    anew = solved(PAIR, tip_edges=True)
    fem.forget_gears()
    # the gears come from a pair of other size, modulus and mate
    solved(of_size(3.7, replace(PAIR, wheel=Gear(53)), material=replace(STEEL, youngs_modulus=70e9)))
    solved(replace(PAIR, pinion=Gear(17), face_width=0.01))
    again = solved(PAIR)
    assert "solve" not in again.cost.parts
    same(anew, again)


def test_size_modulus_and_face_width_scale_exactly():
    rho1 = np.linspace(PAIR.points.A, PAIR.points.E, 9)
    places = np.stack([rho1[:4], rho1[:4] + PAIR.base_pitch], axis=1)
    bodies = solved(PAIR)
    for factor, modulus in ((1.0, 2.5e9), (0.31, 206e9), (1e3 / 7, 71.3e9)):
        other = solved(of_size(factor, material=replace(STEEL, youngs_modulus=modulus)))
        stiffer = factor * modulus / 206e9
        np.testing.assert_allclose(other.own(factor * rho1) * stiffer, bodies.own(rho1), rtol=1e-12)
        np.testing.assert_allclose(other.bulk(factor * places) * stiffer, bodies.bulk(places), rtol=1e-12)
        assert other.error == pytest.approx(bodies.error, rel=1e-9)
    wide = solved(replace(PAIR, face_width=0.1))
    np.testing.assert_allclose(wide.own(rho1) * 2.5, bodies.own(rho1), rtol=1e-14)


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize("hub", [None, 0.012])
def test_a_gear_in_modules_has_the_flexibility_of_the_gear_itself(plane, hub):
    """Meshed, factorised and loaded in metres and pascals; the triangles differ by rounding."""
    pair = replace(PAIR, material=(STEEL, PLASTIC))
    supports = Support(hub_radius=hub), Support()
    bodies = solved(pair, plane=plane, supports=supports)
    profiles = held_profiles(pair, supports)
    rings = mesh_and_factor(pair, plane, COARSE, 1, profiles)
    both = zip(rings, profiles, (bodies.pinion, bodies.wheel), bodies.tips, bodies.rings(), strict=True)
    for ring, profile, gear, tips, kept in both:
        places = sample_places(profile, len(gear.own_series.coefficients))
        direct = gear_compliance(ring, profile, sampled(ring, places))
        rho = np.linspace(*direct.rho_range, 7)
        np.testing.assert_allclose(gear.own(rho), direct.own(rho), rtol=1e-9)
        np.testing.assert_allclose(gear.cross(1, rho, rho), direct.cross(1, rho, rho), rtol=1e-8)
        assert (gear.hub_windup, gear.logarithm) == pytest.approx((direct.hub_windup, direct.logarithm), 1e-9)
        there = tip_strips(ring, profile)
        np.testing.assert_allclose(tips.rho, there.rho, rtol=1e-9)
        np.testing.assert_allclose(tips.kernel, there.kernel, rtol=1e-6)
        np.testing.assert_allclose(kept.mesh.points, ring.mesh.points, rtol=0, atol=1e-7 * pair.module)
        np.testing.assert_allclose(kept.schur, ring.schur, rtol=0, atol=1e-6 * np.abs(ring.schur).max())
        flank = kept.mesh.facets["flank_left"]
        arc = kept.mesh.parameters["flank_left"]
        at = kept.mesh.curves["flank_left"].at(arc[:, 0])
        np.testing.assert_allclose(at, kept.mesh.points[flank[:, 0]], rtol=0, atol=1e-12)


OTHER = {
    "teeth": 25,
    "profile_shift": 0.11,
    "generating_shift": 0.05,
    "bore_radius": 0.0081,
    "tip_alteration": -0.01,
    "thickness_allowance": 3e-5,
    "tip_chamfer": 1.1e-4,
    "blank": Blank(4e-3, 5e-3),
}
LIKE = {
    "tip_relief": TipRelief(2e-5, 1e-3),
    "lead": Lead(crowning=1e-5),
    "face_width": 0.5,
    "face_offset": 0.0,
}
"""What no flexibility depends on."""


def key(pair, plane="strain", support=FIXED):
    return shapes(pair, held_profiles(pair, (support, FIXED)), plane)[0]


def test_the_key_holds_every_field_of_a_gear():
    assert {field.name for field in fields(Gear)} == {*OTHER, *LIKE}
    for name, value in OTHER.items():
        changed = replace(PAIR, pinion=replace(PINION, **{name: value}))
        assert key(changed) != key(PAIR), name
        assert key(changed).profile != key(PAIR).profile, name
    for name, value in {"rim_thickness": 4.1e-3, "web_thickness": 5.1e-3, "hub_radius": 0.009}.items():
        blank = replace(OTHER["blank"], **{name: value})
        pairs = (replace(PAIR, pinion=replace(PINION, blank=one)) for one in (blank, OTHER["blank"]))
        assert len({key(one) for one in pairs}) == 2, name
    for name, value in LIKE.items():
        assert key(replace(PAIR, pinion=replace(PINION, **{name: value}))) == key(PAIR)


def test_the_key_holds_rack_poisson_ratio_plane_and_hub_and_nothing_of_the_pair():
    for name, value in {"h_aP": 0.95, "h_fP": 1.3, "rho_fP": 0.3, "alpha": 0.36}.items():
        assert key(replace(PAIR, rack=replace(BasicRack(), **{name: value}))) != key(PAIR), name
    assert {field.name for field in fields(BasicRack)} == {"h_aP", "h_fP", "rho_fP", "alpha"}
    assert key(replace(PAIR, material=replace(STEEL, poisson_ratio=0.31))) != key(PAIR)
    assert key(PAIR, "stress") != key(PAIR)
    assert key(PAIR, support=Support(hub_radius=0.009)) != key(PAIR)
    for alike in (
        replace(PAIR, material=replace(STEEL, youngs_modulus=1e9, density=1.0)),
        replace(PAIR, face_width=1e-3, wheel=Gear(77), centre_distance=None),
        of_size(1 / 3),
        of_size(0.7),
    ):
        assert key(alike) == key(PAIR)
    assert key(PAIR, support=Support(radial_stiffness=1e8, torsional_stiffness=1e5)) == key(PAIR)
    # sizes and refinements of the mesh, and the number of loads, are in the record's key
    one = MeshedShape(key(PAIR), COARSE, 1)
    assert len({one, replace(one, refinements=2), replace(one, sizes=Sizes())}) == 3


class Shelf:
    """Keeps records as files do, and counts."""

    def __init__(self):
        self.held, self.computed = {}, []

    def __call__(self, name, inputs, compute):
        place = name, repr(sorted(inputs.items()))
        if place not in self.held:
            self.computed.append(name)
            self.held[place] = pickle.dumps(compute())
        return pickle.loads(self.held[place])


def test_a_study_solves_each_gear_once_and_tips_where_edges_are_free(no_gear_solved):
    shelf = Shelf()
    for pinion in (Gear(18), Gear(21)):
        for wheel in (Gear(21), Gear(40)):
            pair = GearPair(pinion, wheel, 2e-3, 0.04)
            bodies = solved(pair, kept=shelf)
            fem.mesh_cycle(pair, 100.0, 8, bodies, beyond_path=False)
    assert shelf.computed == ["gear flanks"] * 3
    assert bodies.tip_strips is None
    solved(pair, tip_edges=True, kept=shelf)
    # and those of the mesh before, from which errors come
    assert shelf.computed == ["gear flanks"] * 3 + ["gear tips"] * 2 + ["gear coarse tips"] * 2


def test_records_from_a_shelf_are_those_of_the_process(no_gear_solved):
    shelf = Shelf()
    here = solved(PAIR, tip_edges=True, kept=shelf)
    fem.forget_gears()
    there = solved(PAIR, tip_edges=True, kept=shelf)
    assert len(shelf.computed) == 6
    same(here, there)
    same(pickle.loads(pickle.dumps(there)), here)


def test_kept_records_refuse_writing():
    gears, meshed = GearStore(), MeshedShape(key(PAIR), COARSE, 1)
    flanks, tips = gears.flanks(meshed, 20), gears.tips(meshed, FINE)
    own, cross = flanks.fine.own_series, flanks.fine.cross_series[1]
    for array in (flanks.rho, own.coefficients, cross.coefficients, tips.kernel):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0.0
    assert gears.flanks(meshed, 20) is flanks


def test_the_memory_is_bounded_and_forgets_the_oldest():
    memo = Memo[int](3)
    for number in (1, 2, 3, 1, 4):
        memo.obtain(number, lambda number=number: number)
    assert len(memo) == 3
    assert memo.obtain(1, lambda: -1) == 1
    assert memo.obtain(2, lambda: -2) == -2
    assert MOST_RECORDS < 10_000


def test_threads_get_one_record():
    memo = Memo[object](8)
    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(lambda n: (n % 4, memo.obtain(n % 4, object)), range(400)))
    assert len({id(value) for _, value in found}) == 4
    assert len(memo) == 4


def test_cost_is_of_what_was_solved_now(no_gear_solved):
    first, again = solved(PAIR, tip_edges=True), solved(PAIR)
    assert {"mesh", "assemble", "factor", "condense", "solve", "tips"} == set(first.cost.parts)
    assert again.cost.parts == {}
    assert again.cost.seconds < 0.2 * first.cost.seconds
    assert again.cost.unknowns == first.cost.unknowns


def test_fillets_are_kept_by_gear_and_have_the_stress_of_the_gear_itself(no_gear_solved):
    shelf = Shelf()
    options = {"fillet_edge": 0.32, "kept": shelf}
    roots = fem.fillets(PAIR, **options)
    assert shelf.computed == ["gear fillets"] * 2
    mate = Gear(31, bore_radius=0.012)  # another gear of the same reach
    other = fem.fillets(of_size(5.0, replace(PAIR, wheel=mate), material=PLASTIC), **options)
    assert shelf.computed == ["gear fillets"] * 4  # PLASTIC has another Poisson's ratio
    other = fem.fillets(of_size(5.0, replace(PAIR, wheel=mate)), **options)
    assert shelf.computed == ["gear fillets"] * 5
    rho = np.linspace(*roots.pinion.rho_range, 5)
    for tooth in (-1, 0, 2):
        stress = roots.pinion.stress(tooth, rho)
        np.testing.assert_allclose(
            5 * other.pinion.stress(tooth, 5 * rho), stress, rtol=0, atol=1e-12 * np.abs(stress).max()
        )
    profile = PAIR.teeth_profiles[0]
    mesh = mesh_sector(profile, Sizes(fillet=0.32, root=0.32, flank=0.25, corner=0.1), 1)
    direct = fillet_influence(
        ring_of(mesh, PlaneElasticity.of(STEEL, "strain")), profile, 2, roots.pinion.rho_range[0]
    )
    for tooth in (0, 1):
        stress = direct.stress(tooth, rho)
        np.testing.assert_allclose(
            roots.pinion.stress(tooth, rho), stress, rtol=0, atol=1e-6 * np.abs(stress).max()
        )
