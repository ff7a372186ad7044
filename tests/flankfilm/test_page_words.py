"""Words and numbers of pages as a reader expects them: equal decimals, units that stay whole, no raw key."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import flankfilm as ff
from base import RangeWarning
from dynamics import diagram
from flankfilm.coupling.mesh.warn_once import distinct
from flankfilm.figures.reading import words
from flankfilm.report.page import Head, Part, Table, render
from flankfilm.report.pair_parts import printed
from flankfilm.report.text import percent, plus_minus
from flankfilm.runs.check import check_scene
from flankfilm.scene import parse_scene
from flankfilm.studies.study_file import Range
from tests.validation.article_motion import lubricated

SCENE = """
wants = ["geometry"]
[pair]
module_mm = 2
face_width_mm = 20
pinion = {{ teeth = 20 }}
wheel = {{ teeth = 41{wheel} }}
"""


def geometry(wheel: str = "") -> dict[str, list[str]]:
    """Cells of the printed geometry by the beginning of their line."""
    lines = printed(ff.run(parse_scene(SCENE.format(wheel=wheel))).dataset)
    return {line.split("]")[0] + "]": line.split("]")[1].split() for line in lines if "]" in line}


def test_rows_of_the_geometry_have_the_same_decimals():
    rows = geometry()
    for name, cells in rows.items():
        decimals = {len(cell.partition(".")[2]) for cell in cells if cell != "-"}
        assert len(decimals) == 1, name
        assert max(decimals) <= 5
    assert rows["base diameter d_b [mm]"] == ["37.5877", "77.0548"]
    assert rows["tip diameter d_a [mm]"] == ["44", "86"]


def test_rims_and_webs_are_told_of_gears_that_have_them():
    web = "thickness of the web along the axis [mm]"
    assert web not in geometry()
    blank = ", bore_mm = 20, blank = { rim_thickness_mm = 5, web_thickness_mm = 6, hub_mm = 30 }"
    assert geometry(blank)[web] == ["20", "6"]


def test_tiny_errors_are_not_counted_out():
    assert percent(3e-14) == percent(9.9e-7) == "< 0.0001 %"
    assert percent(1e-6) == "0.0001 %"
    assert percent(0.0) == "0 %"
    assert percent(-0.0246) == "-2.5 %"
    assert percent(123.4) == "12000 %"
    assert plus_minus(None) == "error unknown"


def test_a_line_breaks_neither_units_nor_errors():
    table = Table(("force [N m]", "of it"), (("1.5 ± 0.2 %", "7 %"), ("2.5 ± < 0.0001 %", "8 %")), "k ± 3 %")
    page = render(Head("", (), ()), [Part("a", "A", tables=(table,))])
    for whole in ("force [N_m]", "1.5 ±_0.2_%", "2.5 ±_&lt;_0.0001_%", ">7_%<", "k ±_3_%"):
        assert whole.replace("_", "\u00a0") in page, whole


def test_a_table_says_how_wide_it_is():
    few, usual, many = (Table(("x",) * n, (("1",) * n,)) for n in (3, 7, 8))
    assert (few.width, usual.width, many.width) == ("few", "", "many")
    assert few.sides[0] == "k"
    assert Table(("model", "x"), (("finite elements", "1"),)).sides == ("f", "n")


def test_warnings_that_differ_in_numbers_are_one_with_their_range():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for pressure in (1.08, 1.5, 0.99e0):
            warnings.warn(
                f"Hertz pressure {pressure} GPa: above 1 GPa, ISO 6336-1", RangeWarning, stacklevel=1
            )
        warnings.warn("another", RangeWarning, stacklevel=1)
    first, second = distinct(caught)
    assert str(first.message) == "Hertz pressure 0.99 to 1.5 GPa: above 1 GPa, ISO 6336-1"
    assert first.category is RangeWarning
    assert str(second.message) == "another"


def test_one_branch_is_no_branches():
    found = diagram(lubricated(0.5), "frequency", (0.5, 0.52), max_period=1, searches=2)
    assert len(found.branches) == 1
    assert found.message.startswith("1 branch; 0 saddle-nodes")


@pytest.mark.parametrize(("low", "high", "steps"), [(-0.3, 0.6, 10), (-1.0, 2.0, 31), (-0.7, 0.7, 15)])
def test_a_range_meets_zero(low, high, steps):
    values = [Range.model_validate({"from": low, "to": high}).at(place) for place in np.linspace(0, 1, steps)]
    assert 0.0 in values
    assert min(abs(value) for value in values if value) > 0.05


def test_errors_among_outputs_are_named_by_what_they_are_of():
    results = ff.run(parse_scene(SCENE.format(wheel=""))).dataset
    assert words(results, "transmission_error_error") == "error of the transmission error"


def test_a_check_says_a_warning_once():
    shifted = SCENE.format(wheel=", profile_shift = 0.1").replace(
        "teeth = 20", "teeth = 20, profile_shift = 0.1"
    )
    distance = 1e3 * ff.run(parse_scene(shifted)).values["pair"].working_centre_distance
    rounded = parse_scene(f"{shifted}centre_distance_mm = {distance - 5e-4}\n")
    (line,) = [line for line in check_scene(rounded) if line.startswith("Warning")]
    assert "taken as rounded" in line
