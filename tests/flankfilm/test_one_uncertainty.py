"""A computed example: all displays of the report, the terminal, files and studies give one uncertainty."""

from __future__ import annotations

import csv
import re
import warnings
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import flankfilm as ff
from base.results import figures
from fem import FaceLoads, RootStress
from fem.stress.gear_root import GearRootStress
from flankfilm.coupling import MeshCycle, MeshLosses, MeshSeries, PairOscillator
from flankfilm.coupling.speeds.drive_sweep import DriveSweep
from flankfilm.outcome.results import Results
from flankfilm.output.model_errors import MODEL_ERRORS
from flankfilm.output.uncertainty import Uncertainty, met
from flankfilm.report.stiffness_parts import stiffness
from flankfilm.report.text import off, percent
from flankfilm.runs.report import headlines, misses, summary
from flankfilm.stages.engine import Stage
from flankfilm.studies.outputs import ERROR_OF, MODEL_ERROR_OF, OUTPUTS
from tests.flankfilm.program import EXAMPLES

DOCS = Path(__file__).parents[2] / "docs"
WANTS = 'wants = ["closed-forms", "stiffness", "film", "root-stress", "fourier"]'
TOLERANCE = 0.004
"""Which the film misses, and the means and the root stress meet."""

CARDS = {
    "mean mesh stiffness (secant": (
        "lubricated_mean_secant_stiffness",
        "mean_secant_stiffness_N_per_mm_um",
    ),
    "mean mesh stiffness (tangent": (
        "lubricated_mean_tangent_stiffness",
        "mean_tangent_stiffness_N_per_mm_um",
    ),
    "loaded transmission error": ("lubricated_transmission_error_range", "transmission_error_um"),
    "minimum film on the path": ("film_least_film", "least_film_um"),
    "maximum root stress": ("", "root_tension_pinion_MPa"),
}
"""Beginning of a card's name to its variable in results.nc and its output of studies."""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Results:
    text = (EXAMPLES / "article.toml").read_text(encoding="utf-8")
    text = re.sub("wants = .*", WANTS, text, count=1).replace("tolerance = 0.005", "tolerance = 0.01")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ff.run(ff.parse_scene(text), out=tmp_path_factory.mktemp("run"), cache=False)


def studied(run: Results, name: str) -> float:
    """Output of a study whose row is this run."""

    class Row(dict):
        scene = run.scene

        def __missing__(self, stage: Stage[Any]) -> Any:
            return run.get(stage) if stage.name != "mesh" else run.values["film"]

    return OUTPUTS[name].value(Row())


@pytest.mark.parametrize("begins", CARDS)
def test_every_display_gives_one_uncertainty(run: Results, begins: str):
    variable, output = CARDS[begins]
    (card,) = [one for one in headlines(run.computed) if one.name.startswith(begins)]
    assert card.uncertainty is not None
    text = off(card.uncertainty, run.scene.tolerance)
    assert card.note.startswith(text)
    (line,) = [line for line in summary(run) if line.startswith(f"{card.name}: ")]
    assert text in line
    missed = [line for line in misses(run.computed) if line.startswith(f"{card.name}: ")]
    assert bool(missed) == (not card.uncertainty.met(run.scene.tolerance)) == ("!" in text)
    errors = studied(run, ERROR_OF[output]), MODEL_ERROR_OF.get(output)
    assert errors[0] == card.uncertainty.numerical
    model = None if errors[1] is None else studied(run, errors[1])
    assert model == card.uncertainty.model
    if not variable:  # a curve, with the error of its maximum
        about = run.dataset["root_pinion_tension"].attrs
        assert (about["error"], about["model_error"]) == (errors[0], model)
        return
    about = run.dataset[variable].attrs
    assert about["error"] == card.uncertainty.numerical
    assert about.get("model_error") == card.uncertainty.model
    assert about["tolerance_met"] == int(met(about["error"], run.scene.tolerance))
    assert run.folder is not None
    with (run.folder / "csv" / "uncertainties.csv").open(encoding="utf-8") as file:
        (row,) = [row for row in csv.DictReader(file) if row["variable"] == variable]
    assert float(row["total_uncertainty"]) == pytest.approx(card.uncertainty.total)
    assert bool(int(row["tolerance_met"])) == ("!" not in text)
    assert row["model_error_source"] == about.get("model_error_source", "")


def test_the_mark_is_that_of_the_numerical_error(run: Results):
    tighter = replace(run, scene=run.scene.model_copy(update={"tolerance": TOLERANCE}))
    marked = {one.name for one in headlines(tighter.computed) if "!" in one.note}
    assert "minimum film on the path" in marked
    assert not any(name.startswith(("mean", "loaded")) for name in marked)


def test_the_table_has_the_models_errors_of_the_cards(run: Results):
    cycle = run.values["film"]
    table = stiffness(None, None, [cycle], (), run.values["pair"].face_width, run.dataset).tables[0]
    (column,) = [i for i, head in enumerate(table.heads) if str(head).startswith("model error of secant")]
    cards = {one.name: one.uncertainty for one in headlines(run.computed)}
    known = [one for name, one in cards.items() if name.startswith(tuple(list(CARDS)[:3]))]
    assert table.rows[0][column] == ", ".join(percent(one.model) for one in known if one is not None)


KINDS = {
    one.__name__: one
    for one in (MeshSeries, PairOscillator, FaceLoads, GearRootStress, RootStress, MeshLosses, DriveSweep)
} | {"MeshFigures": MeshCycle}


@pytest.mark.parametrize("key", MODEL_ERRORS)
def test_entries_are_of_figures_and_have_a_page(key: tuple[str, str]):
    kind, figure = key
    assert figure in figures(KINDS[kind])
    assert (DOCS / MODEL_ERRORS[key].source).is_file()
    page = (DOCS / "validation" / "model_errors.md").read_text(encoding="utf-8")
    assert Path(MODEL_ERRORS[key].source).name in page


def test_what_is_not_known_says_so(run: Results):
    shown = {one.name: one for one in headlines(run.computed)}
    assert "(numerical; model not estimated)" in shown["minimum film on the path"].note
    closed = [one for one in run.values["other cycles"] if one.contact is None]
    assert all(MODEL_ERRORS[("MeshFigures", "mean_stiffness")].of(one) is None for one in closed)
    assert closed


@pytest.mark.parametrize(
    ("modules", "blank", "plane", "face", "part"),
    [
        (20.0, None, "strain", None, 0.021),
        (10.0, None, "strain", None, 0.021),
        (5.0, None, "strain", None, 0.58 * 0.09 / 0.91),
        (0.5, None, "strain", None, 0.09 / 0.91),
        (20.0, None, "stress", None, 0.09 / 0.91),
        (20.0, object(), "strain", None, 0.057),
        (3.0, None, "strain", "free-ends", 0.002),
        (20.0, None, "strain", "walls", 0.021),
    ],
)
def test_what_the_plane_leaves_out(modules: float, blank: object, plane: str, face: str | None, part: float):
    gear = SimpleNamespace(blank=blank, teeth=10**6)
    steel = SimpleNamespace(poisson_ratio=0.3)
    pair = SimpleNamespace(
        pinion=gear, wheel=gear, materials=(steel, steel), face_width=2e-3 * modules, module=2e-3
    )
    over = None if face is None else SimpleNamespace(setting=SimpleNamespace(model=face), pair=pair)
    contact = SimpleNamespace(
        pair=pair,
        plane=plane,
        face=over,
        lines=None,
        reference="bore",
        model_error=0.01,
        beyond_path=True,
    )
    of = MODEL_ERRORS[("MeshFigures", "mean_secant_stiffness")].of
    assert of(contact) == pytest.approx(0.01 + part, rel=1e-9)
    if over is not None:
        factor = MODEL_ERRORS[("FaceLoads", "greatest_face_load_factor")].of(over)
        assert factor == (0.005 if face == "free-ends" else 0.13)


def test_parts_of_the_model_error(run: Results):
    """Plane and contacts' law by hand, of the example's 36 and 40 teeth: discs, even load, against the bodies."""
    contact = run.values["film"].contact
    secant, tangent, between = (
        MODEL_ERRORS[("MeshFigures", name)].of(run.values["film"])
        for name in ("mean_secant_stiffness", "mean_stiffness", "transmission_error_range")
    )
    assert secant is not None
    assert tangent is not None
    assert between is not None
    teeth = 0.005 + 0.005 * (36 / 40) ** (np.log(5) / np.log(120 / 36))
    assert secant == pytest.approx(contact.model_error + 0.021 + teeth, rel=1e-9)
    assert tangent - secant == pytest.approx(contact.model_error, rel=1e-9)
    swing = run.values["film"].transmission_error_range
    deflection = contact.force / run.values["film"].secant_stiffness.min()
    assert between == pytest.approx(0.021 + contact.model_error * deflection / swing, rel=1e-9)
    assert Uncertainty(1e-3, secant).total == pytest.approx(secant + 1e-3)
