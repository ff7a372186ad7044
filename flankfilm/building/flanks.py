"""Measured and worn flanks of a scene, from its curves to those of the ground, and whether they cover the teeth."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import gears
from base import Array, Faults, InputError
from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.curve_sections import CurveSection
from flankfilm.scene.sections.flank_sections import DeviationsSection, LeadSection, WearSection
from flankfilm.scene.sections.gears import GEARS, GearSection
from flankfilm.scene.sections.map_section import MapSection
from flankfilm.scene.sections.section import required

__all__ = ["deviations", "measured_lead"]

SLACK = 0.05
"""Part of the active profile, or of the face, that a curve may leave out at either end."""

LEAST_TWIST = 1e-8
"""Twist of a map that is worth a word [m]."""

Both = tuple[gears.GearDeviations | None, gears.GearDeviations | None]


def deviations(scene: Scene, pair: gears.GearPair, *, every_tooth: bool) -> Both | None:
    """Deviations and wear of both gears; those of single teeth only where every tooth counts.

    A mesh cycle of one base pitch stands for all teeth: it knows mean profiles and no pitches.

    Raises
    ------
    InputError
        With all curves that leave out a part of the active profile.
    """
    line, ends = pair.line_of_action, np.array([pair.points.A, pair.points.E])
    gear_deviations = []
    with Faults() as faults:
        for name, section, radius, active in zip(
            GEARS,
            required(scene.pair, "[pair]").each,
            pair.base_radii,
            (ends, line - ends[::-1]),
            strict=True,
        ):
            curves = _Curves(f"pair.{name}", radius, active, faults)
            gear_deviations.append(_of_gear(curves, section.deviations, section.wear))
    first, second = (
        gear if gear is None or every_tooth else _plain_as_none(gear.mean) for gear in gear_deviations
    )
    return (first, second) if first or second else None


def measured_lead(section: GearSection, name: str, face_width: float, base_radius: float) -> gears.Lead:
    """Measured lead of a gear, and the rest of a map where it is kept.

    Parameters
    ----------
    section : GearSection
    name : {"pinion", "wheel"}
    face_width, base_radius : float
        Of the gear [m].

    Raises
    ------
    InputError
        Where it leaves out a part of the face.

    Warns
    -----
    GeometryWarning
        Of a map's twist that is left out.
    """
    made = section.deviations
    if made is None or (made.lead is None and made.map is None):
        return gears.Lead()
    source: LeadSection | MapSection
    rest: gears.Topography | None = None
    if made.map is not None:
        source, kind = made.map, "map"
        parts = made.map.flank_map(base_radius)
        trace = parts.lead
        if made.map.twist == "kept":
            rest = parts.rest
        elif parts.twist > LEAST_TWIST:
            size = f"{name}: the map's twist, up to {1e6 * parts.twist:.2g} um of material"
            twist = f'{size}, is left out; give map.twist = "kept" to count it'
            warnings.warn(twist, gears.GeometryWarning, stacklevel=2)
    elif made.lead is not None:
        source, kind = made.lead, "lead"
        trace = made.lead.trace()
    half, slack = 0.5 * face_width, SLACK * face_width
    apart = trace.z[-1] <= -half or trace.z[0] >= half
    short = trace.z[0] > slack - half or trace.z[-1] < half - slack
    if apart or (short and source.beyond == "refuse"):
        key = f"{name}.deviations.{kind}" + (".file" if source.file else "")
        ends = f"the face, {-1e3 * half:.5g} to {1e3 * half:.5g} mm"
        value = f"{1e3 * trace.z[0]:.6g} to {1e3 * trace.z[-1]:.6g} mm"
        if apart:
            remedy = "Check the unit, and that places are counted from the middle of this gear's face"
            raise InputError.at(key, value, f"must lie on {ends}", remedy)
        remedy = 'Measure farther, count places from the middle of the face, or give beyond = "hold"'
        raise InputError.at(key, value, f"must cover {ends}, but for a twentieth at either end", remedy)
    return gears.Lead(trace=trace, topography=rest)


def _of_gear(
    curves: _Curves, section: DeviationsSection | None, wear: WearSection | None
) -> gears.GearDeviations | None:
    """Deviations of a gear as its keys give them."""
    made = gears.GearDeviations()
    if section is not None:
        made = gears.GearDeviations(curves.profile(section), section.pitches())
    if wear is not None and wear.factor > 0.0:  # a factor of 0 is the gear unworn
        made = gears.GearDeviations(made.profile, made.pitch, curves.wear(wear))
    return _plain_as_none(made)


def _plain_as_none(gear_deviations: gears.GearDeviations) -> gears.GearDeviations | None:
    return gear_deviations if gear_deviations.curved or gear_deviations.pitch is not None else None


@dataclass(frozen=True)
class _Curves:
    """Turns a gear's curves into those of the ground.

    Attributes
    ----------
    path : str
        The gear's place in the scene.
    base_radius : float
        [m]
    active : (2,) array
        Curvature radii at the ends of the active profile [m].
    faults : Faults
        Notes curves that do not cover it.
    """

    path: str
    base_radius: float
    active: Array
    faults: Faults

    def profile(
        self, measured: DeviationsSection
    ) -> gears.ProfileDeviation | tuple[gears.ProfileDeviation, ...] | None:
        """Measured profile of all teeth, or of each."""
        if (traces := measured.traces) is not None and traces.teeth is not None:
            at = "deviations.traces." + ("file" if traces.file else "teeth")
            self._cover(at, traces.teeth, traces.beyond == "hold")
            return tuple(curve.profile(self.base_radius) for curve in traces.teeth)
        if measured.map is not None:
            self._cover(
                "deviations.map" + (".file" if measured.map.file else ""),
                [measured.map],
                measured.map.beyond == "hold",
            )
            return None if self.faults.found else measured.map.flank_map(self.base_radius).profile
        if measured.profile is None:
            return None
        self._cover("deviations.profile", [measured.profile], hold=True)
        return measured.profile.profile(self.base_radius)

    def wear(self, worn: WearSection) -> gears.WearDepth | tuple[gears.WearDepth, ...]:
        """Wear of all teeth, or of each."""
        at = "wear.file" if worn.file else "wear" if worn.teeth is None else "wear.teeth"
        self._cover(at, worn.teeth or [worn], worn.beyond == "hold", ends_at_nothing=True)
        if worn.teeth is None:
            return worn.worn(self.base_radius, worn.factor)
        return tuple(curve.worn(self.base_radius, worn.factor) for curve in worn.teeth)

    def _cover(
        self, at: str, curves: Sequence[CurveSection], hold: bool, ends_at_nothing: bool = False
    ) -> None:
        """Note curves that leave out too much of the active profile: the first with its range, others by number."""
        low, high = self.active
        slack, bad = SLACK * (high - low), []
        for number, section in enumerate(curves):
            rho, values = np.array(section.radii(self.base_radius)), getattr(section, section.values[0])
            missing = (rho[0] > low + slack, rho[-1] < high - slack)
            if ends_at_nothing:
                missing = (missing[0] and values[0] != 0.0, missing[1] and values[-1] != 0.0)
            apart = not (rho[0] < high and rho[-1] > low)  # nan as well
            if apart or (any(missing) and not hold):
                bad.append((number, section, apart))
        if not bad:
            return
        number, section, apart = bad[0]
        by = section.measured_by
        places = getattr(section, by)
        unit = by.rpartition("_")[2]
        ends = " to ".join(f"{section.place(float(rho), self.base_radius):.5g}" for rho in (low, high))
        more = f", and {len(bad) - 1} more teeth" if len(bad) > 1 else ""
        tooth = f"tooth {number}: " if len(curves) > 1 else ""
        value = f"{tooth}{places[0]:.6g} to {places[-1]:.6g} {unit}{more}"
        span = f"the active profile, {ends} {unit}"
        if apart:
            remedy = "Check the unit, and whether the points are on the involute"
            self.faults.add(f"{self.path}.{at}", value, f"must lie on {span}", remedy)
        else:
            remedy = 'Measure farther, or give beyond = "hold": the ends then keep their value'
            allowed = f"must cover {span}, but for a twentieth at either end"
            self.faults.add(f"{self.path}.{at}", value, allowed, remedy)
