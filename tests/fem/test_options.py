"""Numerical settings: each reaches what it decides, and moves it as it says."""

from __future__ import annotations

import warnings
from dataclasses import fields

import numpy as np
import pytest

import fem
from base import InputError, RangeWarning
from fem.laws.mesh_setup import MeshSetup
from fem.pair.options import LIMITS
from gears import Bearing, Gear, GearDeviations, GearPair, ProfileDeviation, Shaft, ShaftSegment

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, 0.02)


def test_every_setting_has_a_limit():
    assert set(LIMITS) == {field.name for field in fields(fem.Options)}


def test_settings_outside_their_limits_are_refused_by_name(bodies):
    wrong = fem.Options(finest=0, order=5.0, sampling=0.0)
    with pytest.raises(InputError, match=r"options\.finest") as refused:
        fem.compliance(PAIR, 0.02, options=wrong)
    assert len(refused.value.faults) == 3
    with pytest.raises(InputError, match=r"options\.sampling"):
        fem.mesh_cycle(PAIR, 50.0, 4, bodies, options=wrong)
    with pytest.raises(InputError, match="must be a Options"):
        fem.mesh_cycle(PAIR, 50.0, 4, bodies, options=None)


def test_the_error_of_a_mesh_is_its_last_change_by_the_order(bodies):
    slow = fem.compliance(PAIR, 0.02, refinements=bodies.refinements, options=fem.Options(order=2.0))
    assert slow.gain == 3.0
    assert bodies.gain == 7.0
    # beside the corner a refinement gains less, whatever the order
    ratio = (slow.error - slow.fit_error) / (bodies.error - bodies.fit_error)
    assert 1.2 < ratio <= 7.0 / 3.0 + 1e-12


def test_a_fit_may_leave_its_part_of_the_tolerance(bodies):
    fine = fem.compliance(PAIR, 0.02, refinements=bodies.refinements, options=fem.Options(fit=1e-4))
    assert fine.fit_error < 0.5 * bodies.fit_error


def test_arcs_leave_their_part_of_the_tolerance(bodies):
    def samples(sampling):
        cycle = fem.mesh_cycle(PAIR, 50.0, 4, bodies, tolerance=0.01, options=fem.Options(sampling=sampling))
        return sum(arc.values.shape[1] for arc in cycle.problem.divided().arcs.arcs)

    assert samples(1e-4) > samples(1.0)


@pytest.mark.parametrize(("most", "corners"), [(20, 8), (5, 0)])
def test_measured_points_end_arcs_unless_there_are_too_many(most, corners):
    rho = np.linspace(4e-3, 8e-3, 8)
    trace = ProfileDeviation(rho, 1e-6 * np.cos(np.arange(8.0)), form="linear")
    measured = MeshSetup(
        PAIR, deviations=(GearDeviations(profile=trace), None), options=fem.Options(measured_points=most)
    )
    plain = MeshSetup(PAIR)
    assert len(measured.flanks.kinks(0)) - len(plain.flanks.kinks(0)) == corners


def warned(bodies, **options):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RangeWarning)
        fem.mesh_cycle(PAIR, 50.0, 4, bodies, options=fem.Options(**options))
    return " ".join(str(one.message) for one in caught)


def test_warnings_begin_at_their_thresholds(bodies):
    assert warned(bodies) == ""
    assert "the teeth deflect by" in warned(bodies, large_deflection=1e-4)
    assert "the half-width of a contact" in warned(bodies, wide_contact=1e-4)


def test_shafts_that_give_way_are_reported_from_their_threshold(bodies):
    shaft = Shaft((ShaftSegment(0.2, 0.02),), (Bearing(0.0, 1e9), Bearing(0.2, 1e9)), 0.06, 0.0)

    def remarks(**options):
        return fem.mesh_cycle(
            PAIR,
            5.0,
            2,
            bodies,
            cells=4,
            face_model="walls",
            shafts=(shaft, None),
            options=fem.Options(**options),
        ).message

    with pytest.warns(RangeWarning, match="the shafts give way"):
        assert "the shafts give way" in remarks(large_shift=1e-5)
    assert "the shafts give way" not in remarks(large_shift=10.0)
