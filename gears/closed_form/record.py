"""The result of a closed form: compliance by parts, stiffness as an array."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import DTypeLike

from base import Array


@dataclass(frozen=True, eq=False)
class ClosedForm:
    """Single-pair deflection by a closed form, at each point of a path of contact.

    ``numpy.asarray(result)`` is the single-pair stiffness.

    Parameters
    ----------
    model : str
        Name of the formula.
    parts : mapping of str to (n,) array
        Compliance of each part, deflection along the line of action over force, both gears together [m/N].
    """

    model: str
    parts: Mapping[str, Array]

    def __post_init__(self) -> None:
        """Keep the parts from being replaced."""
        object.__setattr__(self, "parts", MappingProxyType(dict(self.parts)))

    @property
    def compliance(self) -> Array:
        """Sum of the parts, (n,) [m/N]."""
        return np.asarray(sum(self.parts.values()))

    @property
    def stiffness(self) -> Array:
        """Secant stiffness of the single pair, (n,) [N/m]."""
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

    def _repr_html_(self) -> str:
        """Stiffness and the shares of the parts, for notebooks."""
        from gears.notebook import closed_form_html

        return closed_form_html(self)
