"""Quantities over time as a caller gives them: functions or values, checked before anything is computed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Faults, InputError, Limit
from ehl.discrete.contact import LIMITS, LineContact
from ehl.discrete.supply import Meniscus
from ehl.solving.time_march import FIRST

OverTime = Callable[[float], float] | ArrayLike
"""A quantity over time: a function of seconds, or values at the times, between which it is linear."""

_LIMITS = {"tolerance": Limit.above(0.0, 0.2, remedy="0.01 is 1 %")}
_NODES = (32, 4097, "129 is usual; leave it out to let the tolerance decide")
_STEP = Limit.above(0.0, 1e6, "s", "leave it out to let the tolerance decide")

Functions = dict[str, Callable[[float], float]]


def at_time(contact: LineContact, functions: Functions, time: float) -> LineContact:
    """Contact at a time; faults name the time."""
    values: dict[str, Any] = {name: float(function(time)) for name, function in functions.items()}
    try:
        return replace(contact, **values)
    except InputError as error:
        faults = [replace(fault, where=f"{fault.where} at t = {time:.6g} s") for fault in error.faults]
        raise InputError(faults) from None


def checked(
    contact: object,
    load: object,
    time: object,
    entrainment: object,
    radius: object,
    tolerance: object,
    nodes: object,
    step: object,
    supply: object,
) -> tuple[Functions, Array]:
    """Raise every fault of the arguments; return the functions of time and the times."""
    functions: Functions = {}
    with Faults() as faults:
        if not isinstance(contact, LineContact):
            faults.add("contact", contact, "must be a LineContact", "build one with ehl.LineContact")
        faults.number("tolerance", tolerance, _LIMITS["tolerance"])
        if nodes is not None:
            faults.whole("nodes", nodes, *_NODES)
        if step is not None:
            faults.number("step", step, _STEP)
        if supply is not None and not isinstance(supply, Meniscus):
            allowed = "must be None (flooded) or ehl.Meniscus"
            faults.add(
                "supply", supply, allowed, "behind a layer the meniscus moves and stores oil: not computed"
            )
        times = _times(time, faults)
        quantities = {"load": load, "entrainment": entrainment, "radius": radius}
        for name, value in quantities.items():
            if value is not None or name == "load":
                _check_function(name, value, times, functions, faults)
    return functions, times


def _times(time: object, faults: Faults) -> Array:
    """Times as an array; two of them where they are faulty."""
    try:
        times = np.asarray(time, dtype=float)
    except (TypeError, ValueError):
        times = np.zeros(0)
    if times.ndim == 1 and times.size > 1 and np.isfinite(times).all() and (np.diff(times) > 0.0).all():
        return times
    faults.add(
        "time", time, "must be two or more increasing times", "give them in s, the first with the steady film"
    )
    return np.array([0.0, 1.0])


def _check_function(name: str, value: object, times: Array, functions: Functions, faults: Faults) -> None:
    """Add the faults of a quantity over time, or its function."""
    if callable(value):
        functions[name] = value
    else:
        try:
            values = np.asarray(value, dtype=float)
        except (TypeError, ValueError):
            values = np.zeros(0)
        if values.shape != times.shape:
            faults.add(
                name, value, "must be a function of time, or one value for each time", "lambda t: 1e5, say"
            )
            return
        functions[name] = lambda at: float(np.interp(at, times, values))
    own = [float(functions[name](at)) for at in times.tolist()]
    if name == "entrainment" and min(own) <= 0.0 < max(own):
        allowed = "must stay positive: where it turns round, inlet and outlet change places"
        faults.add(name, min(own), allowed, "solve the time before and the time after by themselves")
        return
    for at, quantity in zip(times.tolist(), own, strict=True):
        before = len(faults.found)
        faults.number(f"{name} at t = {at:.6g} s", quantity, LIMITS[name])
        if len(faults.found) > before:
            return


def jump_fault(contact_at: Callable[[float], LineContact], time: float) -> InputError:
    """Fault of a load that jumps."""
    contact = contact_at(time)
    unit = contact.half_width / contact.entrainment
    return InputError.at(
        "load",
        f"{contact.load:.6g} N/m at t = {time:.6g} s",
        f"must not jump, as it does within the next {FIRST * unit:.2g} s: in no time no oil leaves the gap, and what "
        "would carry the jump is a flat punch as wide as the oil reaches",
        f"ramp it over the time in which load sharing shifts it, b/u = {unit:.2g} s or some tenths of it",
    )
