"""Root stress over the face together with contacts that move and with shafts."""

from __future__ import annotations

import numpy as np
import pytest

import fem
from fem.stress.face_fillets import root_influences
from gears import Alignment, Bearing, Gear, GearPair, Material, Shaft, ShaftSegment

STEEL, PA66 = Material(206e9, 0.3, 7850.0), Material(3e9, 0.4, 1140.0)
PLASTIC = GearPair(Gear(17), Gear(51), 2e-3, 20e-3, material=(STEEL, PA66)).with_backlash(600e-6)
PAIR = GearPair(Gear(20), Gear(30), 2e-3, 20e-3).with_backlash(100e-6)
BESIDE = Shaft(
    (ShaftSegment(0.035, 0.025), ShaftSegment(0.03, 0.4), ShaftSegment(0.135, 0.025)),
    (Bearing(0.005, 5e8), Bearing(0.195, 5e8)),
    0.05,
    0.0,
)
"""Bends beside its gear but not under it, so that an alignment does to the face what it does."""


@pytest.fixture(scope="module")
def plastic():
    return fem.compliance(PLASTIC, 0.05), fem.fillets(PLASTIC, 0.05)


@pytest.mark.long
@pytest.mark.slow
def test_even_loads_of_contacts_that_move_are_the_plane_s(plastic):
    bodies, roots = plastic
    given = {"compliance": bodies, "moving_contact": True}
    plane, over = (
        fem.root_stress(PLASTIC, fem.mesh_cycle(PLASTIC, 10.0, 6, **given, **more), roots)
        for more in ({}, {"cells": 8, "face_model": "walls"})
    )
    for name in ("pinion", "wheel"):
        one, other = getattr(over, name), getattr(plane, name)
        assert one.greatest_tension_Pa == pytest.approx(other.greatest_tension_Pa, rel=1e-8)
        assert one.greatest_compression_Pa == pytest.approx(other.greatest_compression_Pa, rel=1e-8)
        assert one.face.over_even == pytest.approx(1.0, abs=1e-8)


@pytest.mark.long
@pytest.mark.slow
def test_contacts_that_move_out_of_parallel_mirror(plastic):
    """The root feels where contacts move to, some hundredths of a module, and the load that the motion leaves."""
    bodies, roots = plastic

    def found(across: float, moving: bool):
        given = {"alignment": Alignment(across), "cells": 8, "face_model": "walls", "moving_contact": moving}
        return fem.root_stress(PLASTIC, fem.mesh_cycle(PLASTIC, 10.0, 6, bodies, **given), roots)

    one, other, still = found(60e-6, True), found(-60e-6, True), found(60e-6, False)
    for name in ("pinion", "wheel"):
        here, there, stays = (getattr(each, name) for each in (one, other, still))
        np.testing.assert_allclose(here.face.cycle_tension, there.face.cycle_tension[::-1], rtol=1e-7)
        assert min(here.face.over_even, stays.face.over_even) > 1.05
        assert 1e-4 < abs(here.greatest_tension_Pa / stays.greatest_tension_Pa - 1.0) < 0.05


@pytest.mark.slow
def test_what_single_cells_move_farther_changes_little(plastic):
    """The flanks' own motion grows with the load: as if all of it followed the cells' at once."""
    bodies, roots = plastic
    given = {"alignment": Alignment(60e-6), "cells": 32, "face_model": "walls", "beyond_path": False}
    moved, still = (
        fem.mesh_cycle(PLASTIC, 20.0, 8, bodies, moving_contact=moving, **given) for moving in (True, False)
    )
    found = fem.root_stress(PLASTIC, moved, roots)
    over = root_influences(roots, PLASTIC, "walls")
    for gear, (name, fillets) in enumerate(zip(("pinion", "wheel"), over, strict=True)):
        stress = getattr(found, name)
        row = int(np.argmax(stress.face.tension.max(axis=(1, 2))))
        pair = int(np.argmax(moved.forces[row]))
        rho, load = moved.flank_rho[gear][row, pair], moved.line_load[row, pair]
        own = rho - still.flank_rho[gear][row, pair] - (moved.transmission_error[row] if gear == 0 else 0.0)
        shift, z = own * (load.max() / load.mean() - 1.0), np.array([stress.greatest_tension.face_position])
        at = np.array([rho, rho + shift])
        near, far = fillets.tangential(0, at, np.stack([load, load]), z)[:, 0, 0].max(axis=-1)
        print(f"{name}: {far / near - 1.0:+.4f}")
        assert abs(far / near - 1.0) < 0.03


@pytest.mark.slow
def test_stress_on_shafts_is_that_of_the_alignment_that_they_come_to():
    bodies, roots = fem.compliance(PAIR, 0.05), fem.fillets(PAIR, 0.05)

    def found(**more):
        given = {"cells": 8, "face_model": "walls", "beyond_path": False}
        cycle = fem.mesh_cycle(PAIR, 100.0, 4, bodies, **given, **more)
        return fem.root_stress(PAIR, cycle, roots), cycle

    bent, cycle = found(shafts=(BESIDE, None))
    slope = cycle.face.shaft_misalignment.sum(axis=0)
    assert slope.min() > 5e-6
    for row in (0, 2):
        given, _ = found(alignment=Alignment(float(slope[row])))
        for name in ("pinion", "wheel"):
            one, other = (getattr(each, name).face.tension[row] for each in (bent, given))
            np.testing.assert_allclose(one, other, atol=3e-3 * other.max())
    assert bent.pinion.face.over_even > 1.05
    assert bent.pinion.greatest_tension.face_position < 0.0
