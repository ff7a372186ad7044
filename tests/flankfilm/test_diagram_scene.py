"""Bifurcation diagrams from scenes: files, jumps, error budgets, forces."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from tests.flankfilm.scenes import PAIR_WITH_BACKLASH

EXAMPLE = Path(__file__).parents[2] / "examples" / "motion" / "branches.toml"
PAIR = f"""
title = "Pair, branches"
wants = ["diagram", "report"]
{PAIR_WITH_BACKLASH}
[operating]
pinion_torque_Nm = 600

[stiffness]
model = "potential-energy"
pairs = "independent"

[dynamics]
fourier_order = 2
error_amplitude_um = 10
diagram = {{ speed_rpm = [7000, 12000], max_period = 1, searches = 2 }}
"""


def run(text: str, out: Path) -> Path:
    run_scene(parse_scene(text, "scene.toml"), out, use_cache=False)
    return out


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.slow
def test_example_of_branches(tmp_path: Path):
    """The folds of the lubricated scan, in the files and in the report."""
    folder = run(EXAMPLE.read_text(encoding="utf-8"), tmp_path)
    jumps = [(float(r["frequency"]), r["direction"], r["motion"]) for r in rows(folder / "csv" / "jumps.csv")]
    assert jumps[0] == (pytest.approx(0.5694026368887, abs=1e-11), "falling", "1-1-1")
    assert jumps[1] == (pytest.approx(0.6555759637891, abs=1e-11), "rising", "1-1-0")
    text = (folder / "report.html").read_text(encoding="utf-8")
    assert "Branches and jumps" in text
    assert "beyond max_period" in text
    with xr.open_dataset(folder / "results.nc", engine="h5netcdf") as data:
        assert set(np.unique(data.diagram_stable)) == {0, 1}
        assert data.jump_frequency.values[0] == pytest.approx(0.5694026368887, abs=1e-11)
    motions = {r["motion"] for r in rows(folder / "csv" / "stable_motions.csv")}
    assert {"1-0-0", "1-1-0", "1-1-1"} <= motions


def test_no_jumps_are_said_to_be_none(tmp_path: Path):
    text = EXAMPLE.read_text(encoding="utf-8")
    folder = run(text.replace("[0.5, 1.2]", "[0.2, 0.5]"), tmp_path)
    assert rows(folder / "csv" / "jumps.csv") == []
    assert "none in range" in (folder / "report.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def pair_folder(tmp_path_factory) -> Path:
    return run(PAIR, tmp_path_factory.mktemp("pair"))


def test_jump_speeds_of_a_pair_with_their_budget(pair_folder: Path):
    jumps = rows(pair_folder / "csv" / "jumps.csv")
    assert jumps
    for jump in jumps:
        assert 7000 < float(jump["speed_rpm"]) < 12000
        parts = [float(jump[f"error_by_{source}"]) for source in ("stiffness", "truncation", "flow")]
        assert math.isfinite(parts[0])
        assert float(jump["error"]) == pytest.approx(sum(parts), rel=1e-9)
        apart = abs(float(jump["longer_frequency"]) / float(jump["frequency"]) - 1)
        assert parts[1] >= apart * (1 - 0.1) if math.isfinite(apart) else math.isinf(parts[1])
    forces = rows(pair_folder / "csv" / "force_over_speed.csv")
    assert all(float(r["factor_iso6336"]) >= 1.0 for r in forces)
    text = (pair_folder / "report.html").read_text(encoding="utf-8")
    assert "tangent, order 2" in text
    assert "secant, order" in text
    assert "ISO 6336-1, method B" in text


def test_what_the_series_leaves_out_of_whole_figures_stands_beside_them(pair_folder: Path):
    with xr.open_dataset(pair_folder / "results.nc", engine="h5netcdf") as data:
        order = int(data.diagram_longer_order)
        assert order >= 8
        for name in ("separated_error", "back_contact_error", "greatest_force_error"):
            assert float(data[f"diagram_{name}"]) >= 0.0
        missed = data.missed_frequency.size
    text = (pair_folder / "report.html").read_text(encoding="utf-8")
    assert f"Motions of period 1 with {order} harmonics instead" in text
    assert ("have jumps that this series has not" in text) == (missed > 0)
