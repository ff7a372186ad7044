"""Deflections in series with pairs of teeth, as laws of place and force: what the mesh needs to know of films."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import fem
from base import Array

if TYPE_CHECKING:
    from gears import GearPair


class DeflectionLaw(fem.Film, Protocol):
    """Separation of the flanks over place and force, in series with pairs or with cells of the face."""

    def corners(self, pair: GearPair) -> Array:
        """Positions within a base pitch at which the law has corners along the path (n,)."""


@runtime_checkable
class PathLaw(DeflectionLaw, Protocol):
    """Law with a stiffness at each place of the path, which independent pairs take in series."""

    def stiffness(self, rho1: Array) -> Array:
        """Stiffness at the places, infinite at NaN [N/m]."""


@dataclass(frozen=True, eq=False)
class Placed:
    """A law of place and force at fixed places: a deflection law of `gears.share_load`."""

    law: Callable[[Array, Array], tuple[Array, Array]]
    rho1: Array

    def approach(self, force: Array) -> Array:
        """Separation or deflection of each pair, shape (positions, pairs) [m]."""
        return self.law(self.rho1, force)[0]

    def slope(self, force: Array) -> Array:
        """Its derivative by the force, shape (positions, pairs) [m/N]."""
        return self.law(self.rho1, force)[1]
