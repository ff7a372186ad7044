"""Shafts as beams: closed forms of bending with shear, torsion, bearings in series and vibration."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import eigh

from base import InputError
from gears import STEEL, Bearing, Shaft, ShaftSegment
from gears.pair.beams import bending, halved, reduced, rotary, shaft_nodes, torsion

E, G, RHO = STEEL.youngs_modulus, STEEL.shear_modulus, STEEL.density
KAPPA = 6 * 1.3 / (7 + 6 * 0.3)
STIFF = 1e13


def plain(
    diameter=0.03, bore=0.0, length=0.2, gear=0.1, torque=0.0, stiffness=STIFF, ends=(0.0, 0.2)
) -> Shaft:
    return Shaft(
        (ShaftSegment(length, diameter, bore),), tuple(Bearing(z, stiffness) for z in ends), gear, torque
    )


def test_load_between_bearings():
    """F a b / (3 E I L) (a b) + shear F a b / (kappa G A L), on bearings in series."""
    d, a, b = 0.03, 0.07, 0.13
    i, area = math.pi * d**4 / 64, math.pi * d**2 / 4
    for stiffness in (STIFF, 2e8):
        compliance = a**2 * b**2 / (3 * E * i * 0.2) + a * b / (KAPPA * G * area * 0.2)
        compliance += ((b / 0.2) ** 2 + (a / 0.2) ** 2) / stiffness
        found = reduced(plain(gear=a, stiffness=stiffness))
        assert 1.0 / found.bending_stiffness == pytest.approx(compliance, rel=1e-9, abs=0.0)
        force = stiffness * found.bearing_shares / found.bending_stiffness
        assert force == pytest.approx([b / 0.2, a / 0.2], rel=1e-7)  # shares of the force


def test_overhung_gear_with_a_bore():
    """Gear beyond the second bearing: F c^2 (L + c) / (3 E I), shear in both fields; Cowper's factor of a tube."""
    d, bore, span, over = 0.03, 0.015, 0.15, 0.05
    i, area = math.pi * (d**4 - bore**4) / 64, math.pi * (d**2 - bore**2) / 4
    m2 = (bore / d) ** 2
    kappa = 6 * 1.3 * (1 + m2) ** 2 / ((7 + 1.8) * (1 + m2) ** 2 + (20 + 3.6) * m2)
    bent = over**2 * (span + over) / (3 * E * i)
    sheared = (over + over**2 / span) / (kappa * G * area)
    found = reduced(plain(bore=bore, gear=0.2, ends=(0.0, 0.15)))
    soft = ((over / span) ** 2 + (1.0 + over / span) ** 2) / STIFF
    assert 1.0 / found.bending_stiffness == pytest.approx(bent + sheared + soft, rel=1e-9, abs=0.0)
    # slope at the gear: F c (2 L + 3 c) / (6 E I) of bending, and what the span's shear tilts, F c / (L kappa G A)
    tilt = over * (2 * span + 3 * over) / (6 * E * i) + over / (span * kappa * G * area)
    tilt += (1.0 + 2.0 * over / span) / (span * STIFF)
    assert abs(found.slope / found.bending_stiffness) == pytest.approx(tilt, rel=1e-9, abs=0.0)


def test_torsion_of_steps_in_series():
    shaft = Shaft(
        (ShaftSegment(0.1, 0.02), ShaftSegment(0.15, 0.03, 0.01)),
        (Bearing(0.0, 1e9), Bearing(0.25, 1e9)),
        0.2,
        0.05,
    )
    polar = [math.pi / 32 * 0.02**4, math.pi / 32 * (0.03**4 - 0.01**4)]
    compliance = 0.05 / (G * polar[0]) + 0.1 / (G * polar[1])
    found = reduced(shaft)
    assert 1.0 / found.torsion_stiffness == pytest.approx(compliance, rel=1e-12, abs=0.0)
    whole = RHO * (polar[0] * 0.1 + polar[1] * 0.15)
    assert found.inertia.sum() == pytest.approx(whole, rel=1e-12, abs=0.0)  # both turn alike: all of it


def test_gear_where_the_torque_is():
    found = reduced(plain(torque=0.1))
    assert found.torsion_stiffness == math.inf
    assert found.inertia[0, 0] == pytest.approx(RHO * math.pi / 32 * 0.03**4 * 0.2, rel=1e-12, abs=0.0)
    assert found.inertia[1].tolist() == [0.0, 0.0]


def test_slender_beam_vibrates_as_euler_says():
    """First frequency on rigid bearings, (pi/L)^2 sqrt(E I / rho A), for a shaft 400 times as long as thick."""
    shaft = plain(diameter=0.005, length=2.0, gear=1.0, ends=(0.0, 2.0))
    nodes = np.linspace(0.0, 2.0, 33)
    stiffness, mass, _ = bending(shaft, nodes)
    lowest = math.sqrt(eigh(stiffness, mass, eigvals_only=True)[0])
    assert lowest == pytest.approx((math.pi / 2) ** 2 * math.sqrt(E * 0.005**2 / 16 / RHO), rel=1e-4)
    # free at both ends in torsion: pi/L sqrt(G/rho)
    k, j = torsion(shaft, nodes)
    assert math.sqrt(eigh(k, j, eigvals_only=True)[1]) == pytest.approx(
        math.pi / 2 * math.sqrt(G / RHO), rel=1e-3
    )


@pytest.mark.parametrize("bore", [0.0, 0.03])
def test_thick_beam_vibrates_as_timoshenko_says(bore):
    """Pinned ends, shear and rotary inertia: (G' k^2 - m w^2)(E I k^2 + G' - r w^2) = (G' k)^2, k = n pi / L.

    A shaft 5 times as long as thick, six modes from above; errors of the second order, and what is left without these.
    """
    shaft = plain(diameter=0.05, bore=bore, length=0.25, gear=0.125, ends=(0.0, 0.25))
    nodes = shaft_nodes(shaft)
    found = []
    for at in (nodes, halved(nodes)):
        stiffness, mass, _ = bending(shaft, at)
        inner = np.setdiff1d(np.arange(len(mass)), [0, len(mass) - 2])
        squares = eigh(stiffness[np.ix_(inner, inner)], mass[np.ix_(inner, inner)], eigvals_only=True)
        found.append(np.sqrt(squares[:6]))
    step, m2 = shaft.segments[0], (bore / 0.05) ** 2
    kappa = 6 * 1.3 * (1 + m2) ** 2 / ((7 + 1.8) * (1 + m2) ** 2 + (20 + 3.6) * m2)
    firm, line, turning = kappa * G * step.area, RHO * step.area, RHO * step.second_moment
    for n in range(1, 7):
        k = n * math.pi / 0.25
        whole = np.poly1d([-line, firm * k**2]) * np.poly1d([-turning, E * step.second_moment * k**2 + firm])
        exact = math.sqrt(np.min((whole - np.poly1d([(firm * k) ** 2])).roots.real))
        coarse, fine = (one[n - 1] / exact - 1.0 for one in found)
        assert 0.0 < fine < coarse
        assert (4.0 * fine - coarse) / 3.0 == pytest.approx(0.0, abs=5e-4)
        assert coarse < 6e-5 * n**4
    whole_mass = rotary(shaft, nodes)
    tilted = np.tile([0.0, 1.0], len(nodes)) + np.tile([1.0, 0.0], len(nodes)) * np.repeat(nodes, 2)
    assert tilted @ whole_mass @ tilted == pytest.approx(turning * 0.25, rel=1e-9)


def test_free_rod_in_torsion():
    """n pi / L sqrt(G / rho), and all of the fourth order: half the elements, 16 times the error."""
    shaft = plain()
    off = []
    for elements in (8, 16):
        k, j = torsion(shaft, shaft_nodes(shaft, elements))
        found = np.sqrt(eigh(k, j, eigvals_only=True)[1:4])
        exact = np.arange(1, 4) * math.pi / 0.2 * math.sqrt(G / RHO)
        off.append(found / exact - 1.0)
    assert off[0] / off[1] == pytest.approx(np.full(3, 16.0), rel=0.1)
    assert np.all(off[1] < 1e-4)


@pytest.mark.parametrize(
    ("changes", "where", "words"),
    [
        ({"segments": ()}, "segments", "at least one"),
        ({"bearings": (Bearing(0.0, 1e8),)}, "bearings", "at least two at different positions"),
        (
            {"bearings": (Bearing(0.1, 1e8), Bearing(0.1, 1e8))},
            "bearings",
            "at least two at different positions",
        ),
        ({"bearings": (Bearing(0.1, 1e8), Bearing(0.3, 1e8))}, "bearings[1].position", "at most 0.2"),
        ({"segments": (ShaftSegment(0.2, 0.03, 0.04),)}, "segments[0].bore", "less than the diameter"),
        ({"gear_position": -0.1}, "gear_position", "at least 0"),
        ({"segments": (ShaftSegment(0.2, math.nan),)}, "segments[0].diameter", "finite"),
    ],
)
def test_what_is_no_shaft(changes, where, words):
    given = {
        "segments": (ShaftSegment(0.2, 0.03),), "bearings": (Bearing(0.0, 1e8), Bearing(0.2, 1e8)),
        "gear_position": 0.1, "torque_position": 0.0,
    }  # fmt: skip
    with pytest.raises(InputError, match=words) as raised:
        Shaft(**{**given, **changes})
    assert raised.value.faults[0].where == where
