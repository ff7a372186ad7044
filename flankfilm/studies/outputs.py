"""What a study can ask of a row: one number each, from the stages that it needs and no others."""

from __future__ import annotations

from collections.abc import Mapping

from base.results import EXACT
from flankfilm.products.catalogue import PRODUCTS
from flankfilm.products.output import Output, error_name, with_errors

OUTPUTS: Mapping[str, Output] = with_errors(
    {name: output for product in PRODUCTS for name, output in product.outputs()}
)
"""Outputs by the name that a study file gives them; the unit is part of it."""

ROUNDING = 1e-12
"""Relative error of what follows from what is given alone."""

ERROR_OF: Mapping[str, str] = {
    name: output.error_output or error_name(name, output)
    for name, output in OUTPUTS.items()
    if output.error_output or output.error is not None
}
"""Output to the output that holds its relative error; the others have none."""

MODEL_ERROR_OF: Mapping[str, str] = {
    name: output.model_output for name, output in OUTPUTS.items() if output.model_output
}
"""Output to the output that holds what its model leaves open, relative."""


def exact(name: str) -> bool:
    """Whether an output follows from what is given alone, so that it errs by rounding."""
    return OUTPUTS[name].no_error == EXACT


def error_said(name: str) -> str:
    """What holds the error of an output, or why it has none: every output says one of both.

    Examples
    --------
    >>> error_said("mean_secant_stiffness_N_per_mm_um")
    'stiffness_error'
    >>> error_said("contact_ratio")
    'exact: it follows from what is given'
    >>> error_said("regime")
    'a class, exact but at its bounds: it follows from the film ratio, which has an error'
    """
    return ERROR_OF.get(name) or OUTPUTS[name].no_error
