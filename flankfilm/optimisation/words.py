"""What an optimisation claims, in words: gain on the start, whether it converged, and which designs tie."""

from __future__ import annotations

from flankfilm.figures.reading import key_words
from flankfilm.optimisation.optimum import Gain, Optimum
from flankfilm.report.text import counted, number, percent
from flankfilm.studies.output_errors import ERROR_OF, exact


def claims(found: Optimum) -> list[str]:
    """Lines for the terminal and the page."""
    return [*gained(found), found.message, tied(found)]


def gained(found: Optimum) -> list[str]:
    """Gain of every objective on the scene as it stands; why there is none."""
    if found.start is None:
        return [f"the scene as it stands makes no design to compare with: {found.task.start.fault}"]
    if not found.gains:
        return [f"the scene as it stands could not be computed: {found.start.result.fault}"]
    kept = "" if found.start_keeps else "; that one does not keep the limits"
    return [f"{_gain(one, found)}{kept}" for one in found.gains]


def _gain(one: Gain, found: Optimum) -> str:
    name, unit = key_words(one.objective)
    best, start = (f"{number(value, 5)} {unit}".removesuffix(" -") for value in (one.best, one.start))
    ends = f"{name}: {best} against {start} of the scene as it stands"
    if not one.told_apart:
        return f"{ends}, no gain: they differ by no more than {error_said(one.objective, found)}"
    more = "less" if one.best < one.start else "more"
    return f"{ends}, {percent(abs(one.share), 3)} {more}{'' if one.share > 0 else ': the scene is better'}"


def error_said(objective: str, found: Optimum) -> str:
    """Relative error of an objective, and where it is from."""
    error = percent(found.error_of(objective, found.evaluations[found.best[0]].result))
    if exact(objective):
        return "rounding"
    own = objective in ERROR_OF
    return f"the error of {error}" if own else f"the tolerance of {error} (its error is not known)"


def tied(found: Optimum) -> str:
    """How many designs cannot be distinguished from the best, and where they lie."""
    best, every = len(found.best), len(found.tied)
    errors = " and ".join(dict.fromkeys(error_said(name, found) for name in found.task.objectives))
    whose = "the best" if best == 1 else "the front"
    if every == best:
        return f"no other design that was computed ties with {whose}, within {errors}"
    ranges = ", ".join(_range(key, *ends) for key, ends in found.tied_ranges().items())
    if best == 1:
        return f"{counted(every, 'design')} tie, they differ by no more than {errors}: {ranges}"
    off = counted(every - best, "design")
    return f"{off} off the front, which differ from it by no more than {errors}; with it: {ranges}"


def _range(key: str, low: float, high: float) -> str:
    name, unit = key_words(key)
    ends = number(low, 4) if number(low, 4) == number(high, 4) else f"{number(low, 4)} to {number(high, 4)}"
    return f"{name} {ends} {unit}".removesuffix(" -")
