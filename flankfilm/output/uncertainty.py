"""How far a figure may be off, and whether that meets the tolerance: every display asks here.

A figure's numerical error is what grids, samples and rounds leave; a tolerance bounds it. Its model error is what the
laws and numbers behind it leave open, where that is estimated (`flankfilm.output.model_errors`): no tolerance makes it
smaller. Both are relative to the figure's value in SI, and the total is their sum.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from base.results import Figure, figures
from flankfilm.output.model_errors import entry

__all__ = ["Uncertainty", "held_error", "held_model_error", "met", "uncertainty"]


@dataclass(frozen=True)
class Uncertainty:
    """How far a figure may be off.

    Attributes
    ----------
    numerical, model : float or None
        Relative errors; None where they are unknown, or not estimated.
    size : float
        Value that they are relative to, where they are shown as absolute ones; 0 where they are shown in per cent.
    unit : str
        Of that value.
    """

    numerical: float | None
    model: float | None = None
    size: float = 0.0
    unit: str = ""

    @property
    def total(self) -> float | None:
        """Numerical and model error together; None where the numerical one is unknown."""
        return None if self.numerical is None else self.numerical + (self.model or 0.0)

    def met(self, tolerance: float) -> bool | None:
        """Whether the numerical error meets a tolerance; None where it is unknown."""
        return None if self.numerical is None else met(self.numerical, tolerance)


def met(error: float, tolerance: float) -> bool:
    """Whether a numerical error meets a tolerance: the one rule by which figures are marked.

    Examples
    --------
    >>> met(0.01, 0.01), met(0.0101, 0.01), met(float("nan"), 0.01)
    (True, False, False)
    """
    return bool(error <= tolerance)


def uncertainty(record: object, name: str) -> Uncertainty:
    """Errors of a figure of a record that is a single number.

    Parameters
    ----------
    record : object
        With figures.
    name : str
        Of the figure.
    """
    figure = figures(type(record))[name]
    error = held_error(record, name, figure)[1]
    return Uncertainty(_single(error), _single(held_model_error(record, name, figure)))


def held_error(record: object, name: str, figure: Figure) -> tuple[str, Any]:
    """Name under which a record holds the numerical error of a figure, and the error itself; None where unknown."""
    headline = getattr(type(record), "headline", ())
    holds = figure.error or ("error" if name in headline and not figure.no_error else "")
    error: Any = getattr(record, holds, None) if holds else None
    return holds, error.get(name, error) if isinstance(error, Mapping) else error


def held_model_error(record: object, name: str, figure: Figure) -> Any:
    """Model error of a figure of a record, of the table or as the record holds it; None where it is not estimated."""
    if (known := entry(record, name)) is not None:
        return known.of(record)
    error: Any = getattr(record, figure.model_error, None) if figure.model_error else None
    return error.get(name) if isinstance(error, Mapping) else error


def _single(error: Any) -> float | None:
    known = isinstance(error, float | np.floating) and bool(np.isfinite(error))
    return float(error) if known else None
