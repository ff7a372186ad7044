"""Root stress over the face at its limits: contacts that end at an edge or on one cell, overhangs, deep crowning."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

import fem
from base import RangeWarning
from gears import Alignment, Gear, GearPair, Lead

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(200e-6)
LINE_LOAD, FEW, MANY = 400e3, 32, 64


def crowned(pair: GearPair) -> GearPair:
    return replace(pair, pinion=replace(pair.pinion, lead=Lead(crowning=200e-6)))


def wide(slenderness: float) -> GearPair:
    return replace(PAIR, face_width=slenderness * PAIR.module)


CASES = {
    "ends at the middle": (PAIR, 0.02, 20e-6),
    "reaches the far edge": (PAIR, 1.0, 20e-6),
    "hardly any load on 60 um": (PAIR, 100.0 / LINE_LOAD, 60e-6),
    "one cell": (PAIR, 50.0 / LINE_LOAD, 2e-3),
    "crowning of 200 um": (crowned(PAIR), 1.0, 0.0),
    "crowning of 200 um, lightly": (crowned(PAIR), 0.05, 0.0),
    "overhang": (replace(PAIR, pinion=replace(PAIR.pinion, face_width=22e-3)), 1.0, 10e-6),
    "overhang at one end": (
        replace(PAIR, wheel=replace(PAIR.wheel, face_width=22e-3, face_offset=1e-3)),
        1.0,
        10e-6,
    ),
    "half a module": (wide(0.5), 1.0, 0.5e-6),
    "forty modules": (wide(40.0), 1.0, 40e-6),
}
"""Pair, part of the line load, and how far axes are out of parallel [m]."""


def stresses(pair: GearPair, part: float, across: float, bodies, roots, cells: int, model: str):
    torque = part * LINE_LOAD * pair.face_width * pair.base_radii[0]
    given = {"alignment": Alignment(across), "cells": cells, "face_model": model}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)  # of loads on few cells
        cycle = fem.mesh_cycle(pair, torque, 4, replace(bodies, pair=pair), **given)
    assert cycle.converged, cycle.message
    return fem.root_stress(pair, cycle, replace(roots, pair=pair)), cycle


@pytest.fixture(scope="module")
def bodies():
    return fem.compliance(PAIR, 0.02)


@pytest.fixture(scope="module")
def roots():
    return fem.fillets(PAIR, 0.02)


@pytest.mark.slow
@pytest.mark.parametrize("model", ["walls", "free-ends"])
@pytest.mark.parametrize("name", CASES)
def test_twice_as_many_cells_are_within_the_error(bodies, roots, name, model):
    """And the root feels the load less than the flank does, greatest where that is greatest."""
    pair, part, across = CASES[name]
    (few, _), (many, cycle) = (
        stresses(pair, part, across, bodies, roots, cells, model) for cells in (FEW, MANY)
    )
    assert many.converged
    most = cycle.face.face_position[np.argmax(cycle.line_load.sum(axis=(0, 1)))]
    for gear in ("pinion", "wheel"):
        one, true = getattr(few, gear), getattr(many, gear)
        for kind in ("greatest_tension_Pa", "greatest_compression_Pa"):
            told, value = one.errors[kind], getattr(true, kind)
            off = abs(getattr(one, kind) / value - 1.0)
            assert off < told
            assert told < 0.2 or name == "one cell"  # of which nothing much is known, and that is told
            print(f"{kind} of the {gear} {1e-6 * value:.4g} MPa, changed by {off:.4f}, told {told:.4f}")
        peak, face = true.greatest_tension, true.face
        print(
            f"over even {face.over_even:.3f}, factors {face.face_factor:.3f} {cycle.face.greatest_face_load_factor:.3f}"
        )
        assert np.isfinite(face.tension).all()
        assert np.abs(peak.face_position) <= 0.5 * pair.face_widths[gear == "wheel"] + 1e-3
        assert peak.stress_Pa == pytest.approx(
            face.cycle_tension.max(), rel=max(0.01, true.errors["greatest_tension_Pa"])
        )
        assert 0.99 < face.over_even < 1.05 * cycle.face.greatest_face_load_factor
        assert abs(peak.face_position - most) < 3.0 * pair.module
