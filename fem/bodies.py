"""Everything of a pair's elasticity that does not depend on the load, put together from its named parts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from functools import cached_property
from math import cos
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Cost, Faults, described, part, quantity, record
from base.results import ITSELF
from fem.back_compliance import BackCompliance
from fem.flamant import hertz_half_width, hertz_indentation
from fem.flank_motion import FlankMotion
from fem.gear_compliance import GearCompliance
from fem.gear_shape import MeshedShape, shapes
from fem.local_law import HertzApproach
from fem.ring import Ring
from fem.solved_gear import Gears
from fem.support import FIXED, Support, held_profiles
from fem.tip_strips import TipStrips
from fem.torsion import step_wind_up

if TYPE_CHECKING:
    from gears import GearPair
    from meshes import Sizes

__all__ = ["PARTS", "Compliance"]

PARTS = ("hub_windup", "coupling", "support")
"""Parts that ``Compliance.without`` can leave out."""


@record
class Compliance:
    """Compliance of both gears of a pair as functions of the contact's place."""

    no_error = "not estimated: what a deflection is made of, whose error is `error`"

    headline = ("plane", "refinements")

    pair: GearPair = part("the gears")
    plane: str = part('"strain" or "stress"')
    pinion: GearCompliance = part("of the pinion, held at the bore or hub")
    wheel: GearCompliance = part("of the wheel, likewise")
    refinements: int = quantity("1", "refinements of the mesh in use")
    sizes: Sizes = part("of the mesh before it was refined")
    reach: int = quantity("1", "neighbours with cross terms on either side of a tooth")
    error: float = quantity("1", "estimated relative error of a pair's deflection, greatest along the path")
    cost: Cost
    converged: bool
    message: str
    supports: tuple[Support, Support] = part("how the bores of both are held", default=(FIXED, FIXED))
    left_out: frozenset[str] = part("names of what was left out", default=frozenset())
    tip_strips: tuple[TipStrips, TipStrips] | None = part(
        "tip edges of both gears; None before contact outside the path has asked for them", default=None
    )
    tip_strips_before: tuple[TipStrips, TipStrips] | None = part(
        "the same on the mesh before the last refinement; None before errors have asked for it", default=None
    )
    flank_motions: tuple[FlankMotion, FlankMotion] | None = part(
        "how the flanks of both gears move; None before contacts that move have asked for it", default=None
    )
    back_series: tuple[BackCompliance, BackCompliance] | None = part(
        "what loads on front flanks do to back flanks; None before flanks on both sides have asked for it",
        default=None,
    )
    back_before: tuple[BackCompliance, BackCompliance] | None = part(
        "the same on the mesh before the last refinement; None where that is unknown", default=None
    )
    fit_error: float = quantity(
        "1", "part of the error by the fit along the flanks", no_error=ITSELF, default=0.0
    )
    gain: float = quantity(
        "1", "by how much the last refinement reduced the mesh's error", no_error=ITSELF, default=1.0
    )
    before: tuple[GearCompliance, GearCompliance] | None = part(
        "of pinion and wheel on the mesh before the last refinement", default=None
    )

    def __getstate__(self) -> dict[str, Any]:
        """Leave the factorised gears behind: they are large, and a factorisation cannot travel."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @property
    def meshed(self) -> tuple[MeshedShape, MeshedShape]:
        """Shapes of both gears in modules, and their meshes: what solved gears are kept by."""
        profiles = held_profiles(self.pair, self.supports)
        first, second = shapes(self.pair, profiles, self.plane)
        return (
            MeshedShape(first, self.sizes, self.refinements),
            MeshedShape(second, self.sizes, self.refinements),
        )

    @cached_property
    def tips(self) -> tuple[TipStrips, TipStrips]:
        """Tip edges of both gears, for contact outside the path; solved where they were not."""
        return self.tip_strips or self.tips_of(Gears())

    @cached_property
    def _tips_before(self) -> tuple[TipStrips, TipStrips]:
        """Tip edges whose difference from these, over the gain of the mesh, is their error.

        Far from the corner over the length of the element there they are those of the mesh before: loads on the flank
        and on the edge are the same tooth's, and what is wrong of both evens out where the load goes from one to the
        other. Nearer, a refinement gains less than ``gain``, and the difference is enlarged by as much.
        """
        edge = self.sizes.corner * 0.5**self.refinements * self.pair.module
        first, second = (
            fine.towards(before, edge, self.gain)
            for fine, before in zip(
                self.tips, self.tip_strips_before or self.tips_of(Gears(), before=True), strict=True
            )
        )
        return first, second

    @cached_property
    def _flanks_before(self) -> tuple[GearCompliance, GearCompliance] | None:
        """Flanks whose difference from these, over the gain of the mesh, is the error of mesh and fit."""
        if self.before is None:
            return None
        first, second = (
            before.off_by(fine, self.gain)
            for fine, before in zip((self.pinion, self.wheel), self.before, strict=True)
        )
        return first, second

    def tips_of(self, gears: Gears, before: bool = False) -> tuple[TipStrips, TipStrips]:
        """Tip edges of both gears from where solved gears are, or on the mesh before the last refinement."""
        first, second = (
            gears.tips(meshed, before).scaled(self.pair.module, flexible.law)
            for meshed, flexible in zip(self.meshed, (self.pinion, self.wheel), strict=True)
        )
        return first, second

    @cached_property
    def motions(self) -> tuple[FlankMotion, FlankMotion]:
        """How the flanks of both gears move beyond yielding along their normals; solved where it was not."""
        return self.flank_motions or self.motions_of(Gears())

    def motions_of(self, gears: Gears) -> tuple[FlankMotion, FlankMotion]:
        """How the flanks of both gears move, from where solved gears are."""
        first, second = (
            gears.motion(meshed).scaled(self.pair.module, flexible.law)
            for meshed, flexible in zip(self.meshed, (self.pinion, self.wheel), strict=True)
        )
        return first, second

    @cached_property
    def back_flanks(self) -> tuple[BackCompliance, BackCompliance]:
        """What loads on the front flanks of both gears do to their back flanks; solved where it was not."""
        if self.back_series is not None:
            return self.back_series
        gears = Gears()
        first, second = (
            gears.backs(meshed).scaled(self.pair.module, flexible.law.plane_modulus)
            for meshed, flexible in zip(self.meshed, (self.pinion, self.wheel), strict=True)
        )
        return first, second

    def rings(self) -> tuple[Ring, Ring]:
        """Meshed and factorised gears: those that this process still has, or computed anew from the same sizes."""
        return self._rings

    @cached_property
    def _rings(self) -> tuple[Ring, Ring]:
        gears = Gears()
        first, second = (
            gears.rings(meshed)[1].scaled(self.pair.module, flexible.law)
            for meshed, flexible in zip(self.meshed, (self.pinion, self.wheel), strict=True)
        )
        return first, second

    @property
    def coarser(self) -> Compliance | None:
        """The same gears, off by their errors times the gain of the last refinement; None where these are unknown.

        By the mesh they differ as the one before that refinement does. Motion and back flanks stay as they are.
        """
        if self._flanks_before is None:
            return None
        pinion, wheel = self._flanks_before
        tips, motions, backs = (
            self.__dict__.get(found, given)  # whatever has been solved until now
            for found, given in (
                ("tips", self.tip_strips),
                ("motions", self.flank_motions),
                ("back_flanks", self.back_series),
            )
        )
        return replace(
            self,
            pinion=pinion,
            wheel=wheel,
            before=None,
            tip_strips=None if tips is None else self._tips_before,
            flank_motions=motions,
            back_series=backs,
        )

    def without(self, *parts: str) -> Compliance:
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
        found = Faults()
        for name in parts:
            found.choice("parts", name, PARTS, "name a part")
        found.raise_if_any()
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
        every = replace(self, left_out=frozenset())
        coupling = every.bulk(np.stack([rho1, ahead], axis=-1))[..., 0, 1]
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
            corner belongs to its law (``fem.tip_contact``).

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
