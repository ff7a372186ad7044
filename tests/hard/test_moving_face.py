"""Contacts that move on cells of the face, of random pairs, beside those that stay: solved, whole, and consistent."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import fem
from gears import Alignment, Bearing, Gear, GearPair, Lead, Material, Shaft, ShaftSegment, TipRelief

STEEL, ALUMINIUM = Material(206e9, 0.3, 7850.0), Material(70e9, 0.33, 2700.0)
PA66, POM = Material(3e9, 0.4, 1140.0), Material(2.8e9, 0.35, 1410.0)
BOTH = ((STEEL, PA66), (PA66, STEEL), (POM, POM), (STEEL, STEEL), (ALUMINIUM, PA66))
MODULE, CHANGE = 2e-3, 1e-4


def _lead(rng: np.random.Generator, width: float) -> Lead:
    return Lead(
        crowning=float(rng.choice([0.0, 1.0, 1.0]) * rng.uniform(0.0, 60e-6)),
        slope=float(rng.choice([0.0, 0.0, 1.0]) * rng.uniform(-20e-6, 20e-6)),
        end_relief=float(rng.choice([0.0, 0.0, 1.0]) * rng.uniform(5e-6, 40e-6)),
        end_relief_length=float(rng.uniform(0.05, 0.3) * width),
    )


def _drawn(seed: int) -> tuple[GearPair, float, dict[str, Any]]:
    """Draw a pair, its torque [N m] and how the face is looked at."""
    rng = np.random.default_rng(seed)
    first = int(rng.integers(17, 40))
    second, width = int(rng.integers(first, 80)), float(MODULE * rng.uniform(4.0, 20.0))
    both = BOTH[rng.integers(len(BOTH))]
    relief = TipRelief(float(rng.uniform(10e-6, 60e-6)), float(rng.uniform(0.3, 0.9) * MODULE))
    eased = relief if rng.random() < 0.4 else None
    wide = float(rng.uniform(1.05, 1.4) * width) if rng.random() < 0.3 else None
    pinion = Gear(first, tip_relief=eased, lead=_lead(rng, width), face_width=wide)
    wheel = Gear(second, tip_relief=eased, lead=_lead(rng, width))
    pair = GearPair(pinion, wheel, MODULE, width, material=both).with_backlash(900e-6)
    line_load = 10 ** rng.uniform(-1.0, 1.7) * (2e4 if both == (STEEL, STEEL) else 1e3)
    options: dict[str, Any] = {
        "cells": int(rng.choice([8, 16, 32, 64])),
        "face_model": "walls" if rng.random() < 0.85 else "slices",
        "friction": float(rng.choice([0.0, 0.0, 0.1])),
        "tip_rounding": float(rng.choice([0.0, 0.0, 60e-6])),
        "beyond_path": bool(rng.random() < 0.75),
    }
    if rng.random() < 0.3:
        length = 3 * width + 0.05
        bearings = Bearing(0.005, 3e8), Bearing(length - 0.005, 3e8)
        slender = ShaftSegment(length, 0.9 * MODULE * first)
        options["shafts"] = Shaft((slender,), bearings, 1.2 * width + 0.02, 0.0), None
    else:
        options["alignment"] = Alignment(float(rng.uniform(-60e-6, 60e-6)), float(rng.uniform(0.0, 200e-6)))
    return pair, float(line_load * width * pair.base_radii[0]), options


def _off(cycles: tuple[fem.MeshCycle, ...]) -> float:
    """By what part the tangent differs from the slope between three torques."""
    less, same, more = cycles
    slope = (more.force - less.force) / (more.transmission_error - less.transmission_error)
    return float(np.abs(same.stiffness / slope - 1.0).max())


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::base.RangeWarning")
@pytest.mark.parametrize("seed", range(20))
def test_random_pairs(seed):
    pair, torque, options = _drawn(seed)
    bodies = fem.compliance(pair, tolerance=0.01, tip_edges=options["beyond_path"])
    torques = torque * np.array([1 - CHANGE, 1.0, 1 + CHANGE])
    stays, moves = (
        fem.mesh_cycle(pair, torques, 10, bodies, moving_contact=moving, **options)
        for moving in (False, True)
    )
    found = moves[1]
    assert found.converged, found.message
    np.testing.assert_allclose(found.load_share.sum(axis=1), 1.0, rtol=1e-12)
    begins = np.diff((found.line_load > 0.0).astype(int), axis=-1, prepend=0) == 1
    assert np.all(np.count_nonzero(begins, axis=-1)[found.forces > 0.0] == 1)  # one piece of the face
    # cells that bear in part change where they bear, which neither tangent counts
    assert _off(moves) < 1.5 * _off(stays) + 2e-4
    bent = torque / pair.base_radii[0] * (1 / found.secant_stiffness - 1 / stays[1].secant_stiffness)
    assert np.abs(bent).max() < 0.04 * np.abs(found.force / found.secant_stiffness).max()
