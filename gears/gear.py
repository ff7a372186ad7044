"""One gear as it is specified: teeth, shift, blank, allowance and tip corrections."""

from __future__ import annotations

from dataclasses import dataclass

from gears.errors import Fault
from gears.limits import Limit, whole_number_faults

FEWEST_TEETH = 5
MOST_TEETH = 10_000

_SHIFT = Limit(-0.8, 1.5, "modules", "shift the profile less")
_ALTERATION = Limit(-1.0, 1.0, "modules", "change the tip less")
_BORE = Limit(0.0, 1e4, "m", "give the radius of the bore in metres, or None for half the root radius", True)
_ALLOWANCE = Limit(0.0, 1.0, "m", "give the arc by which the tooth is thinned, in metres")
_CHAMFER = Limit(0.0, 1.0, "m", "give the radial height of the chamfer in metres")
_RELIEF = Limit(0.0, 1.0, "m", "give the material removed at the tip in metres")
_LENGTH = Limit(0.0, 1e3, "m", "give the length along the path of contact in metres", low_open=True)


@dataclass(frozen=True)
class TipRelief:
    """Material removed from the flank towards the tip.

    Parameters
    ----------
    amount : float
        Material removed at the end of the flank, normal to it [m].
    length : float
        Length of the relieved part along the path of contact (roll length), from the end of the flank [m].
    form : {"linear", "parabolic"}
        How the relief grows from its start to the end of the flank.
    """

    amount: float  # C_a, m
    length: float  # L_Ca, m
    form: str = "linear"

    def faults(self, where: str) -> tuple[Fault, ...]:
        """All faults of the values, empty when there are none."""
        found = (
            *_RELIEF.faults(f"{where}.amount", self.amount),
            *_LENGTH.faults(f"{where}.length", self.length),
        )
        if self.form not in ("linear", "parabolic"):
            allowed = "'linear' or 'parabolic'"
            found = (*found, Fault(f"{where}.form", repr(self.form), allowed, "choose one of them"))
        return found


@dataclass(frozen=True)
class Gear:
    """One spur gear of a pair; the pair adds module, face width, rack and material, and checks the values.

    Parameters
    ----------
    teeth : int
        Number of teeth z, 5 to 10,000.
    profile_shift : float
        Profile shift coefficient x [modules].
    bore_radius : float or None
        Radius of the bore [m]; None takes half the root radius.
    tip_alteration : float
        Tip alteration coefficient k [modules]: r_a = r + m (h_aP + x + k).
    thickness_allowance : float
        Amount by which the tooth is thinner than nominal, arc at the reference circle [m].
    tip_relief : TipRelief or None
        Relief of the flank towards the tip.
    tip_chamfer : float
        Radial height of a chamfer of 45 deg at the tip edges [m].
    """

    teeth: int  # z
    profile_shift: float = 0.0  # x, modules
    bore_radius: float | None = None  # m
    tip_alteration: float = 0.0  # k, modules
    thickness_allowance: float = 0.0  # arc at the reference circle, m
    tip_relief: TipRelief | None = None
    tip_chamfer: float = 0.0  # radial height, m

    def faults(self, where: str = "gear") -> tuple[Fault, ...]:
        """All faults of the values by themselves, empty when there are none."""
        found = (
            *whole_number_faults(
                f"{where}.teeth",
                self.teeth,
                FEWEST_TEETH,
                MOST_TEETH,
                "choose teeth in this range",
            ),
            *_SHIFT.faults(f"{where}.profile_shift", self.profile_shift),
            *_ALTERATION.faults(f"{where}.tip_alteration", self.tip_alteration),
            *_ALLOWANCE.faults(f"{where}.thickness_allowance", self.thickness_allowance),
            *_CHAMFER.faults(f"{where}.tip_chamfer", self.tip_chamfer),
        )
        if self.bore_radius is not None:
            found = (*found, *_BORE.faults(f"{where}.bore_radius", self.bore_radius))
        if self.tip_relief is not None:
            found = (*found, *self.tip_relief.faults(f"{where}.tip_relief"))
        return found
