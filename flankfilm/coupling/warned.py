"""Warnings of many films as one."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager


def distinct(caught: Iterable[warnings.WarningMessage]) -> list[warnings.WarningMessage]:
    """Drop warnings that differ from an earlier one in their numbers alone."""
    seen: dict[str, warnings.WarningMessage] = {}
    for warning in caught:
        seen.setdefault(re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "#", str(warning.message)), warning)
    return list(seen.values())


@contextmanager
def warned_once() -> Iterator[None]:
    """Pass on the distinct ones of all warnings, at the end."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        yield
    for warning in distinct(caught):
        warnings.warn_explicit(warning.message, warning.category, warning.filename, warning.lineno)
