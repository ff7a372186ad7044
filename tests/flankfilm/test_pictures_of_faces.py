"""Flank maps: what is painted stands where its pair touches, and nothing where nothing bears."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from base.results import EXACT
from fem import FaceLoads, MeshCycle, compliance, mesh_cycle
from flankfilm.figures.face import FlankMap, face_load_factor, flank_map
from flankfilm.figures.reading import Reading, read_figure
from flankfilm.figures.views import register
from flankfilm.output.variables import figure_of, of_quantities, of_record
from gears import Alignment, Gear, GearPair

register()

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)


@pytest.fixture(scope="module")
def cycle() -> MeshCycle:
    bodies = compliance(PAIR, tolerance=0.05)
    alignment = Alignment(40e-6)
    return mesh_cycle(PAIR, 50.0, 8, bodies, alignment=alignment, cells=8, face_model="slices")


def painted(axes):
    (mesh,) = axes.collections
    return mesh


def test_cells_stand_at_the_travel_of_their_pair():
    travel = Reading(np.array([[0.5, 1.5], [1.0, np.nan]]), "travel", "mm")
    loads = Reading(np.array([[[1.0, 0.0], [5.0, 6.0]], [[3.0, 4.0], [9.0, 9.0]]]), "line load", "N/mm")
    found = FlankMap.of(travel, Reading(np.array([-1.0, 1.0]), "face", "mm"), loads)
    assert found.travel.tolist() == [0.5, 1.0, 1.5]
    np.testing.assert_array_equal(found.values.values, [[1.0, np.nan], [3.0, 4.0], [5.0, 6.0]])


def test_teeth_that_come_by_one_after_the_other_show_the_greatest():
    travel = Reading(np.array([[0.5], [0.5 + 1e-13]]), "travel", "mm")
    loads = Reading(np.array([[[1.0, 7.0]], [[2.0, np.nan]]]), "line load", "N/mm")
    found = FlankMap.of(travel, Reading(np.array([-1.0, 1.0]), "face", "mm"), loads)
    np.testing.assert_array_equal(found.values.values, [[2.0, 7.0]])


def test_the_map_of_a_record_holds_its_loads(cycle: MeshCycle):
    assert isinstance(cycle.face, FaceLoads)
    load, pressure, *bars = cycle.face.plot().axes
    grid = painted(load).get_array()
    assert float(grid.max()) == pytest.approx(1e-3 * cycle.face.greatest_line_load)
    # the axes open the gap where z > 0: the greatest load stands on the other side, and the far end lifts off
    row, _ = np.unravel_index(np.ma.argmax(grid), grid.shape)
    assert row < 4
    assert np.ma.getmaskarray(grid)[-1].all()
    assert load.get_ylim() == (-10.0, 10.0)
    assert [axes.get_ylabel() for axes in bars] == ["line load [N/mm]", "Hertz pressure [MPa]"]
    assert pressure.get_xlabel() == "travel along the path of contact from A [mm]"
    # forces of all pairs, from the map alone
    widths = np.diff(painted(load).get_coordinates()[0, :, 0])
    assert np.ptp(widths) <= 2.1e-9  # places are rounded to 1e-9 mm
    total = grid.filled(0.0).sum() * PAIR.face_width / 8 * 1e3
    assert total == pytest.approx(cycle.forces.sum(), rel=1e-12)


def test_the_map_of_a_cycle_stands_above_its_factor(cycle: MeshCycle):
    _, factor, stiffness, error, _ = cycle.plot().axes
    assert np.allclose(factor.lines[0].get_ydata(), np.tile(cycle.face_load_factor, 2))
    assert np.allclose(stiffness.lines[0].get_ydata(), 1e-6 * np.tile(cycle.dense_secant_stiffness, 2))
    assert np.allclose(error.lines[0].get_ydata(), 1e6 * np.tile(cycle.dense_transmission_error, 2))


def test_the_map_of_a_dataset_is_that_of_the_record(cycle: MeshCycle):
    points = PAIR.points
    path = (
        figure_of(
            "rho1", "m", "radius", "point", [getattr(points, name) for name in "ABCDE"], no_error=EXACT
        ),
    )
    parts = (
        of_quantities("path_point", path),
        of_record("dry_face", cycle.face),
        of_record("dry", cycle, ["position"]),
    )
    results = xr.merge(parts).rename_dims(path_point_point="path_point").assign(path_point=list("ABCDE"))
    first, second = flank_map(results).axes[0], cycle.face.plot().axes[0]
    np.testing.assert_allclose(painted(first).get_array(), painted(second).get_array())
    curve = face_load_factor(results).axes[0].lines[0]
    assert np.allclose(curve.get_ydata(), np.tile(cycle.face_load_factor, 2))
    with pytest.raises(ValueError, match="lead or an alignment"):
        flank_map(results.drop_vars("dry_face_travel"))


def test_pressures_at_tip_edges_are_not_given(cycle: MeshCycle):
    assert cycle.face is not None
    edges = cycle.edge & (cycle.forces > 0.0)
    flanks = ~cycle.edge & (cycle.forces > 0.0)
    assert edges.any()
    assert np.isnan(cycle.face.hertz_pressure[edges]).all()
    assert np.isfinite(cycle.face.hertz_pressure[flanks]).all()
    travel = read_figure(cycle.face, "travel").values
    start, end = 0.0, 1e3 * (PAIR.points.E - PAIR.points.A)
    assert ((travel[edges] < start) | (travel[edges] > end)).all()
