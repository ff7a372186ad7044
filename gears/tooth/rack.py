"""The basic rack that generates both gears of a pair."""

from __future__ import annotations

import math
from dataclasses import dataclass

from base import Fault, Faults, Limit
from gears.tooth.errors import GeometryError

LIMITS = {
    "h_aP": Limit.above(0.0, 3.0, "modules", "ISO 53 profile A has 1.0"),
    "h_fP": Limit.above(0.0, 3.0, "modules", "ISO 53 profile A has 1.25"),
    "rho_fP": Limit.above(0.0, 3.0, "modules", "ISO 53 profile A has 0.38"),
    "alpha": Limit(
        math.radians(10.0), math.radians(35.0), "rad", "give the angle in radians (20 deg is 0.349066)"
    ),
}
"""What the numbers of a basic rack may be."""

NO_PROTUBERANCE = "must be 0: fillets are those of a tool with straight flanks, without protuberance"
"""What holds of a tool's protuberance."""


@dataclass(frozen=True)
class BasicRack:
    """Basic rack tooth profile; the default is profile A of ISO 53.

    The rack that cuts the gear has the tooth with dedendum `h_fP` of the profile as its tip, rounded by arcs
    of radius `rho_fP`. Where the two arcs of one rack tooth would overlap they are replaced by the single
    arc that touches both flanks and the tip line (full-radius fillet).

    Parameters
    ----------
    h_aP : float
        Addendum of the profile [modules].
    h_fP : float
        Dedendum of the profile [modules].
    rho_fP : float
        Fillet radius of the profile [modules].
    alpha : float
        Pressure angle [rad].

    Examples
    --------
    >>> BasicRack(h_aP=1.0, h_fP=1.4, rho_fP=0.39).full_radius
    False
    """

    h_aP: float = 1.0  # addendum, modules
    h_fP: float = 1.25  # dedendum, modules
    rho_fP: float = 0.38  # fillet radius, modules
    alpha: float = math.radians(20.0)  # pressure angle, rad

    @classmethod
    def of_tool(
        cls,
        h_aP0: float,
        rho_aP0: float,
        h_aP: float = 1.0,
        alpha: float = math.radians(20.0),
        protuberance: float = 0.0,
    ) -> BasicRack:
        """Rack that a rack-shaped tool cuts, by the tool's data as drawings and calculation programs have them.

        Parameters
        ----------
        h_aP0 : float
            Addendum of the tool, the dedendum of the gears [modules].
        rho_aP0 : float
            Radius of the tool's tip [modules].
        h_aP : float
            Addendum of the gears [modules].
        alpha : float
            Pressure angle [rad].
        protuberance : float
            Of the tool [modules]; only 0 is accepted, since the fillet is that of a tool with straight flanks.

        Raises
        ------
        GeometryError
            Of a tool with protuberance.

        Examples
        --------
        >>> BasicRack.of_tool(h_aP0=1.39, rho_aP0=0.25).h_fP
        1.39
        """
        if protuberance != 0.0:
            remedy = "leave it out: root stress and the start of the flank are then those of a plain tool"
            raise GeometryError.at("protuberance", protuberance, NO_PROTUBERANCE, remedy)
        return cls(h_aP, h_aP0, rho_aP0, alpha)

    @property
    def largest_fillet_radius(self) -> float:
        """Radius of the one arc that touches both flanks and the tip line of the rack tooth [modules].

        (pi/4 - h_fP tan alpha) cos alpha / (1 - sin alpha)
        """
        half_tip_width = math.pi / 4.0 - self.h_fP * math.tan(self.alpha)
        return half_tip_width * math.cos(self.alpha) / (1.0 - math.sin(self.alpha))

    @property
    def full_radius(self) -> bool:
        """Whether the tip arcs overlap and the full-radius fillet takes their place."""
        return self.rho_fP > self.largest_fillet_radius

    @property
    def fillet_radius(self) -> float:
        """Radius of the tip arc that is used: `rho_fP`, or less for a full-radius fillet [modules]."""
        return min(self.rho_fP, self.largest_fillet_radius)

    @property
    def tip_centre_offset(self) -> float:
        """Distance of the tip arc's centre from the centre line of the rack tooth [modules]."""
        if self.full_radius:
            return 0.0
        depth = self.h_fP - self.rho_fP
        return math.pi / 4.0 - depth * math.tan(self.alpha) - self.rho_fP / math.cos(self.alpha)

    def faults(self, path: str = "rack") -> tuple[Fault, ...]:
        """All faults of the values, empty when there are none."""
        collector = Faults.of(self, LIMITS, f"{path}.")
        if not collector.found and self.largest_fillet_radius <= 0.0:
            deepest = math.pi / 4.0 / math.tan(self.alpha)
            allowed = f"must be less than {deepest:.6g} modules at this pressure angle"
            remedy = "the rack tooth ends in a point before its tip, so not even a full-radius fillet fits: "
            remedy += "reduce h_fP or alpha"
            collector.add(f"{path}.h_fP", f"{self.h_fP:g}", allowed, remedy)
        return tuple(collector.found)


ISO_53_A = BasicRack()
"""Basic rack tooth profile A of ISO 53."""
