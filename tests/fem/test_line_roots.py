"""Root stress of helical pairs over a mesh cycle: the spur limit, the other hand, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base import InputError
from fem import compliance, fillets, line_fillets, mesh_cycle, root_stress
from gears import Alignment, Gear, GearPair

GEAR = Gear(teeth=18, profile_shift=0.2, bore_radius=8e-3)
SPUR = GearPair(GEAR, GEAR, module=2e-3, face_width=12e-3)
TORQUE, POSITIONS, CELLS, ASKEW = 80.0, 6, 16, Alignment(in_plane=8e-6)


def stresses(pair):
    """Root stress of a pair out of parallel, and its cycle."""
    bodies = compliance(pair, tolerance=0.02)
    options = {"alignment": ASKEW, "cells": CELLS, "beyond_path": False}
    cycle = mesh_cycle(pair, TORQUE, POSITIONS, bodies, **options)
    of_pair = line_fillets if pair.helix_angle else fillets
    return root_stress(pair, cycle, of_pair(pair, tolerance=0.05)), cycle


@pytest.mark.slow
@pytest.mark.long
def test_a_helix_of_a_milliradian_is_the_spur_pair():
    """Other waves, other ends, another contact: within 1 % a module from the ends, maxima within both errors."""
    (helical, lines), (spur, cells) = (stresses(replace(SPUR, helix_angle=angle)) for angle in (1e-3, 0.0))
    assert lines.lines is not None
    assert cells.face is not None
    for name in ("pinion", "wheel"):
        one, other = getattr(helical, name), getattr(spur, name)
        for field, key in (("tension", "greatest_tension_Pa"), ("compression", "greatest_compression_Pa")):
            mine, theirs = (np.abs(getattr(of.face, field)).max(axis=(0, 1)) for of in (one, other))
            at = np.interp(other.face.face_position, one.face.face_position, mine)
            off = at / theirs - 1.0
            print(name, field, np.round(off, 3), one.errors[key], other.errors[key])
            place = np.abs(other.face.face_position)
            assert np.abs(off[place < 0.5 * SPUR.face_width - SPUR.module]).max() < 0.01
            assert abs(mine.max() / theirs.max() - 1.0) < one.errors[key] + other.errors[key]


@pytest.mark.slow
@pytest.mark.long
def test_the_other_hand_mirrors_the_face_and_forces_are_needed():
    pair = replace(SPUR, helix_angle=0.3)
    right, cycle = stresses(pair)
    assert cycle.lines is not None
    gear = right.pinion
    assert gear.helical
    assert 0.0 < gear.errors["greatest_tension_Pa"] < 0.2
    assert gear.greatest_tension_Pa == pytest.approx(gear.face.cycle_tension.max(), rel=0.01)
    # the stress is linear in the forces
    loaded = cycle.lines
    twice = replace(cycle, lines=replace(loaded, line_load=2.0 * loaded.line_load, fewer=2.0 * loaded.fewer))
    roots = line_fillets(pair, tolerance=0.05)
    doubled = root_stress(pair, twice, roots)
    assert doubled.pinion.greatest_tension_Pa == pytest.approx(2.0 * gear.greatest_tension_Pa, rel=1e-9)
    # back flanks and other hands: the axis counted the other way
    mirrored = replace(pair, helix_angle=-0.3)
    bodies = compliance(mirrored, tolerance=0.02)
    options = {"alignment": replace(ASKEW, in_plane=-ASKEW.in_plane), "cells": CELLS}
    left = root_stress(
        mirrored, mesh_cycle(mirrored, TORQUE, POSITIONS, bodies, **options), line_fillets(mirrored, 0.05)
    )
    for one, other in ((right.pinion, left.pinion), (right.wheel, left.wheel)):
        np.testing.assert_allclose(one.face.cycle_tension[::-1], other.face.cycle_tension, rtol=5e-3)
    with pytest.raises(InputError, match="must be LineFillets"):
        root_stress(pair, cycle, fillets(SPUR, tolerance=0.1))


def test_spur_pairs_have_no_fillets_of_lines():
    with pytest.raises(InputError, match="must be helical"):
        line_fillets(SPUR)
