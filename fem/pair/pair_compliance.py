"""Compliance of a pair, which does not depend on the load, put together from its named parts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import cos
from types import MappingProxyType

import numpy as np

from base import Array, Faults, described, part, record
from fem.elasticity.flamant import hertz_half_width, hertz_indentation
from fem.elasticity.support import held_profiles
from fem.elasticity.torsion import step_wind_up
from fem.pair.hertz_approach import HertzApproach
from fem.pair.solved_pair import SolvedPair

__all__ = ["PARTS", "PairCompliance"]

PARTS = ("hub_windup", "coupling", "support")
"""Parts that ``PairCompliance.without`` can leave out."""


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
        n = rho1.shape[-1]
        width, common = self.pair.face_width, self._common
        reach = 0 if "coupling" in self.left_out else self.reach
        matrix = np.zeros((*rho1.shape, n))
        own, diagonal = self.pinion.own(rho1) + self.wheel.own(rho2), np.arange(n)
        matrix[..., diagonal, diagonal] = own / width + common
        for apart in range(1, min(n, reach + 1)):
            # the pair ahead has the smaller rho2, and the cross term is symmetric (Maxwell and Betti)
            behind, ahead = diagonal[:-apart], diagonal[apart:]
            first = self.pinion.cross(apart, rho1[..., behind], rho1[..., ahead])
            second = self.wheel.cross(apart, rho2[..., ahead], rho2[..., behind])
            if leaning is not None:
                # corners are the places of largest rho
                angles = leaning[0][..., ahead], leaning[1][..., behind]
                corners = (
                    self.pinion.corner(apart, rho1[..., behind]),
                    self.wheel.corner(apart, rho2[..., ahead]),
                )
                first = np.cos(angles[0]) * first - np.sin(angles[0]) * corners[0]
                second = np.cos(angles[1]) * second - np.sin(angles[1]) * corners[1]
            cross = (first + second) / width + common
            matrix[..., behind, ahead] = matrix[..., ahead, behind] = cross
        return matrix

    def hertz(self, rho1: Array, curvature: Array | float = 1.0, lever: Array | float = 1.0) -> HertzApproach:
        """Local indentation of pairs at rho1 [m] as a function of their forces.

        Parameters
        ----------
        rho1 : array
            [m]
        curvature : array or float
            Of relieved flanks over that of the involutes.
        lever : array or float
            Lever kappa of the normal about the pinion's axis over its base radius, where forces are kappa F and
            the indentation is what turns the pinion.
        """
        path = self.pair.path_at(np.clip(rho1, 0.0, self.pair.line_of_action))
        width = self.pair.face_width
        first, second = self.pinion.law, self.wheel.law
        reduced = 2 / (1 / first.plane_modulus + 1 / second.plane_modulus)
        half_width = hertz_half_width(
            1.0 / (width * lever), path.radius / curvature, reduced
        )  # of kappa F = 1 N
        length = self.pair.module
        constant = (
            hertz_indentation(half_width, first, length) + hertz_indentation(half_width, second, length)
        ) / width
        per_log = (1 / first.plane_modulus + 1 / second.plane_modulus) / (np.pi * width)
        return HertzApproach(constant / lever**2, per_log / np.square(lever))
