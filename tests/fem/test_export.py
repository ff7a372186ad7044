"""Loaded gears for other programs: balance of the forces, and decks that say what they should."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse.linalg import splu

import fem
from base import InputError
from fem.elasticity.plane_elasticity import stiffness_matrix
from fem.fields.export import export_pair, export_position, write_abaqus
from fem.fields.loaded_gears import flank_forces, loaded_gears
from meshes import Sizes

TORQUE = 600.0


@pytest.fixture(scope="module")
def cycles(article_pair, article_bodies):
    return {
        beyond: fem.mesh_cycle(article_pair, TORQUE, 40, article_bodies, beyond_path=beyond, reference="bore")
        for beyond in (False, True)
    }


def moment(gear):
    arm = gear.mesh.points - gear.axis
    return float(np.sum(arm[:, 0] * gear.forces[:, 1] - arm[:, 1] * gear.forces[:, 0]))


def solved(gear):
    """Displacements with the bore held."""
    stiffness = stiffness_matrix(gear.mesh.points, gear.mesh.triangles, gear.law) * gear.face_width
    free = np.ones(len(gear.mesh.points), dtype=bool)
    free[np.unique(gear.mesh.facets["bore"])] = False
    free = np.repeat(free, 2)
    moved = np.zeros(stiffness.shape[0])
    factor = splu(stiffness[free][:, free], permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    moved[free] = factor.solve(gear.forces.ravel()[free])
    return moved.reshape(-1, 2)


@pytest.mark.parametrize("spread", ["hertz", "line"])
@pytest.mark.parametrize("row", [3, 20])
def test_the_torque_comes_back_exactly_on_the_path(article_pair, cycles, row, spread):
    pinion, wheel = loaded_gears(article_pair, cycles[False], row, spread, refinements=0)
    ratio = article_pair.base_radii[1] / article_pair.base_radii[0]
    # an edge's parabola leaves the involute by some 1e-6 of its length, so the lever is not exact
    assert moment(pinion) == pytest.approx(-TORQUE, rel=3e-6)
    assert moment(wheel) == pytest.approx(-TORQUE * ratio, rel=3e-6)
    if spread == "line":
        np.testing.assert_allclose(pinion.forces.sum(axis=0), -wheel.forces.sum(axis=0), rtol=1e-12)


@pytest.mark.parametrize("row", [28, 33, 38])
def test_edges_press_against_flanks(article_pair, cycles, row):
    assert np.any(cycles[True].edge[row] & (cycles[True].forces[row] > 0))
    pinion, wheel = loaded_gears(article_pair, cycles[True], row, "line", refinements=0)
    np.testing.assert_allclose(pinion.forces.sum(axis=0), -wheel.forces.sum(axis=0), rtol=1e-12)
    # the gears stand as when unloaded, and turn by gap/r_b (5e-4) until an edge touches
    assert moment(pinion) == pytest.approx(-TORQUE, rel=5e-4)


def test_pressure_and_line_load_have_one_resultant(article_pair, cycles):
    for loads in flank_forces(article_pair, cycles[False], 3):
        assert all(load.half_width > 5e-5 for load in loads)
    spread, line = (
        loaded_gears(article_pair, cycles[False], 3, kind, refinements=0)[0].forces
        for kind in ("hertz", "line")
    )
    # the flank's normal turns over the contact, by a/rho = 0.02 near A to either side: the rest is of second order
    np.testing.assert_allclose(spread.sum(axis=0), line.sum(axis=0), rtol=5e-4)
    assert np.count_nonzero(spread) >= np.count_nonzero(line)


@pytest.mark.slow
def test_the_work_of_the_forces_is_that_of_the_compliance(article_pair, article_bodies, cycles):
    """2 W = F D, once the approach within a Hertz pressure is its mean instead of that at its middle.

    At its middle a half-plane moves by 2/(pi E*) [ln(2/a) + 1/2 - ...], in the mean over the pressure by
    2/(pi E*) [ln(2/a) + 1/4 - ...]: both gears together lose w/(2 pi) (1/E1* + 1/E2*).
    """
    cycle = cycles[False]
    sizes = Sizes(flank=0.03)
    for row in (4, 31):
        gears = loaded_gears(article_pair, cycle, row, loaded_sizes=sizes, refinements=0)
        work = sum(float(np.sum(gear.forces * solved(gear))) for gear in gears)
        force = cycle.forces[row]
        mean = sum(1 / gear.law.plane_modulus for gear in gears) / (2 * np.pi * article_pair.face_width)
        expected = cycle.force * cycle.transmission_error[row] - mean * np.sum(force**2)
        assert work == pytest.approx(expected, rel=1e-3)


def test_a_part_of_the_gear(article_pair, cycles):
    whole, part = (
        loaded_gears(article_pair, cycles[False], 3, refinements=0, neighbours=n)[0] for n in (None, 1)
    )
    assert len(np.unique(whole.mesh.tooth)) == 36
    assert np.unique(part.mesh.tooth).tolist() == [-1, 0, 1, 2]  # two pairs, tooth 0 entered last
    assert moment(part) == pytest.approx(moment(whole), rel=1e-12)


def test_decks(tmp_path, article_pair, cycles):
    gears = loaded_gears(article_pair, cycles[False], 20, refinements=0, neighbours=0)
    for form in ("inp", "msh"):
        files = export_pair(tmp_path / form, gears, form)
        assert [f.name for f in files] == [f"pinion.{form}", f"wheel.{form}"]
        assert sorted(f.name for f in (tmp_path / form).iterdir()) == [f.name for f in files]
    lines = (tmp_path / "inp" / "pinion.inp").read_text().splitlines()
    start, end = lines.index("*CLOAD") + 1, lines.index("*NODE PRINT, NSET=GEAR")
    loads = np.zeros_like(gears[0].forces)
    for node, component, value in (line.split(",") for line in lines[start:end]):
        loads[int(node) - 1, int(component) - 1] = float(value)
    np.testing.assert_allclose(loads, gears[0].forces, rtol=1e-13)
    assert "*ELEMENT, TYPE=CPE6" in lines
    thickness = lines[lines.index("*SOLID SECTION, ELSET=GEAR, MATERIAL=MATERIAL") + 1]
    assert float(thickness) == 0.04
    assert lines[lines.index("*BOUNDARY") + 1] == "BORE, 1, 2"


def test_one_call_for_a_position(tmp_path, article_pair, article_bodies):
    files = export_position(tmp_path, article_pair, TORQUE, 0.25, "inp", article_bodies, refinements=0)
    assert [f.name for f in files] == ["pinion.inp", "wheel.inp"]
    before = [f.read_bytes() for f in files]
    export_position(tmp_path, article_pair, TORQUE, 0.25, "inp", article_bodies, refinements=0)
    assert before == [f.read_bytes() for f in files]
    with pytest.raises(InputError, match="position"):
        export_position(tmp_path, article_pair, TORQUE, 1.5)


def test_plane_stress_is_a_thin_slice(tmp_path, article_pair):
    cycle = fem.mesh_cycle(article_pair, TORQUE, 4, plane="stress")
    gear = loaded_gears(article_pair, cycle, 0, refinements=0, neighbours=0)[0]
    lines = write_abaqus(tmp_path / "a.inp", gear).read_text().splitlines()
    assert "*ELEMENT, TYPE=CPS6" in lines
    thickness = float(lines[lines.index("*SOLID SECTION, ELSET=GEAR, MATERIAL=MATERIAL") + 1])
    start, end = lines.index("*CLOAD") + 1, lines.index("*NODE PRINT, NSET=GEAR")
    total = sum(float(line.split(",")[2]) for line in lines[start:end] if line.split(",")[1].strip() == "1")
    assert total / thickness == pytest.approx(gear.forces[:, 0].sum() / 0.04, rel=1e-9)


def test_what_is_refused(tmp_path, article_pair, cycles):
    with pytest.raises(InputError, match="row"):
        loaded_gears(article_pair, cycles[True], 40)
    with pytest.raises(InputError, match="spread"):
        flank_forces(article_pair, cycles[True], 0, "point")
    with pytest.raises(InputError, match="format"):
        export_pair(tmp_path, (), "nas")
    with pytest.raises(InputError, match="cut"):
        loaded_gears(article_pair, cycles[True], 0, loaded_sizes=Sizes(rim=0.3), refinements=0)
