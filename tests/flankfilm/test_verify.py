"""Closed forms against finite elements: figures, their errors, files and messages."""

from __future__ import annotations

import numpy as np
import pytest

from base import Cost
from flankfilm.build import gear_pair
from flankfilm.coupling.verification import POINTS, UNITS, Curves, figure_errors, figures, stations
from flankfilm.scene import read_scene
from tests.flankfilm.program import EXAMPLES, flankfilm


@pytest.fixture(scope="module")
def pair():
    return gear_pair(read_scene(EXAMPLES / "article.toml"))


def made_up(pair, n=360, error=1e-3):
    """Stiffness 20 + 3 cos + 2 cos 2 + cos 3, and one pair of 10 + 2 (rho - A)/(E - A), in N/(mm um)."""
    unit = 1e9 * pair.face_width
    phase = 2 * np.pi * (np.arange(n) + 0.5) / n
    secant = 20 + 3 * np.cos(phase) + 2 * np.cos(2 * phase + 1) + np.cos(3 * phase + 2)
    rho1 = stations(pair)
    single = 10 + 2 * (rho1 - pair.points.A) / (pair.points.E - pair.points.A)
    pairs = np.where(np.arange(n) < 0.7 * n, 2, 1)
    return Curves(
        "made up", unit * single, unit * secant, 1e-6 * np.sin(phase) + 3e-6, pairs, Cost(0.0), error
    )


def test_the_path_is_walked_from_A_to_E_with_C(pair):
    rho1 = stations(pair)
    assert rho1.size == POINTS + 1
    assert rho1[0] == pair.points.A
    assert rho1[-1] == pair.points.E
    assert pair.points.C in rho1


def test_figures_are_those_of_the_curves(pair):
    found = figures(pair, made_up(pair))
    along = (pair.points.C - pair.points.A) / (pair.points.E - pair.points.A)
    assert found["one pair, at C"] == pytest.approx(10 + 2 * along, rel=1e-12)
    assert found["one pair, largest"] == pytest.approx(12.0, rel=1e-12)
    assert found["one pair, mean A to E"] == pytest.approx(11.0, rel=1e-12)
    assert found["mesh, mean"] == pytest.approx(20.0, rel=1e-12)
    for j, amplitude in ((1, 3.0), (2, 2.0), (3, 1.0)):
        assert found[f"harmonic {j} over mean"] == pytest.approx(amplitude / 20, rel=1e-12)
    assert found["transmission error, peak to peak"] == pytest.approx(2.0, rel=1e-4)
    assert set(found) == set(UNITS)


def test_a_third_of_the_positions_are_midpoints_too(pair):
    whole, third = made_up(pair, 360), made_up(pair, 120)
    for name, value in figures(pair, third).items():
        if "two pairs" not in name:
            assert figures(pair, whole, every=3)[name] == pytest.approx(value, rel=1e-9), name


def test_errors_bound_what_a_relative_error_of_the_stiffness_can_do(pair):
    """Disturb the curves by the error at each position, signs at their worst for each figure."""
    curves = made_up(pair)
    bounds, values = figure_errors(pair, curves), figures(pair, curves)
    phase = 2 * np.pi * (np.arange(360) + 0.5) / 360
    for sign in (
        np.sign(np.cos(phase)),
        np.sign(np.cos(2 * phase + 1)),
        np.ones(360),
        np.sign(np.sin(phase)),
    ):
        moved = Curves(
            "",
            curves.single_stiffness * (1 + 1e-3),
            curves.secant_stiffness * (1 + 1e-3 * sign),
            curves.transmission_error * (1 + 1e-3 * sign),
            curves.pairs,
            Cost(0.0),
        )
        for name, value in figures(pair, moved).items():
            assert abs(value / values[name] - 1) <= bounds[name] * 1.05, name


def test_the_command_writes_tables_curves_and_a_figure(tmp_path):
    import pandas as pd

    done = flankfilm("verify", EXAMPLES / "article.toml", "--out", tmp_path / "out")
    assert "against finite elements, without hub wind-up and coupling" in done.stdout
    table = pd.read_csv(tmp_path / "out" / "verify.csv")
    ishikawa = table[(table.model == "Ishikawa") & (table.figure == "one pair, at C")].set_index("reference")
    # Ishikawa knows no hub wind-up; without it finite elements are stiffer, with it softer than the formula
    whole, stripped = ishikawa.difference_percent[["held to the path", "without hub wind-up"]]
    assert whole > 8
    assert 0 < stripped < 2
    assert (table.reference_error_percent > 0).all()
    off = 100 * (table.value / table.reference_value - 1)
    assert np.allclose(off, table.difference_percent)
    for name in ("verify_one_pair.csv", "verify_mesh.csv"):
        assert np.isfinite(pd.read_csv(tmp_path / "out" / name).to_numpy()).all()
    assert "<svg" in (tmp_path / "out" / "verify.svg").read_text(encoding="utf-8")


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
    done = flankfilm("verify", scene, cwd=tmp_path, status=2)
    for section in ("[pair]", "[material]", "[operating]"):
        assert section in done.stderr
