"""What a deflection is measured against: exact identities, limits, and what is refused."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest

import fem
from base import InputError
from fem.cycle.events import ContactProblem
from fem.elasticity.support import Support
from fem.pair.references import turns
from gears import Gear, GearPair, Material, share_load
from gears.closed_form import inertial_share

TORQUE = 600.0
CURVES = ("transmission_error", "stiffness", "secant_stiffness", "pair_stiffness")


@pytest.fixture(scope="module", params=[(False, 0.0), (False, 0.1), (True, 0.0), (True, 0.1)])
def cycle(request, article_pair, article_bodies):
    beyond_path, friction = request.param
    return fem.mesh_cycle(
        article_pair,
        TORQUE,
        compliance=article_bodies,
        beyond_path=beyond_path,
        friction=friction,
        reference="bore",
    )


@pytest.fixture(scope="module")
def on_path(article_pair, article_bodies):
    return fem.mesh_cycle(
        article_pair, TORQUE, compliance=article_bodies, beyond_path=False, reference="bore"
    )


@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_teeth_are_what_is_left_without_the_hubs_windup(article_pair, article_bodies, friction):
    """Taken out of the compliance matrix, or of the deflection that the whole matrix gives: the same."""
    options = {"beyond_path": False, "friction": friction}
    found = fem.mesh_cycle(article_pair, TORQUE, compliance=article_bodies, reference="teeth", **options)
    stiff = article_bodies.without("hub_windup")
    other = fem.mesh_cycle(article_pair, TORQUE, compliance=stiff, **options)
    assert found.reference == other.reference == "teeth"
    np.testing.assert_allclose(found.forces, other.forces, rtol=1e-12, atol=1e-9)
    for name in CURVES:
        np.testing.assert_allclose(getattr(found, name), getattr(other, name), rtol=1e-12, err_msg=name)
    if friction:
        plain = fem.mesh_cycle(article_pair, TORQUE, compliance=article_bodies, beyond_path=False)
        assert np.max(np.abs(found.stiffness / plain.against("teeth").stiffness - 1)) > 1e-3


def test_no_force_and_no_gap_depends_on_the_reference(cycle):
    for reference in ("body", "teeth"):
        other = cycle.against(reference)
        assert other.reference == reference
        for name in ("forces", "load_share", "gaps", "unloaded_transmission_error", "hertz_pressure"):
            np.testing.assert_array_equal(getattr(other, name), getattr(cycle, name))
        back = other.against("bore")
        for name in CURVES:
            np.testing.assert_allclose(getattr(back, name), getattr(cycle, name), rtol=1e-13, err_msg=name)
            assert not np.allclose(getattr(other, name), getattr(cycle, name), rtol=1e-2)


def test_the_tangent_is_the_slope_of_the_deflection(article_pair, article_bodies, cycle):
    """Central differences over the torque, with tip edges and friction too."""
    step = 1e-4
    options = {"compliance": article_bodies, "beyond_path": cycle.beyond_path, "friction": cycle.friction}
    low, high = (
        one.against("teeth")
        for one in fem.mesh_cycle(article_pair, [TORQUE * (1 - step), TORQUE * (1 + step)], **options)
    )
    slope = (high.force - low.force) / (high.transmission_error - low.transmission_error)
    found = cycle.against("teeth")
    np.testing.assert_allclose(slope, found.stiffness, rtol=1e-5)
    of_pairs = (high.forces - low.forces) / (high.transmission_error - low.transmission_error)[:, None]
    np.testing.assert_allclose(of_pairs, found.pair_stiffness, rtol=1e-4, atol=1e-5 * found.mean_stiffness)


def test_the_difference_is_the_turn_of_the_rings(on_path, article_pair, article_bodies):
    """The same at every position: wind-up for the teeth, less what inertia leaves of it for the bodies."""
    windup = article_bodies.hub_windup
    left = [
        inertial_share(b / r) for b, r in zip(article_pair.bore_radii, article_pair.root_radii, strict=True)
    ]
    expected = {"teeth": sum(windup), "body": sum(w * (1 - s) for w, s in zip(windup, left, strict=True))}
    assert left == pytest.approx([0.0933] * 2, abs=5e-5)
    for reference, turn in expected.items():
        other = on_path.against(reference)
        for name in ("stiffness", "secant_stiffness"):
            less = 1 / getattr(on_path, name) - 1 / getattr(other, name)
            np.testing.assert_allclose(less, turn, rtol=1e-9)
        np.testing.assert_allclose(
            on_path.transmission_error - other.transmission_error, turn * on_path.force, rtol=1e-9
        )
        # the turns are exact: D has the error that it had
        assert other.error / on_path.error == pytest.approx(np.max(other.stiffness / on_path.stiffness))


def test_a_heavy_shaft_makes_the_body_turn_as_the_bore_does(on_path):
    light, heavy = (on_path.against("body", (inertia, inertia)) for inertia in (0.0, 1e3))
    assert light.mean_stiffness > 1.1 * on_path.mean_stiffness
    assert heavy.mean_stiffness == pytest.approx(on_path.mean_stiffness, rel=1e-6)
    assert heavy.bore_inertia == (1e3, 1e3)
    assert heavy.against("teeth").bore_inertia == (0.0, 0.0)


def test_density_matters_beside_an_inertia_on_the_bore_alone(article_pair):
    lead = Material(206e9, 0.3, 11340.0)
    heavy = GearPair(article_pair.pinion, article_pair.wheel, 2e-3, 0.04, material=lead)
    held = (Support(), Support())
    np.testing.assert_array_equal(turns(heavy, held, "body"), turns(article_pair, held, "body"))
    assert np.all(turns(heavy, held, "body", (1e-3, 1e-3)) < turns(article_pair, held, "body", (1e-3, 1e-3)))


def test_a_rigid_hub_turns_with_the_bore_and_so_does_its_inertia(article_pair):
    """A hub in the bore of a gear is the same as a larger bore with that hub's inertia on it."""
    radius, held = 0.027, (Support(hub_radius=0.027), Support())
    bored = GearPair(Gear(36, bore_radius=radius), Gear(40, bore_radius=0.01875), 2e-3, 0.04)
    bore = article_pair.bore_radii[0]
    inertia = 0.5 * np.pi * 7850.0 * 0.04 * (radius**4 - bore**4)
    found = turns(article_pair, held, "body")
    expected = turns(bored, (Support(), Support()), "body", (inertia, 0.0))
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    assert found[0] > 1.5 * turns(bored, (Support(), Support()), "body")[0]


def test_a_shaft_that_twists_counts_at_the_bore_alone_and_one_that_bends_everywhere(article_pair, on_path):
    sprung = (Support(radial_stiffness=5e8, torsional_stiffness=2e5), Support(torsional_stiffness=3e5))
    bodies = fem.compliance(article_pair, supports=sprung)
    found = fem.mesh_cycle(article_pair, TORQUE, compliance=bodies, beyond_path=False)
    for reference in ("bore", "body", "teeth"):
        more = 1 / found.against(reference).stiffness - 1 / on_path.against(reference).stiffness
        turn = sum(r**2 / s.torsional_stiffness for r, s in zip(article_pair.base_radii, sprung, strict=True))
        expected = 1 / 5e8 + (turn if reference == "bore" else 0.0)
        np.testing.assert_allclose(more, expected, rtol=1e-9)
    bent = fem.mesh_cycle(article_pair, TORQUE, compliance=bodies.without("support"), beyond_path=False)
    np.testing.assert_allclose(bent.against("body").stiffness, on_path.against("body").stiffness, rtol=1e-12)


def test_figures_between_events_follow_the_reference(cycle, monkeypatch):
    """From the problem, from arcs that are known, and from a copy that was pickled: the same figures."""
    names = ("mean_stiffness", "mean_secant_stiffness", "transmission_error_range", "greatest_stiffness")
    alone = replace(cycle.against("body"), origin=None)  # whose arcs are solved for
    solved = [getattr(alone, name) for name in names]
    for known in (cycle, pickle.loads(pickle.dumps(cycle))):
        assert known.arcs is not None
        found = known.against("body")
        with monkeypatch.context() as patch:
            patch.setattr(ContactProblem, "arcs", None)  # nothing is solved anew
            assert found.arcs is not None
        assert [getattr(found, name) for name in names] == pytest.approx(solved, rel=1e-4)
        np.testing.assert_allclose(
            found.stiffness_harmonics, alone.stiffness_harmonics, rtol=1e-6, atol=1e-12
        )
        back = found.against("bore")
        assert [getattr(back, n) for n in names] == pytest.approx(
            [getattr(cycle, n) for n in names], rel=1e-9
        )


def test_load_sharing_with_and_without_a_common_compliance():
    """The identity by itself, with levers: forces stay, tangents differ by Sherman and Morrison's formula."""

    class Spring:
        def approach(self, force):
            return 1e-9 * force

        def slope(self, force):
            return np.full_like(force, 1e-9)

    bulk, gaps, levers = np.array([[3e-9, 1e-9], [1e-9, 2e-9]]), [0.0, 1e-6], [0.97, 1.02]
    common = 0.7e-9
    one, other = (share_load(1e4, bulk + c, Spring(), gaps, levers=levers) for c in (0.0, common))
    np.testing.assert_allclose(one.forces, other.forces, rtol=1e-12)
    assert other.transmission_error - one.transmission_error == pytest.approx(common * one.forces.sum())
    slope = 1 + common * one.pair_stiffness.sum()
    np.testing.assert_allclose(other.pair_stiffness, one.pair_stiffness / slope, rtol=1e-12)
    assert one.stiffness == pytest.approx(np.dot(levers, one.pair_stiffness))


def test_what_cannot_be_measured_is_refused(article_pair, article_bodies, on_path):
    with pytest.raises(InputError, match="reference"):
        fem.mesh_cycle(article_pair, TORQUE, compliance=article_bodies, reference="shaft")
    with pytest.raises(InputError, match="kg m2"):
        on_path.against("body", (-1.0, 0.0))
    alone = fem.mesh_cycle(article_pair, TORQUE, compliance=article_bodies.without("coupling"))
    with pytest.raises(InputError, match="coupling"):
        alone.against("body")
    assert pickle.loads(pickle.dumps(on_path)).against("body").reference == "body"
