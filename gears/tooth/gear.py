"""One gear as it is specified: teeth, shift, bore and blank, allowance and tip corrections."""

from __future__ import annotations

from dataclasses import dataclass, fields

from base import Fault, Faults, Limit, shorten
from gears.tooth.blank import Blank
from gears.tooth.face import STRAIGHT, Lead

RELIEF_LIMITS = {
    "amount": Limit(0.0, 1.0, "m", "give the material removed at the tip in metres"),
    "length": Limit.above(0.0, 1e3, "m", "give the length along the path of contact in metres"),
}
"""What the numbers of tip relief may be."""

LIMITS = {
    "teeth": Limit(5, 10_000, remedy="choose teeth in this range", whole=True),
    "profile_shift": Limit(-0.8, 1.5, "modules", "shift the profile less"),
    "bore_radius": Limit.above(
        0.0, 1e4, "m", "give the radius of the bore in metres, or None for half the root radius"
    ),
    "tip_alteration": Limit(-1.0, 1.0, "modules", "change the tip less"),
    "generating_shift": Limit(-0.8, 1.5, "modules", "give the shift at which the tool cuts the gear"),
    "thickness_allowance": Limit(0.0, 1.0, "m", "give the arc by which the tooth is thinned, in metres"),
    "face_width": Limit(1e-6, 100.0, "m", "give the gear's own face width in metres, or None for the pair's"),
    "face_offset": Limit(-100.0, 100.0, "m", "give the place of its middle along the axis in metres"),
    "tip_chamfer": Limit(0.0, 1.0, "m", "give the radial height of the chamfer in metres"),
}
"""What the numbers of a gear may be."""


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

    def faults(self, path: str) -> tuple[Fault, ...]:
        """All faults of the values, empty when there are none."""
        collector = Faults.of(self, RELIEF_LIMITS, f"{path}.")
        collector.choice(f"{path}.form", self.form, ("linear", "parabolic"), "choose one of them")
        return tuple(collector.found)


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
    blank : Blank or None
        Rim, web and hub; None is a disc as wide as the face.
    generating_shift : float or None
        x_E [modules], at which the tool cuts flank and fillet where that is not `profile_shift`: a tooth thinner than
        nominal by 2 (x - x_E) m tan alpha at the reference circle, with a deeper root. The tip circle and the centre
        distance of no backlash stay those of `profile_shift`. None cuts at `profile_shift`.
    lead : Lead
        Crowning, slope and end relief along the gear's own face.
    face_width : float or None
        Of this gear, where it is wider than the face in contact, which is the pair's [m]; None is as wide.
    face_offset : float
        Place of the middle of this gear's face along the axis, from that of the face in contact [m].

    Examples
    --------
    >>> Gear(teeth=21, profile_shift=0.2, tip_relief=TipRelief(amount=20e-6, length=2e-3))
    Gear(teeth=21, profile_shift=0.2, tip_relief=TipRelief(amount=2e-05, length=0.002, form='linear'))
    """

    teeth: int  # z
    profile_shift: float = 0.0  # x, modules
    bore_radius: float | None = None  # m
    tip_alteration: float = 0.0  # k, modules
    thickness_allowance: float = 0.0  # arc at the reference circle, m
    tip_relief: TipRelief | None = None
    tip_chamfer: float = 0.0  # radial height, m
    blank: Blank | None = None
    generating_shift: float | None = None  # x_E, modules
    lead: Lead = STRAIGHT
    face_width: float | None = None  # m
    face_offset: float = 0.0  # m

    @property
    def cut_shift(self) -> float:
        """Shift at which the tool cuts the gear, x_E or x [modules]."""
        return self.profile_shift if self.generating_shift is None else self.generating_shift

    def __repr__(self) -> str:
        """Teeth, and what differs from the defaults."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        defaults = {field.name: field.default for field in fields(self)}
        changed = (
            f"{name}={f'{value:.9g}' if isinstance(value, float) else shorten(value)}"
            for name, value in values.items()
            if value != defaults[name]
        )
        return f"Gear({', '.join(changed)})"

    def faults(self, path: str = "gear") -> tuple[Fault, ...]:
        """All faults of the values by themselves, empty when there are none."""
        collector = Faults.of(self, LIMITS, f"{path}.")
        if self.tip_relief is not None:
            collector.extend(self.tip_relief.faults(f"{path}.tip_relief"))
        collector.extend(self.lead.faults(f"{path}.lead"))
        if self.blank is not None:
            collector.extend(self.blank.faults(f"{path}.blank"))
        return tuple(collector.found)
