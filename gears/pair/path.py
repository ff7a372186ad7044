"""Path of contact: curvature radii and surface speeds along the line of action."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from base import Array, described, quantity, record
from base.results import EXACT


@dataclass(frozen=True)
class PathPoints:
    """Points of the line of action by their curvature radius on the pinion, rho1 [m].

    Parameters
    ----------
    A, E : float
        Start and end of contact, at the end of the wheel's and of the pinion's flank.
    B, D : float
        One base pitch before E and after A; for a contact ratio below two a single pair carries between them.
    C : float
        Pitch point.
    """

    A: float
    B: float
    C: float
    D: float
    E: float


@record
class PathOfContact:
    """Points on the line of action; rho1 + rho2 = a sin alpha_w.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> path = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3).path_of_contact(n=3)
    >>> path
    PathOfContact(3 points, rho1 7.254 to 17.31 mm)
    >>> (1e3 * path.radius).round(3)
    array([5.23 , 6.479, 5.783])
    >>> path.sliding(speed=200.0).round(3)
    array([-1.922, -0.012,  1.899])
    """

    no_error = EXACT

    rho1: Array = quantity("m", "curvature radius of the pinion's flank", "point", shown="mm")
    rho2: Array = quantity("m", "curvature radius of the wheel's flank", "point", shown="mm")
    start: float = quantity("m", "rho1 at A", shown="mm")
    base_radii: tuple[float, float] = quantity("m", "base radii r_b1 and r_b2", "gear", shown="mm")

    def __repr__(self) -> str:
        """One line: how many points, and where."""
        ends = f"{1e3 * self.rho1.min():.4g} to {1e3 * self.rho1.max():.4g}"
        return f"PathOfContact({self.rho1.size} points, rho1 {ends} mm)"

    @described("m", "point", shown="mm")
    def position(self) -> Array:
        """Distance from A along the line of action."""
        return np.asarray(self.rho1 - self.start)

    @described("m", "point", shown="mm")
    def radius(self) -> Array:
        """Radius of relative curvature R = rho1 rho2 / (rho1 + rho2).

        In the transverse section: helical flanks, whose lines of contact are inclined, have R / cos beta_b across them.
        """
        return np.asarray(self.rho1 * self.rho2 / (self.rho1 + self.rho2))

    @property
    def radii(self) -> tuple[Array, Array]:
        """Distances of the contact from the axes of pinion and wheel, each (n,) [m]."""
        first, second = self.base_radii
        return np.hypot(first, self.rho1), np.hypot(second, self.rho2)

    @property
    def specific_sliding(self) -> tuple[Array, Array]:
        """Specific sliding (u1 - u2)/u1 of the pinion and (u2 - u1)/u2 of the wheel, each (n,) [-].

        Zero at the pitch point, positive where a flank is the faster one (its addendum), and unbounded
        towards its own base circle, where it stands still.
        """
        u1, u2 = self.surface_speeds(1.0)
        with np.errstate(divide="ignore"):
            return np.asarray((u1 - u2) / u1), np.asarray((u2 - u1) / u2)

    def surface_speeds(self, speed: float) -> tuple[Array, Array]:
        """Speeds of the two flanks along their common tangent, u1 = omega1 rho1, u2 = omega2 rho2.

        Parameters
        ----------
        speed : float
            Speed of the pinion omega1 [rad/s].

        Returns
        -------
        (n,) array, (n,) array
            u1 and u2 [m/s].
        """
        first, second = self.base_radii
        return np.asarray(speed * self.rho1), np.asarray(speed * first / second * self.rho2)

    def entrainment(self, speed: float) -> Array:
        """Entrainment speed, the mean (u1 + u2) / 2, (n,) [m/s]; `speed` of the pinion [rad/s]."""
        first, second = self.surface_speeds(speed)
        return np.asarray(0.5 * (first + second))

    def sliding(self, speed: float) -> Array:
        """Sliding speed u1 - u2, (n,) [m/s], negative before C; `speed` of the pinion [rad/s]."""
        first, second = self.surface_speeds(speed)
        return np.asarray(first - second)
