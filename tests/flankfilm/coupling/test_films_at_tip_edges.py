"""Films and losses of helical pairs whose tip edges touch: dry beyond the path, balanced, and the spur limit."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import ehl
import fem
from flankfilm import coupling
from flankfilm.coupling import FilmModel, Flanks, LoadedTeeth, LubricatedCycle, lubricate
from flankfilm.coupling.drive.mesh_in_space import spatial_mesh
from flankfilm.coupling.mesh.cells import cells_of
from flankfilm.coupling.mesh.resolution import resolution_of
from flankfilm.output.line_model_errors import MEAN, deflection_of_lines, mean_of_lines
from gears import Gear, GearPair

PAIR = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=math.radians(18.0))
OIL = ehl.Lubricant(0.05, 19e-9, 870.0, temperature=353.15, eyring_stress=5e6)
SPEED, TORQUE = 300.0, 8.0
FREE, HELD = Flanks(beyond_path=True, cells=24), Flanks(beyond_path=False, cells=24)


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, tolerance=0.02)


def lubricated(bodies: fem.PairCompliance, flanks: Flanks, positions: int = 12) -> LubricatedCycle:
    teeth = LoadedTeeth(bodies.pair, TORQUE, compliance=bodies, flanks=flanks)
    dry = teeth.cycle(positions)
    return lubricate(teeth, dry, SPEED, OIL, resolution_of(0.01), FilmModel("dowson"), profiles=False)


@pytest.mark.slow
class TestFilms:
    @pytest.fixture(scope="class")
    @classmethod
    def free(cls, bodies: fem.PairCompliance) -> LubricatedCycle:
        return lubricated(bodies, FREE)

    def test_cells_beyond_the_path_are_dry(self, free):
        films, cells = free.over_lines, cells_of(free)
        loaded = cells.line_load > 0.0
        beyond = loaded & (cells.part == 0.0)
        assert beyond.any()
        for values in (
            films.minimum_thickness,
            films.central_thickness,
            films.hertz_pressure,
            films.half_width,
        ):
            assert not np.isfinite(values[beyond]).any()
            assert np.isfinite(
                values[cells.bear & films.counts & (cells.line_load > films.lightest_load)]
            ).all()
        assert not cells.bear[beyond].any()
        assert np.isfinite(films.least_film)
        edges = PAIR.points.A, PAIR.points.E
        assert edges[0] <= np.nanmin(cells.rho1) < np.nanmax(cells.rho1) <= edges[1]

    def test_the_torque_is_carried_by_the_levers_of_all_cells(self, free):
        levers = np.nan_to_num(free.contact.lines.levers[0], nan=1.0)
        across = (free.lines.force * levers).sum(axis=(1, 2)) * PAIR.helix.base_cosine
        assert across == pytest.approx(TORQUE / PAIR.base_radii[0], rel=1e-9)
        assert levers.min() < 1.0 - 1e-4
        forces = spatial_mesh(free.contact).load
        turning = forces[:, 5]  # of the pinion about its axis
        assert np.abs(turning) == pytest.approx(TORQUE, rel=1e-9)

    def test_films_change_the_stiffness_about_as_much_as_without_edges(self, bodies, free):
        """Edges carry a tenth of the load, and films soften by some per cent."""
        held = lubricated(bodies, HELD)
        changes = [
            each.secant_stiffness.mean() / each.dry.secant_stiffness.mean() - 1.0 for each in (free, held)
        ]
        assert changes[0] < 0.0
        assert changes[0] == pytest.approx(changes[1], rel=0.3)


@pytest.mark.slow
def test_model_errors_do_not_count_edges_that_are_in_the_model(bodies):
    held, free = (
        fem.mesh_cycle(PAIR, TORQUE, 6, bodies, cells=24, beyond_path=edges) for edges in (False, True)
    )
    for law in (1.0, 2.0):
        assert mean_of_lines(free, law) == pytest.approx(MEAN + law * free.flank_error, rel=1e-12)
        assert mean_of_lines(free, law) < 0.7 * mean_of_lines(held, law)
    assert deflection_of_lines(free) < 0.5 * deflection_of_lines(held)


@pytest.mark.slow
@pytest.mark.long
def test_tip_edges_lose_power_at_the_mean_friction(bodies):
    """Power of cells on the path by their films, of edges by friction and sliding: all of it heats both gears."""
    found = coupling.mesh_losses(
        PAIR, TORQUE, SPEED, OIL, tolerance=0.05, positions=8, compliance=bodies, flanks=FREE
    )
    slid = found.cycle.contact.edge_sliding(SPEED).mean()
    assert found.edge_loss == pytest.approx(found.mean_friction * slid, rel=1e-9)
    assert 0.0 < found.edge_loss < 0.3 * found.mesh_loss
    on_path = found.over_lines.power_lost.mean()
    assert on_path == pytest.approx(found.sliding_loss + found.rolling_loss, rel=found.error)
    assert found.heat.sum() == pytest.approx(found.mesh_loss, rel=1e-9)
    assert found.efficiency == pytest.approx(1.0 - found.mesh_loss / (TORQUE * SPEED), rel=1e-12)


@pytest.mark.slow
@pytest.mark.long
def test_a_small_helix_has_films_and_edges_of_the_spur_face():
    spur = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3)
    flanks, found = Flanks(beyond_path=True, cells=16), []
    for pair in (spur, replace(spur, helix_angle=1e-6)):
        known = fem.compliance(pair, tolerance=0.02)
        teeth = LoadedTeeth(pair, TORQUE, compliance=known, flanks=flanks)
        dry = teeth.cycle(16)
        found.append(
            lubricate(teeth, dry, SPEED, OIL, resolution_of(0.01), FilmModel("dowson"), profiles=False)
        )
    straight, twisted = found
    error = straight.error + twisted.error
    print(error, twisted.secant_stiffness / straight.secant_stiffness - 1.0)
    assert twisted.secant_stiffness == pytest.approx(straight.secant_stiffness, rel=error)
    assert twisted.transmission_error == pytest.approx(straight.transmission_error, rel=error)
    share = [np.sort(each.load_share, axis=1)[:, -2:] for each in found]
    assert share[1] == pytest.approx(share[0], abs=error)
    slid = twisted.contact.edge_sliding(SPEED)
    contact = straight.contact
    pressed = np.where(
        contact.edge & (contact.forces > 0.0), contact.forces * np.abs(contact.sliding(SPEED)), 0.0
    )
    assert slid.max() > 0.0
    assert slid == pytest.approx(pressed.sum(axis=1), abs=2.0 * error * slid.max())
