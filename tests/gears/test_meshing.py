"""Rolling the generated flanks, and the outlines."""

from __future__ import annotations

import math
from dataclasses import fields

import numpy as np
import pytest

from gears import Gear, GearPair, GeometryError, TipRelief, check_meshing, outline
from gears.tooth.profile import ToothProfile

PAIRS = {
    "article": (Gear(36), Gear(40), None),
    "undercut by a hair": (Gear(17), Gear(43), None),
    "shifted": (Gear(14, 0.4), Gear(33, 0.2), None),
    "given distance and chamfers": (Gear(36, tip_chamfer=2e-4), Gear(40, 0.2, tip_chamfer=1e-4), 77e-3),
    "large wheel drives": (Gear(90, -0.2), Gear(19, 0.3), None),
}


@pytest.mark.parametrize("name", PAIRS)
def test_flanks_keep_the_ratio_and_nothing_interferes(name):
    pinion, wheel, distance = PAIRS[name]
    pair = GearPair(pinion, wheel, 2e-3, 0.02, centre_distance=distance)
    pair = pair.with_backlash(pair.backlash + 4e-5)
    found = check_meshing(pair, positions=9)
    assert found.angle_deviation < 1e-12
    assert found.back_clearance == pytest.approx(pair.backlash, abs=1e-13)
    assert found.overlap < 1e-12
    assert min(found.tip_clearances) > 0
    widest = [
        pair.working_centre_distance - t - r
        for t, r in zip(pair.tip_radii, pair.root_radii[::-1], strict=True)
    ]
    assert all(c <= w + 1e-12 for c, w in zip(found.tip_clearances, widest, strict=True))


def test_without_backlash_both_flanks_touch():
    found = check_meshing(GearPair(Gear(25), Gear(31), 2e-3, 0.02), positions=7)
    assert abs(found.back_clearance) < 1e-15


class Bent(ToothProfile):
    """A tooth whose flank is off by a nanometre at one end."""

    def half_angle(self, radius):
        return super().half_angle(radius) + 1e-9 / 0.04 * (radius / 0.04 - 1)


def test_the_check_sees_a_wrong_flank(monkeypatch, article_pair):
    """A nanometre shows in the transmitted angle."""
    first, second = article_pair.teeth_profiles
    bent = Bent(**{field.name: getattr(second, field.name) for field in fields(second) if field.init})
    monkeypatch.setattr(GearPair, "teeth_profiles", property(lambda pair: (first, bent)))
    assert check_meshing(article_pair, positions=5).angle_deviation > 1e-10


def test_the_check_sees_a_tip_in_the_fillet(monkeypatch, article_pair):
    """Teeth moved together by more than the clearance overlap."""
    distance = article_pair.working_centre_distance

    def nearer(by):
        monkeypatch.setattr(GearPair, "working_centre_distance", property(lambda pair: distance - by))
        return check_meshing(article_pair, positions=5)

    assert min(nearer(0.0).tip_clearances) > 0
    assert max(nearer(0.6e-3).tip_clearances) < 0
    assert nearer(0.0).overlap < 1e-12
    assert nearer(0.1e-3).overlap > 1e-5


def area(polygon):
    x, y = polygon[:, 0], polygon[:, 1]
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def test_outline_is_closed_anticlockwise_and_encloses_the_gear(article_pair):
    tooth = article_pair.teeth_profiles[0]
    ring = outline(tooth)
    assert np.array_equal(ring[0], ring[-1])
    assert np.all(np.linalg.norm(np.diff(ring, axis=0), axis=1) > 0)
    # teeth and gaps are about equally wide at the reference circle, so the area is near that of its disc
    assert area(ring) == pytest.approx(math.pi * tooth.reference_radius**2, rel=0.02)
    for part in (outline(tooth, teeth=1), outline(tooth, teeth=4)):
        # mirror images: nearest point of the outline to each mirrored point
        off = np.linalg.norm(part[:, None] * [-1, 1] - part[None], axis=-1).min(axis=1)
        assert off.max() < 1e-12
    few = outline(tooth, teeth=5)
    sector = math.pi * tooth.bore_radius**2 * 5 / 36
    assert area(few) + sector == pytest.approx(area(ring) * 5 / 36, rel=1e-3)


def test_outline_draws_relief_inwards_and_refuses_teeth_it_has_not():
    gear = Gear(30, tip_relief=TipRelief(2e-5, 1e-3))
    tooth = GearPair(gear, Gear(40), 2e-3, 0.02).teeth_profiles[0]
    assert (
        area(outline(tooth)) > area(outline(tooth, relief_scale=1.0)) > area(outline(tooth, relief_scale=2.0))
    )
    with pytest.raises(GeometryError) as caught:
        outline(tooth, teeth=31, points_per_part=1)
    assert [f.where for f in caught.value.faults] == ["teeth", "points_per_part"]
    with pytest.raises(GeometryError):
        check_meshing(GearPair(gear, Gear(40), 2e-3, 0.02), positions=1)
