"""Closed forms against finite elements: figures, their errors, files and messages."""

from __future__ import annotations

import numpy as np
import pytest

from base import InputError
from base.later import known
from flankfilm.building.pair import gear_pair
from flankfilm.coupling.mesh.verification import POINTS, UNITS, mesh_figures, single_figures, stations
from flankfilm.scene import parse_scene, read_scene
from flankfilm.verification.run import unknown_over_face, verification_outcome
from flankfilm.verification.tables import face_table
from gears import BasicRack, Gear, GearPair, closed_form
from gears.sharing.events import Sampled, arcs_between_events
from gears.sharing.mesh_arcs import ALONE, CURVES, Compared, MeshArcs
from tests.flankfilm.program import EXAMPLES, command, flankfilm
from tests.flankfilm.test_face_scene import SCENE


@pytest.fixture(scope="module")
def pair():
    return gear_pair(read_scene(EXAMPLES / "article.toml"))


def made_up(pair, change=0.0):
    """Stiffness 20 + 3 cos + 2 cos 2 + cos 3 in N/(mm um) and 40 mm, and a transmission error of 2 um."""

    def sample(position):
        phase = 2 * np.pi * position
        secant = 20 + 3 * np.cos(phase) + 2 * np.cos(2 * phase + 1) + np.cos(3 * phase + 2)
        moved = 1e-6 * np.sin(phase) + 3e-6
        curves = np.stack([(1 + change) * moved, secant, 1e9 * pair.face_width * secant / (1 + change)])
        return Sampled(curves, np.zeros((len(position), 0)))

    corners = np.array([0.0, pair.contact_ratio - 1.0])
    return arcs_between_events(sample, CURVES, corners, tolerance=1e-10)


def test_the_path_is_walked_from_A_to_E_with_C(pair):
    rho1 = stations(pair)
    assert rho1.size == POINTS + 1
    assert rho1[0] == pair.points.A
    assert rho1[-1] == pair.points.E
    assert pair.points.C in rho1


def test_figures_are_those_of_the_curves(pair):
    arcs = MeshArcs(made_up(pair), ALONE, 1.0, 1e-3)
    rho1, unit = stations(pair), 1e9 * pair.face_width
    single = unit * (10 + 2 * (rho1 - rho1[0]) / np.ptp(rho1))
    found = single_figures(pair, single, 1e-3) | mesh_figures(pair, arcs)
    along = (pair.points.C - pair.points.A) / (pair.points.E - pair.points.A)
    values = {name: one.value for name, one in found.items()}
    assert values["one pair, at C"] == pytest.approx(10 + 2 * along, rel=1e-12)
    assert values["one pair, largest"] == pytest.approx(12.0, rel=1e-12)
    assert values["one pair, mean A to E"] == pytest.approx(11.0, rel=1e-12)
    assert values["mesh, mean"] == pytest.approx(20.0, rel=1e-9)
    high = 2 * np.pi * (pair.contact_ratio - 1.0)
    waves = [3 * np.sin(high), np.sin(2 * high + 1) - np.sin(1), (np.sin(3 * high + 2) - np.sin(2)) / 3]
    assert values["mesh, two pairs, mean"] == pytest.approx(20 + sum(waves) / high, rel=1e-9)
    for j, amplitude in ((1, 3.0), (2, 2.0), (3, 1.0)):
        assert values[f"harmonic {j} over mean"] == pytest.approx(amplitude / 20, rel=1e-9)
    assert values["transmission error, peak to peak"] == pytest.approx(2.0, rel=1e-9)
    assert set(found) == set(UNITS)
    for name, one in found.items():
        assert one.relative == pytest.approx(1e-3, rel=1e-3), name


def test_two_pairs_bear_over_what_a_contact_ratio_above_two_leaves_them():
    """Three pairs over the first part of the base pitch; the mean of two is that of the rest, and no more."""
    rack = BasicRack(h_aP=1.3, h_fP=1.55, rho_fP=0.2)
    pair = GearPair(Gear(60), Gear(70), module=2e-3, face_width=40e-3, rack=rack)
    low = pair.contact_ratio - 2.0
    assert 0.05 < low < 0.5
    found = mesh_figures(pair, MeshArcs(made_up(pair), ALONE, 1.0, 1e-3))["mesh, two pairs, mean"]
    ends = 2 * np.pi * np.array([low, 1.0])
    waves = 3 * np.sin(ends) + np.sin(2 * ends + 1) + np.sin(3 * ends + 2) / 3
    assert found.value == pytest.approx(20 + np.diff(waves)[0] / np.diff(ends)[0], rel=1e-9)


def test_errors_are_what_the_mesh_before_differs_by(pair):
    """A mesh that yields 0.7 % more, with a gain of 7: 0.1 % of all but of a ratio to the mean."""
    found = mesh_figures(pair, MeshArcs(made_up(pair), known(Compared(made_up(pair, 7e-3).arcs)), 7.0, 0.0))
    for name, one in found.items():
        expected = 0.0 if name.startswith("harmonic") else 1e-3
        assert one.relative == pytest.approx(expected, rel=0.01, abs=1e-8), name


def test_what_lies_between_the_stations_is_in_the_errors_of_a_single_pair(pair):
    rho1, width = stations(pair), 1e9 * pair.face_width
    unit, fine = (rho1 - rho1[0]) / np.ptp(rho1), np.linspace(0, 1, 100_001)

    def curve(x):
        return 10 + 4 * x * (1 - x) + 0.05 * np.sin(40 * x)

    found = single_figures(pair, width * curve(unit), 0.0)
    largest, mean = found["one pair, largest"], found["one pair, mean A to E"]
    assert 0 < curve(fine).max() - largest.value < 2 * largest.error
    assert 0 < abs(np.trapezoid(curve(fine), fine) - mean.value) < 2 * mean.error


@pytest.mark.slow
def test_the_command_writes_tables_curves_and_a_figure(tmp_path):
    import pandas as pd

    done = flankfilm("verify", EXAMPLES / "article.toml", "--out", tmp_path / "out")
    assert "against finite elements without hub wind-up and coupling" in done.stdout
    table = pd.read_csv(tmp_path / "out" / "verify.csv")
    ishikawa = table[(table.model == "Ishikawa") & (table.figure == "one pair, at C")].set_index("reference")
    # Ishikawa has no hub wind-up; the bodies' inertia leaves a tenth of it in the deflection relative to them
    whole, stripped = ishikawa.difference_percent[["held to the path", "without hub wind-up"]]
    assert 0 < stripped < whole < 3
    assert (table.reference_error_percent > 0).all()
    off = 100 * (table.value / table.reference_value - 1)
    assert np.allclose(off, table.difference_percent)
    for name in ("verify_one_pair.csv", "verify_mesh.csv"):
        assert np.isfinite(pd.read_csv(tmp_path / "out" / name).to_numpy()).all()
    assert "<svg" in (tmp_path / "out" / "verify.svg").read_text(encoding="utf-8")


FACE = (
    SCENE.replace("teeth = 36", "teeth = 20")
    .replace("teeth = 40", "teeth = 30, lead_slope_um = -6")
    .replace("width_mm = 40", "width_mm = 20")
    .replace("Nm = 600", "Nm = 100")
    + '[alignment]\nin_plane_um = 26\ncells = 8\nface_model = "walls"\n'
)


@pytest.mark.slow
def test_the_load_over_the_face_stands_beside_slices_and_iso(tmp_path):
    """Even loads of the closed forms as without it; factors, line loads and what they differ by in files and page."""
    import pandas as pd

    scene = parse_scene(FACE)
    outcome = verification_outcome(scene, tmp_path, use_cache=False)
    over = outcome.result.over_face
    assert over.model == ("between walls", "independent slices", "ISO 6336-1, method C")
    first, slices, iso = over.pitch_point_factor
    assert iso == closed_form.iso6336_face_load(gear_pair(scene), 100.0, 20e-6).K_Hbeta
    np.testing.assert_allclose(over.factor_difference, [0.0, slices / first - 1.0, iso / first - 1.0])
    assert over.factor_difference[1] < -0.01  # slices bear too evenly
    files = {path.name for path in outcome.files}
    assert {"verify_face.csv", "verify_line_load.csv"} <= files
    table = pd.read_csv(tmp_path / "verify_face.csv")
    np.testing.assert_allclose(table.difference_percent, 100 * over.factor_difference, rtol=1e-6, atol=1e-12)
    loads = pd.read_csv(tmp_path / "verify_line_load.csv")
    assert loads.shape == (8, 4)
    np.testing.assert_allclose(loads.max().iloc[1:3] / loads.mean().iloc[1:3], [first, slices], rtol=1e-6)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Load over the face" in page
    assert f"{abs(100 * over.factor_difference[1]):.1f}" in page
    assert [str(one.header) for one in face_table(over).columns][:4][-1] == "differs from the first"


def test_what_knows_no_cells_is_left_out_of_a_verification_with_its_reason():
    stress = FACE.replace("[stiffness]\n", '[stiffness]\nplane = "stress"\n')
    assert stress != FACE
    scene = parse_scene(stress)
    assert "stiffness.plane" in unknown_over_face(scene, gear_pair(scene))
    assert unknown_over_face(parse_scene(FACE), gear_pair(scene)) == ""
    rooted = FACE.replace('["stiffness"]', '["stiffness", "root-stress"]')
    assert rooted != FACE
    assert unknown_over_face(parse_scene(rooted), gear_pair(scene)) == ""
    with pytest.raises(InputError, match=r"alignment\.cells"):
        unknown_over_face(parse_scene(FACE.replace("cells = 8", "cells = 7")), gear_pair(scene))


def test_finite_elements_add_up_like_springs(tmp_path):
    """Without coupling, and with the same deflection, one pair's compliance falls by the wind-up alone."""
    import fem

    scene = read_scene(EXAMPLES / "article.toml")
    pair = gear_pair(scene)
    bodies = fem.compliance(pair, tolerance=0.002)
    rho1 = stations(pair)
    whole = fem.single_pair_stiffness(pair, force=1e4, rho1=rho1, compliance=bodies)
    stripped = fem.single_pair_stiffness(pair, force=1e4, rho1=rho1, compliance=bodies.without("hub_windup"))
    assert np.allclose(1 / whole - 1 / stripped, sum(bodies.hub_windup), rtol=1e-9)


def test_all_missing_sections_are_named(tmp_path):
    scene = tmp_path / "motion.toml"
    scene.write_text((EXAMPLES / "oscillator.toml").read_text(encoding="utf-8"), encoding="utf-8")
    done = command("verify", scene, cwd=tmp_path, status=2)
    for section in ("[pair]", "[material]", "[operating]"):
        assert section in done.stderr
