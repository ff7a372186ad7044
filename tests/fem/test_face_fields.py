"""Teeth and flanks over the face: pressures add up to forces, an even load moves the solid as in the plane."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from base import InputError
from fem import MeshCycle, PairCompliance, compliance, field_blocks, mesh_cycle
from fem.fields.face_fields import face_fields
from fem.fields.face_waves import gear_prisms
from fem.fields.stress_fields import draw_gears, loaded_fields
from fem.fields.vtk import write_vtk_series
from gears import Alignment, Gear, GearPair
from tests.tooth_surfaces import blocks_of, check_closed, check_loads, check_values

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
TORQUE = 100.0
ROWS = 8


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(PAIR, tolerance=0.02)


@pytest.fixture(scope="module")
def cycle(bodies: PairCompliance) -> MeshCycle:
    return mesh_cycle(PAIR, TORQUE, ROWS, bodies, alignment=Alignment(40e-6), cells=16, face_model="walls")


@pytest.fixture(scope="module")
def prisms(bodies: PairCompliance):
    return gear_prisms(bodies)


def areas(points, quads):
    """Of plane quadrangles, by their diagonals."""
    a, b, c, d = (points[quads[:, k]] for k in range(4))
    return 0.5 * np.linalg.norm(np.cross(c - a, d - b), axis=1)


def test_pressures_over_areas_are_the_forces(bodies, prisms, cycle):
    for row in range(ROWS):
        for field in face_fields(PAIR, cycle, row, bodies, prisms):
            flanks = field.flanks
            force = flanks.pressure_Pa * areas(flanks.points, flanks.cells)
            for offset, whole in zip(cycle.pair_offset, cycle.forces[row], strict=True):
                assert force[flanks.pair == offset].sum() == pytest.approx(whole, rel=1e-11, abs=1e-9)
    # beyond the path a tip edge presses, and its force is there too
    assert (cycle.forces[cycle.edge] > 0.0).any()


def test_pressures_stay_below_hertz_s_greatest_and_come_near_it(bodies, prisms, cycle):
    row = ROWS // 2
    flanks = face_fields(PAIR, cycle, row, bodies, prisms)[0].flanks
    on_flanks = flanks.tip_edge == 0
    assert (flanks.pressure_Pa <= flanks.hertz_pressure_Pa + 1e-6)[on_flanks].all()
    assert flanks.pressure_Pa.max() > 0.95 * np.nanmax(cycle.face.hertz_pressure[row])


def test_flanks_of_both_gears_touch_where_they_press(bodies, prisms, cycle):
    """Middles of the pressures of both gears stand within rounding of the flanks' meshes of each other."""
    row = ROWS // 2
    middles = []
    for field in face_fields(PAIR, cycle, row, bodies, prisms):
        flanks = field.flanks
        force = flanks.pressure_Pa * areas(flanks.points, flanks.cells) * (flanks.pair == 0)
        middles.append(force @ flanks.points[flanks.cells].mean(axis=1) / force.sum())
    assert np.linalg.norm(middles[0] - middles[1]) < 2e-3 * PAIR.module
    # the axes open the gap where z > 0
    assert middles[0][2] < 0.0


def test_an_even_load_moves_the_solid_as_in_the_plane(bodies, prisms):
    even = mesh_cycle(PAIR, TORQUE, ROWS, bodies, cells=8, face_model="walls")
    plane = mesh_cycle(PAIR, TORQUE, ROWS, bodies)
    row = ROWS // 2
    drawings = draw_gears(PAIR, bodies, 1)
    for solid, flat in zip(
        face_fields(PAIR, even, row, bodies, prisms),
        loaded_fields(PAIR, plane, row, bodies, drawings),
        strict=True,
    ):
        teeth = solid.teeth
        assert np.abs(teeth.displacement_m[:, 2]).max() < 1e-12
        size, tree = np.linalg.norm(flat.displacement_m, axis=1).max(), cKDTree(flat.points)
        for z in (-10e-3, 10e-3):
            here = np.abs(teeth.points[:, 2] - z) < 1e-9
            found, at = teeth.displacement_m[here, :2], teeth.points[here, :2]
            apart, near = tree.query(at)
            same = apart < 1e-8
            assert same.sum() > 100
            off = np.linalg.norm(found - flat.displacement_m[near], axis=1)[same]
            # but beside the loads, where the mesh has no Hertz pressure
            assert np.quantile(off, 0.9) < 0.02 * size


def test_loads_by_free_ends_move_the_solid_between_walls(bodies, prisms, cycle):
    """The picture is that of its line loads alone, whatever coupled their cells."""
    free = replace(cycle, face=replace(cycle.face, setting=replace(cycle.face.setting, model="free-ends")))
    for walled, ended in zip(
        face_fields(PAIR, cycle, 4, bodies, prisms), face_fields(PAIR, free, 4, bodies), strict=True
    ):
        np.testing.assert_array_equal(ended.teeth.displacement_m, walled.teeth.displacement_m)
        np.testing.assert_array_equal(ended.flanks.displacement_m, walled.flanks.displacement_m)


def test_teeth_bend_most_where_they_bear_most(bodies, prisms, cycle):
    row = ROWS // 2
    pinion, wheel = (one.teeth for one in face_fields(PAIR, cycle, row, bodies, prisms))
    for teeth in (pinion, wheel):
        size = np.linalg.norm(teeth.displacement_m, axis=1)
        near, far = (size[np.abs(teeth.points[:, 2] - z) < 1e-9].max() for z in (-10e-3, 10e-3))
        assert near > 1.3 * far
        assert np.abs(teeth.displacement_m[:, 2]).max() > 0.01 * size.max()


def test_gaps_are_those_that_are_left(bodies, prisms, cycle):
    loads, gap = cycle.face.line_load, cycle.face.gap
    assert (gap[loads > 0.0] == 0.0).all()
    assert (gap[np.isfinite(gap)] >= 0.0).all()
    # lifted cells of a pair that bears: the gap grows towards the open end
    row, column = np.argwhere((loads > 0.0).any(axis=-1) & (loads == 0.0).any(axis=-1))[0]
    assert (np.diff(gap[row, column]) >= -1e-9).all()
    assert 0.0 < gap[row, column, -1] < 40e-6


def test_a_series_is_read_back(bodies, cycle, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    series = write_vtk_series(tmp_path, PAIR, cycle, bodies, (1, 5))
    entries = ET.parse(series).findall(".//DataSet")
    names = [f"{gear}{part}" for part in ("", "_flanks") for gear in ("pinion", "wheel")]
    assert [entry.get("name") for entry in entries] == 2 * names
    times = sorted({float(str(entry.get("timestep"))) for entry in entries})
    assert times == pytest.approx(cycle.position[[1, 5]])
    for row in (1, 5):
        for gear in ("pinion", "wheel"):
            flanks = pyvista.read(tmp_path / "vtk" / f"{gear}_flanks_{row:04d}.vtu")
            area = flanks.compute_cell_sizes(length=False, volume=False)["Area"]
            assert float(flanks["pressure_Pa"] @ area) == pytest.approx(cycle.forces[row].sum(), rel=1e-9)
            teeth = pyvista.read(tmp_path / "vtk" / f"{gear}_{row:04d}.vtu")
            volume = teeth.compute_cell_sizes(length=False, area=False)["Volume"]
            assert volume.min() > 0.0
            assert teeth.bounds[4:] == pytest.approx((-10e-3, 10e-3))


def test_both_gears_turn(bodies, cycle):
    blocks = {row: field_blocks(PAIR, cycle, row, bodies) for row in (3, 5)}

    def lean(row, name):
        teeth = blocks[row][name]
        points = teeth.extract_cells(np.flatnonzero(teeth["tooth"] == 0)).points
        x, y = points[:, :2].mean(axis=0) - [0.0, 0.0 if name == "pinion" else sum(PAIR.pitch_radii)]
        return np.arctan2(y, x)

    step = (cycle.position[5] - cycle.position[3]) * PAIR.base_pitch
    for name, sign, radius in zip(("pinion", "wheel"), (1.0, -1.0), PAIR.base_radii, strict=True):
        turned = lean(5, name) - lean(3, name)
        assert turned == pytest.approx(sign * step / radius, rel=1e-5)


def test_what_cannot_be_drawn_is_refused(bodies, prisms, cycle):
    plane = mesh_cycle(PAIR, TORQUE, ROWS, bodies)
    with pytest.raises(InputError, match="must have cells of the face"):
        face_fields(PAIR, plane, 0, bodies, prisms)
    with pytest.raises(InputError, match=r"row = 8.*at most 7"):
        face_fields(PAIR, cycle, 8, bodies, prisms)
    with pytest.raises(InputError, match="must have converged"):
        face_fields(PAIR, replace(cycle, forces=np.nan * cycle.forces), 0, bodies, prisms)
    with pytest.raises(InputError, match="must be even along the face"):
        loaded_fields(PAIR, cycle, 0, bodies)


@pytest.mark.slow
def test_surfaces_for_a_page_hold_the_teeth_and_the_loads(bodies, cycle):
    held = [blocks_of(PAIR, cycle, row, bodies) for row in (0, ROWS // 2)]
    check_closed(PAIR, held[0])
    for row, blocks in zip((0, ROWS // 2), held, strict=True):
        check_values(PAIR, blocks)
        loads = check_loads(PAIR, blocks, TORQUE)
        # the largest line load of the cycle, at its cell
        assert np.linalg.norm(loads.load, axis=1).max() == pytest.approx(cycle.line_load[row].max(), rel=1e-2)
