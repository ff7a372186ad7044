"""Fields must hold the loads: free edges, force and torque on the hub, the approach, Hertz under the contact."""

from __future__ import annotations

import pickle
import xml.etree.ElementTree as ET
from dataclasses import replace

import meshio
import numpy as np
import pytest

import fem
from base import InputError
from fem.elasticity.flamant import hertz_half_width
from fem.elasticity.ring import mesh_and_factor
from fem.fields.contact_forces import contact_forces
from fem.fields.grids import rounded, single_precision, write_grid
from fem.fields.picture import picture_of
from fem.fields.stress_fields import REGIONS, draw_gears, loaded_fields
from fem.fields.vtk import write_vtk_series
from fem.stress.tooth_root import root_stress
from meshes import Sizes


@pytest.fixture(scope="module")
def cycle(article_pair, article_bodies):
    return fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, beyond_path=False, reference="bore")


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
        centre = np.zeros(2) if gear == 0 else np.array([0.0, article_pair.working_centre_distance])
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
        assert together == pytest.approx(cycle.transmission_error[row], rel=0.05)


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
        # plane strain, nu 0.3: 0.558 p at 0.70 a, and some of the tooth's own bending
        assert field.von_mises_Pa[top] == pytest.approx(0.558 * peak, rel=0.12)
        assert 0.4 * a < depth < 1.0 * a


def test_free_edges_are_free(article_pair, cycle, rings, state):
    """Top land: stress across the edge vanishes; fillet: the larger principal stress runs along it."""
    _, fields = state
    peak = max(field.von_mises_Pa.max() for field in fields)
    for gear, field in enumerate(fields):
        centre = np.zeros(2) if gear == 0 else np.array([0.0, article_pair.working_centre_distance])
        some, angle = on_circle(field, centre, article_pair.tip_radii[gear])
        outward = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        xx, yy, _, xy = field.stress_Pa[some].T
        across = xx * outward[:, 0] ** 2 + yy * outward[:, 1] ** 2 + 2 * xy * outward[:, 0] * outward[:, 1]
        assert np.sqrt(np.mean(across**2)) < 0.01 * peak


def hertz_work(article_pair, bodies, cycle, row):
    """Work of one force: int F dD of the linear part and of the indentation F (c - k ln F)."""
    column = int(np.argmax(cycle.forces[row]))
    force = cycle.forces[row, column]
    rho1 = cycle.rho1[row, column]
    linear = bodies.own(np.array([rho1]))[0] * force
    law = bodies.hertz(np.array([rho1]))
    k = law.per_log
    return 0.5 * linear * force + force**2 * (
        0.5 * float(law.constant[0]) - 0.5 * k * np.log(force) - 0.25 * k
    )


def test_strain_energy_is_the_work_of_the_load(article_pair, article_bodies, cycle, rings):
    """Energy over both gears by quadrature over the cells, one pair in contact."""
    row = ROWS[1]
    fields = loaded_fields(article_pair, cycle, row, article_bodies, rings)
    energy = 0.0
    for field in fields:
        corners = field.points[field.cells[:, :3]]
        d, e = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        areas = 0.5 * np.abs(d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0])
        # the three middles integrate quadratics exactly
        energy += np.sum(areas[:, None] / 3 * field.energy_density_J_per_m3[field.cells[:, 3:]])
    work = hertz_work(article_pair, article_bodies, cycle, row)
    assert energy * article_pair.face_width == pytest.approx(work, rel=0.004)


def test_names_and_shapes(state):
    _, fields = state
    for field in fields:
        assert set(field.point_data) == {
            "displacement_m",
            "stress_Pa",
            "von_mises_Pa",
            "principal_Pa",
            "principal_direction",
            "energy_density_J_per_m3",
        }
        for values in field.point_data.values():
            assert len(values) == len(field.points)
            assert np.all(np.isfinite(values))
        assert np.all(field.principal_Pa[:, 0] >= field.principal_Pa[:, 1])
        assert field.cells.max() == len(field.points) - 1
        xx, yy, _, xy = field.stress_Pa.T
        x, y = field.principal_direction.T
        drawn = np.stack([xx * x + xy * y, xy * x + yy * y], axis=1)
        np.testing.assert_allclose(
            drawn, field.principal_Pa[:, :1] * field.principal_direction, atol=1e-9 * np.abs(xx).max()
        )


def test_regions_are_rim_fillet_and_flank(article_pair, state):
    _, fields = state
    for gear, field in enumerate(fields):
        centre = np.zeros(2) if gear == 0 else np.array([0.0, article_pair.working_centre_distance])
        r = np.linalg.norm(field.points[field.cells[:, :3]].mean(axis=1) - centre, axis=1)
        root, form = article_pair.root_radii[gear], article_pair.form_radii[gear]
        for number, (low, high) in enumerate(((0, root), (root, form), (form, 1))):
            some = field.region == number
            assert some.any()
            assert np.all((r[some] >= low) & (r[some] <= high))
        assert REGIONS == ("rim", "fillet", "flank")
        assert not field.indicative.any()


def test_stress_is_one_on_both_sides_of_a_cut(article_pair, state):
    """Sectors are drawn apart: at common points they must agree."""
    _, fields = state
    for field in fields:
        order = np.lexsort(np.round(field.points / 1e-9).T)
        same = np.linalg.norm(np.diff(field.points[order], axis=0), axis=1) < 1e-10
        one, other = order[:-1][same], order[1:][same]
        assert len(one) >= 10 * len(np.unique(field.tooth))
        size = np.abs(field.stress_Pa[one]).max()
        np.testing.assert_allclose(field.stress_Pa[one], field.stress_Pa[other], atol=1e-6 * size)
        moved = field.displacement_m
        np.testing.assert_allclose(moved[one], moved[other], atol=1e-6 * np.abs(moved).max())


def test_fillets_show_the_root_stress(article_pair, cycle, state):
    """Against the influence functions, on meshes of their own."""
    row, fields = state
    root = root_stress(article_pair, cycle, tolerance=0.01)
    placed = article_pair.placement(
        float(article_pair.points.A + cycle.position[row] * article_pair.base_pitch)
    )
    turns = ((placed.pinion_angle, np.zeros(2)), (placed.wheel_angle, placed.wheel_centre))
    for field, found, (angle, centre), sign in zip(
        fields, (root.pinion, root.wheel), turns, (1, -1), strict=True
    ):
        column = int(np.argmax(cycle.forces[row]))
        offset = int(cycle.pair_offset[column])
        profile = article_pair.teeth_profiles[0 if sign == 1 else 1]
        whole = angle + sign * offset * profile.pitch_angle
        c, s = np.cos(whole), np.sin(whole)
        local = (field.points - centre) @ np.array([[c, -s], [s, c]])
        stress = found.tangential_Pa[row, int(np.flatnonzero(found.tooth == offset)[0]), 0]
        samples, _, _ = found.line.side(left=True)
        compared = 0
        for sample, exact in zip(samples, stress, strict=True):
            away = np.linalg.norm(local - sample, axis=1)
            nearest = int(np.argmin(away))
            if away[nearest] < 0.004 * article_pair.module and exact > 0.6 * stress.max():
                compared += 1
                assert field.principal_Pa[nearest, 0] == pytest.approx(exact, rel=0.03)
                assert abs(field.principal_Pa[nearest, 1]) < 0.01 * stress.max()
        assert compared >= 2


@pytest.fixture(scope="module")
def free(article_pair, article_bodies):
    return fem.mesh_cycle(article_pair, 600.0, 40, article_bodies)


def test_tip_edges_are_drawn_and_marked(article_pair, article_bodies, rings, free):
    row = int(np.flatnonzero(np.any(free.edge & (free.forces > 100), axis=1))[0])
    fields = loaded_fields(article_pair, free, row, article_bodies, rings)
    assert all(np.all(np.isfinite(field.von_mises_Pa)) for field in fields)
    assert all(0 < field.indicative.sum() < 0.2 * len(field.cells) for field in fields)


def test_contact_forces_balance_the_torque(article_pair, free):
    """Forces along the true normals, tip edges included, about the pinion's axis; opposite on the two gears."""
    for row in range(0, 40, 3):
        contacts = contact_forces(article_pair, free, row)
        pinion = contacts.gear == 0
        np.testing.assert_allclose(contacts.force_N[pinion], -contacts.force_N[~pinion])
        np.testing.assert_allclose(contacts.points[pinion], contacts.points[~pinion])
        place, force = contacts.points[pinion], contacts.force_N[pinion]
        torque = np.sum(place[:, 0] * force[:, 1] - place[:, 1] * force[:, 0])
        assert -torque == pytest.approx(free.torque, rel=2e-3)
        on_path = pinion & (contacts.tip_edge == 0)
        assert np.all(np.isfinite(contacts.pressure_Pa) == (contacts.tip_edge == 0))
        for point, offset in zip(contacts.points[on_path], contacts.pair[on_path], strict=True):
            rho1 = free.rho1[row, int(np.flatnonzero(free.pair_offset == offset)[0])]
            expected = article_pair.placement(float(rho1)).contact_point
            np.testing.assert_allclose(point, expected, atol=1e-12)


def test_hertz_shear_in_the_written_file(tmp_path, article_pair, article_bodies):
    """K. L. Johnson: the greatest shear stress is 0.300 p_H at the depth 0.786 a, for any Poisson's ratio.

    Under a hundredth of the torque: the tooth's own stress grows with the load, p_H with its root, so that one
    is a hundredth of the other.
    """
    pyvista = pytest.importorskip("pyvista")
    light = fem.mesh_cycle(article_pair, 6.0, 40, article_bodies, beyond_path=False)
    write_vtk_series(tmp_path, article_pair, light, article_bodies, [35])
    contacts = pyvista.read(tmp_path / "vtk" / "contacts_0035.vtu")
    half, peak = contacts["half_width_m"][0], contacts["pressure_Pa"][0]
    assert peak == pytest.approx(
        np.sqrt(
            article_pair.reduced_modulus
            * light.force
            / (0.04 * 2 * np.pi)
            / article_pair.path_at(light.rho1[35, 0]).radius[0]
        ),
        rel=1e-5,
    )
    for gear, name in enumerate(("pinion", "wheel")):
        grid = pyvista.read(tmp_path / "vtk" / f"{name}_0035.vtu")
        inward = contacts["force_N"][contacts["gear"] == gear][0] / light.force
        away = grid.points - contacts.points[0]
        near = np.flatnonzero(np.linalg.norm(away, axis=1) < 3 * half)
        shear = 0.5 * (grid["principal_Pa"][near, 0] - grid["principal_Pa"][near, 1])
        top = near[np.argmax(shear)]
        assert shear.max() == pytest.approx(0.300 * peak, rel=0.02)
        # the cells are a third of the half-width, and the maximum is flat
        assert away[top] @ inward == pytest.approx(0.786 * half, abs=float(0.15 * half))


def test_time_series_for_paraview(tmp_path, article_pair, article_bodies, cycle):
    """Written files are read by VTK itself: names, active fields, and parts."""
    pyvista = pytest.importorskip("pyvista")
    seen = []
    path = write_vtk_series(
        tmp_path, article_pair, cycle, article_bodies, [0, 35], lambda done, of: seen.append((done, of))
    )
    assert seen == [(1, 2), (2, 2)]
    sets = ET.parse(path).getroot().findall("Collection/DataSet")
    parts = ("pinion", "wheel", "contacts")
    assert [s.get("file") for s in sets] == [f"vtk/{part}_{row:04d}.vtu" for row in (0, 35) for part in parts]
    assert [s.get("name") for s in sets] == 2 * list(parts)
    reader = pyvista.get_reader(path)
    assert reader.time_values == pytest.approx([0.0125, 0.8875])
    reader.set_active_time_value(reader.time_values[1])
    pinion, wheel, contacts = reader.read()
    assert wheel.active_scalars_name == "von_mises_Pa"
    assert wheel.active_vectors_name == "displacement_m"
    assert wheel["displacement_m"].shape == (wheel.n_points, 3)
    assert wheel["stress_Pa"].shape == (wheel.n_points, 4)
    assert wheel.GetPointData().GetArray("stress_Pa").GetComponentName(3) == "xy"
    assert set(np.unique(wheel.cell_data["gear"])) == {1}
    assert set(np.unique(wheel.cell_data["region"])) == {0, 1, 2}
    assert len(np.unique(wheel.cell_data["tooth"])) == 40
    assert wheel.area == pytest.approx(wheel.compute_cell_sizes()["Area"].sum())
    assert contacts.n_points == contacts.n_cells == 2 * np.count_nonzero(cycle.forces[35])
    total = np.linalg.norm(contacts["force_N"][contacts["gear"] == 0].sum(axis=0))
    assert total == pytest.approx(cycle.force, rel=1e-6)
    fields = loaded_fields(article_pair, cycle, 35, article_bodies)
    both = pinion, wheel
    for grid, field in zip(both, fields, strict=True):
        assert grid["von_mises_Pa"].max() == pytest.approx(field.von_mises_Pa.max(), rel=0.03)


def test_stored_numbers_are_as_exact_as_promised(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    rng = np.random.default_rng(5)
    values = rng.normal(size=500) * 10.0 ** rng.integers(-20, 12, 500)
    values[:3] = 0.0, np.nan, -1.5
    places = rng.normal(size=(500, 3)).astype(np.float32)
    grid = pyvista.UnstructuredGrid({pyvista.CellType.VERTEX: np.arange(500)[:, None]}, places)
    grid["exact_m"], grid["rough_Pa"] = single_precision(values), rounded(single_precision(values))
    write_grid(tmp_path / "a.vtu", grid)
    back = pyvista.read(tmp_path / "a.vtu")
    np.testing.assert_allclose(back["exact_m"], values, rtol=1e-7)
    np.testing.assert_allclose(back["rough_Pa"], values, rtol=2.5e-4)
    np.testing.assert_array_equal(back.points, places)
    assert meshio.read(tmp_path / "a.vtu").points.shape == (500, 3)
    write_grid(tmp_path / "b.vtu", pyvista.UnstructuredGrid())
    assert pyvista.read(tmp_path / "b.vtu").n_points == 0


def test_rows_outside_the_cycle_are_refused(article_pair, article_bodies, cycle):
    with pytest.raises(InputError, match="row"):
        loaded_fields(article_pair, cycle, 40, article_bodies)


def test_flanks_are_drawn_round(article_pair):
    """Straight sides between the drawn points stay within a thousandth of the module of the involute."""
    ring = mesh_and_factor(article_pair, "strain", Sizes(), 1)[0]
    picture = picture_of(ring.mesh)
    points = picture.interpolate(ring.mesh.points)
    sides = np.concatenate(
        [picture.cells[:, [a, b]] for a, b in ((0, 3), (3, 1), (1, 4), (4, 2), (2, 5), (5, 0))]
    )
    ends, count = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
    ends = points[ends[count == 1]]
    profile = article_pair.teeth_profiles[0]
    r_b, psi = profile.base_radius, profile.base_half_angle

    def off_flank(place):
        radius = np.clip(np.linalg.norm(place, axis=-1), profile.form_radius, profile.flank_end_radius)
        roll = np.sqrt((radius / r_b) ** 2 - 1)
        angle = np.abs(np.arctan2(place[..., 0], place[..., 1]))
        return radius * np.abs(angle - (psi - roll + np.arctan(roll)))

    # where cells of different size meet, a side is single as well: keep those that end on the involute
    on_flank = np.all(off_flank(ends) < 2e-4 * article_pair.module, axis=1)
    middle = ends[on_flank].mean(axis=1)
    assert len(middle) > 20
    assert off_flank(middle).max() < 1e-3 * article_pair.module


@pytest.mark.usefixtures("no_gear_solved")
def test_gears_are_made_ready_once_for_copies_of_a_pair_and_anew_for_another_material(
    article_pair, article_bodies
):
    first = draw_gears(article_pair, article_bodies)
    again = draw_gears(article_pair, pickle.loads(pickle.dumps(article_bodies)))
    assert all(one is other for one, other in zip(first, again, strict=True))
    steel = article_pair.materials[0]
    stiffer = replace(article_pair, material=replace(steel, youngs_modulus=2 * steel.youngs_modulus))
    own = draw_gears(stiffer, fem.compliance(stiffer))
    for one, other in zip(own, first, strict=True):
        size = float(np.abs(one.stress_by_cut).max())
        np.testing.assert_allclose(one.stress_by_cut, 2 * other.stress_by_cut, atol=1e-9 * size)


def test_positions_alone_are_sent_without_solving_more_and_have_the_same_fields(article_pair, article_bodies):
    cycle = fem.mesh_cycle(article_pair, 600.0, 4, article_bodies, beyond_path=False)
    assert cycle.arcs is not None
    sent = pickle.loads(pickle.dumps(cycle.without_arcs()))
    assert "value" not in vars(cycle.arcs.others)
    assert sent.arcs is None
    for one, other in zip(
        loaded_fields(article_pair, cycle, 1, article_bodies),
        loaded_fields(article_pair, sent, 1, article_bodies),
        strict=True,
    ):
        np.testing.assert_array_equal(one.stress_Pa, other.stress_Pa)
