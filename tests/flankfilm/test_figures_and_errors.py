"""Every figure of every record says what it errs by, or why that is not known, where it is declared."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import pkgutil
import re

import numpy as np
import pytest

from base import quantity, record
from base.results import figures, why_no_error
from base.units import FACTORS
from flankfilm.output.variables import PLACES, of_models, of_record

PACKAGES = ("gears", "meshes", "fem", "ehl", "dynamics", "flankfilm")


def records() -> dict[str, type]:
    """Every class with figures, by its place."""
    found = {}
    for package in map(importlib.import_module, PACKAGES):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if "peer_scripts" in module.name or module.name.endswith("__main__"):
                continue
            for cls in vars(importlib.import_module(module.name)).values():
                if inspect.isclass(cls) and cls.__module__ == module.name and dataclasses.is_dataclass(cls):
                    found[f"{module.name}:{cls.__qualname__}"] = cls
    return {place: cls for place, cls in found.items() if figures(cls)}


RECORDS = records()


def unsaid(cls: type) -> list[str]:
    """Figures of a record that do not say what they err by."""
    whole = (
        set(getattr(cls, "headline", ()))
        if hasattr(cls, "error") or "error" in cls.__annotations__
        else set()
    )
    return [
        name
        for name, figure in figures(cls).items()
        if not (
            figure.unit == "" or figure.error or name in whole or name in PLACES or why_no_error(cls, name)
        )
    ]


@pytest.mark.parametrize("place", RECORDS)
def test_every_figure_says_what_it_errs_by_or_why_not(place):
    assert not unsaid(RECORDS[place])


@pytest.mark.parametrize("place", RECORDS)
def test_what_figures_declare_is_there(place):
    """Units that are known, axes that are words, a meaning in words, and the figure that holds the error."""
    cls = RECORDS[place]
    held = {field.name for field in dataclasses.fields(cls)}
    for name, figure in figures(cls).items():
        for unit in {figure.unit, figure.shown} - {""}:
            atoms = re.split(r"[ /()]+", re.sub(r"(?<=[a-z])\d", "", unit))
            assert {*atoms} <= {*FACTORS, "J", "s^0.5", ""}, (name, unit)
        assert len(figure.meaning) > 2 or figure.meaning.isalnum(), name
        assert all(axis.isidentifier() or axis == "..." for axis in figure.dims), (name, figure.dims)
        if figure.error:
            assert figure.error in held or hasattr(cls, figure.error), (name, figure.error)
        assert not figure.no_error or " " in figure.no_error, name


def test_a_figure_that_says_nothing_is_found():
    @record
    class Tooth:
        height: float = quantity("m", "height")
        deflection: float = quantity("m", "deflection", error="error")
        material: str = quantity("", "name of the material")
        error: float = quantity("1", "relative error of the deflection", default=0.1)

    assert unsaid(Tooth) == ["height"]


@record
class Curve:
    position: object = quantity("1", "where", "position")
    force: object = quantity("N", "force", "position", error="error")
    share: object = quantity("1", "share", "position", error="share_error")
    share_error: object = quantity("1", "error of the share", "position")
    parts: object = quantity("N", "force of", "position", error="errors", no_error="unknown: a formula")
    mean: float = quantity("N", "mean force", error="error", no_error="unknown without one")
    error: float | None = 0.02

    no_error = "not estimated"

    @property
    def errors(self):
        return {"one": 0.5}


def curve(error: float | None = 0.02) -> Curve:
    values = np.array([1.0, 2.0])
    return Curve(values, values, values, 0.1 * values, {"one": values, "other": values}, 1.5, error)


def said(data) -> dict[str, object]:
    return {
        str(name): next(
            about.attrs[kind] for kind in ("error", "error_variable", "error_note") if kind in about.attrs
        )
        for name, about in data.variables.items()
    }


def test_variables_take_over_what_figures_say():
    assert said(of_record("dry", curve())) == {
        "dry_position": "a place",
        "dry_force": 0.02,
        "dry_share": "dry_share_error",
        "dry_share_error": "it is an error, or the measure of one, itself",
        "dry_parts_one": 0.5,
        "dry_parts_other": "unknown: a formula",
        "dry_mean": 0.02,
    }
    without = said(of_record("dry", curve(None)))
    assert without["dry_mean"] == "unknown without one"
    assert without["dry_force"] == "not estimated"


def test_models_beside_each_other_have_the_largest_error_where_all_have_one():
    both = {"a": curve(), "b": curve(0.03)}
    assert said(of_models("other", both, "model"))["other_mean"] == 0.03
    one = said(of_models("other", {"a": curve(), "b": curve(None)}, "model", no_error="not of all"))
    assert one["other_mean"] == "not of all"
    held = said(of_models("other", both, "model", errors={"force": "share_error"}))
    assert held["other_force"] == "other_share_error"
    lacking = said(of_models("other", both, "model", errors={"force": "gone_error"}))
    assert lacking["other_force"] == 0.03
