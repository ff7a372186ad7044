"""How a gear's bore is held: on a rigid shaft, or on a rigid hub that its shaft holds elastically.

A rigid hub moves without strain, and its reaction follows from statics alone: a force F along the line of
action displaces it by F/k_r along that line and turns it by F r_b/k_t. Normals of all contacts of a pair lie on
the line of action, so every contact, whichever tooth carries the force, yields by the same

    F (1/k_r + r_b^2/k_t)

on top of the elastic gear with its bore held; no finite element is asked. (At a tip edge outside the path the
normal leans by some hundredths of a radian; that is left out of what the supports yield.)
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING

from base import Faults, Limit, rounded_down

if TYPE_CHECKING:
    from gears import GearPair, ToothProfile

__all__ = ["FIXED", "Support", "held_profiles", "on_both"]

ROUNDING = 1e-9
"""Relative difference below which a hub is as large as the bore."""

HUB_RADIUS = Limit(0.0, unit="m", low_open=True, remedy="leave it out: the bore")


@dataclass(frozen=True)
class Support:
    """Support of one gear; fixed on its bore unless given otherwise.

    Parameters
    ----------
    radial_stiffness : float
        k_r of the rigid hub's centre along the line of action [N/m], for the whole face width.
    torsional_stiffness : float
        k_t of the hub's turn about its axis [N m/rad].
    hub_radius : float, optional
        Radius of a rigid hub that is larger than the bore [m]; the gear is held there. What it leaves of the
        body is the rim.

    Raises
    ------
    base.InputError
        Stiffness not positive, or a hub radius that is not positive and finite.
    """

    radial_stiffness: float = inf  # N/m
    torsional_stiffness: float = inf  # N m/rad
    hub_radius: float | None = None  # m

    def __post_init__(self) -> None:
        """Refuse values that no support has."""
        faults = Faults()
        for name, value, unit in (
            ("radial_stiffness", self.radial_stiffness, "N/m"),
            ("torsional_stiffness", self.torsional_stiffness, "N m/rad"),
        ):
            if not value > 0:
                allowed = f"must be more than 0 {unit}, inf for rigid"
                faults.add(f"support.{name}", f"{value!r}", allowed, "give its stiffness")
        if self.hub_radius is not None:
            faults.number("support.hub_radius", self.hub_radius, HUB_RADIUS)
        faults.raise_if_any()

    def compliance(self, base_radius: float) -> float:
        """1/k_r + r_b^2/k_t along the line of action [m/N]."""
        return 1 / self.radial_stiffness + self.turn(base_radius)

    def turn(self, base_radius: float) -> float:
        """r_b^2/k_t, the hub's turn along the line of action [m/N]."""
        return base_radius**2 / self.torsional_stiffness


FIXED = Support()


def on_both(support: Support | tuple[Support, Support] | None) -> tuple[Support, Support]:
    """Supports of pinion and wheel; one given for both, or none: held on the bores."""
    if support is None:
        return FIXED, FIXED
    return support if isinstance(support, tuple) else (support, support)


def held_profiles(pair: GearPair, supports: tuple[Support, Support]) -> tuple[ToothProfile, ToothProfile]:
    """Teeth of both gears with the radius at which each is held as its bore.

    Raises
    ------
    base.InputError
        A hub inside the bore, one that leaves less than 0.05 modules of rim, or less than 0.25 modules of web.
    """
    faults, held = Faults(), []
    for name, profile, support in zip(("pinion", "wheel"), pair.teeth_profiles, supports, strict=True):
        radius = profile.bore_radius if support.hub_radius is None else support.hub_radius
        most, margin = profile.root_radius - 0.05 * profile.module, "0.05 modules under the root circle"
        if profile.steps:
            most, margin = (
                profile.zones[0].inner - 0.25 * profile.module,
                "0.25 modules of web inside the rim",
            )
        if abs(radius - profile.bore_radius) < ROUNDING * profile.bore_radius:
            radius = profile.bore_radius
        if support.hub_radius is not None and not profile.bore_radius <= radius <= most:
            allowed = f"must be {profile.bore_radius:.6g} m (bore) to {rounded_down(most)} m ({margin})"
            remedy = "the hub fills the bore and leaves a rim"
            faults.add(f"{name}.support.hub_radius", f"{radius:g} m", allowed, remedy)
        held.append(replace(profile, bore_radius=radius))
    faults.raise_if_any()
    return held[0], held[1]
