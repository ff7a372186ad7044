"""Twisted teeth, flanks and lines of contact for ParaView: exact flanks, balance, the contact's compliance."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from math import radians

import numpy as np
import pytest

from base import Array, InputError
from fem import MeshCycle, PairCompliance, compliance, field_blocks, mesh_cycle
from fem.elasticity.lengthened import FacePieces
from fem.elasticity.line_load import flank_points
from fem.elasticity.prism import prism
from fem.fields.face_fields import face_fields
from fem.fields.helix_fields import HelixFields, helix_fields
from fem.fields.helix_solids import CellLoads, TwistedGear, twisted_gears
from fem.fields.loaded_gears import frames
from fem.fields.paraview_state import STATE
from fem.fields.vtk import write_vtk_series
from fem.influence.gear_face import section_of
from fem.pair.line_compliance import gear_lines
from gears import Gear, GearPair
from meshes import Sizes
from tests.tooth_surfaces import blocks_of, check_closed, check_loads, check_values

PAIR = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=radians(18.0))
WIDER = replace(PAIR, pinion=replace(PAIR.pinion, face_width=6e-3))
TORQUE, ROWS = 8.0, 4


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(PAIR, tolerance=0.02)


@pytest.fixture(scope="module")
def cycle(bodies: PairCompliance) -> MeshCycle:
    return mesh_cycle(PAIR, TORQUE, ROWS, bodies, cells=16)


@pytest.fixture(scope="module")
def solids(bodies: PairCompliance, cycle: MeshCycle) -> tuple[TwistedGear, TwistedGear]:
    assert cycle.lines is not None
    return twisted_gears(bodies, cycle.lines.slope)


@pytest.fixture(scope="module")
def drawn(bodies, cycle, solids) -> list[HelixFields]:
    return [helix_fields(PAIR, cycle, row, bodies, solids) for row in range(ROWS)]


def untwisted(points: Array, pair: GearPair, cycle: MeshCycle, row: int, gear: int) -> Array:
    """Points of the common frame in the section of tooth 0 at mid-face."""
    angle, centre = frames(pair, float(pair.points.A + cycle.position[row] * pair.base_pitch))[gear]
    slope = (1 - 2 * gear) * np.tan(pair.helix.base_angle)
    turn = -angle - slope / pair.base_radii[gear] * points[:, 2]
    x, y = (points[:, :2] - centre).T
    return np.stack([np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y], axis=-1)


def off_the_flank(points: Array, pair: GearPair, gear: int) -> Array:
    """Distance of points of a section from the nearest left involute [m], along the circle."""
    profile = pair.teeth_profiles[gear]
    radius = np.linalg.norm(points, axis=1)
    # from a tooth's centre line on +y the left involute is at the half angle anticlockwise
    off = np.arctan2(-points[:, 0], points[:, 1]) - profile.half_angle(radius)
    pitch = profile.pitch_angle
    return np.asarray(radius * np.abs((off + 0.5 * pitch) % pitch - 0.5 * pitch))


@pytest.mark.slow
def test_flanks_lines_and_teeth_are_on_the_exact_involute_turned_by_the_helix(drawn, cycle):
    for row, fields in enumerate(drawn):
        for gear, one in enumerate((fields.pinion, fields.wheel)):
            lines = fields.lines.points[np.unique(fields.lines.cells[fields.lines.gear == gear])]
            for points in (one.flanks.points, lines):
                section = untwisted(points, PAIR, cycle, row, gear)
                assert off_the_flank(section, PAIR, gear).max() < 1e-13
            # nodes of the solid: as many of each layer are on the flank of every tooth
            teeth = one.teeth.points
            near = off_the_flank(untwisted(teeth, PAIR, cycle, row, gear), PAIR, gear) < 1e-13
            by_layer = [int(near[np.abs(teeth[:, 2] - z) < 1e-12].sum()) for z in np.unique(teeth[:, 2])]
            assert min(by_layer) == max(by_layer) >= 7 * len(np.unique(one.teeth.tooth))


@pytest.mark.slow
def test_both_gears_touch_along_the_same_lines(drawn, cycle):
    for row, fields in enumerate(drawn):
        lines = fields.lines
        ends = [lines.points[lines.cells[lines.gear == gear]] for gear in (0, 1)]
        assert np.abs(ends[0] - ends[1]).max() < 1e-14
        length = np.linalg.norm(np.diff(ends[0], axis=1), axis=2).sum()
        assert length == pytest.approx(cycle.lines.whole_length[row], rel=1e-12)


@pytest.mark.slow
def test_forces_add_up_to_the_torque_and_the_axial_force(drawn):
    across = TORQUE / PAIR.base_radii[0]
    for fields in drawn:
        lines = fields.lines
        middles = lines.points[lines.cells].mean(axis=1)
        for gear, sense in ((0, 1.0), (1, -1.0)):
            own = lines.gear == gear
            force = lines.force_N[own].sum(axis=0)
            assert np.hypot(*force[:2]) == pytest.approx(across, rel=1e-9)
            assert force[2] == pytest.approx(sense * PAIR.axial_force(TORQUE), rel=1e-9)
            at = middles[own] - [0.0, gear * sum(PAIR.pitch_radii), 0.0]
            torque = np.cross(at, lines.force_N[own])[:, 2].sum()
            # against the driving turn of the pinion; chords of cells are straight
            assert torque == pytest.approx(-across * PAIR.base_radii[gear], rel=1e-9)


@pytest.mark.slow
def test_pressures_over_areas_are_the_forces_and_stay_below_hertz_s(drawn, cycle):
    pyvista = pytest.importorskip("pyvista")
    for row, fields in enumerate(drawn):
        for one in (fields.pinion, fields.wheel):
            flanks = one.flanks
            grid = pyvista.UnstructuredGrid({pyvista.CellType.QUAD: flanks.cells}, flanks.points)
            force = flanks.pressure_Pa * grid.compute_cell_sizes(length=False, volume=False)["Area"]
            by_pair = [force[flanks.pair == offset].sum() for offset in cycle.pair_offset]
            # viewers have no single area of a quadrangle that is not plane
            assert by_pair == pytest.approx(cycle.forces[row], rel=1e-6, abs=1e-9)
            loaded = flanks.pressure_Pa > 0.0
            # at tips, where half of the width is beyond the edge, the other half has it all
            within = flanks.pressure_Pa[loaded] / flanks.hertz_pressure_Pa[loaded]
            assert np.quantile(within, 0.9) < 1.05
            assert flanks.pressure_Pa.max() > 0.9 * np.nanmax(cycle.lines.hertz_pressure[row])
            assert np.all(loaded <= (flanks.line_load_N_per_m > 0.0))


@pytest.mark.slow
def test_tip_edges_press_on_the_exact_flanks_and_are_said(bodies, solids):
    """Lines that go on beyond the path: forces of both gears' flanks, and places held to the ends of the path."""
    pyvista = pytest.importorskip("pyvista")
    free = mesh_cycle(PAIR, TORQUE, 2, bodies, cells=16, beyond_path=True)
    lines = free.lines
    assert lines is not None
    for row in range(2):
        fields = helix_fields(PAIR, free, row, bodies, solids)
        edges = lines.force[row][np.isfinite(lines.z[row]) & (lines.on_path[row] == 0.0)].sum()
        for gear, one in enumerate((fields.pinion, fields.wheel)):
            flanks = one.flanks
            grid = pyvista.UnstructuredGrid({pyvista.CellType.QUAD: flanks.cells}, flanks.points)
            force = flanks.pressure_Pa * grid.compute_cell_sizes(length=False, volume=False)["Area"]
            by_pair = [force[flanks.pair == offset].sum() for offset in free.pair_offset]
            # quadrangles are less plane where a line turns along the tip
            assert by_pair == pytest.approx(free.forces[row], rel=1e-4, abs=1e-9)
            at_edges = flanks.tip_edge == 1
            assert force[at_edges].sum() == pytest.approx(edges, rel=1e-4)
            assert not np.isfinite(flanks.hertz_pressure_Pa[at_edges]).any()
            section = untwisted(flanks.points, PAIR, free, row, gear)
            assert off_the_flank(section, PAIR, gear).max() < 1e-12
        own = fields.lines.points
        assert np.isfinite(own).all()
    assert edges > 0.0


@pytest.mark.slow
def test_other_teeth_yield_as_the_contact_says(bodies, cycle, solids):
    """The contact's compliance is waves of a fine section with what free ends add, apart from this solid."""
    row, lines = 1, cycle.lines
    touching = np.flatnonzero(cycle.forces[row] > 0.0)
    for gear, (solid, of_gear) in enumerate(zip(solids, gear_lines(bodies, lines.slope), strict=True)):
        side, module = 1 - 2 * gear, PAIR.module
        first, second = (np.isfinite(lines.z[row, k]) for k in touching[:2])
        (near, far), cosine = touching[:2], PAIR.helix.base_cosine
        felt = []
        for column, used in ((near, first), (far, second)):
            along = lines.z[row, column, used], lines.rho[gear][row, column, used]
            felt.append(
                of_gear.line(int(cycle.pair_offset[column]), *along, lines.length[row, column] * cosine)
            )
        force = lines.force[row, near, first]
        by_contact = force @ of_gear.between(*felt, 0.0)
        loads = CellLoads(
            lines.rho[gear][row, near, first],
            lines.z[row, near, first],
            force,
            lines.length[row, near] * cosine,
        )
        numbers = [side * int(cycle.pair_offset[column]) for column in (near, far)]
        moved = solid.moved([loads], numbers[:1], numbers[1:])[0]
        at = flank_points(solid.mesh, felt[1].line.rho)
        along = solid.pieces.values(felt[1].line.z)
        there = np.einsum("nk,nkpa,np->na", at.weights, moved[at.nodes], along)
        slope = side * lines.slope
        normal = cosine * np.column_stack([at.inward, np.full(len(there), slope)])
        assert module * felt[1].line.length == pytest.approx(lines.length[row, far] * cosine)
        found = np.einsum("na,na->n", there, normal)
        assert np.abs(by_contact).max() > 1e-8
        assert np.abs(found - by_contact).max() < 0.06 * np.abs(by_contact).max()


@pytest.mark.slow
def test_finer_solids_move_alike_away_from_contacts(bodies, cycle, solids, drawn):
    """Displacement of the loaded teeth's other flanks and roots on twice as fine a section with more pieces."""
    coarse, row, lines = solids[0], 1, cycle.lines
    over = section_of(
        bodies.meshed[0],
        Sizes(flank=0.3, fillet=0.3, root=0.6, corner=0.3, top=1.0, growth=1.0, rim=2.0, layer_growth=2.0),
        0,
        lines.slope / bodies.meshed[0].shape.profile.base_radius,
    )
    pieces = FacePieces(np.linspace(-2.5, 2.5, 4))
    fine = replace(coarse, solid=prism(over, pieces.face()), pieces=pieces)
    loads, numbers = [], []
    for column in np.flatnonzero(cycle.forces[row] > 0.0).tolist():
        used = np.isfinite(lines.z[row, column])
        loads.append(
            CellLoads(
                lines.rho[0][row, column, used],
                lines.z[row, column, used],
                lines.force[row, column, used],
                lines.length[row, column] * PAIR.helix.base_cosine,
            )
        )
        numbers.append(int(cycle.pair_offset[column]))
    rho = np.linspace(2.0, 4.0, 5)
    found = []
    for solid in (coarse, fine):
        moved = solid.moved(loads, numbers, numbers)
        at = flank_points(solid.mesh, rho, "right")
        along = solid.pieces.values(np.linspace(-2.4, 2.4, 7))
        found.append(np.einsum("nk,tnkpa,zp->tnza", at.weights, moved[:, at.nodes], along))
    assert np.abs(found[0] - found[1]).max() < 0.02 * np.abs(found[1]).max()


@pytest.mark.slow
def test_a_series_is_read_back_by_others(bodies, cycle, tmp_path):
    meshio = pytest.importorskip("meshio")
    series = write_vtk_series(tmp_path, PAIR, cycle, bodies, (1, 3))
    entries = ET.parse(series).findall(".//DataSet")
    names = ["pinion", "wheel", "pinion_flanks", "wheel_flanks", "lines"]
    assert [entry.get("name") for entry in entries] == 2 * names
    lines = meshio.read(tmp_path / "vtk" / "lines_0003.vtu")
    assert {block.type for block in lines.cells} == {"line"}
    force, gear = lines.cell_data["force_N"][0], lines.cell_data["gear"][0]
    assert force[gear == 0].sum(axis=0)[2] == pytest.approx(PAIR.axial_force(TORQUE), rel=1e-9)
    teeth = meshio.read(tmp_path / "vtk" / "wheel_0001.vtu")
    assert {block.type for block in teeth.cells} == {"wedge"}
    text = (tmp_path / STATE).read_text(encoding="utf-8")
    compile(text, STATE, "exec")
    assert "$" not in text
    assert all(f'"{name}"' in text for name in names)


@pytest.mark.slow
def test_wedges_are_right_way_round_and_cover_a_wider_gear(bodies):
    pytest.importorskip("pyvista")
    wider = replace(bodies, pair=WIDER)
    cycle = mesh_cycle(WIDER, TORQUE, 2, wider, cells=12)
    blocks = field_blocks(WIDER, cycle, 0, wider)
    assert blocks["pinion"].bounds[4:] == pytest.approx((-3e-3, 3e-3))
    assert blocks["wheel"].bounds[4:] == pytest.approx((-2.5e-3, 2.5e-3))
    assert blocks["pinion_flanks"].bounds[4:] == pytest.approx((-3e-3, 3e-3))
    for name in ("pinion", "wheel"):
        assert blocks[name].compute_cell_sizes(length=False, area=False)["Volume"].min() > 0.0


@pytest.mark.slow
def test_what_cannot_be_drawn_is_refused(bodies, cycle, solids):
    with pytest.raises(InputError, match="must be 0 for fields"):
        face_fields(PAIR, cycle, 0, bodies)
    with pytest.raises(InputError, match=r"row = 4.*at most 3"):
        helix_fields(PAIR, cycle, 4, bodies, solids)
    spur = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3)
    flat = compliance(spur, tolerance=0.05)
    with pytest.raises(InputError, match="must have lines of contact"):
        helix_fields(spur, mesh_cycle(spur, TORQUE, 2, flat), 0, flat)


@pytest.mark.slow
def test_surfaces_for_a_page_hold_the_teeth_and_the_lines_of_contact(bodies, cycle):
    for row in (0, ROWS // 2):
        blocks = blocks_of(PAIR, cycle, row, bodies)
        check_closed(PAIR, blocks)
        check_values(PAIR, blocks)
        loads = check_loads(PAIR, blocks, TORQUE)
        length = np.linalg.norm(np.diff(loads.ends, axis=1)[:, 0], axis=1)
        assert -(length @ loads.load)[2] == pytest.approx(cycle.lines.axial_force, rel=1e-6)
