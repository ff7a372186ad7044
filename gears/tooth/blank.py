"""Blank of a gear: a rim and a hub as wide as the face, a thinner web between them."""

from __future__ import annotations

from dataclasses import dataclass

from base import Fault, Faults, Limit, rounded_down, rounded_up

LIMITS = {
    "rim_thickness": Limit.above(0.0, 1e4, "m", "give the rim's thickness below the root circle in metres"),
    "web_thickness": Limit.above(0.0, 100.0, "m", "give the web's thickness along the axis in metres"),
    "hub_radius": Limit.above(0.0, 1e4, "m", "give the hub's outer radius in metres, or None for no hub"),
    "web_offset": Limit(-100.0, 100.0, "m", "put the web in the middle of the face"),
}
"""What the numbers of a blank may be."""

THINNEST_RIM = 0.5
"""Rim thickness below which a rim on a web is refused [modules]."""

LOWEST_WEB = 0.25
"""Height of the web between rim and hub or bore below which it is refused [modules]."""

THINNEST_WEB = 0.05
"""Web thickness over the face width below which it is refused."""


@dataclass(frozen=True)
class Zone:
    """Ring of a gear's body.

    Attributes
    ----------
    inner, outer : float
        Radii [m].
    thickness : float
        Along the axis, over the face width.
    """

    inner: float
    outer: float
    thickness: float


@dataclass(frozen=True)
class Blank:
    """Rim, web and hub of a gear; without one the gear is a disc as wide as its face.

    Parameters
    ----------
    rim_thickness : float
        s_R, from the root circle to the inside of the rim [m].
    web_thickness : float
        b_s, along the axis [m]. The web runs all round, without holes or spokes.
    hub_radius : float or None
        Outer radius of the hub, which is as wide as the face [m]; None carries the web down to the bore.
    web_offset : float
        Distance of the web from the middle of the face [m]. Only 0 is accepted: the rim on a web off its middle tilts
        under the load, which no plane model has.

    Examples
    --------
    >>> Blank(rim_thickness=6e-3, web_thickness=12e-3, hub_radius=25e-3)
    Blank(rim_thickness=0.006, web_thickness=0.012, hub_radius=0.025, web_offset=0.0)
    """

    rim_thickness: float  # s_R, m
    web_thickness: float  # b_s, m
    hub_radius: float | None = None  # m
    web_offset: float = 0.0  # m

    def faults(self, path: str) -> tuple[Fault, ...]:
        """All faults of the values by themselves, empty when there are none."""
        return tuple(Faults.of(self, LIMITS, f"{path}.").found)

    def check(
        self, faults: Faults, path: str, root: float, bore: float, module: float, face_width: float | None
    ) -> None:
        """Note what does not fit a gear.

        Parameters
        ----------
        faults : Faults
            Where to.
        path : str
            ``wheel.blank``.
        root, bore, module : float
            Root circle's and bore's radius, module [m].
        face_width : float or None
            [m]; None where it is at fault itself.
        """
        inside = bore if self.hub_radius is None else self.hub_radius
        below = "bore" if self.hub_radius is None else "hub"
        least, most = THINNEST_RIM * module, root - LOWEST_WEB * module
        if self.hub_radius is not None and not bore <= self.hub_radius <= most - least:
            allowed = f"must be {rounded_up(bore)} m to {rounded_down(most - least)} m"
            remedy = "the hub lies outside the bore, and leaves half a module of rim and a quarter of web"
            faults.add(f"{path}.hub_radius", f"{self.hub_radius:g}", allowed, remedy)
        elif least > most - inside:
            remedy = (
                f"half a module of rim and a quarter of web do not fit above the {below}: give a smaller one"
            )
            faults.add(
                f"{path}.rim_thickness", f"{self.rim_thickness:g}", f"must leave the {below} room", remedy
            )
        elif not least <= self.rim_thickness <= most - inside:
            allowed = f"must be {rounded_up(least)} m to {rounded_down(most - inside)} m"
            remedy = f"half a module carries the teeth, and a quarter is left for the web above the {below}"
            faults.add(f"{path}.rim_thickness", f"{self.rim_thickness:g}", allowed, remedy)
        if self.web_offset != 0.0:
            remedy = (
                "a web off the middle of the face tilts the rim under load, which takes a three-dimensional "
            )
            remedy += "model: centre the web"
            faults.add(f"{path}.web_offset", f"{self.web_offset:g}", "must be 0 m", remedy)
        least = THINNEST_WEB * (face_width or 0.0)
        if face_width is not None and not least <= self.web_thickness <= face_width:
            allowed = f"must be {rounded_up(least)} m to {rounded_down(face_width)} m"
            remedy = (
                "the web is at most as wide as the face; on a thinner one the rim bends across its width, "
            )
            remedy += "which takes a three-dimensional model"
            faults.add(f"{path}.web_thickness", f"{self.web_thickness:g}", allowed, remedy)

    def steps(self, root_radius: float, face_width: float) -> tuple[tuple[float, float], ...]:
        """Radii [m] at which the thickness changes, outer ones first, each with the one below over the face width.

        Empty where the web is as wide as the face: the gear is then a disc.
        """
        thickness = self.web_thickness / face_width
        if thickness == 1.0:
            return ()
        rim = root_radius - self.rim_thickness
        hub = () if self.hub_radius is None else ((self.hub_radius, 1.0),)
        return ((rim, thickness), *hub)
