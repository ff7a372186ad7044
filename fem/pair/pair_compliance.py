"""Compliance of a pair, which does not depend on the load, put together from its named parts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import cos
from types import MappingProxyType

import numpy as np

from base import Array, Faults, Integers, described, part, record
from fem.elasticity.flamant import hertz_half_width, hertz_indentation
from fem.elasticity.support import held_profiles
from fem.elasticity.torsion import step_wind_up
from fem.pair.hertz_approach import HertzApproach
from fem.pair.solved_pair import SolvedPair

__all__ = ["PARTS", "PairCompliance", "contacts_apart"]

PARTS = ("hub_windup", "coupling", "support")
"""Parts that ``PairCompliance.without`` can leave out."""


def contacts_apart(gear: int, count: int, reach: int) -> Iterator[tuple[int, Integers, Integers]]:
    """Contacts of a gear that are 1, 2, ... teeth apart: how many, those that are loaded and those that are seen.

    Contacts stand in order of their rho1. Cross terms are symmetric (Maxwell and Betti) and known towards growing rho:
    the pair ahead has the larger rho on the pinion and the smaller one on the wheel.

    Parameters
    ----------
    gear : int
        0 is the pinion, 1 the wheel.
    count : int
        Contacts.
    reach : int
        Neighbours that feel a load.
    """
    contact = np.arange(count)
    for apart in range(1, min(count, reach + 1)):
        behind, ahead = contact[:-apart], contact[apart:]
        yield (apart, behind, ahead) if gear == 0 else (apart, ahead, behind)


@record
class PairCompliance(SolvedPair):
    """Compliance of both gears of a pair as functions of the contact's place."""

    left_out: frozenset[str] = part("names of what was left out", default=frozenset())

    def without(self, *parts: str) -> PairCompliance:
        """Leave parts out, to compare with models that do not have them.

        Parameters
        ----------
        *parts : {"hub_windup", "coupling", "support"}
            Turning of the bodies on their hubs, in ``own`` and in every cross term; all cross terms between
            teeth; the supports of rigid hubs.

        Returns
        -------
        Compliance
            The same finite-element solution; only what ``own`` and ``bulk`` add up differs.

        Raises
        ------
        base.InputError
            A name that is no part.
        """
        faults = Faults()
        for name in parts:
            faults.choice("parts", name, PARTS, "name a part")
        faults.raise_if_any()
        return replace(self, left_out=self.left_out | set(parts))

    @described("m/N", "gear")
    def hub_windup(self) -> tuple[float, float]:
        """Turn of pinion's and wheel's body on its hub, along the line of action, at the pair's face width."""
        first, second = (
            plane + steps for plane, steps in zip(self.plane_windup, self.step_windup, strict=True)
        )
        return first, second

    @described("m/N", "gear", kept=True)
    def step_windup(self) -> tuple[float, float]:
        """Part of that turn by steps of pinion's and wheel's thickness, where rim and hub meet a narrower web."""
        first, second = (
            step_wind_up(profile, width, gear.law.shear_modulus) / width
            for profile, gear, width in zip(
                held_profiles(self.pair, self.supports),
                (self.pinion, self.wheel),
                self.pair.face_widths,
                strict=True,
            )
        )
        return first, second

    @property
    def plane_windup(self) -> tuple[float, float]:
        """The part that the finite elements of the plane hold, in ``own`` and cross terms of the gears [m/N]."""
        width = self.pair.face_width
        return self.pinion.hub_windup / width, self.wheel.hub_windup / width

    @described("m/N", "gear")
    def support(self) -> tuple[float, float]:
        """Compliance of pinion's and wheel's rigid hubs along the line of action."""
        first, second = (s.compliance(r) for s, r in zip(self.supports, self.pair.base_radii, strict=True))
        return first, second

    @described("m", "gear", shown="mm")
    def rim_thickness(self) -> tuple[float, float]:
        """Thickness of pinion's and wheel's rim below the root circle; of a disc down to where it is held."""
        first, second = (profile.rim_thickness for profile in held_profiles(self.pair, self.supports))
        return first, second

    @property
    def _common(self) -> float:
        """What all contacts yield alike beyond the compliances of the flanks [m/N]; less what is left out."""
        support = 0.0 if "support" in self.left_out else sum(self.support)
        if "hub_windup" in self.left_out:
            return support - sum(self.plane_windup)
        return support + sum(self.step_windup)

    @property
    def common_across(self) -> float:
        """What all contacts of one side yield by those of the other, beyond the flanks' compliances [m/N].

        Torques of the two sides are opposed; their normals are 2 alpha_w apart.
        """
        windup = sum(self.hub_windup) if "hub_windup" in self.left_out else 0.0
        if "support" in self.left_out:
            return windup
        apart = cos(2 * self.pair.working_pressure_angle)
        for support, radius in zip(self.supports, self.pair.base_radii, strict=True):
            windup -= support.turn(radius) + apart / support.radial_stiffness
        return windup

    @described("m/N")
    def turning(self) -> float:
        """What hubs and supports move all teeth by alike, which closes no gap, unless it is left out."""
        if "coupling" in self.left_out:
            return 0.0
        windup = 0.0 if "hub_windup" in self.left_out else sum(self.hub_windup)
        return windup + (0.0 if "support" in self.left_out else sum(self.support))

    def parts(self, rho1: Array) -> Mapping[str, Array]:
        """Deflection of a pair per force without the local indentation, part by part [m/N], at rho1 (n,) [m].

        ``pinion`` and ``wheel`` (teeth with the bodies' deformation under them), ``hub_windup`` and
        ``support`` add up to ``own``, whatever is left out. ``coupling`` stands apart: the deflection by the
        force on the pair one base pitch ahead; nan where that pair would be beyond the path.
        """
        rho1 = np.asarray(rho1, dtype=float)
        width, ahead = self.pair.face_width, rho1 + self.pair.base_pitch
        whole = replace(self, left_out=frozenset())
        coupling = whole.bulk(np.stack([rho1, ahead], axis=-1))[..., 0, 1]
        windup, support = sum(self.hub_windup), sum(self.support)
        return MappingProxyType(
            {
                "pinion": self.pinion.own(rho1) / width - self.plane_windup[0],
                "wheel": self.wheel.own(self.pair.line_of_action - rho1) / width - self.plane_windup[1],
                "hub_windup": np.full(rho1.shape, windup),
                "support": np.full(rho1.shape, support),
                "coupling": np.where(ahead <= self.pair.points.E, coupling, np.nan),
            }
        )

    def own(self, rho1: Array) -> Array:
        """Deflection of a pair per force without the local indentation [m/N], at rho1 [m]."""
        rho1 = np.asarray(rho1, dtype=float)
        total = self.pinion.own(rho1) + self.wheel.own(self.pair.line_of_action - rho1)
        return np.asarray(total / self.pair.face_width + self._common)

    def bulk(self, rho1: Array, rho2: Array | None = None, leaning: Array | None = None) -> Array:
        """Bulk compliance of pairs in order of their rho1, one tooth apart.

        Parameters
        ----------
        rho1 : (..., n) array
            Curvature radii on the pinion [m].
        rho2 : (..., n) array, optional
            On the wheel; those of the line of action unless given.
        leaning : (2, ..., n) array, optional
            Angles by which forces lean from pinion's and wheel's own normal, away from the tip [rad]: not zero
            only where that gear's tip corner is in contact. Cross terms alone; the own compliance of a
            corner belongs to its law (``fem.laws.tip_contact``).

        Returns
        -------
        (..., n, n) array
            Symmetric [m/N].
        """
        rho1 = np.asarray(rho1, dtype=float)
        rho2 = self.pair.line_of_action - rho1 if rho2 is None else rho2
        first, second = (
            self.even_loads(gear, rho, None if leaning is None else leaning[gear])
            for gear, rho in enumerate((rho1, rho2))
        )
        contact, reach = np.arange(rho1.shape[-1]), 0 if "coupling" in self.left_out else self.reach
        near = np.abs(contact[:, None] - contact) <= reach
        return np.where(near, (first + second) / self.pair.face_width + self._common, 0.0)

    def even_loads(self, gear: int, rho: Array, leaning: Array | None = None) -> Array:
        """What even line loads yield on one gear, without the local indentation.

        Parameters
        ----------
        gear : int
            0 is the pinion, 1 the wheel.
        rho : (..., n) array
            Curvature radii of n pairs on it, in order of rho1, one tooth apart [m].
        leaning : (..., n) array, optional
            Angles by which forces lean from its own normal, as of ``bulk``.

        Returns
        -------
        (..., n, n) array
            Symmetric [m per N/m].
        """
        flexible, n = (self.pinion, self.wheel)[gear], rho.shape[-1]
        basis = flexible.cross_basis(rho)
        compliance: Array = np.zeros((*rho.shape, n))
        compliance[..., np.arange(n), np.arange(n)] = flexible.own(rho)
        for apart, load, point in contacts_apart(gear, n, self.reach):
            loads = basis[..., load, :]
            moved = flexible.cross_series[apart].of_bases(loads, basis[..., point, :])
            if leaning is not None:
                # corners are the places of largest rho
                angle, corner = leaning[..., point], loads @ flexible.corner_series[apart].coefficients
                moved = np.cos(angle) * moved - np.sin(angle) * corner
            compliance[..., load, point] = compliance[..., point, load] = moved
        return compliance

    def hertz(
        self, rho1: Array, curvature: Array | float = 1.0, length: Array | float | None = None
    ) -> HertzApproach:
        """Local indentation of pairs at rho1 [m] as a function of their forces.

        Parameters
        ----------
        rho1 : array
            [m]
        curvature : array or float
            Of relieved flanks over that of the involutes; cos(beta_b) along lines of contact that cross the face.
        length : array or float, optional
            Of the line on which the force acts [m]; the face width unless given.
        """
        path = self.pair.path_at(np.clip(rho1, 0.0, self.pair.line_of_action))
        width = self.pair.face_width if length is None else length
        first, second = self.pinion.law, self.wheel.law
        reduced = 2 / (1 / first.plane_modulus + 1 / second.plane_modulus)
        half_width = hertz_half_width(1.0 / width, path.radius / curvature, reduced)  # of 1 N
        length = self.pair.module
        constant = (
            hertz_indentation(half_width, first, length) + hertz_indentation(half_width, second, length)
        ) / width
        per_log = (1 / first.plane_modulus + 1 / second.plane_modulus) / (np.pi * width)
        return HertzApproach(constant, per_log)
