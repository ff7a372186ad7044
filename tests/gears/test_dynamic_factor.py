"""Dynamic factor after ISO 6336-1, method B: worked by hand in every range, and its ranges join."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base import InputError
from gears.closed_form import iso6336, iso6336_dynamic
from gears.closed_form.dynamic_factor import _constants

FORCE, MASS = 17_000.0, 0.4


def test_each_range_by_hand(article_pair):
    """Contact ratio between 1.5 and 2: constants 0.32, 0.34, 0.23, 0.90, 0.47, 0.47; w = F cos(alpha) / b."""
    prime = iso6336(article_pair, FORCE)
    load = FORCE * math.cos(math.radians(20)) / 40e-3
    b_p, b_f = prime.c_prime * 1e9 * 8e-6 / load, prime.c_prime * 1e9 * 5e-6 / load
    b_k = 1.0 - prime.c_prime * 1e9 * 10e-6 / load
    resonance = math.sqrt(prime.mesh_stiffness / MASS) / 36
    ratios = np.array([0.0, 0.5, 1.0, 1.325, 2.0])
    found = iso6336_dynamic(
        article_pair, FORCE, MASS, ratios * resonance,
        pitch_deviation=8e-6, profile_deviation=5e-6, relief=10e-6,
    )  # fmt: skip
    seven = 0.125 * math.sin(math.pi * (article_pair.contact_ratio - 2.0)) + 0.875
    main = 0.32 * b_p + 0.34 * b_f + 0.90 * b_k + 1.0
    above = 0.47 * b_p + 0.47 * b_f + seven
    below = 0.5 * (0.32 * b_p + 0.34 * b_f + 0.23 * b_k) + 1.0
    assert pytest.approx(ratios, rel=1e-12) == found.N
    assert found.K_v == pytest.approx([1.0, below, main, 0.5 * (main + above), above], rel=1e-12)
    assert found.N_S == 0.85


def test_constants_of_high_contact_ratios_by_hand():
    """Table of ISO 6336-1: at 2.2 0.57/1.9, 0.096/0.64, 0.46/0.76, 0.12/0.46 and sin 36 degrees."""
    found = (0.32, 0.3, 0.15, 0.605263158, 0.47, 0.260869565, 0.875 + 0.125 * 0.587785252)
    assert _constants(2.2) == pytest.approx(found, rel=1e-8)
    assert _constants(2.7)[6] == pytest.approx(1.0, rel=1e-12)
    assert _constants(2.7)[2:4] == pytest.approx((0.096 / 1.14, 0.435 / 1.26), rel=1e-12)
    assert _constants(1.2)[6] == pytest.approx(0.75, rel=1e-12)
    assert _constants(2.0)[:6] == (0.32, 0.34, 0.23, 0.90, 0.47, 0.47)


def test_without_deviations_the_stiffness_alone_excites(article_pair):
    """B_p = B_f = 0 and B_k = 1, at half the resonance and at it."""
    speeds = iso6336_dynamic(article_pair, FORCE, MASS, 1.0).resonance_speed * np.array([0.5, 1.0])
    found = iso6336_dynamic(article_pair, FORCE, MASS, speeds)
    assert found.K_v == pytest.approx([1.0 + 0.5 * 0.23, 1.90], rel=1e-12)


def test_main_resonance_joins_what_lies_above(article_pair):
    resonance = iso6336_dynamic(article_pair, FORCE, MASS, 1.0).resonance_speed
    for ratio in (1.15, 1.5):
        sides = resonance * ratio * np.array([1 - 1e-9, 1 + 1e-9])
        low, high = iso6336_dynamic(article_pair, FORCE, MASS, sides).K_v
        assert low == pytest.approx(high, rel=1e-7)


def test_light_loads_end_the_subcritical_range_earlier(article_pair):
    light = iso6336_dynamic(article_pair, 1000.0, MASS, 1.0)
    load = 1000.0 * math.cos(math.radians(20)) / 40.0
    assert pytest.approx(0.5 + 0.35 * math.sqrt(load / 100.0), rel=1e-12) == light.N_S


def test_faults_are_listed_together(article_pair):
    with pytest.raises(InputError) as caught:
        iso6336_dynamic(article_pair, -1.0, 0.0, math.nan, relief=-1.0)
    assert len(caught.value.faults) == 4
