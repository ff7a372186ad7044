"""Measured leads and maps of flanks: what they remove, what a map falls apart into, faults."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from base import InputError
from gears import Gear, GearPair, Lead, LeadTrace, flank_map

Z = np.linspace(-0.02, 0.02, 41)


def test_a_straight_trace_is_a_slope_and_a_parabola_is_crowning():
    trace = LeadTrace([-0.02, 0.02], [4e-6, -4e-6], form="linear")
    np.testing.assert_allclose(
        Lead(trace=trace).removed(Z, 0.04), Lead(slope=8e-6).removed(Z, 0.04), atol=1e-20
    )
    bulge = LeadTrace(Z, -10e-6 * (Z / 0.02) ** 2)
    between = 0.5 * (Z[1:] + Z[:-1])
    crowned = Lead(crowning=10e-6).removed(between, 0.04)
    # a cubic without overshoot follows a parabola to the second order of its cells
    np.testing.assert_allclose(Lead(trace=bulge).removed(between, 0.04), crowned, atol=10e-6 / 20**2)


def test_a_trace_adds_to_what_is_designed():
    trace = LeadTrace([-0.02, 0.0, 0.02], [1e-6, 0.0, -3e-6])
    both = Lead(crowning=5e-6, slope=-2e-6, trace=trace).removed(Z, 0.04)
    np.testing.assert_allclose(
        both, Lead(crowning=5e-6, slope=-2e-6).removed(Z, 0.04) - trace.at(Z), atol=1e-20
    )
    assert not GearPair(Gear(teeth=20, lead=Lead(trace=trace)), Gear(teeth=30), 2e-3, 0.04).straight


@pytest.mark.parametrize(
    ("trace", "where", "allowed"),
    [
        (LeadTrace([0.0, 0.0], [0.0, 0.0]), "pinion.lead.trace.z", "growing places"),
        (LeadTrace([0.0, 1.0], [0.0, 40.0]), "pinion.lead.trace.material", "0.001 m"),
        (LeadTrace([0.0], [0.0]), "pinion.lead.trace", "at least 2"),
        (LeadTrace([0.0, 1.0], [0.0, np.nan]), "pinion.lead.trace.material", "finite"),
    ],
)
def test_faults_of_a_trace(trace, where, allowed):
    with pytest.raises(InputError, match=allowed) as raised:
        GearPair(Gear(teeth=20, lead=Lead(trace=trace)), Gear(teeth=30), 2e-3, 0.04)
    assert where in {fault.where for fault in raised.value.faults}


@given(
    profile=arrays(float, 5, elements=st.floats(-1e-4, 1e-4)),
    lead=arrays(float, 4, elements=st.floats(-1e-4, 1e-4)),
)
def test_a_map_without_twist_falls_apart_into_what_it_was_made_of(profile, lead):
    rho, z = np.array([8.0, 9.0, 11.0, 12.0, 15.0]) * 1e-3, np.array([-20.0, -5.0, 5.0, 18.0]) * 1e-3
    found = flank_map(rho, z, profile[:, None] + lead)
    assert found.twist < 1e-18
    whole = np.array(found.profile.material)[:, None] + np.array(found.lead.material)
    np.testing.assert_allclose(whole, profile[:, None] + lead, atol=1e-18)
    assert abs(np.trapezoid(found.lead.material, z)) < 1e-20


def test_the_sum_is_nearest_to_the_map_and_twist_is_what_it_misses():
    rng = np.random.default_rng(20261123)
    rho, z = np.linspace(8e-3, 15e-3, 7), np.linspace(-0.02, 0.02, 9)
    heights = rng.normal(0.0, 3e-6, (7, 9)) + 5e-6 * np.outer(np.linspace(-1, 1, 7), np.linspace(-1, 1, 9))
    found = flank_map(rho, z, heights)
    left = heights - np.array(found.profile.material)[:, None] - np.array(found.lead.material)
    assert found.twist == pytest.approx(np.abs(left).max(), rel=1e-12)
    np.testing.assert_array_equal(found.rest.material, left)
    over, along = (np.convolve(np.diff(x), [0.5, 0.5]) for x in (rho, z))
    np.testing.assert_allclose(left @ along, 0.0, atol=1e-22)  # nothing is left for a curve over the profile
    np.testing.assert_allclose(over @ left, 0.0, atol=1e-22)  # nor for one along the face


def test_faults_of_a_map_all_at_once():
    with pytest.raises(InputError) as raised:
        flank_map([1e-3, 1e-3], [0.0], np.zeros((2, 3)))
    assert {fault.where for fault in raised.value.faults} == {"rho", "z", "material"}
    with pytest.raises(InputError, match="finite"):
        flank_map([1e-3, 2e-3], [0.0, 1.0], [[0.0, np.nan], [0.0, 0.0]])
