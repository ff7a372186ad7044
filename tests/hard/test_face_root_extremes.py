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
