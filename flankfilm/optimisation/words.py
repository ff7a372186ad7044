"""What an optimisation claims, in words: gain on the start, whether it converged, and which designs tie."""

from __future__ import annotations

from flankfilm.figures.reading import key_words
from flankfilm.optimisation.optimum import Gain, Optimum
from flankfilm.report.text import counted, number, percent
from flankfilm.studies.outputs import ERROR_OF, exact


def claims(optimum: Optimum) -> list[str]:
    """Lines for the terminal and the page."""
    return [*gained(optimum), optimum.message, tied(optimum)]


def gained(optimum: Optimum) -> list[str]:
    """Gain of every objective on the scene as it stands; why there is none."""
    if optimum.start is None:
        return [f"the scene as it stands makes no design to compare with: {optimum.task.start.fault}"]
    if not optimum.gains:
        return [f"the scene as it stands could not be computed: {optimum.start.result.fault}"]
    kept = "" if optimum.start_keeps else "; that one does not keep the limits"
    return [f"{_gain(gain, optimum)}{kept}" for gain in optimum.gains]


def _gain(gain: Gain, optimum: Optimum) -> str:
    name, unit = key_words(gain.objective)
    best, start = (f"{number(value, 5)} {unit}".removesuffix(" -") for value in (gain.best, gain.start))
    ends = f"{name}: {best} against {start} of the scene as it stands"
    if not gain.told_apart:
        return f"{ends}, no gain: they differ by no more than {error_said(gain.objective, optimum)}"
    more = "less" if gain.best < gain.start else "more"
    return f"{ends}, {percent(abs(gain.share), 3)} {more}{'' if gain.share > 0 else ': the scene is better'}"


def error_said(objective: str, optimum: Optimum) -> str:
    """Relative error of an objective, and where it is from."""
    error = percent(optimum.error_of(objective, optimum.evaluations[optimum.best[0]].result))
    if exact(objective):
        return "rounding"
    own = objective in ERROR_OF
    return f"the error of {error}" if own else f"the tolerance of {error} (its error is not known)"


def tied(optimum: Optimum) -> str:
    """How many designs cannot be distinguished from the best, and where they lie."""
    best, designs = len(optimum.best), len(optimum.tied)
    errors = " and ".join(dict.fromkeys(error_said(name, optimum) for name in optimum.task.objectives))
    whose = "the best" if best == 1 else "the front"
    if designs == best:
        return f"no other design that was computed ties with {whose}, within {errors}"
    ranges = ", ".join(_range(key, *ends) for key, ends in optimum.tied_ranges().items())
    if best == 1:
        return f"{counted(designs, 'design')} tie, they differ by no more than {errors}: {ranges}"
    off = counted(designs - best, "design")
    return f"{off} off the front, which differ from it by no more than {errors}; with it: {ranges}"


def _range(key: str, low: float, high: float) -> str:
    name, unit = key_words(key)
    ends = number(low, 4) if number(low, 4) == number(high, 4) else f"{number(low, 4)} to {number(high, 4)}"
    return f"{name} {ends} {unit}".removesuffix(" -")
