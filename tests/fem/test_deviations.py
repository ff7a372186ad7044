"""Deviations in the loaded contact: exact shifts, equivalences, many pitches, the unloaded error."""

from __future__ import annotations

import numpy as np
import pytest

import fem
from base import InputError
from gears import Gear, GearDeviations, GearPair, PitchDeviations, ProfileDeviation, TipRelief, WearDepth

COS = np.cos(np.radians(20.0))


def pitch(values):
    return GearDeviations(pitch=PitchDeviations(values))


@pytest.mark.parametrize(("gear", "sign"), [(0, 1.0), (1, -1.0)])
@pytest.mark.parametrize("beyond", [False, True])
def test_a_turn_of_one_gear_shifts_the_error_by_exactly_that(
    article_pair, article_bodies, gear, sign, beyond
):
    """All teeth of the pinion late by s: it turns on by s cos(alpha) first. The wheel's: as much less."""
    late = 7e-6
    both = [None, None]
    both[gear] = pitch(np.full((36, 40)[gear], late))
    plain = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, beyond_path=beyond)
    turned = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, beyond_path=beyond, deviations=both)
    shift = sign * late * COS
    np.testing.assert_allclose(turned.transmission_error - plain.transmission_error, shift, rtol=1e-9)
    np.testing.assert_allclose(turned.unloaded_transmission_error, shift, rtol=1e-12)
    for name in ("forces", "stiffness", "secant_stiffness", "load_share"):
        np.testing.assert_allclose(getattr(turned, name), getattr(plain, name), rtol=1e-8, atol=1e-6)


def test_equal_single_pitch_deviations_cancel(article_pair, article_bodies):
    both = [GearDeviations(pitch=PitchDeviations.from_single(np.full(n, 5e-6))) for n in (36, 40)]
    plain = fem.mesh_cycle(article_pair, 600.0, 10, article_bodies)
    same = fem.mesh_cycle(article_pair, 600.0, 10, article_bodies, deviations=both)
    np.testing.assert_allclose(same.transmission_error, plain.transmission_error, rtol=1e-12)


@pytest.mark.parametrize(("form", "points", "close"), [("linear", 1201, 2e-4), ("parabolic", 601, 1e-5)])
@pytest.mark.parametrize("beyond", [False, True])
def test_a_curve_that_equals_tip_relief_gives_its_numbers(form, points, close, beyond):
    relief = TipRelief(12e-6, 1.9e-3, form)
    eased = GearPair(Gear(36, tip_relief=relief), Gear(40, tip_relief=relief), 2e-3, 0.04)
    plain = GearPair(Gear(36), Gear(40), 2e-3, 0.04)
    curves = []
    for profile in eased.teeth_profiles:
        rho = np.linspace(*profile.flank_rho, points)
        curves.append(GearDeviations(ProfileDeviation(rho, -profile.relief(rho))))
    bodies = fem.compliance(plain)
    one = fem.mesh_cycle(plain, 400.0, 20, bodies, beyond, deviations=curves)
    two = fem.mesh_cycle(eased, 400.0, 20, fem.compliance(eased), beyond)
    # the linear form has a corner at its start, which the smooth curve rounds within one interval
    np.testing.assert_allclose(one.transmission_error, two.transmission_error, rtol=close)
    np.testing.assert_allclose(one.load_share, two.load_share, atol=5 * close)


def test_curves_come_on_top_of_relief():
    relief = TipRelief(10e-6, 2e-3, "parabolic")
    eased = GearPair(Gear(36, tip_relief=relief), Gear(40), 2e-3, 0.04)
    low, high = eased.teeth_profiles[0].flank_rho
    flat = GearDeviations(ProfileDeviation([low, high], [4e-6, 4e-6]))
    one = fem.unloaded_transmission_error(eased, 40, False)
    two = fem.unloaded_transmission_error(eased, 40, False, deviations=(flat, None))
    # turned back by so much, the sloped part is met that much farther down its flank
    np.testing.assert_allclose(two - one, -4e-6, rtol=1e-4)
    np.testing.assert_allclose(np.median(two - one), -4e-6, rtol=1e-12)


@pytest.fixture(scope="module")
def loose_pair(article_pair):
    """With backlash, so that no deviation makes flanks on both sides bear."""
    return article_pair.with_backlash(200e-6)


@pytest.fixture(scope="module")
def loose_bodies(loose_pair):
    return fem.compliance(loose_pair)


def test_a_tooth_that_is_early_carries_alone(loose_pair, loose_bodies):
    """One tooth of the pinion early by more than the deflection: its neighbours do not touch."""
    late = np.zeros(36)
    late[5] = -60e-6
    cycle = fem.mesh_cycle(
        loose_pair, 600.0, 20, loose_bodies, False, deviations=(pitch(late), None), pitches=9
    )
    assert cycle.position[0] == 0.025
    assert cycle.position[-1] == 8.975
    on = cycle.teeth[0] == 5
    touching = (cycle.forces > 0) & on
    rows = touching.any(axis=1)
    # from its coming into mesh at pitch 5 until it leaves one contact ratio later
    ratio = loose_pair.contact_ratio
    np.testing.assert_array_equal(rows, (cycle.position > 5) & (cycle.position < 5 + ratio))
    np.testing.assert_allclose(cycle.load_share[touching], 1.0, rtol=1e-12)
    np.testing.assert_allclose(cycle.unloaded_transmission_error[rows], -60e-6 * COS, rtol=1e-12)
    np.testing.assert_array_equal(cycle.unloaded_transmission_error[~rows], 0.0)


def test_many_pitches_are_the_pitches_one_by_one(article_pair, article_bodies):
    rng = np.random.default_rng(1)
    both = [pitch(rng.normal(0.0, 4e-6, n)) for n in (36, 40)]
    given = {"compliance": article_bodies, "deviations": both}
    many = fem.mesh_cycle(article_pair, 300.0, 8, pitches=50, first_teeth=(30, 3), **given)
    for k in (0, 7, 49):
        one = fem.mesh_cycle(article_pair, 300.0, 8, first_teeth=(30 + k, 3 + k), **given)
        rows = slice(8 * k, 8 * k + 8)
        np.testing.assert_allclose(many.transmission_error[rows], one.transmission_error, rtol=1e-9)
        np.testing.assert_allclose(many.forces[rows], one.forces, rtol=1e-7, atol=1e-6)
        np.testing.assert_array_equal(many.teeth[:, rows], one.teeth)
        np.testing.assert_allclose(many.position[rows] - k, one.position, atol=1e-12)


def test_all_repeats_after_the_common_period():
    pair = GearPair(Gear(24), Gear(36), 2e-3, 0.04)
    rng = np.random.default_rng(2)
    both = [pitch(rng.normal(0.0, 5e-6, n)) for n in (24, 36)]
    error = fem.unloaded_transmission_error(pair, 6, deviations=both, pitches=144).reshape(144, 6)
    np.testing.assert_array_equal(error[72:], error[:72])
    assert not np.allclose(error[24:48], error[:24])
    other = fem.unloaded_transmission_error(pair, 6, deviations=both, pitches=72, first_teeth=(24, 0))
    np.testing.assert_array_equal(other.reshape(72, 6), error[:72])


def test_without_load_perfect_involutes_have_no_error(article_pair):
    for beyond in (False, True):
        np.testing.assert_array_equal(fem.unloaded_transmission_error(article_pair, 40, beyond), 0.0)


def test_light_loads_approach_the_unloaded_error(loose_pair, loose_bodies):
    rng = np.random.default_rng(3)
    given = {
        "deviations": [pitch(rng.normal(0.0, 5e-6, n)) for n in (36, 40)],
        "pitches": 12,
        "tip_rounding": (20e-6, 50e-6),
    }
    bare = fem.unloaded_transmission_error(loose_pair, 20, **given)
    light = fem.mesh_cycle(loose_pair, 1e-6, 20, loose_bodies, **given)
    np.testing.assert_allclose(light.unloaded_transmission_error, bare, atol=1e-15)
    np.testing.assert_allclose(light.transmission_error, bare, atol=1e-12)
    assert np.all(light.transmission_error > bare)
    # the deflection itself is far below the rounding of the error, and still has digits
    heavier = fem.mesh_cycle(loose_pair, 1e-5, 20, loose_bodies, **given)
    # (a tip edge begins on a single strip, with a constant stiffness; the cubic through the first points of its law
    # bends the other way by 2e-5 of it at this load, in proportion to the force)
    assert np.all(heavier.secant_stiffness >= light.secant_stiffness * (1 - 3e-5))
    assert np.all(heavier.secant_stiffness < 1.3 * light.secant_stiffness)


def test_a_late_pair_hands_over_through_the_tip_edge(article_pair):
    """A pair that enters too late: the one before it goes on past E with the pinion's tip edge."""
    late = np.zeros(36)
    late[3] = 20e-6
    held, free, finer = (
        fem.unloaded_transmission_error(
            article_pair, positions, beyond, deviations=(pitch(late), None), pitches=6
        )
        for positions, beyond in ((200, False), (200, True), (400, True))
    )
    assert held.max() == pytest.approx(20e-6 * COS, rel=1e-12)
    assert np.abs(np.diff(held)).max() == pytest.approx(20e-6 * COS, rel=1e-12)  # a step
    # with tip edges there is none: the change between positions halves with their distance
    assert np.all(free <= held + 1e-18)
    steps = [np.abs(np.diff(error)).max() for error in (free, finer)]
    assert steps[0] < 0.1 * free.max()
    assert steps[0] / steps[1] == pytest.approx(2.0, rel=0.1)


def test_back_flanks_keep_the_backlash(article_pair, article_bodies):
    loose = article_pair.with_backlash(80e-6)
    cycle = fem.mesh_cycle(loose, 600.0, 10)
    np.testing.assert_allclose(cycle.back_gap, 80e-6, rtol=1e-9)
    assert "back flanks" not in cycle.message
    tight = fem.mesh_cycle(article_pair, 600.0, 10, article_bodies)
    np.testing.assert_allclose(tight.back_gap, 0.0, atol=1e-18)
    assert "back flanks stand clear" in tight.message
    late = np.zeros(36)
    late[7] = 100e-6
    jam = fem.mesh_cycle(loose, 600.0, 10, deviations=(pitch(late), None), pitches=12)
    assert jam.back_gap.min() == pytest.approx(80e-6 - 100e-6 * COS, rel=1e-9)
    assert "jam" in jam.message
    # the wheel's following tooth early closes the gap as well
    early = np.zeros(40)
    early[7] = -30e-6
    shut = fem.mesh_cycle(loose, 600.0, 10, beyond_path=False, deviations=(None, pitch(early)), pitches=12)
    assert shut.back_gap.min() == pytest.approx(80e-6 - 30e-6 * COS, rel=1e-9)


def curve_over(profile, seed):
    """A smooth random profile of some micrometres."""
    rho = np.linspace(*profile.flank_rho, 9)
    return ProfileDeviation(rho, np.random.default_rng(seed).normal(0.0, 3e-6, 9))


def test_equal_traces_of_all_teeth_are_one_profile(article_pair, article_bodies):
    curves = [curve_over(profile, seed) for seed, profile in enumerate(article_pair.teeth_profiles)]
    late = PitchDeviations(np.random.default_rng(5).normal(0.0, 4e-6, 36))
    one = (GearDeviations(curves[0], late), GearDeviations(curves[1]))
    each = (GearDeviations([curves[0]] * 36, late), GearDeviations([curves[1]] * 40))
    given = {"positions": 10, "compliance": article_bodies, "pitches": 40, "tip_rounding": 20e-6}
    single = fem.mesh_cycle(article_pair, 400.0, deviations=one, **given)
    traced = fem.mesh_cycle(article_pair, 400.0, deviations=each, **given)
    for name in ("transmission_error", "unloaded_transmission_error", "stiffness", "forces", "back_gap"):
        np.testing.assert_allclose(
            getattr(traced, name), getattr(single, name), rtol=1e-12, atol=1e-20, err_msg=name
        )


@pytest.mark.parametrize("gear", [0, 1])
def test_one_tooth_moves_only_where_it_meshes(article_pair, article_bodies, gear):
    count, flank = (36, 40)[gear], article_pair.teeth_profiles[gear].flank_rho
    base = ProfileDeviation(flank, [0.0, -3e-6])
    other = ProfileDeviation(np.linspace(*flank, 5), [0.0, -4e-6, -12e-6, -4e-6, -3e-6])
    curves = [base] * count
    curves[7] = other
    both, same = [None, None], [None, None]
    far = [base] * count
    far[25] = other  # does not mesh within these pitches
    both[gear], same[gear] = GearDeviations(curves), GearDeviations(far)
    given = {"positions": 20, "compliance": article_bodies, "beyond_path": False, "pitches": 12}
    moved = fem.mesh_cycle(article_pair, 600.0, deviations=both, **given)
    plain = fem.mesh_cycle(article_pair, 600.0, deviations=same, **given)
    meshes = (moved.position > 7) & (moved.position < 7 + article_pair.contact_ratio)
    change = moved.transmission_error - plain.transmission_error
    np.testing.assert_allclose(change[~meshes], 0.0, atol=1e-15)
    assert np.all(change[meshes] > 1e-8)
    # without load, where it meshes alone, by what it lacks at the point of contact
    alone = meshes & (np.sum(moved.flank_rho[0] > 0, axis=1) == 1)
    assert alone.any()
    rho = moved.flank_rho[gear][alone]
    rho = rho[np.isfinite(rho)]
    gap = moved.unloaded_transmission_error[alone]
    np.testing.assert_allclose(gap, -other.at(rho), rtol=1e-12)


def test_relabelled_teeth_shift_the_revolution(article_pair, article_bodies):
    shift, rng = 5, np.random.default_rng(8)
    sets = []
    for count, profile in zip((36, 40), article_pair.teeth_profiles, strict=True):
        curves = [curve_over(profile, seed) for seed in rng.integers(0, 10**6, count)]
        sets.append(
            (curves, rng.normal(0.0, 4e-6, count), [worn(profile, d) for d in rng.uniform(0, 5e-6, count)])
        )
    first = [GearDeviations(c, PitchDeviations(late), w) for c, late, w in sets]
    rolled = [
        GearDeviations(c[shift:] + c[:shift], PitchDeviations(np.roll(late, -shift)), w[shift:] + w[:shift])
        for c, late, w in sets
    ]
    given = {"positions": 6, "compliance": article_bodies, "tip_rounding": 20e-6}
    long = fem.mesh_cycle(article_pair, 300.0, deviations=first, pitches=30 + shift, **given)
    later = fem.mesh_cycle(article_pair, 300.0, deviations=rolled, pitches=30, **given)
    rows = slice(6 * shift, None)
    np.testing.assert_allclose(later.transmission_error, long.transmission_error[rows], rtol=1e-9)
    np.testing.assert_allclose(later.forces, long.forces[rows], rtol=1e-7, atol=1e-6)
    # and the whole repeats after the least common multiple of the teeth
    error = fem.unloaded_transmission_error(article_pair, 2, deviations=first, pitches=2 * 360)
    np.testing.assert_array_equal(error[: 2 * 360], error[2 * 360 :])


def worn(profile, depth, form="linear"):
    """Wear from nothing at the middle of the flank to a depth at both of its ends."""
    low, high = profile.flank_rho
    return WearDepth([low, 0.5 * (low + high), high], [depth, 0.0, depth], form)


def test_wear_as_deep_as_linear_relief_is_that_relief():
    relief = TipRelief(12e-6, 1.9e-3)
    eased = GearPair(Gear(36, tip_relief=relief), Gear(40, tip_relief=relief), 2e-3, 0.04)
    plain = GearPair(Gear(36), Gear(40), 2e-3, 0.04)
    wear = []
    for profile in eased.teeth_profiles:
        low, high = profile.flank_rho
        wear.append(GearDeviations(wear=WearDepth([low, high - 1.9e-3, high], [0.0, 0.0, 12e-6], "linear")))
    bodies = fem.compliance(plain)
    one = fem.mesh_cycle(plain, 400.0, 20, bodies, deviations=wear)
    two = fem.mesh_cycle(eased, 400.0, 20, fem.compliance(eased))
    # places of kinks are found within 1e-12 modules, and corners' laws through strips of .01 modules enlarge that
    for name in ("transmission_error", "stiffness", "load_share", "gaps"):
        np.testing.assert_allclose(
            getattr(one, name), getattr(two, name), rtol=1e-7, atol=1e-18, err_msg=name
        )
    assert one.transmission_error_range == pytest.approx(two.transmission_error_range, rel=1e-8)


def test_wear_takes_material_off_what_is_there(article_pair):
    """Flanks in excess by as much as they are worn are true involutes; of each tooth or of all alike."""
    profile = article_pair.teeth_profiles[0]
    wear = worn(profile, 8e-6, "smooth")
    thick = ProfileDeviation(wear.rho, wear.depth)
    for given in (wear, [wear] * 36):
        error = fem.unloaded_transmission_error(
            article_pair, 20, deviations=(GearDeviations(thick, wear=given), None)
        )
        np.testing.assert_allclose(error, 0.0, atol=1e-20)
    even = WearDepth(profile.flank_rho, [5e-6, 5e-6])
    error = fem.unloaded_transmission_error(article_pair, 20, False, (GearDeviations(wear=even), None))
    np.testing.assert_allclose(error, 5e-6, rtol=1e-12)  # the wheel lags


def test_all_faults_at_once(article_pair, article_bodies):
    with pytest.raises(InputError) as caught:
        fem.mesh_cycle(
            article_pair,
            float("nan"),
            2.5,
            article_bodies,
            deviations=(
                GearDeviations([ProfileDeviation([1.0, 2.0], [0.0, 0.0])] * 35, PitchDeviations([0.0] * 3)),
                GearDeviations(ProfileDeviation([1.0], [0.0]), wear=WearDepth([1.0, 2.0], [0.0, -1e-6])),
            ),
            pitches=0,
            first_teeth=(1, 0.5),
            tip_rounding=-1e-6,
            friction=0.9,
        )
    assert {fault.where for fault in caught.value.faults} == {
        "torque",
        "friction",
        "positions",
        "pitches",
        "first_teeth",
        "tip_rounding",
        "deviations[0].profile",
        "deviations[0].pitch",
        "deviations[1].profile",
        "deviations[1].wear.depth",
    }
    for bad in ((1e-6, 1e-6, 1e-6), float("nan"), "sharp", (None, 0.0), True):
        with pytest.raises(InputError, match="tip_rounding"):
            fem.unloaded_transmission_error(article_pair, tip_rounding=bad)
    with pytest.raises(InputError, match=r"tip_rounding\[0\].*at most"):
        fem.unloaded_transmission_error(article_pair, tip_rounding=(1e-3, 0.0))
    with pytest.raises(InputError, match="of pinion and wheel"):
        fem.unloaded_transmission_error(article_pair, deviations=(None,))
    with pytest.raises(InputError, match="torques"):
        fem.mesh_cycle(article_pair, [], compliance=article_bodies)
    with pytest.raises(InputError) as caught:
        fem.mesh_cycle(article_pair, [1.0, np.inf, np.nan], compliance=article_bodies)
    assert [fault.value for fault in caught.value.faults] == ["inf", "nan"]
