"""Flanks that differ over profile and face together: twist by its definitions, tables against surfaces, faults."""

from __future__ import annotations

import numpy as np
import pytest

from base import InputError
from gears import Gear, GearPair, Lead, LeadTrace, Topography

WIDTH, SPAN = 0.04, (8e-3, 18e-3)
Z, RHO = np.linspace(-0.5, 0.5, 9) * WIDTH, np.linspace(*SPAN, 7)


def surface(rho, z):
    """Smooth in both, 10 um high."""
    return 10e-6 * np.sin(300.0 * rho + 0.3) * np.cos(90.0 * z - 0.2)


def table(points, form="smooth", of=surface):
    rho, z = np.linspace(*SPAN, points), np.linspace(-0.5, 0.5, points + 3) * WIDTH
    return Topography(rho, z, of(rho[:, None], z), form)


def test_twist_is_the_difference_of_slopes_over_either():
    """S_alpha of the profiles at both ends of the face is S_beta of the leads at both ends of the profile."""
    removed = Lead(twist=12e-6).removed_at(Z, RHO[:, None], WIDTH, SPAN)
    profile_slopes, lead_slopes = removed[-1] - removed[0], removed[:, -1] - removed[:, 0]
    assert profile_slopes[-1] - profile_slopes[0] == pytest.approx(12e-6, rel=1e-12)
    assert lead_slopes[-1] - lead_slopes[0] == pytest.approx(12e-6, rel=1e-12)
    assert removed[-1, -1] > 0.0  # at the tip where z > 0
    np.testing.assert_allclose(removed[3], 0.0, atol=1e-20)
    np.testing.assert_allclose(removed[:, 4], 0.0, atol=1e-20)


def test_a_slice_of_a_twist_is_a_slope_of_the_lead():
    for place, part in ((SPAN[0], -0.5), (SPAN[1], 0.5), (0.25 * SPAN[0] + 0.75 * SPAN[1], 0.25)):
        slope = Lead(slope=part * 12e-6).removed(Z, WIDTH)
        np.testing.assert_allclose(
            Lead(twist=12e-6).removed_at(Z, place, WIDTH, SPAN), slope, rtol=0, atol=1e-19
        )


def test_the_twists_of_both_gears_cancel_along_the_line_of_action():
    pair = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=WIDTH)
    rho1 = np.linspace(pair.points.A, pair.points.E, 5)[:, None]
    first, second = (
        Lead(twist=30e-6).removed_at(Z, rho, WIDTH, span)
        for rho, span in zip((rho1, pair.line_of_action - rho1), pair.active_profiles, strict=True)
    )
    assert np.abs(first).max() > 7e-6
    np.testing.assert_allclose(first + second, 0.0, atol=1e-19)


def test_without_twist_and_table_it_is_what_is_removed_along_the_face():
    trace = LeadTrace(Z, 1e-6 * np.cos(200.0 * Z))
    lead = Lead(crowning=5e-6, slope=-3e-6, end_relief=4e-6, end_relief_length=5e-3, trace=trace)
    found = lead.removed_at(Z, RHO[:, None], WIDTH, SPAN)
    assert found.shape == (7, 9)
    np.testing.assert_array_equal(found, np.tile(lead.removed(Z, WIDTH), (7, 1)))


def test_arrays_broadcast_and_pair_up_along_oblique_lines():
    lead = Lead(crowning=5e-6, twist=20e-6, topography=table(6))
    grid = lead.removed_at(Z, RHO[:, None], WIDTH, SPAN)
    chosen = np.array([6, 3, 0])
    oblique = lead.removed_at(Z[[0, 4, 8]], RHO[chosen], WIDTH, SPAN)
    np.testing.assert_array_equal(oblique, grid[chosen, [0, 4, 8]])
    assert lead.removed_at(Z, RHO[0], WIDTH, SPAN).shape == (9,)


def test_a_table_of_a_twist_is_the_twist():
    twist = Lead(twist=20e-6)
    rows = -twist.removed_at(Z[[0, -1]], np.array(SPAN)[:, None], WIDTH, SPAN)
    for form in ("linear", "smooth"):
        made = Lead(topography=Topography(SPAN, Z[[0, -1]], rows, form))
        np.testing.assert_allclose(
            made.removed_at(Z, RHO[:, None], WIDTH, SPAN),
            twist.removed_at(Z, RHO[:, None], WIDTH, SPAN),
            atol=1e-19,
        )


def test_quadratic_surfaces_come_back_exactly():
    def quadratic(rho, z):
        x, y = rho / 10e-3, z / 20e-3
        return 1e-6 * (1.0 + 2.0 * x - y + x * y + 3.0 * x**2 - 2.0 * y**2 + x**2 * y**2)

    rho = np.array([8e-3, 9e-3, 13e-3, 18e-3])  # unevenly spaced
    z = np.array([-0.02, -0.011, 0.004, 0.02])
    made = Topography(rho, z, quadratic(rho[:, None], z))
    np.testing.assert_allclose(made.at(RHO[:, None], Z), quadratic(RHO[:, None], Z), atol=1e-18)


@pytest.mark.parametrize(("form", "order"), [("linear", 2.0), ("smooth", 3.0)])
def test_tables_converge(form, order):
    """Bilinear by the second order in the distances, bicubic with slopes by differences by the third."""
    rho, z = np.linspace(*SPAN, 101)[:, None], np.linspace(-0.5, 0.5, 101) * WIDTH
    errors = [np.abs(table(n, form).at(rho, z) - surface(rho, z)).max() for n in (17, 33)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.35)


def test_a_smooth_table_has_a_continuous_derivative():
    made, step = table(5), 1e-9
    for at, across in ((made.rho[2], 1.0), (made.z[3], 0.0)):
        ahead, here, behind = (
            made.at(at + k * step, 0.003) if across else made.at(0.012, at + k * step) for k in (1, 0, -1)
        )
        assert (ahead - here) / step == pytest.approx((here - behind) / step, rel=1e-4)


def test_points_are_met_and_edges_are_held():
    for form in ("linear", "smooth"):
        made = table(5, form)
        rho, z = np.array(made.rho), np.array(made.z)
        np.testing.assert_allclose(made.at(rho[:, None], z), made.material, rtol=0, atol=1e-20)
        np.testing.assert_allclose(made.at(1.0, z), made.material[-1], rtol=0, atol=1e-20)
        np.testing.assert_allclose(made.at(rho, -1.0), [row[0] for row in made.material], rtol=0, atol=1e-20)


def test_equal_tables_are_equal_and_leads_with_them_are_not_straight():
    one, other = table(4), table(4)
    assert one == other
    assert hash(Lead(topography=one)) == hash(Lead(topography=other))
    for lead in (Lead(twist=1e-6), Lead(topography=one)):
        assert lead.topographic
        assert not GearPair(Gear(teeth=20, lead=lead), Gear(teeth=30), 2e-3, WIDTH).straight
    assert not Lead(crowning=1e-6).topographic


@pytest.mark.parametrize(
    ("lead", "faults"),
    [
        (Lead(twist=np.nan), {"twist": "finite"}),
        (Lead(twist=5e-3), {"twist": "0.001 m"}),
        (Lead(topography=[[1.0]]), {"topography": "must be a Topography"}),
        (Lead(topography=Topography([8e-3], Z, np.zeros((1, 9)))), {"topography.rho": "at least 2"}),
        (Lead(topography=Topography(RHO[::-1], Z, np.zeros((7, 9)))), {"topography.rho": "growing radii"}),
        (Lead(topography=Topography(RHO, np.zeros(9), np.zeros((7, 9)))), {"topography.z": "growing places"}),
        (
            Lead(topography=Topography(RHO, [0.02, np.nan], [[0.0, np.inf]] * 6)),
            {"topography.z": "finite", "topography.material": "a row for each of 7 rho"},
        ),
        (Lead(topography=Topography(RHO, Z, np.full((7, 9), 8.0))), {"topography.material": "0.001 m"}),
        (Lead(topography=Topography(SPAN, SPAN, [[0.0], [0.0, 1.0]])), {"topography.material": "2 z"}),
        (Lead(topography=Topography([], [], [])), {"topography.rho": "2", "topography.z": "2"}),
        (Lead(topography=Topography(RHO, Z, np.zeros((7, 9)), "cubic")), {"topography.form": "'linear'"}),
        (
            Lead(topography=Topography(np.arange(1001.0), Z, np.zeros((1001, 9)))),
            {"topography.rho": "1000"},
        ),
    ],
)
def test_faults_are_all_named(lead, faults):
    with pytest.raises(InputError) as told:
        GearPair(Gear(teeth=20, lead=lead), Gear(teeth=30), 2e-3, -1.0)
    found = {fault.where: fault.allowed for fault in told.value.faults}
    assert "face_width" in found  # all at once
    for where, allowed in faults.items():
        matching = [f.allowed for f in told.value.faults if f.where == f"pinion.lead.{where}"]
        assert any(allowed in each for each in matching), (where, matching)
