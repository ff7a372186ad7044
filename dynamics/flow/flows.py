"""Which flow an oscillator has: the one place where it is chosen for the kind of oscillator."""

from __future__ import annotations

from collections.abc import Callable

from base import Faults, InputError
from dynamics.flow.drive_flow import drive_flow
from dynamics.flow.exact_flow import exact_flow
from dynamics.flow.stepwise_flow import StepwiseFlow
from dynamics.flow.table_reuse import TableReuse
from dynamics.model.drive_oscillator import DriveOscillator
from dynamics.model.limits import POSITIVE
from dynamics.model.oscillator import GearOscillator
from dynamics.model.protocol import Flow, Oscillator
from dynamics.model.smooth_oscillator import SmoothOscillator


def flow_of(
    oscillator: Oscillator,
    tolerance: float | None = None,
    parameters: tuple[str, ...] = (),
    extrema: bool = False,
) -> Flow:
    """Make an oscillator ready to be followed.

    Parameters
    ----------
    oscillator : GearOscillator, DriveOscillator or SmoothOscillator
        The oscillator.
    tolerance : float, optional
        Of a step (stepwise flow) or of one period's map (exact flow of one freedom); that of several freedoms leaves
        rounding alone, whatever is asked for.
    parameters : tuple of str
        Parameters to differentiate by, stepwise flow alone.
    extrema : bool
        Whether extrema of X are among the events, stepwise flow alone.

    Raises
    ------
    InputError
        If the tolerance is out of range or there is no such parameter; also if derivatives by parameters or extrema
        of the exact flow are asked for, which `map_derivatives` and `turning_points` give.
    """
    if isinstance(oscillator, SmoothOscillator):
        return StepwiseFlow(oscillator, tolerance, parameters, extrema)
    if not isinstance(oscillator, GearOscillator | DriveOscillator):
        raise unserved(oscillator)
    drives = isinstance(oscillator, DriveOscillator)
    asked = (
        (
            "parameters",
            parameters,
            "take differences" if drives else "take dynamics.branches.sensitivity.map_derivatives",
        ),
        ("extrema", extrema, "take trajectory" if drives else "take dynamics.flow.exact_flow.turning_points"),
    )
    with Faults() as faults:
        for name, value, remedy in asked:
            if value:
                faults.add(name, value, f"must be left out for a {type(oscillator).__name__}", remedy)
        if tolerance is not None:
            faults.number("tolerance", tolerance, POSITIVE)
    if isinstance(oscillator, GearOscillator):
        return exact_flow(oscillator, tolerance=tolerance)
    return drive_flow(oscillator)


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
    if isinstance(oscillator, GearOscillator):
        with Faults() as faults:
            if tolerance is not None:
                faults.number("tolerance", tolerance, POSITIVE)
        line = TableReuse(oscillator, parameter, tolerance)
        if line.first > 0:  # else it is all made anew, and there is nothing to keep
            return line.at
    return lambda here: flow_of(here, tolerance)


def unserved(oscillator: object) -> InputError:
    """Error of what is no oscillator that there is a flow for."""
    allowed = "must be a GearOscillator, a SmoothOscillator or a DriveOscillator"
    return InputError.at("oscillator", type(oscillator).__name__, allowed, "take one of these")
