"""Warnings of many films as one."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager

from ehl.solving.options import PressureWarning

NUMBER = re.compile(r"([-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)")


def distinct(caught: Iterable[warnings.WarningMessage]) -> list[warnings.WarningMessage]:
    """Warnings that differ in their numbers alone as one, which says over what the numbers range."""
    alike: dict[tuple[str, ...], list[warnings.WarningMessage]] = {}
    for warning in caught:
        alike.setdefault(tuple(NUMBER.split(str(warning.message))[::2]), []).append(warning)
    return [_joined(group) for group in alike.values()]


def _joined(group: Sequence[warnings.WarningMessage]) -> warnings.WarningMessage:
    """The first of warnings that are alike, with every number that differs as a range."""
    first = group[0]
    parts = [
        said[0] if len(set(said)) == 1 else f"{min(said, key=float)} to {max(said, key=float)}"
        for said in zip(*(NUMBER.split(str(warning.message)) for warning in group), strict=True)
    ]
    text = "".join(parts)
    if text == str(first.message):
        return first
    return warnings.WarningMessage(first.category(text), first.category, first.filename, first.lineno)


@contextmanager
def pressures_unsaid() -> Iterator[None]:
    """Leave out warnings of Hertz pressures: of films beside the contacts', such as those that a table is made from."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PressureWarning)
        yield


@contextmanager
def warned_once() -> Iterator[None]:
    """Pass on the distinct ones of all warnings, at the end."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        yield
    for warning in distinct(caught):
        warnings.warn_explicit(warning.message, warning.category, warning.filename, warning.lineno)
