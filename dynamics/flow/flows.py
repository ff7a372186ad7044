"""Which flow an oscillator has: the one place where it is chosen for the kind of oscillator."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import singledispatch

from base import Faults, InputError
from dynamics.flow.drive_flow import DriveFlow, drive_flow, tabulated
from dynamics.flow.exact_flow import ExactFlow, exact_flow
from dynamics.flow.protocol import Flow, PartedFlow
from dynamics.flow.stepwise_flow import StepwiseFlow
from dynamics.flow.table_reuse import TableReuse
from dynamics.model.drive_oscillator import DriveOscillator
from dynamics.model.limits import POSITIVE
from dynamics.model.oscillator import GearOscillator
from dynamics.model.protocol import Oscillator, PeriodicOscillator
from dynamics.model.smooth_oscillator import SmoothOscillator


@singledispatch
def flow_of(oscillator: Oscillator, tolerance: float | None = None) -> Flow:
    """Make an oscillator ready to be followed.

    Parameters
    ----------
    oscillator : GearOscillator, DriveOscillator or SmoothOscillator
        The oscillator.
    tolerance : float, optional
        Of a step (stepwise flow) or of one period's map (exact flow of one freedom); that of several freedoms leaves
        rounding alone, whatever is asked for.

    Returns
    -------
    Flow
        `Flow.slopes` adds derivatives by parameters to the stepwise one.

    Raises
    ------
    InputError
        If the tolerance is out of range, or there is no flow for such an oscillator.
    """
    raise unserved(oscillator)


@flow_of.register
def _exact(oscillator: GearOscillator, tolerance: float | None = None) -> ExactFlow:
    return exact_flow(oscillator, tolerance=tolerance)


@flow_of.register
def _of_drive(oscillator: DriveOscillator, tolerance: float | None = None) -> DriveFlow:
    _check(tolerance)
    return drive_flow(oscillator)


@flow_of.register
def _stepwise(oscillator: SmoothOscillator, tolerance: float | None = None) -> StepwiseFlow:
    return StepwiseFlow(oscillator, tolerance)


@singledispatch
def refined_flow(oscillator: PeriodicOscillator, refinement: int = 1) -> PartedFlow:
    """Make an oscillator ready to be followed in so many times the usual number of cells.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator.
    refinement : int
        Factor on the number of cells.

    Raises
    ------
    InputError
        If its flow has no cells.
    """
    raise unserved(oscillator)


@refined_flow.register
def _exact_cells(oscillator: GearOscillator, refinement: int = 1) -> ExactFlow:
    return exact_flow(oscillator, refinement)


@refined_flow.register
def _cells_of_drive(oscillator: DriveOscillator, refinement: int = 1) -> DriveFlow:
    return tabulated(oscillator, math.ceil(oscillator.cells) * refinement)


@singledispatch
def flows_along(
    oscillator: Oscillator, parameter: str, tolerance: float | None = None
) -> Callable[[Oscillator], Flow]:
    """Flows of an oscillator with one value of a parameter after another, each good until the next is asked for.

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator; its own value of the parameter is not used.
    parameter : str
        One of its `parameters`.
    tolerance : float, optional
        As of `flow_of`.

    Raises
    ------
    InputError
        If the tolerance is out of range or there is no such parameter; or by the callable, as by `flow_of`.
    """
    return lambda here: flow_of(here, tolerance)


@flows_along.register
def _tables_along(
    oscillator: GearOscillator, parameter: str, tolerance: float | None = None
) -> Callable[[Oscillator], Flow]:
    _check(tolerance)
    line = TableReuse(oscillator, parameter, tolerance)
    if line.first > 0:  # else it is all made anew, and there is nothing to keep
        return line.at
    return lambda here: flow_of(here, tolerance)


def _check(tolerance: float | None) -> None:
    with Faults() as faults:
        if tolerance is not None:
            faults.number("tolerance", tolerance, POSITIVE)


def unserved(oscillator: object) -> InputError:
    """Error of what is no oscillator that there is a flow for."""
    allowed = "must be a GearOscillator, a SmoothOscillator or a DriveOscillator"
    return InputError.at("oscillator", type(oscillator).__name__, allowed, "take one of these")
