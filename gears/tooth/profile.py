"""One generated tooth: involute flank, trochoidal fillet, chamfer and top land."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from base import Array
from gears.tooth.blank import Zone
from gears.tooth.gear import Gear, TipRelief
from gears.tooth.helix import Helix
from gears.tooth.involute import involute_function
from gears.tooth.rack import BasicRack
from gears.tooth.rotation import polar
from gears.tooth.trochoid import Trochoid, form_point

THINNEST_HUB = 0.05
"""Thickness of a hub round its bore below which it is none [modules]."""


@dataclass(frozen=True)
class ToothProfile:
    """One tooth in its own frame: gear axis at the origin, centre line of the tooth along +y.

    All curves belong to the right-hand flank, x > 0; the left-hand flank is the mirror image. Polar angles
    are measured from +y towards +x. The involute is the exact one: tip relief is given apart by `relief`, as
    a gap to be added, not as a change of shape.

    Parameters
    ----------
    teeth : int
        z.
    module : float
        m_n, of the normal section [m]; all else belongs to the transverse section.
    reference_radius, base_radius, root_radius, form_radius, flank_end_radius, tip_radius, bore_radius : float
        Radii [m]. The involute runs from the form circle to the end of the flank, which is the tip circle or
        the start of the chamfer.
    base_half_angle : float
        Half-thickness angle of the involute on the base circle [rad].
    fillet_curve : Trochoid
        The fillet in its own parameter.
    tip_half_angle : float
        Half angle of the top land [rad]; not positive for a pointed tooth.
    undercut : bool
        Whether the fillet cuts the involute.
    tip_relief : TipRelief or None
        Relief of the flank.
    steps : tuple of (float, float)
        Radii at which the body's thickness changes, outer ones first [m], each with the thickness below it over the
        face width; none in a disc.
    """

    teeth: int
    module: float  # m, m
    reference_radius: float  # r, m
    base_radius: float  # r_b, m
    root_radius: float  # r_f, m
    form_radius: float  # r_Ff, m
    flank_end_radius: float  # r_Fa, m
    tip_radius: float  # r_a, m
    bore_radius: float  # m
    base_half_angle: float  # psi_b, rad
    fillet_curve: Trochoid
    tip_half_angle: float  # rad
    undercut: bool
    tip_relief: TipRelief | None = None
    steps: tuple[tuple[float, float], ...] = ()  # m, -

    def __repr__(self) -> str:
        """One line: the tooth among its like."""
        tip, root = 1e3 * self.tip_radius, 1e3 * self.root_radius
        return (
            f"ToothProfile({self.teeth} teeth, module {1e3 * self.module:.6g} mm, "
            f"root radius {root:.7g} mm, tip radius {tip:.7g} mm)"
        )

    @property
    def pitch_angle(self) -> float:
        """Angle between neighbouring teeth, 2 pi / z [rad]."""
        return 2.0 * math.pi / self.teeth

    @property
    def zones(self) -> tuple[Zone, ...]:
        """Rings of the body between root circle and bore, the outermost first: rim, web, hub; one ring in a disc.

        A hub of less than 0.05 modules is none.
        """
        rings, outer, thickness = [], self.root_radius, 1.0
        for radius, below in self.steps:
            if radius > self.bore_radius + THINNEST_HUB * self.module:
                rings.append(Zone(radius, outer, thickness))
                outer, thickness = radius, below
        return (*rings, Zone(self.bore_radius, outer, thickness))

    @property
    def rim_thickness(self) -> float:
        """s_R, from the root circle to the inside of the rim; of a disc to the bore [m]."""
        rim = self.zones[0]
        return rim.outer - rim.inner

    @property
    def rim_ratio(self) -> float:
        """Rim thickness over tooth depth, s_R/h_t."""
        return self.rim_thickness / (self.tip_radius - self.root_radius)

    @property
    def root_half_angle(self) -> float:
        """Polar angle at which the fillet leaves the root circle [rad]; the root arc runs on to pi / z."""
        return self.fillet_curve.foot_angle

    @property
    def flank_rho(self) -> tuple[float, float]:
        """Curvature radii at the form circle and at the end of the flank [m]."""
        base = self.base_radius
        form = math.sqrt(max(self.form_radius**2 - base**2, 0.0))
        return form, math.sqrt(self.flank_end_radius**2 - base**2)

    def half_angle(self, radius: float | Array) -> Array:
        """Half-thickness angle of the involute at given radii.

        psi(r) = psi_b - inv alpha_r, alpha_r = arccos(r_b / r)

        Parameters
        ----------
        radius : float or (n,) array
            Radii, at least the form radius [m].

        Returns
        -------
        array like `radius`
            Half angle [rad].
        """
        ratio = np.asarray(radius, dtype=float) / self.base_radius
        roll = np.sqrt(np.maximum((ratio - 1.0) * (ratio + 1.0), 0.0))
        return np.asarray(self.base_half_angle - involute_function(roll))

    def involute(self, rho: float | Array) -> Array:
        """Points of the right-hand involute.

        Parameters
        ----------
        rho : float or (n,) array
            Curvature radius, sqrt(r^2 - r_b^2) [m].

        Returns
        -------
        (n, 2) array
            Points [m].
        """
        length = np.asarray(rho, dtype=float)
        angle = self.base_half_angle - length / self.base_radius
        sine, cosine = np.sin(angle), np.cos(angle)
        base = self.base_radius
        return np.stack((base * sine + length * cosine, base * cosine - length * sine), axis=-1)

    def normal(self, rho: float | Array) -> Array:
        """Outward unit normals of the right-hand involute at curvature radii `rho` [m], (n, 2)."""
        angle = self.base_half_angle - np.asarray(rho, dtype=float) / self.base_radius
        return np.stack((np.cos(angle), -np.sin(angle)), axis=-1)

    def fillet(self, t: float | Array) -> Array:
        """Points of the fillet from the root circle (t = 0) to the form circle (t = 1).

        t is proportional to the angle of the normal of the rack's tip arc, so points equally spaced in t are
        closest where the fillet is most curved.

        Parameters
        ----------
        t : float or (n,) array
            Parameter in [0, 1].

        Returns
        -------
        (n, 2) array
            Points [m].
        """
        return self.fillet_curve.point(np.asarray(t, dtype=float) * self.fillet_curve.end)

    def fillet_normal(self, t: float | Array) -> Array:
        """Outward unit normals of the fillet at parameters `t` in [0, 1], (n, 2)."""
        return self.fillet_curve.normal(np.asarray(t, dtype=float) * self.fillet_curve.end)

    def chamfer(self, t: float | Array) -> Array:
        """Points of the chamfer, a straight line from the end of the flank (t = 0) to the top land (t = 1).

        Parameters
        ----------
        t : float or (n,) array
            Parameter in [0, 1].

        Returns
        -------
        (n, 2) array
            Points [m]; all the same one if the tooth has no chamfer.
        """
        along = np.asarray(t, dtype=float)[..., None]
        start = self.involute(self.flank_rho[1])
        if self.flank_end_radius == self.tip_radius:
            return np.asarray(np.broadcast_to(start, (*along.shape[:-1], 2)).copy())
        end = polar(self.tip_radius, self.tip_half_angle)
        return np.asarray((1.0 - along) * start + along * end)

    def relief(self, rho: float | Array) -> Array:
        """Material removed normal to the flank by tip relief.

        Linear: C (1 - s / L); parabolic: C (1 - s / L)^2, s the roll length from the end of the flank.

        Parameters
        ----------
        rho : float or (n,) array
            Curvature radius on the flank [m].

        Returns
        -------
        array like `rho`
            Removed material, at least 0 [m].
        """
        length = np.asarray(rho, dtype=float)
        if self.tip_relief is None:
            return np.zeros_like(length)
        from_end = self.flank_rho[1] - length
        depth = np.clip(1.0 - from_end / self.tip_relief.length, 0.0, None)
        power = 2 if self.tip_relief.form == "parabolic" else 1
        return np.asarray(self.tip_relief.amount * depth**power)

    def boundary_angle(self, radius: float | Array) -> Array:
        """Polar angle of the right-hand boundary of the tooth at given radii (without relief).

        The radius grows monotonically along fillet, involute and chamfer, so the tooth's outline is a
        function of it. Inside the root circle the answer is pi / z (all material), outside the tip circle
        -inf (none).

        Parameters
        ----------
        radius : float or (n,) array
            Radii [m].

        Returns
        -------
        array like `radius`
            Polar angle [rad].
        """
        r = np.asarray(radius, dtype=float)
        inside = np.clip(r, self.root_radius, self.form_radius)
        curve = self.fillet_curve
        fillet = curve.polar_angle(curve.beta_at(inside, curve.end))
        angle = np.where(r < self.form_radius, fillet, self.half_angle(np.maximum(r, self.form_radius)))
        if self.flank_end_radius < self.tip_radius:
            angle = np.where(r > self.flank_end_radius, self._chamfer_angle(r), angle)
        angle = np.where(r < self.root_radius, 0.5 * self.pitch_angle, angle)
        return np.where(r > self.tip_radius, -np.inf, angle)

    def _chamfer_angle(self, radius: Array) -> Array:
        start, end = self.chamfer(np.array([0.0, 1.0]))
        along = (end - start) / np.linalg.norm(end - start)
        foot = float(start @ along)
        offset = float(start[0] * along[1] - start[1] * along[0])
        distance = np.sqrt(np.maximum(radius**2 - offset**2, 0.0)) - foot
        points = start + distance[..., None] * along
        return np.asarray(np.arctan2(points[..., 0], points[..., 1]))


def generate(
    gear: Gear, module: float, rack: BasicRack, face_width: float | None = None, helix_angle: float = 0.0
) -> ToothProfile | None:
    """Generate the tooth that the rack cuts, in the transverse section.

    Module, rack, shifts and thickness allowance belong to the normal section: r = z m_n/(2 cos beta),
    r_b = r cos alpha_t, psi_b = (pi/2 + 2 x tan alpha_n)/z + inv alpha_t; heights keep m_n. The thickness allowance
    displaces each generating flank sideways by half its amount: flank and fillet turn towards the centre line of the
    tooth by A / (2 r cos beta), root and tip circles stay. A generating shift moves the rack, so flank, fillet and root
    circle; the tip circle stays.

    Parameters
    ----------
    gear : Gear
        The specification, free of value faults.
    module : float
        m_n [m].
    rack : BasicRack
        The generating profile.
    face_width : float, optional
        b, to which the web's thickness is referred [m]; the body is a disc unless given.
    helix_angle : float
        beta on the reference cylinder [rad].

    Returns
    -------
    ToothProfile or None
        The tooth; None if undercut leaves no involute. A pointed tooth is returned with a `tip_half_angle`
        that is not positive.
    """
    helix = Helix(helix_angle, rack.alpha)
    radius = 0.5 * gear.teeth * module / helix.cosine
    base = radius * helix.transverse_cosine
    shift = gear.cut_shift
    thinning = 0.5 * gear.thickness_allowance / radius / helix.cosine
    half = (0.5 * math.pi + 2.0 * shift * math.tan(rack.alpha)) / gear.teeth - thinning
    base_half_angle = half + float(involute_function(helix.transverse_tangent))
    depth = module * (rack.h_fP - rack.fillet_radius - shift)
    arc = module * rack.fillet_radius
    foot = math.pi / gear.teeth - module * rack.tip_centre_offset / radius / helix.cosine - thinning
    trochoid = Trochoid(radius, depth, arc, foot, 0.5 * math.pi - rack.alpha, helix_angle)
    meeting = form_point(trochoid, base, base_half_angle, helix)
    if meeting is None:
        return None
    end, rho_form, undercut = meeting
    root = radius - depth - arc
    tip = radius + module * (rack.h_aP + gear.profile_shift + gear.tip_alteration)
    flank_end = tip - gear.tip_chamfer
    return ToothProfile(
        teeth=int(gear.teeth),
        module=module,
        reference_radius=radius,
        base_radius=base,
        root_radius=root,
        form_radius=math.hypot(base, rho_form),
        flank_end_radius=flank_end,
        tip_radius=tip,
        bore_radius=0.5 * root if gear.bore_radius is None else float(gear.bore_radius),
        base_half_angle=base_half_angle,
        fillet_curve=Trochoid(radius, depth, arc, foot, end, helix_angle),
        tip_half_angle=_top_land(base, base_half_angle, flank_end, tip),
        undercut=undercut,
        tip_relief=gear.tip_relief,
        steps=() if gear.blank is None or face_width is None else gear.blank.steps(root, face_width),
    )


def _top_land(base: float, base_half_angle: float, flank_end: float, tip: float) -> float:
    """Half angle of the top land; a chamfer of 45 deg to the radius takes its part off it."""
    roll = math.sqrt(max((flank_end / base - 1.0) * (flank_end / base + 1.0), 0.0))
    angle = base_half_angle - float(involute_function(roll))
    if flank_end == tip:
        return angle
    # the chamfer's line passes the axis at the distance flank_end / sqrt(2)
    return angle - (0.25 * math.pi - math.asin(flank_end * math.sqrt(0.5) / tip))
