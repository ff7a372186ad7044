"""Films that reach the back flanks: against Martin's cylinders, and against the cells of a face loaded evenly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import ehl
import fem
from flankfilm.coupling import FilmModel, Flanks, LoadedTeeth, LubricatedCycle, lubricate
from flankfilm.coupling.mesh.resolution import resolution_of
from gears import Alignment, Gear, GearPair

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3)
OIL = ehl.Lubricant(0.05, 19e-9, 870.0)
SPEED, TORQUE = 200.0, 2.0
Cycles = Callable[..., LubricatedCycle]


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR.with_backlash(300e-6), tolerance=0.02)


@pytest.fixture(scope="module")
def cycles(bodies) -> Cycles:
    def lubricated(
        backlash: float, positions: int = 40, cells: int | None = None, **given
    ) -> LubricatedCycle:
        pair = PAIR.with_backlash(backlash)
        even = None if cells is None else Alignment()
        flanks = Flanks(alignment=even, cells=cells, face_model="walls")
        teeth = LoadedTeeth(pair, TORQUE, compliance=replace(bodies, pair=pair), flanks=flanks)
        film = FilmModel(**given)
        return lubricate(teeth, teeth.cycle(positions), SPEED, OIL, resolution_of(0.01), film, profiles=False)

    return lubricated


@pytest.mark.slow
@pytest.mark.parametrize("backlash", [30e-6, 15e-6, 8e-6, 3e-6])
def test_films_on_back_flanks_carry_as_rigid_cylinders_in_an_isoviscous_oil(cycles, backlash):
    r"""Martin's F = 4.896 eta u R b/h, over the path; h is the backlash and what the front flanks are apart."""
    cycle = cycles(backlash).contact
    rho1 = np.linspace(PAIR.points.A, PAIR.points.E, 2001)
    path = PAIR.path_at(rho1)
    product = np.trapezoid(path.entrainment(SPEED) * path.radius, rho1) / PAIR.base_pitch
    height = backlash + cycle.transmission_error
    martin = 4.896 * OIL.viscosity * product * PAIR.face_width / height
    # viscosity grows a little, by 5 % in the narrowest gap
    assert cycle.opposite_force.mean() == pytest.approx(martin.mean(), rel=0.07)
    net = cycle.forces.sum(axis=1) - cycle.opposite_force
    np.testing.assert_allclose(net * PAIR.base_radii[0], TORQUE, rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("backlash", [300e-6, 15e-6, 3e-6])
def test_the_plane_is_one_cell_of_the_face(cycles, backlash):
    """Forces of both sides, deflection and stiffness with films: those of cells under even loads, to rounding."""
    plane, face = (cycles(backlash, 8, cells) for cells in (None, 4))
    for name in ("forces", "transmission_error", "stiffness", "secant_stiffness", "least_film", "error"):
        np.testing.assert_allclose(getattr(plane, name), getattr(face, name), rtol=1e-9)
    np.testing.assert_allclose(plane.contact.opposite_force, face.contact.opposite_force, rtol=1e-9)
    for name, error in face.errors.items():
        assert plane.errors[name] == pytest.approx(error, rel=1e-5)
    assert plane.over_face is None
