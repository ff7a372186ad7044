"""One uncertainty of a figure: numerical and model error side by side, and one rule by which it is marked."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from base import quantity, record
from ehl.discrete import regimes
from flankfilm.coupling.mesh.extreme_errors import of_greatest, of_least
from flankfilm.output.uncertainty import Uncertainty, met, uncertainty
from flankfilm.output.variables import of_record, with_tolerance
from flankfilm.report.film_parts import regime_said
from flankfilm.report.page import Headline
from flankfilm.report.text import off
from flankfilm.stages.losses import LOSSES
from flankfilm.stages.mesh import FILM
from flankfilm.studies.outputs import OUTPUTS


@record
class Loss:
    """A figure with both errors, one with a numerical one and one without."""

    headline = ("loss",)

    loss: float = quantity("W", "loss", error="errors", model_error="model_errors")
    film: float = quantity("m", "film", error="error")
    share: float = quantity("1", "share", no_error="not estimated")
    error: float = 0.02

    @property
    def errors(self) -> dict[str, float | None]:
        """Numerical errors by name."""
        return {"loss": 0.003}

    @property
    def model_errors(self) -> dict[str, float]:
        """Model errors by name."""
        return {"loss": 0.2}


FOUND = Loss(500.0, 1e-6, 0.1)


def test_all_displays_say_the_same_of_a_figure():
    asked = {name: uncertainty(FOUND, name) for name in ("loss", "film", "share")}
    assert asked == {"loss": Uncertainty(0.003, 0.2), "film": Uncertainty(0.02), "share": Uncertainty(None)}
    assert asked["loss"].total == pytest.approx(0.203)
    data = with_tolerance(of_record("a", FOUND), 0.01)
    assert data.attrs["tolerance"] == 0.01
    assert {key: data["a_loss"].attrs[key] for key in ("error", "model_error", "tolerance_met")} == {
        "error": 0.003,
        "model_error": 0.2,
        "tolerance_met": 1,
    }
    assert data["a_film"].attrs["tolerance_met"] == 0
    assert "tolerance_met" not in data["a_share"].attrs
    shown = {name: Headline(name, "1", uncertainty=one) for name, one in asked.items()}
    notes = {name: one.against(0.01).note for name, one in shown.items()}
    assert notes["loss"] == "± 20 % (numerical 0.3 %, model 20 %)"
    assert notes["film"] == "± 2 % (numerical; model not estimated); ! above the tolerance of 1 %"
    assert notes["share"] == "error unknown"
    missed = {name for name, one in shown.items() if one.miss(0.01)}
    assert missed == {str(name)[2:] for name in data.data_vars if data[name].attrs.get("tolerance_met") == 0}


def test_only_the_numerical_error_has_a_tolerance_to_meet():
    assert Uncertainty(0.01, 0.5).met(0.01)
    assert not Uncertainty(0.0101, 0.0).met(0.01)
    assert Uncertainty(None, 0.5).met(0.01) is None
    assert not met(float("nan"), 0.01)


def test_temperatures_err_by_kelvin():
    assert off(Uncertainty(0.2 / 378.0, size=378.0, unit="K"), 0.01).startswith("± 0.2 K (numerical")
    assert off(Uncertainty(1e-4, size=100.0, unit="points"), 0.01).startswith("± 0.01 points")


def test_the_greatest_value_errs_as_those_near_it():
    rises, errors = np.array([25.0, 24.9, 0.3]), np.array([0.004, 0.005, 1.1])
    assert of_greatest(rises, errors) < 0.006
    assert of_least(np.array([0.45, 0.46, 3.0]), np.array([0.01, 0.002, 0.3])) == pytest.approx(0.01)
    assert of_greatest(np.array([1.0, 0.99]), np.array([0.0, 0.05])) == pytest.approx(0.0395)
    assert of_greatest(np.zeros(3), errors) == 0.0


def test_regimes_have_names_at_the_head_and_numbers_in_studies():
    said = {ratio: regime_said(ratio).split(" lubrication")[0] for ratio in (0.99, 1.0, 2.99, 3.0)}
    assert said == {0.99: "boundary", 1.0: "mixed", 2.99: "mixed", 3.0: "full film"}
    rough = SimpleNamespace(film=SimpleNamespace(least_film_ratio=0.4))
    smooth = SimpleNamespace(film=SimpleNamespace(least_film_ratio=None))
    assert OUTPUTS["regime"].value({FILM: rough}) == 1.0
    assert np.isnan(OUTPUTS["regime"].value({FILM: smooth}))
    hot = SimpleNamespace(path=SimpleNamespace(least_film_ratio=3.1), boundary=None)
    assert OUTPUTS["regime_with_heat"].value({LOSSES: hot}) == 3.0
    assert "doi:10.1007/s40544-019-0267-5" in (regimes.__doc__ or "")
