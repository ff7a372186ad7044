"""Every output of a study has an error, is exact, or says why it has none; and says so wherever it is shown."""

from __future__ import annotations

import csv
import html
import re
import textwrap
from pathlib import Path

import pytest

import flankfilm as ff
from base.results import EXACT, ITSELF
from flankfilm.products.output import error_name
from flankfilm.studies.columns import error_attributes
from flankfilm.studies.outputs import ERROR_OF, MODEL_ERROR_OF, OUTPUTS, error_said, exact
from flankfilm.studies.page import error_noted
from tests.flankfilm.explained import unexplained

HELD = {*ERROR_OF.values(), *MODEL_ERROR_OF.values()}

GEOMETRY = """
[pair]
module_mm = 2.0
face_width_mm = 20.0
backlash_um = 50
pinion = { teeth = 24 }
wheel = { teeth = 31 }
[material]
youngs_modulus_GPa = 206.0
poisson_ratio = 0.3
density_kg_per_m3 = 7850
[operating]
pinion_torque_Nm = 100.0
pinion_speed_rpm = 1000.0
[stiffness]
model = "ishikawa"
pairs = "independent"
[film]
model = "none"
"""

STUDY = """
scene = "scene.toml"
outputs = ["contact_ratio", "iso_contact_stress_MPa", "mean_secant_stiffness_N_per_mm_um", "transmission_error_um",
           "transmission_error_error"]
[vary]
"pair.module_mm" = [2.0, 2.5]
"""


@pytest.mark.parametrize("name", OUTPUTS)
def test_every_output_has_an_error_or_says_why_not(name: str):
    output, said = OUTPUTS[name], error_said(name)
    if name in ERROR_OF:
        assert said in OUTPUTS
        assert OUTPUTS[said].no_error == ITSELF
        return
    assert said == output.no_error
    assert " " in said
    assert "<" not in said
    assert not said.endswith(".")
    assert output.error is None


@pytest.mark.parametrize("name", sorted(HELD | {name for name in OUTPUTS if name.endswith("_error")}))
def test_errors_are_errors_themselves(name: str):
    assert OUTPUTS[name].no_error == ITSELF
    assert OUTPUTS[name].unit == "1"
    assert not exact(name)


def test_what_follows_from_the_geometry_is_exact():
    known = {name for name in OUTPUTS if exact(name)}
    assert {name for name, output in OUTPUTS.items() if output.wants == ("geometry",)} <= known
    assert not known & {*ERROR_OF, *HELD}
    assert all(OUTPUTS[name].no_error == EXACT for name in known)


@pytest.mark.parametrize("name", OUTPUTS)
def test_what_variables_say(name: str):
    alone, beside = error_attributes(name, [name]), error_attributes(name, [name, ERROR_OF.get(name, "")])
    assert len(alone) == len(beside) == 1
    if name in ERROR_OF:
        assert beside == {"error_variable": ERROR_OF[name]}
        assert ERROR_OF[name] in alone["error_note"]
    else:
        assert alone == beside == {"error_note": OUTPUTS[name].no_error}


def test_errors_are_named_as_before():
    """An output whose record has an error has a column for it that is called after it."""
    own = {name for name in ERROR_OF if OUTPUTS[name].error is not None and not OUTPUTS[name].error_output}
    assert all(ERROR_OF[name] == error_name(name, OUTPUTS[name]) for name in own)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory, rows_of_module_here: None) -> Path:
    folder = tmp_path_factory.mktemp("study")
    (folder / "scene.toml").write_text(
        'wants = ["stiffness"]\n' + textwrap.dedent(GEOMETRY), encoding="utf-8"
    )
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    ff.study(folder / "study.toml", out=folder / "out")
    return folder / "out"


def test_data_table_and_page_of_a_study_say_it(study: Path):
    data = ff.open_results(study)
    assert not unexplained(data)
    assert data.contact_ratio.attrs["error_note"] == EXACT
    assert data.transmission_error_um.attrs["error_variable"] == "transmission_error_error"
    with (study / "columns.csv").open(encoding="utf-8", newline="") as file:
        said = {row["column"]: row for row in csv.DictReader(file)}
    with (study / "rows.csv").open(encoding="utf-8", newline="") as file:
        heads = next(csv.reader(file))
    assert set(heads) - {"row", "fault", "crc32"} == set(said)
    for name, row in said.items():
        assert bool(row["error_column"]) != bool(row["error_note"]), name
        assert not row["error_column"] or row["error_column"] in heads
    page = html.unescape(re.sub(r"\s+", " ", (study / "report.html").read_text(encoding="utf-8")))
    for name in ("contact_ratio", "iso_contact_stress_MPa"):
        assert error_noted(OUTPUTS[name].no_error) in page
    assert "not asked for: the output stiffness_error holds it" in page


def test_tables_of_a_run_say_it(tmp_path: Path):
    text = 'wants = ["stiffness", "closed-forms", "geometry"]\n' + textwrap.dedent(GEOMETRY)
    run = ff.run(ff.parse_scene(text), out=tmp_path / "run", cache=False)
    assert run.folder is not None
    tables = {path.stem for path in (run.folder / "csv").glob("*.csv")}
    with (run.folder / "csv" / "columns.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["table"] for row in rows} == tables - {"columns", "uncertainties", "geometry"}
    for row in rows:
        ways = [row[way] for way in ("relative_error", "error_variable", "error_note")]
        assert sum(map(bool, ways)) == 1, row
    for table in {row["table"] for row in rows}:
        with (run.folder / "csv" / f"{table}.csv").open(encoding="utf-8", newline="") as file:
            assert next(csv.reader(file)) == [row["column"] for row in rows if row["table"] == table]
    with (run.folder / "csv" / "geometry.csv").open(encoding="utf-8", newline="") as file:
        assert {row["error"] for row in csv.DictReader(file)} == {EXACT}
