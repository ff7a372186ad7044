"""Progress in a log: a line for each stage, and what is compiled once; the geometry of a scene that wants it alone."""

from __future__ import annotations

import csv

import pytest
import xarray as xr
from numba import njit

from base import hide_compilation
from flankfilm.processes.progress import compiling_line, console_progress, console_rows, row_lines, rows_of
from flankfilm.runs.report import summary
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene

GEOMETRY = """
wants = ["geometry", "report"]
[pair]
module_mm = 1.0
face_width_mm = 10.0
pinion = { teeth = 20, bore_mm = 5 }
wheel = { teeth = 30, bore_mm = 5 }
"""


def said(log: str) -> list[str]:
    return [line.split(" s  ", 1)[1] for line in log.splitlines()]


def test_a_log_has_a_line_for_each_stage_and_one_where_code_is_compiled(capsys):
    hide_compilation()
    with console_progress() as progress:
        for done, what in enumerate(("geometry", "oil film", "oil film")):
            progress(what, done, 3)
        for constant in (1.0, 2.0):
            njit(lambda x, more=constant: x + more)(1.0)
    njit(lambda x: x + 3.0)(1.0)
    assert said(capsys.readouterr().err) == ["geometry", "oil film", compiling_line("")]


def test_a_log_has_a_line_for_each_tenth_of_the_rows(capsys):
    with console_rows() as progress:
        for done in range(201):
            progress(done, 200)
    assert said(capsys.readouterr().err) == [f"{20 * tenth} of 200 rows" for tenth in range(11)]


def test_rows_of_a_stage_are_shown_from_five_seconds_on(capsys):
    """Every 5 s with the time left by the pace so far; what is counted next has a pace of its own."""
    now = [0.0]
    with console_progress() as progress:
        rows = rows_of(progress, "sweep", lambda: now[0])
        for done in range(1, 11):
            now[0] += 2.0
            rows("speeds", done, 10)
        for done in range(1, 4):
            now[0] += 6.0
            rows("peaks", done, 3)
    expected = ["3 of 10 speeds, 14", "6 of 10 speeds, 8", "9 of 10 speeds, 2"]
    expected += ["1 of 3 peaks, 12", "2 of 3 peaks, 6", "3 of 3 peaks, 0"]
    assert said(capsys.readouterr().err) == [f"sweep: {one} s left" for one in expected]


def test_geometry_alone_needs_no_material_is_printed_and_written(tmp_path):
    found = run_scene(parse_scene(GEOMETRY), tmp_path, use_cache=False)
    printed = {
        line[: line.index("]") + 1]: line.split("]")[1].split() for line in summary(found) if "]" in line
    }
    assert printed["span W_k over k teeth [mm]"] == ["7.6604", "10.7526"]
    assert printed["transverse contact ratio [-]"] == [f"{found.values['pair'].contact_ratio:.5f}"]
    with (tmp_path / "csv" / "geometry.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["figure"]: row for row in csv.DictReader(file)}
    assert float(rows["span W_k over k teeth"]["wheel"]) == pytest.approx(10.75263, abs=1e-5)
    assert rows["span W_k over k teeth"]["pair"] == ""
    with xr.open_dataset(tmp_path / "results.nc", engine="h5netcdf") as data:
        assert data.dimensions_span.values[0] == pytest.approx(7.660439e-3, abs=1e-9)
        assert data.path_specific_sliding.dims == ("path_station", "gear")
    assert "span W_k over k teeth" in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_slow_rows_have_a_line_each_with_the_time_left():
    """Of 30 rows only every third had a line, and none the time left."""
    said: list[str] = []
    time = iter(10.0 * row for row in range(31))
    show = row_lines(lambda what, done, total: said.append(what), clock=time.__next__)
    for done in range(31):
        show(done, 30)
    assert len(said) == 31
    assert said[1] == "1 of 30 rows, about 5 min left"
    assert said[29] == "29 of 30 rows, about 10 s left"
    assert said[30] == "30 of 30 rows"
