"""Face-load factor over a tolerance of the alignment: both ends count, and crowning is weighed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from base import InputError
from flankfilm.coupling import Flanks, LoadedTeeth, face_load_tolerance
from gears import Alignment, Gear, GearPair, Lead

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
MEANT, TOLERANCE = 12e-6, 10e-6


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, tolerance=0.05)


def teeth(bodies, lead: Lead, in_plane: float = MEANT) -> LoadedTeeth:
    pair = replace(PAIR, pinion=replace(PAIR.pinion, lead=lead))
    flanks = Flanks(alignment=Alignment(in_plane), cells=16, face_model="walls")
    return LoadedTeeth(pair, 100.0, compliance=replace(bodies, pair=pair), flanks=flanks)


def robust(bodies, crowning: float, slope: float = -MEANT) -> float:
    given = teeth(bodies, Lead(crowning=crowning, slope=slope))
    return face_load_tolerance(given, TOLERANCE, positions=8).robust_face_load_factor


def test_both_ends_of_the_tolerance_are_loaded_alike_where_the_slope_undoes_the_alignment(bodies):
    found = face_load_tolerance(teeth(bodies, Lead(crowning=4e-6, slope=-MEANT)), TOLERANCE, positions=8)
    np.testing.assert_allclose(found.in_plane, [2e-6, 12e-6, 22e-6])
    less, meant, more = found.face_load_factor
    assert less == pytest.approx(more, rel=1e-6)
    assert found.robust_face_load_factor == max(less, more) > meant
    assert 0.0 < found.error < 0.05


def test_factors_are_those_of_the_cycles_and_none_between_is_greater(bodies):
    given = teeth(bodies, Lead(crowning=4e-6, slope=-5e-6))
    found = face_load_tolerance(given, TOLERANCE, positions=8)
    between = []
    for in_plane in np.linspace(MEANT - TOLERANCE, MEANT + TOLERANCE, 9):
        cycle = teeth(bodies, Lead(crowning=4e-6, slope=-5e-6), float(in_plane)).cycle(8).contact
        assert cycle is not None
        assert cycle.face is not None
        between.append(cycle.face.greatest_face_load_factor)
    assert found.face_load_factor == pytest.approx([between[0], between[4], between[8]])
    assert max(between) == pytest.approx(found.robust_face_load_factor)


def test_some_crowning_is_best_and_a_slope_that_is_off_costs(bodies):
    factors = [robust(bodies, crowning) for crowning in (0.0, 3e-6, 6e-6, 20e-6)]
    assert 0 < int(np.argmin(factors)) < 3
    assert robust(bodies, 4e-6) < robust(bodies, 4e-6, slope=-MEANT + 4e-6)


def test_a_tolerance_below_nothing_is_refused(bodies):
    with pytest.raises(InputError, match=r"tolerance.*at least 0"):
        face_load_tolerance(teeth(bodies, Lead()), -1e-6)
