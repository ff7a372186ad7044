"""Gears of unequal width: against equally wide ones with more cells, symmetry, overhangs that stiffen, faults."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base import InputError
from fem import PairCompliance, compliance, mesh_cycle
from fem.contact.cell_matrix import cell_matrix
from fem.pair.face_setting import FaceSetting
from gears import Alignment, Bearing, Gear, GearPair, Heat, Lead, Shaft, ShaftSegment, warm_pair

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
TORQUE = 100.0


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(PAIR, tolerance=0.02)


def _wide(
    pinion: float | None, wheel: float | None = None, offsets=(0.0, 0.0), both: float = 20e-3
) -> GearPair:
    first = replace(PAIR.pinion, face_width=pinion, face_offset=offsets[0])
    second = replace(PAIR.wheel, face_width=wheel, face_offset=offsets[1])
    return replace(PAIR, pinion=first, wheel=second, face_width=both)


def _cycle(bodies, pair, face_model="walls", torque=TORQUE, **more):
    return mesh_cycle(pair, torque, 8, replace(bodies, pair=pair), face_model=face_model, **more)


def _matrix(bodies, pair, cells, model):
    own = replace(bodies, pair=pair)
    rho1 = np.array([[pair.points.A + 0.2 * pair.base_pitch, pair.points.A + 1.2 * pair.base_pitch]])
    rho = np.stack([rho1, pair.line_of_action - rho1])
    found = cell_matrix(FaceSetting(cells, model=model), own, rho, own.bulk(rho1))
    return found.reshape(2, cells, 2, cells)


@pytest.mark.parametrize("model", ["walls", pytest.param("free-ends", marks=pytest.mark.slow)])
def test_a_part_of_the_face_yields_as_a_part_of_equally_wide_gears(bodies, model):
    """Both gears 24 mm wide, loaded on 20 mm of them, are those two by two whose one gear is that wide."""
    plain = _matrix(bodies, PAIR, 20, model)
    apart = [_matrix(bodies, pair, 20, model) - plain for pair in (_wide(24e-3), _wide(None, 24e-3))]
    equal = _matrix(bodies, replace(PAIR, face_width=24e-3), 24, model)[:, 2:22, :, 2:22]
    np.testing.assert_allclose(plain + sum(apart), equal, atol=1e-10 * np.abs(plain).max())


def test_a_part_at_one_side_likewise(bodies):
    plain = _matrix(bodies, PAIR, 20, "walls")
    one, other = _wide(24e-3, None, (1e-3, 0.0)), _wide(None, 24e-3, (0.0, 1e-3))
    apart = [_matrix(bodies, pair, 20, "walls") - plain for pair in (one, other)]
    equal = _matrix(bodies, replace(PAIR, face_width=24e-3), 24, "walls")[:, 1:21, :, 1:21]
    np.testing.assert_allclose(plain + sum(apart), equal, atol=1e-10 * np.abs(plain).max())


def test_cells_that_do_not_divide_the_face_find_the_same(bodies):
    """A factor between those of widths whose cells divide it; a hair wider is as wide."""
    factors = [
        float(_cycle(bodies, _wide(width), cells=20).face_load_factor[3]) for width in (22e-3, 22.7e-3, 24e-3)
    ]
    assert factors[0] < factors[1] < factors[2]
    hair = _cycle(bodies, _wide(20.00001e-3), cells=16)
    np.testing.assert_allclose(hair.line_load, _cycle(bodies, PAIR, cells=16).line_load, rtol=1e-4)


def test_a_face_of_its_own_as_wide_as_the_pair_gives_the_same_digits(bodies):
    same = _cycle(bodies, _wide(20e-3, 20e-3), cells=16, alignment=Alignment(20e-6))
    plain = _cycle(bodies, PAIR, cells=16, alignment=Alignment(20e-6))
    np.testing.assert_array_equal(same.line_load, plain.line_load)
    assert mesh_cycle(_wide(20e-3), TORQUE, 8, replace(bodies, pair=_wide(20e-3))).face is None


def test_overhangs_stiffen_the_ends_and_are_counted_unasked(bodies):
    found = _cycle(bodies, _wide(25e-3))
    assert found.face is not None
    load = found.line_load[3].sum(axis=0)
    np.testing.assert_allclose(load, load[::-1], rtol=1e-8)
    assert load[0] == load.max() > 1.1 * load.mean()
    assert (np.diff(load[:32]) < 0.0).all()
    np.testing.assert_allclose(found.line_load.sum(axis=-1) * 20e-3 / 64, found.forces, rtol=1e-12, atol=1e-9)
    # what goes on beyond the load holds it up
    assert found.stiffness[3] > mesh_cycle(PAIR, TORQUE, 8, bodies).stiffness[3]


def test_an_offset_mirrored_mirrors_the_loads(bodies):
    one, other = (_cycle(bodies, _wide(24e-3, None, (by, 0.0)), cells=16) for by in (2e-3, -2e-3))
    np.testing.assert_allclose(one.line_load, other.line_load[..., ::-1], rtol=1e-8)
    # set off to the right, the pinion goes on there alone
    assert (one.line_load[..., -1].sum(axis=1) > one.line_load[..., 0].sum(axis=1)).all()


def test_leads_are_those_of_the_gears_own_faces(bodies):
    """Crowning of 16 um over 40 mm is 4 um over the 20 mm in contact; set off it tilts, as a slope does."""
    wide = _wide(40e-3)
    crowned = replace(wide, pinion=replace(wide.pinion, lead=Lead(crowning=16e-6)))
    same = replace(wide, wheel=replace(wide.wheel, lead=Lead(crowning=4e-6)))
    first, second = (_cycle(bodies, pair, cells=16) for pair in (crowned, same))
    np.testing.assert_allclose(first.line_load, second.line_load, rtol=1e-7)
    away = replace(crowned, pinion=replace(crowned.pinion, face_offset=5e-3))
    # C (2 (z - o)/b_g)^2 = 4 um (2 z/b)^2 - 8 C o z/b_g^2 + ...: -8 um over the face
    tilted = replace(same, pinion=replace(same.pinion, face_offset=5e-3))
    first, second = (
        _cycle(bodies, away, cells=16),
        _cycle(bodies, tilted, cells=16, alignment=Alignment(-8e-6)),
    )
    np.testing.assert_allclose(first.line_load, second.line_load, rtol=1e-6, atol=1.0)


def test_sizes_follow_the_gears_own_width():
    wide = _wide(25e-3)
    assert wide.face_widths == (25e-3, 20e-3)
    assert wide.moments_of_inertia[0] == pytest.approx(1.25 * PAIR.moments_of_inertia[0])
    assert wide.moments_of_inertia[1] == PAIR.moments_of_inertia[1]
    warm = warm_pair(_wide(25e-3, None, (1e-3, 0.0)), Heat(pinion_temperature=353.15)).pair
    grown = warm.face_width / 20e-3
    assert warm.pinion.face_width == pytest.approx(25e-3 * grown)
    assert warm.pinion.face_offset == pytest.approx(1e-3 * grown)


@pytest.mark.parametrize(
    ("pair", "named", "remedy"),
    [
        ({"pinion": 15e-3}, "pinion.face_width", "at least 0.02 m"),
        ({"pinion": 24e-3, "offsets": (3e-3, 0.0)}, "pinion.face_width", "at least 0.026 m"),
        ({"pinion": 25e-3, "wheel": 24e-3}, "face_width", "must be 0.024 m"),
        ({"pinion": 25e-3, "wheel": 24e-3, "offsets": (2e-3, 0.0)}, "face_width", "face_offset"),
        ({"pinion": -1.0}, "pinion.face_width", "None for the pair's"),
    ],
)
def test_faces_that_are_not_all_in_contact_are_refused(pair, named, remedy):
    with pytest.raises(InputError, match=named.replace(".", r"\.")) as told:
        _wide(**{"pinion": None} | pair)
    assert remedy in str(told.value)


def test_a_refusals_remedy_is_accepted():
    """Pinion 25 mm, wheel 24 mm, 2 mm apart: 22.5 mm in contact, whose middle is .75 mm beside the wheel's."""
    with pytest.raises(InputError, match=r"0\.00125 m of the pinion and -0\.00075 m of the wheel") as told:
        _wide(25e-3, 24e-3, (2e-3, 0.0))
    assert "0.0225 m" in str(told.value)
    _wide(25e-3, 24e-3, (1.25e-3, -0.75e-3), 22.5e-3)


def test_a_shaft_has_its_gear_at_the_middle_of_the_gears_own_face(bodies):
    ends = Bearing(0.005, 5e8), Bearing(0.195, 5e8)

    def shaft(at: float) -> Shaft:
        return Shaft((ShaftSegment(0.2, 0.025),), ends, at, 0.0)

    plain = _cycle(bodies, _wide(24e-3, None, (2e-3, 0.0)), cells=16, shafts=(shaft(0.072), None))
    moved = _cycle(bodies, _wide(24e-3, None, (-2e-3, 0.0)), cells=16, shafts=(shaft(0.068), None))
    np.testing.assert_allclose(plain.face.shaft_misalignment[0], moved.face.shaft_misalignment[0], rtol=0.05)
