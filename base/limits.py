"""Limits of single values, and a collector that raises all faults of an input together."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from numbers import Integral, Real
from typing import Any, Self, TypeVar

import numpy as np

from base.faults import Fault, InputError, shorten

T = TypeVar("T")


@dataclass(frozen=True)
class Limit:
    """Interval that a number must lie in.

    Parameters
    ----------
    low, high : float
        Bounds; infinite where there is none.
    unit : str
        For the message.
    remedy : str
        What to do about a value outside.
    low_open, high_open : bool
        Whether the bound itself is refused.
    whole : bool
        Whether the number must be an integer.
    """

    low: float = -math.inf
    high: float = math.inf
    unit: str = ""
    remedy: str = ""
    low_open: bool = False
    high_open: bool = False
    whole: bool = False

    @classmethod
    def above(cls, low: float, high: float = math.inf, unit: str = "", remedy: str = "") -> Limit:
        """Limit of numbers that must be more than `low`.

        Examples
        --------
        >>> str(Limit.above(0.0, unit="m"))
        'must be a finite number, more than 0 m'
        """
        return cls(low, high, unit, remedy, low_open=True)

    def __str__(self) -> str:
        """What must hold, in words."""
        unit = f" {self.unit}" if self.unit else ""
        bounds = []
        if math.isfinite(self.low):
            bounds.append(f"{'more than' if self.low_open else 'at least'} {self.low:.6g}")
        if math.isfinite(self.high):
            bounds.append(f"{'less than' if self.high_open else 'at most'} {self.high:.6g}")
        kind = "a whole number" if self.whole else "a finite number"
        return f"must be {kind}" + (f", {' and '.join(bounds)}{unit}" if bounds else "")

    def holds(self, value: float) -> bool:
        """Whether the interval contains `value`; never for nan."""
        above = value > self.low if self.low_open else value >= self.low
        below = value < self.high if self.high_open else value <= self.high
        return above and below and math.isfinite(value)

    def faults(self, path: str, value: object) -> tuple[Fault, ...]:
        """Faults of one value: no number, not finite, not whole, outside; a boolean is no number.

        Parameters
        ----------
        path : str
            Path of the value.
        value : object
            As given.

        Returns
        -------
        tuple of Fault
            Empty where the value is in order.
        """
        kind = Integral if self.whole else Real
        if isinstance(value, bool) or not isinstance(value, kind):
            return (Fault(path, shorten(value), str(self), self.remedy or "give a number"),)
        if not self.holds(float(value)):
            return (Fault(path, f"{value!s}", str(self), self.remedy),)
        return ()

    def in_unit(self, factor: float, unit: str) -> Limit:
        """The same limit for numbers in another unit, `factor` of this one's."""
        return replace(self, low=self.low / factor, high=self.high / factor, unit=unit)


class Faults:
    """Collects the faults of one input, to raise them together: at the end of a ``with`` block, or when asked.

    Parameters
    ----------
    kind : type of InputError
        What is raised.

    Examples
    --------
    >>> with Faults() as faults:
    ...     faults.number("tolerance", 0.005, Limit(0.0, 0.2, low_open=True))
    0.005
    """

    def __init__(self, kind: type[InputError] = InputError) -> None:
        self.kind = kind
        self.found: list[Fault] = []

    @classmethod
    def of(cls, record: Any, limits: Mapping[str, Limit], path: str = "") -> Self:
        """Collector with the faults of a record's numbers; arguments as of `fields`."""
        faults = cls()
        faults.fields(record, limits, path)
        return faults

    def __enter__(self) -> Self:
        """Collect until the block ends."""
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        """Raise all faults noted, unless the block itself has raised."""
        if kind is None:
            self.raise_if_any()

    def add(self, path: str, value: object, allowed: str, remedy: str = "") -> None:
        """Note a fault; arguments as of `Fault.of`."""
        self.found.append(Fault.of(path, value, allowed, remedy))

    def extend(self, faults: Iterable[Fault]) -> None:
        """Note faults that were found elsewhere."""
        self.found.extend(faults)

    def number(self, path: str, value: object, limit: Limit) -> float:
        """Return the value as a float; where it breaks `limit`, note that and return nan."""
        faults = limit.faults(path, value)
        self.found.extend(faults)
        return math.nan if faults else float(value)  # type: ignore[arg-type]

    def numbers(self, limits: Mapping[str, Limit], values: Iterable[object]) -> None:
        """Note the faults of several numbers, given in the order of their limits; the last ones may be left out."""
        for (name, limit), value in zip(limits.items(), values, strict=False):
            self.number(name, value, limit)

    def fields(self, record: Any, limits: Mapping[str, Limit], path: str = "") -> None:
        """Note the faults of a dataclass's numbers; fields whose default is None may be None.

        Parameters
        ----------
        record : dataclass instance
            Its attributes are checked.
        limits : mapping
            Name of a field to its limit.
        path : str
            What stands before the names: ``"roughness."``.
        """
        optional = {f.name for f in dataclasses.fields(record) if f.default is None}
        for name, limit in limits.items():
            value = getattr(record, name)
            if not (value is None and name in optional):
                self.number(path + name, value, limit)

    def whole(self, path: str, value: object, low: int, high: int, remedy: str = "") -> int:
        """Return the value as an int; where it is none within [low, high], note that and return `low`."""
        if isinstance(value, float | np.floating) and value.is_integer():
            value = int(value)
        number = self.number(path, value, Limit(low, high, remedy=remedy, whole=True))
        return low if math.isnan(number) else int(number)

    def instance(
        self, path: str, value: object, kind: type, remedy: str = "", optional: bool = False
    ) -> bool:
        """Whether the value is of a class, or None where it is optional; where it is not, note that."""
        if isinstance(value, kind) or (optional and value is None):
            return True
        allowed = f"must be a {kind.__name__}" + (", or left out" if optional else "")
        self.add(path, shorten(value), allowed, remedy)
        return False

    def choice(self, path: str, value: T, options: Sequence[T], remedy: str = "") -> T:
        """Return the value; where it is none of `options`, note that."""
        if value not in options:
            self.add(path, shorten(value), f"must be {' or '.join(map(repr, options))}", remedy)
        return value

    def raise_if_any(self) -> None:
        """Raise all faults noted, if there are any."""
        if self.found:
            raise self.kind(self.found)
