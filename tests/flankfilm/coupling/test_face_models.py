"""Models of the load over the face side by side: what ISO 6336-1 draws, and what it leaves out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from flankfilm.coupling import Flanks, LoadedTeeth, face_load_models
from flankfilm.coupling.mesh.face_models import _linear, left_out_by_iso
from gears import Alignment, Gear, GearPair, Lead

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, tolerance=0.05)


def models(bodies, slope, torque, pair=PAIR):
    flanks = Flanks(alignment=Alignment(slope), cells=16, face_model="slices")
    teeth = LoadedTeeth(pair, torque, compliance=replace(bodies, pair=pair), flanks=flanks)
    return face_load_models(teeth, teeth.cycle(4))


@pytest.mark.parametrize(("slope", "torque"), [(8e-6, 150.0), (-8e-6, 150.0), (60e-6, 40.0)])
def test_the_load_by_iso_is_linear_has_its_mean_and_its_factor_at_the_end_that_the_slope_closes(
    bodies, slope, torque
):
    found = models(bodies, slope, torque)
    load, x = found.line_load[-1], found.face_position / PAIR.face_width
    mean, factor = found.line_load[0].mean(), found.face_load_factor[-1]
    assert (factor > 2.0) == (abs(slope) > 50e-6)
    assert load.mean() == pytest.approx(mean, rel=0.02 if factor > 2.0 else 1e-9)  # cut off within a cell
    bears = np.flatnonzero(load)
    fall = np.diff(load[bears]) / np.diff(x[bears])
    assert fall == pytest.approx(np.full(len(bears) - 1, fall[0]), rel=1e-9)
    end = -0.5 * np.sign(slope)
    first = 0 if end < 0.0 else -1
    assert load[first] + fall[0] * (end - x[first]) == pytest.approx(mean * factor, rel=1e-9)
    most = int(np.argmax(found.line_load[0]))
    assert np.sign(found.face_position[most]) == np.sign(end)


@pytest.mark.parametrize("factor", [1.0, 1.3, 1.999, 2.01, 5.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_load_by_iso_is_the_whole_load(factor, side):
    x = np.linspace(-0.5, 0.5, 200_001)
    load = _linear(3.0, factor, side, x)
    assert np.trapezoid(load, x) == pytest.approx(3.0, rel=1e-6)
    assert load[0 if side < 0.0 else -1] == load.max() == pytest.approx(3.0 * factor)


def test_what_iso_leaves_out_is_named_gear_by_gear(bodies):
    crowned = replace(PAIR, wheel=Gear(teeth=30, lead=Lead(crowning=5e-6)))
    flanks = Flanks(alignment=Alignment(0.0, 50e-6), cells=8, face_model="walls")
    teeth = LoadedTeeth(crowned, 100.0, compliance=replace(bodies, pair=crowned), flanks=flanks)
    face = teeth.cycle(4).contact.face
    said = "crowning of the wheel, alignment across the plane of action, free ends of the face, running in"
    assert left_out_by_iso(face, crowned) == said
