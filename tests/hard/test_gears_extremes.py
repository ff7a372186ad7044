"""Gears that broke a prototype, or would break a careless program."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base import RangeWarning
from gears import (
    Gear,
    GearPair,
    GeometryError,
    LoadSharingError,
    check_meshing,
    closed_form,
    share_load,
)
from gears.tooth.profile import generate
from gears.tooth.rack import ISO_53_A, BasicRack


def test_17_teeth_undercut_by_a_hair():
    """At z = 17 the rack reaches some micrometres below the base tangent point: the cut is far below rounding."""
    tooth = generate(Gear(17), 1e-3, ISO_53_A)
    assert tooth is not None
    assert tooth.undercut
    assert 0 < tooth.form_radius - tooth.base_radius < 1e-8
    assert np.abs(tooth.fillet(1.0) - tooth.involute(tooth.flank_rho[0])).max() < 1e-17
    found = check_meshing(GearPair(Gear(17), Gear(43), 1e-3, 0.01), positions=7)
    assert found.angle_deviation < 1e-12


@pytest.mark.parametrize("rack", [ISO_53_A, BasicRack(rho_fP=0.6), BasicRack(h_fP=1.0, rho_fP=1e-3)])
def test_fillet_meets_involute_for_every_tooth_count_and_shift(rack):
    """No gap larger than 1e-13 modules, from 5 to 10,000 teeth."""
    for z in [*range(5, 60), 99, 500, 2500, 10_000]:
        for x in np.linspace(-0.8, 1.5, 24):
            if 0.5 * z - rack.h_fP + x <= 0.05:
                continue
            tooth = generate(Gear(z, float(x)), 1.0, rack)
            if tooth is None or tooth.flank_end_radius <= tooth.form_radius:
                continue
            gap = np.abs(tooth.fillet(1.0) - tooth.involute(tooth.flank_rho[0])).max()
            assert gap < 1e-13 * max(1.0, z / 10), (z, x)


def test_the_largest_gears_still_keep_the_ratio():
    found = check_meshing(GearPair(Gear(10_000), Gear(10_000), 1e-3, 0.01), positions=5)
    assert found.angle_deviation < 1e-12
    assert abs(found.back_clearance) < 1e-13


@pytest.mark.timeout(20)
def test_absurd_tooth_counts_are_refused_at_once():
    for teeth in (100_000_000, 10**30, -1):
        with pytest.raises(GeometryError, match="teeth"):
            GearPair(Gear(teeth), Gear(40), 2e-3, 0.04)


def test_undercut_pair_keeps_its_closed_forms_finite():
    pair = GearPair(Gear(12, 0.1), Gear(30, 0.2, tip_alteration=-0.15), 2e-3, 0.02)
    assert pair.teeth_profiles[0].undercut
    path = pair.path_of_contact(9)
    with pytest.warns(RangeWarning, match="theta_f"):
        forms = [closed_form.potential_energy(pair, path)]
    forms += [closed_form.ishikawa(pair, path), closed_form.weber_banaschek(pair, path, 500.0)]
    for form in forms:
        assert np.all(np.asarray(form) > 0)


class Line:
    def approach(self, force):
        safe = np.where(force > 0, force, 1.0)
        return np.where(force > 0, 1.6e-10 * safe * (np.log(1e12 / safe) + 1.0), 0.0)

    def slope(self, force):
        safe = np.where(force > 0, force, 1.0)
        return np.where(force > 0, 1.6e-10 * np.log(1e12 / safe), np.inf)


class ThickFilm:
    """A film that never lets go: s = c F^-0.1, infinite at zero force."""

    def approach(self, force):
        with np.errstate(divide="ignore"):
            return 3e-6 * np.asarray(force, dtype=float) ** -0.1

    def slope(self, force):
        with np.errstate(divide="ignore"):
            return -3e-7 * np.asarray(force, dtype=float) ** -1.1


def test_gaps_and_forces_over_thirty_decades():
    bulk = 1e-9 * (np.eye(3) + 0.2)
    for force in np.logspace(-12, 8, 11):
        for gap in np.logspace(-16, 3, 14):
            share = share_load(float(force), bulk, Line(), [0.0, gap, 3 * gap])
            assert share.forces.sum() == pytest.approx(force, rel=1e-10)
            assert np.all(np.diff(share.forces) <= 1e-9 * force)
            assert math.isfinite(float(share.stiffness))


def test_gap_at_the_edge_of_contact():
    """The second pair carries nothing, then continuously more, as the gap closes through the point of touch."""
    bulk, force = 1e-9 * np.eye(2), 1e4
    alone = float(share_load(force, [[1e-9]], Line(), [0.0]).transmission_error)
    loads = [
        float(share_load(force, bulk, Line(), [0.0, alone * (1 - s)]).forces[1])
        for s in (-1e-3, -1e-9, -1e-15, 0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3)
    ]
    assert loads[:3] == [0.0, 0.0, 0.0]
    assert np.all(np.diff(loads) >= 0)
    assert 0 < loads[-1] < 1e-2 * force
    assert 0 < loads[6] < 1e-6 * force


def test_a_film_without_bound_is_refused_rather_than_lost_in_infinities():
    with pytest.raises(LoadSharingError, match="film"):
        share_load(1e4, 1e-9 * np.eye(2), Line(), [0.0, 1e-5], ThickFilm())
