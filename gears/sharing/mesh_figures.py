"""Figures of a mesh cycle that no choice of positions decides: means, extremes and harmonics, each with its error.

All follow from the smooth arcs between the cycle's events (`gears.sharing.mesh_arcs`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property, partial
from typing import TypeVar

import numpy as np

from base import Array, described
from base.later import known
from gears.sharing.mesh_arcs import Estimate, MeshArcs

__all__ = ["MeshFigures"]

T = TypeVar("T")

HARMONICS = 50
"""Harmonics of the mesh frequency that are figures of a cycle."""

SHOWN = 24
"""Points of an arc in pictures."""

_OF_HARMONICS = ("stiffness", "secant_stiffness", "transmission_error")
"""Curves whose harmonics are figures of a cycle."""

IN_SINGLE_POSITIONS = "not estimated in single positions; means and extremes have errors"


class _WhenAsked(Mapping[str, T]):
    """Values by names, each found when it is first asked for: a study of one figure needs no other."""

    def __init__(self, names: Iterable[str], find: Callable[[str], T]) -> None:
        """Take the names, and what finds the value of one."""
        self._names, self._find, self._known = tuple(names), find, dict[str, T]()

    def __getitem__(self, name: str) -> T:
        """Value of a name."""
        if name not in self._names:
            raise KeyError(name)
        if name not in self._known:
            self._known[name] = self._find(name)
        return self._known[name]

    def __iter__(self) -> Iterator[str]:
        """All names."""
        return iter(self._names)

    def __len__(self) -> int:
        """Count the names."""
        return len(self._names)


class MeshFigures(ABC):
    """Figures of a cycle that has arcs; nan where its contact has no solution at one of its positions."""

    @property
    def no_error(self) -> str:
        """Why figures that say nothing of their error have none."""
        return IN_SINGLE_POSITIONS

    @property
    @abstractmethod
    def arcs(self) -> MeshArcs | None:
        """Curves on smooth arcs between events; None where the contact has no solution at one of its positions.

        Raises
        ------
        base.SolverError
            It has none between them.
        """

    @cached_property
    def _estimates(self) -> Mapping[str, Estimate]:
        return _WhenAsked(_ESTIMATES, partial(_estimate, self.arcs))

    @property
    def errors(self) -> Mapping[str, float | None]:
        """Estimated relative errors of means and extremes by their names; None where they are unknown."""
        estimates = self._estimates
        return _WhenAsked(estimates, lambda name: estimates[name].relative)

    @described("N/m", error="errors", called="mean_tangent_stiffness")
    def mean_stiffness(self) -> float:
        """Mean mesh stiffness (tangent)."""
        return self._estimates["mean_stiffness"].value

    @described("N/m", error="errors")
    def mean_secant_stiffness(self) -> float:
        """Mean mesh stiffness (secant)."""
        return self._estimates["mean_secant_stiffness"].value

    @described("m", shown="um", error="errors")
    def transmission_error_range(self) -> float:
        """Transmission error, peak to peak."""
        return self._estimates["transmission_error_range"].value

    @described("N/m", error="errors", called="least_tangent_stiffness")
    def least_stiffness(self) -> float:
        """Minimum mesh stiffness (tangent)."""
        return self._estimates["least_stiffness"].value

    @described("N/m", error="errors", called="greatest_tangent_stiffness")
    def greatest_stiffness(self) -> float:
        """Maximum mesh stiffness (tangent)."""
        return self._estimates["greatest_stiffness"].value

    @described("N/m", error="errors")
    def least_secant_stiffness(self) -> float:
        """Minimum mesh stiffness (secant)."""
        return self._estimates["least_secant_stiffness"].value

    @described("N/m", error="errors")
    def greatest_secant_stiffness(self) -> float:
        """Maximum mesh stiffness (secant)."""
        return self._estimates["greatest_secant_stiffness"].value

    @described("1", error="errors")
    def greatest_load_share(self) -> float:
        """Largest share of the torque that a pair takes."""
        return self._estimates["greatest_load_share"].value

    @described("1", "harmonic", error="stiffness_harmonics_error", called="tangent_stiffness_harmonics")
    def stiffness_harmonics(self) -> Array:
        """Amplitudes of the tangent stiffness' harmonics over its mean."""
        return self._harmonics("stiffness")[0]

    @described("1", "harmonic", called="tangent_stiffness_harmonics_error")
    def stiffness_harmonics_error(self) -> Array | None:
        """Estimated errors of the tangent stiffness' harmonics over the mean."""
        return self._harmonics("stiffness")[1]

    @described("1", "harmonic", error="secant_stiffness_harmonics_error")
    def secant_stiffness_harmonics(self) -> Array:
        """Amplitudes of the secant stiffness' harmonics over its mean."""
        return self._harmonics("secant_stiffness")[0]

    @described("1", "harmonic")
    def secant_stiffness_harmonics_error(self) -> Array | None:
        """Estimated errors of the secant stiffness' harmonics over the mean."""
        return self._harmonics("secant_stiffness")[1]

    @described("m", "harmonic", shown="um", error="transmission_error_harmonics_error")
    def transmission_error_harmonics(self) -> Array:
        """Amplitudes of the transmission error's harmonics."""
        return self._harmonics("transmission_error")[0]

    @described("m", "harmonic", shown="um")
    def transmission_error_harmonics_error(self) -> Array | None:
        """Estimated errors of the transmission error's harmonics."""
        return self._harmonics("transmission_error")[1]

    def _harmonics(self, name: str) -> tuple[Array, Array | None]:
        """Amplitudes and errors; of a stiffness over its mean."""
        size, error = self._amplitudes[name]
        return size.copy(), None if error is None else error.copy()

    @cached_property
    def _amplitudes(self) -> dict[str, tuple[Array, Array | None]]:
        """What `_harmonics` gives, of all curves: one integral has the amplitudes and their errors."""
        arcs, order = self.arcs, np.arange(1, HARMONICS + 1)
        if arcs is None:
            return dict.fromkeys(_OF_HARMONICS, (np.full(HARMONICS, np.nan), None))
        return {
            name: arcs.amplitudes(name, order, over_mean=name != "transmission_error")
            for name in _OF_HARMONICS
        }

    @described("1", "event", no_error="not estimated")
    def event_position(self) -> Array:
        """Events: where contacts begin or end, base pitches from A."""
        return np.zeros(0) if self.arcs is None else self.arcs.events

    @described("1", "dense")
    def dense_position(self) -> Array:
        """Positions on the arcs, base pitches; events twice, before and after."""
        if self.arcs is None:
            return np.zeros(0)
        unit = np.linspace(0.0, 1.0, SHOWN)
        return np.concatenate([arc.low + arc.width * unit for arc in self.arcs.arcs.arcs])

    @described("N/m", "dense", error="error", called="dense_tangent_stiffness")
    def dense_stiffness(self) -> Array:
        """Tangent stiffness on the arcs."""
        return self._dense("stiffness")

    @described("N/m", "dense", error="error")
    def dense_secant_stiffness(self) -> Array:
        """Secant stiffness on the arcs."""
        return self._dense("secant_stiffness")

    @described("m", "dense", shown="um", error="error")
    def dense_transmission_error(self) -> Array:
        """Transmission error on the arcs."""
        return self._dense("transmission_error")

    def _dense(self, name: str) -> Array:
        return np.zeros(0) if self.arcs is None else self.arcs.arcs.on_each(name, SHOWN)


_ESTIMATES: Mapping[str, Callable[[MeshArcs], Estimate]] = {
    "mean_stiffness": lambda arcs: arcs.mean("stiffness"),
    "mean_secant_stiffness": lambda arcs: arcs.mean("secant_stiffness"),
    "transmission_error_range": lambda arcs: arcs.range("transmission_error"),
    "least_stiffness": lambda arcs: arcs.extreme("stiffness", greatest=False),
    "greatest_stiffness": lambda arcs: arcs.extreme("stiffness", greatest=True),
    "least_secant_stiffness": lambda arcs: arcs.extreme("secant_stiffness", greatest=False),
    "greatest_secant_stiffness": lambda arcs: arcs.extreme("secant_stiffness", greatest=True),
    "greatest_load_share": lambda arcs: arcs.greatest_share(),
}


def _estimate(arcs: MeshArcs | None, name: str) -> Estimate:
    """Estimate of a figure; nan without arcs."""
    return Estimate(float("nan"), known(None)) if arcs is None else _ESTIMATES[name](arcs)
