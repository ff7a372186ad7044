"""Sampled studies: normal ranges, quantiles with what half the rows change, and 1000 pairs from tolerances."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from statistics import NormalDist

import numpy as np
import pytest
import xarray as xr

import flankfilm as ff
from flankfilm.stages.rating import RATING
from flankfilm.studies.execution import Execution
from flankfilm.studies.plan import plan_of
from flankfilm.studies.quantiles import SHARES, quantiles, sampled
from flankfilm.studies.study_file import Range, StudyFile
from tests.flankfilm.test_rating_scene import WHOLE, engine, put


def test_a_normal_range_has_the_quantiles_of_a_truncated_normal_distribution():
    spread = Range.model_validate({"from": -3.0, "to": 3.0, "normal": True})
    assert (spread.at(0.0), spread.at(0.5), spread.at(1.0)) == (-3.0, 0.0, 3.0)
    inside = 1.0 - 2.0 * NormalDist().cdf(-3.0)
    for unit in (0.01, 0.3, 0.9):
        z = float(spread.at(unit))
        assert (NormalDist().cdf(z) - NormalDist().cdf(-3.0)) / inside == pytest.approx(unit, abs=1e-9)
        assert spread.place(z) == pytest.approx(unit, abs=1e-9)
    drawn = np.array([spread.at((k + 0.5) / 4096) for k in range(4096)])
    assert drawn.std() == pytest.approx(0.9866, abs=2e-3)  # of the truncated one
    equal = Range.model_validate({"from": 1.0, "to": 100.0, "log": True, "normal": True})
    assert equal.at(0.5) == pytest.approx(10.0)


def test_quantiles_know_what_half_the_rows_say_and_leave_out_what_failed():
    rng = np.random.default_rng(3)
    values = rng.normal(size=4000)
    values[::7] = math.nan
    (found,) = quantiles(xr.Dataset({"S_H": ("row", values)}), ["S_H"])
    expected = [NormalDist().inv_cdf(share) for share in SHARES]
    assert found.rows == np.isfinite(values).sum()
    assert found.values == pytest.approx(expected, abs=0.12)
    assert (found.changes > 0.0).all()
    assert list(quantiles(xr.Dataset({"S_H": ("row", values[:6])}), ["S_H"])) == []
    assert not sampled("grid", 100)
    assert not sampled("sobol", 8)


def test_shares_of_a_grade_are_between_a_perfect_gear_and_the_rating():
    whole = engine(WHOLE)[RATING]
    none = engine(put(WHOLE, rating__tolerance_shares={"f_pb": 0.0, "f_falpha": 0.0, "f_Hbeta": 0.0}))[RATING]
    half = engine(put(WHOLE, rating__tolerance_shares={"f_pb": 0.5, "f_falpha": 0.5, "f_Hbeta": 0.5}))[RATING]
    same = engine(put(WHOLE, rating__tolerance_shares={}))[RATING]
    assert same.S_H == whole.S_H
    for name in ("K_v", "K_Hbeta"):
        low, middle, high = (getattr(found.factors, name) for found in (none, half, whole))
        assert low < middle < high
    assert min(none.S_H) > min(half.S_H) > min(whole.S_H)
    assert none.factors.effective.f_pb_eff == 0.0


@pytest.mark.slow
def test_a_study_of_tolerances_has_quantiles(tmp_path: Path):
    study = {
        "scene": WHOLE,
        "outputs": ["S_H", "iso_K_v"],
        "design": "sobol",
        "samples": 32,
        "vary": {
            "rating.tolerance_shares.f_pb": {"from": 0.0, "to": 1.0},
            "rating.tolerance_shares.f_Hbeta": {"from": 0.0, "to": 1.0},
        },
    }
    results = ff.study(
        plan_of(StudyFile.model_validate(study), tmp_path), tmp_path / "out", Execution(workers=1)
    )
    assert not results.failures
    with (tmp_path / "out" / "quantiles.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["output"]: row for row in csv.DictReader(file)}
    values = ff.open_results(tmp_path / "out").S_H.values
    assert float(rows["S_H"]["quantile_50_percent"]) == pytest.approx(np.median(values), rel=1e-12)
    assert rows["iso_K_v"]["rows"] == "32"
    assert "Quantiles" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
