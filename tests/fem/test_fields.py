"""Fields must hold the loads: free edges, force and torque on the hub, the approach, Hertz under the contact."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import meshio
import numpy as np
import pytest

import fem
from fem.fields import draw_gears, loaded_fields
from fem.flamant import hertz_half_width
from fem.vtk import write_vtk_series


@pytest.fixture(scope="module")
def cycle(article_pair, article_bodies):
    return fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, beyond_path=False)


@pytest.fixture(scope="module")
def rings(article_pair, article_bodies):
    return draw_gears(article_pair, article_bodies, 1)


ROWS = (2, 35)  # two pairs in contact, and one


@pytest.fixture(scope="module", params=ROWS)
def state(request, article_pair, article_bodies, cycle, rings):
    return request.param, loaded_fields(article_pair, cycle, request.param, article_bodies, rings)


def on_circle(field, centre, radius):
    """Nodal stresses and displacements of the points at a radius, by angle."""
    away = field.points - centre
    r = np.linalg.norm(away, axis=1)
    some = np.flatnonzero(np.abs(r / radius - 1) < 1e-9)
    angle = np.arctan2(away[some, 1], away[some, 0])
    order = some[np.argsort(angle)]
    _, first = np.unique(np.round(np.sort(angle), 9), return_index=True)
    return order[first], np.sort(angle)[first]


def test_hub_bears_force_and_torque(article_pair, cycle, state):
    row, fields = state
    placed = article_pair.placement(float(np.nanmin(cycle.rho1[row])))
    total = cycle.force / article_pair.face_width
    for sign, gear, centre in ((-1, 0, np.zeros(2)), (1, 1, placed.wheel_centre)):
        field, radius = fields[gear], article_pair.bore_radii[gear]
        some, angle = on_circle(field, centre, radius)
        width = np.diff(np.append(angle, angle[0] + 2 * np.pi))
        width = 0.5 * (width + np.roll(width, 1))
        outward = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        xx, yy, _, xy = field.stress_Pa[some].T
        pull = np.stack(
            [xx * outward[:, 0] + xy * outward[:, 1], xy * outward[:, 0] + yy * outward[:, 1]], axis=1
        )
        force = np.sum(pull * (width * radius)[:, None], axis=0)
        # the hub's pull on the body (its outward normal points to the hub) balances the flank's force
        np.testing.assert_allclose(-force, -sign * total * placed.normal, rtol=0, atol=0.03 * total)
        torque = np.sum(radius * (outward[:, 0] * pull[:, 1] - outward[:, 1] * pull[:, 0]) * width * radius)
        assert abs(torque) == pytest.approx(total * article_pair.base_radii[gear], rel=0.01)


def test_hub_is_held_and_hubless_points_move(article_pair, state):
    _, fields = state
    for gear, field in enumerate(fields):
        centre = np.zeros(2) if gear == 0 else np.array([0.0, article_pair.axis_distance])
        some, _ = on_circle(field, centre, article_pair.bore_radii[gear])
        assert np.abs(field.displacement_m[some]).max() < 1e-18
        assert np.linalg.norm(field.displacement_m, axis=1).max() > 5e-6


def test_flanks_under_the_load_close_the_approach(article_pair, cycle, state):
    """Normal displacements of the two surfaces at the contact add up to the approach."""
    row, fields = state
    for column in np.flatnonzero(cycle.forces[row] > 0):
        placed = article_pair.placement(float(cycle.rho1[row, column]))
        together = 0.0
        for field, sign in zip(fields, (-1.0, 1.0), strict=True):
            nearest = np.argmin(np.linalg.norm(field.points - placed.contact_point, axis=1))
            assert np.linalg.norm(field.points[nearest] - placed.contact_point) < 5e-5
            together += sign * field.displacement_m[nearest] @ placed.normal
        # the nearest point of the picture lies some micrometres off the middle of the contact
        assert together == pytest.approx(cycle.approach[row], rel=0.05)


def test_greatest_mises_is_below_the_contact_as_hertz_says(article_pair, cycle, state):
    row, fields = state
    column = int(np.argmax(cycle.forces[row]))
    line_load = cycle.forces[row, column] / article_pair.face_width
    radius = article_pair.path_at(cycle.rho1[row, column]).radius
    a = float(hertz_half_width(line_load, radius, article_pair.reduced_modulus)[0])
    peak = 2 * line_load / (np.pi * a)
    placed = article_pair.placement(float(cycle.rho1[row, column]))
    for field, sign in zip(fields, (-1.0, 1.0), strict=True):
        near = np.linalg.norm(field.points - placed.contact_point, axis=1) < 3 * a
        top = np.flatnonzero(near)[np.argmax(field.von_mises_Pa[near])]
        depth = sign * (field.points[top] - placed.contact_point) @ placed.normal
        # plane strain, nu .3: .558 p at .70 a, and some of the tooth's own bending
        assert field.von_mises_Pa[top] == pytest.approx(0.558 * peak, rel=0.12)
        assert 0.4 * a < depth < 1.0 * a


def test_free_edges_are_free(article_pair, cycle, rings, state):
    """Top land: stress across the edge vanishes; fillet: the larger principal stress runs along it."""
    _, fields = state
    peak = max(field.von_mises_Pa.max() for field in fields)
    for gear, field in enumerate(fields):
        centre = np.zeros(2) if gear == 0 else np.array([0.0, article_pair.axis_distance])
        some, angle = on_circle(field, centre, article_pair.tip_radii[gear])
        outward = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        xx, yy, _, xy = field.stress_Pa[some].T
        across = xx * outward[:, 0] ** 2 + yy * outward[:, 1] ** 2 + 2 * xy * outward[:, 0] * outward[:, 1]
        assert np.sqrt(np.mean(across**2)) < 0.01 * peak


def test_strain_energy_is_the_work_of_the_load(article_pair, article_bodies, cycle, rings):
    """Energy of the linear part: half of force times deflection, by quadrature over the cells."""
    row = ROWS[1]
    fields = loaded_fields(article_pair, cycle, row, article_bodies, rings)
    energy = 0.0
    for field in fields:
        corners = field.points[field.cells[:, :3]]
        d, e = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        areas = 0.5 * np.abs(d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0])
        # the three middles integrate quadratics exactly
        energy += np.sum(areas[:, None] / 3 * field.energy_density_J_per_m3[field.cells[:, 3:]])
    column = int(np.argmax(cycle.forces[row]))
    force = cycle.forces[row, column]
    # the indentation grows as F ln F, so its work is a little more than half: between the two
    work = 0.5 * force * cycle.approach[row]
    assert energy * article_pair.face_width == pytest.approx(work, rel=0.04)


def test_names_and_shapes(state):
    _, fields = state
    for field in fields:
        assert set(field.point_data) == {
            "displacement_m",
            "stress_Pa",
            "von_mises_Pa",
            "principal_Pa",
            "energy_density_J_per_m3",
        }
        for values in field.point_data.values():
            assert len(values) == len(field.points)
            assert np.all(np.isfinite(values))
        assert np.all(field.principal_Pa[:, 0] >= field.principal_Pa[:, 1])
        assert field.cells.max() == len(field.points) - 1


def test_tip_edges_can_be_drawn(article_pair, article_bodies, rings):
    free = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies)
    row = int(np.flatnonzero(np.any(free.edge & (free.forces > 100), axis=1))[0])
    fields = loaded_fields(article_pair, free, row, article_bodies, rings)
    assert all(np.all(np.isfinite(field.von_mises_Pa)) for field in fields)


def test_time_series_for_paraview(tmp_path, article_pair, article_bodies, cycle):
    seen = []
    path = write_vtk_series(
        tmp_path, article_pair, cycle, article_bodies, [0, 7], lambda done, of: seen.append((done, of))
    )
    sets = ET.parse(path).getroot().findall("Collection/DataSet")
    assert [s.get("file") for s in sets] == [
        f"vtk/{gear}_{row:04d}.vtu" for row in (0, 7) for gear in ("pinion", "wheel")
    ]
    assert [float(s.get("timestep")) for s in sets] == pytest.approx([0.0125, 0.0125, 0.1875, 0.1875])
    back = meshio.read(tmp_path / sets[3].get("file"))
    assert back.point_data["displacement_m"].shape[1] == 3
    assert set(np.unique(back.cell_data["gear"][0])) == {1}
    assert len(np.unique(back.cell_data["tooth"][0])) == 40
    assert seen == [(1, 2), (2, 2)]


def test_rows_outside_the_cycle_are_refused(article_pair, article_bodies, cycle):
    with pytest.raises(fem.FemError, match="position"):
        loaded_fields(article_pair, cycle, 40, article_bodies)
