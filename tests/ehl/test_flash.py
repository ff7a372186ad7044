"""Blok's flash temperature against Jaeger's moving source under a Hertz distribution of heat."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehl import STEEL, LineContact, Lubricant, Solid, blok_flash_temperature
from ehl.discrete.solids import surface_heating

OIL = Lubricant(0.075, 19.6e-9, 860.0)
FRICTION = 0.03


def contact(sliding: float) -> LineContact:
    return LineContact(2e5, 8.0, 6e-3, 2.26e11, OIL, sliding=sliding)


def heated(solid: Solid, speed: float, heat: float, half_width: float) -> float:
    """Greatest rise of one surface under an ellipse of heat [W/m]."""
    edges = np.linspace(-1.5, 1.5, 301) * half_width
    middle = 0.5 * (edges[1:] + edges[:-1])
    shape = np.sqrt(np.maximum(1.0 - (middle / half_width) ** 2, 0.0))
    flux = heat * shape / (0.5 * math.pi * half_width)
    return float(np.max(surface_heating(edges, speed, solid, 6e-3) @ flux))


@pytest.mark.parametrize("sliding", [1.0, -3.0])
@pytest.mark.parametrize("solids", [(STEEL, STEEL), (STEEL, Solid(120.0, 2700.0, 900.0))])
def test_both_surfaces_are_as_hot_as_the_moving_source_makes_them(sliding, solids):
    one = contact(sliding)
    heat = FRICTION * one.load * abs(sliding)
    # a share of the heat such that both are as hot
    alone = [
        heated(solid, speed, heat, one.half_width)
        for solid, speed in zip(solids, one.surface_speeds, strict=True)
    ]
    both = 1.0 / (1.0 / alone[0] + 1.0 / alone[1])
    # fast sources alone: the rest is conduction ahead of the source
    assert blok_flash_temperature(one, FRICTION, solids) == pytest.approx(both, rel=0.02)


def test_nothing_slides_and_nothing_warms():
    assert blok_flash_temperature(contact(0.0), FRICTION) == 0.0
    assert blok_flash_temperature(contact(1.0), 0.0) == 0.0
    assert blok_flash_temperature(contact(-1.0), -FRICTION) > 0.0
