"""Which output of a study holds the relative error of another one, and which outputs have none."""

from __future__ import annotations

from collections.abc import Mapping

from flankfilm.studies.held_errors import HELD, MODEL
from flankfilm.studies.output import error_name
from flankfilm.studies.outputs import OUTPUTS

ROUNDING = 1e-12
"""Relative error of what follows from the geometry alone."""

MODEL_ERROR_OF: Mapping[str, str] = {name: error for error, names in MODEL.items() for name in names}
"""Output to the output that holds what its model leaves open, relative."""

ERROR_OF: Mapping[str, str] = {
    **{name: error_name(name, output) for name, output in OUTPUTS.items() if output.error is not None},
    **{name: error for error, names in HELD.items() for name in names},
}
"""Output to the output that holds its relative error; the others have none."""


def exact(name: str) -> bool:
    """Whether an output follows from the geometry alone, so that it errs by rounding."""
    return OUTPUTS[name].wants == ("geometry",)
