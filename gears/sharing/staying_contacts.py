"""Contacts that stay where undeformed flanks touch: forces coupled by a compliance, and a law for each."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Protocol

import numpy as np

from base import Array, Booleans, record
from gears.sharing.active_set import Linearised
from gears.sharing.load_coupling import Coupling

__all__ = ["DeflectionLaw", "JointLaw", "StayingContacts"]


class DeflectionLaw(Protocol):
    """A deflection of each pair that depends on its own force only."""

    def approach(self, force: Array) -> Array:
        """Deflection, or for a film what it props the bodies apart, (..., pairs) [m]."""

    def slope(self, force: Array) -> Array:
        """Its derivative to the force, (..., pairs) [m/N]; infinite at zero force is allowed."""


class JointLaw(DeflectionLaw, Protocol):
    """A law whose deflection and slope cost less together; what derives from it says these alone."""

    def approach(self, force: Array) -> Array:
        """As of ``DeflectionLaw``."""
        return self.value_and_slope(force)[0]

    def slope(self, force: Array) -> Array:
        """As of ``DeflectionLaw``."""
        return self.value_and_slope(force)[1]

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Deflection [m] and its derivative [m/N], (..., pairs)."""


@record
class StayingContacts:
    """Overlap = compliance F + law(F) - film(F) + gap - reach D (``gears.sharing.active_set.ContactForces``).

    Attributes
    ----------
    coupling : Coupling
    local : DeflectionLaw
    film : DeflectionLaw or None
    gaps : (..., n) array
        At D = 0, inf where nothing can touch [m].
    reach : (..., n) array
        By how much D closes the gap; below 0 where D opens it.
    lever_ratios : (..., n) array
        l_i of the forces, with the same signs.
    """

    coupling: Coupling
    local: DeflectionLaw
    film: DeflectionLaw | None
    gaps: Array
    reach: Array
    lever_ratios: Array

    @cached_property
    def touchable(self) -> Booleans:
        """As of ``ContactForces``."""
        return np.isfinite(self.gaps)

    @property
    def start(self) -> float:
        """As of ``ContactForces``."""
        return self.coupling.start

    @property
    def apart(self) -> bool:
        """As of ``ContactForces``."""
        return self.coupling.apart

    @cached_property
    def at_zero(self) -> Array:
        """Gaps less the film that stands in them without a force (..., n) [m]."""
        return self.gaps if self.film is None else self.gaps - self.film.approach(np.zeros_like(self.gaps))

    def bent(self, loads: Array, wanted: Booleans, known: Array | None) -> Array:
        """As of ``ContactForces``."""
        return self.coupling.applied(loads, wanted, np.zeros_like(loads) if known is None else known)

    def laws(self, loads: Array) -> tuple[Array, Array]:
        """What contacts yield by their own forces, films among it: value [m] and slope [m/N]."""
        value, slope = _asked(self.local, loads)
        if self.film is not None:
            props, falls = _asked(self.film, loads)
            value, slope = value - props, slope - falls
        return value, slope

    def linearised(self, loads: Array, approach: Array, bent: Array) -> Linearised:
        """As of ``ContactForces``."""
        value, slope = self.laws(loads)
        gaps = np.where(self.touchable, self.gaps, 0.0)
        nothing = np.zeros_like(loads)
        # an idle contact may have an infinite slope; its row is left out of the Newton step
        return Linearised(
            bent + value + gaps - self.reach * approach[..., None],
            self.reach + nothing,
            self.lever_ratios + nothing,
            np.sum(self.lever_ratios * loads, axis=-1),
            np.where(loads > 0.0, slope, 1.0),
            self.coupling,
        )

    def unloaded(self, loads: Array, approach: Array, bent: Array) -> Array:
        """As of ``ContactForces``."""
        return np.asarray(bent + self.at_zero - self.reach * approach[..., None])


def _asked(law: DeflectionLaw, loads: Array) -> tuple[Array, Array]:
    """Deflection and slope of a law, together where that costs less."""
    # whether it is a `JointLaw` would cost as much to ask as many a law does
    together: Callable[[Array], tuple[Array, Array]] | None = getattr(law, "value_and_slope", None)
    return (law.approach(loads), law.slope(loads)) if together is None else together(loads)
