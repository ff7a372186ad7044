"""The result of a closed form: compliance by parts, stiffness as an array."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import DTypeLike

from base import Array, described, record

UNKNOWN = "unknown: a closed form, until it is compared with finite elements (flankfilm verify)"

STANDARD = "unknown: a standard's formula"


@record
class ClosedForm:
    """Single-pair deflection by a closed form, at each point of a path of contact.

    ``numpy.asarray(result)`` is the single-pair stiffness.

    Attributes
    ----------
    model : str
        Name of the formula.
    parts : mapping of str to (n,) array
        Compliance of each part, deflection along the line of action over force, both gears together [m/N].
    """

    model: str
    parts: Mapping[str, Array]

    no_error = UNKNOWN

    @classmethod
    def of_both(cls, model: str, pinion: Mapping[str, Array], wheel: Mapping[str, Array]) -> ClosedForm:
        """Of the compliances of either gear, the same parts of each [m/N]."""
        return cls(model, {name: pinion[name] + wheel[name] for name in pinion})

    def __post_init__(self) -> None:
        """Keep the parts from being replaced."""
        object.__setattr__(self, "parts", MappingProxyType(dict(self.parts)))

    @described("m/N", "point")
    def compliance(self) -> Array:
        """Sum of the parts' compliances."""
        return np.asarray(sum(self.parts.values()))

    @described("N/m", "point")
    def stiffness(self) -> Array:
        """Secant stiffness of the single pair."""
        return np.asarray(1.0 / self.compliance)

    @property
    def error(self) -> None:
        """Model error, which a closed form cannot know: None stands for unknown, never for zero."""
        return

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> Array:
        """Stiffness as an array."""
        return np.array(self.stiffness, dtype=dtype)

    def __reduce__(self) -> tuple[type[ClosedForm], tuple[str, dict[str, Array]]]:
        """Pickle by the plain mapping."""
        return ClosedForm, (self.model, dict(self.parts))

    def __repr__(self) -> str:
        """One line: the formula, how many points, the range of the stiffness."""
        stiffness = np.atleast_1d(self.stiffness)
        ends = f"{stiffness.min():.4g} to {stiffness.max():.4g}"
        return f"ClosedForm({self.model}, {stiffness.size} points, stiffness {ends} N/m, model error unknown)"
