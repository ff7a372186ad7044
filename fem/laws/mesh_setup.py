"""How a pair is set up for contact: teeth that meet first, rounded tips, deviations, friction; checked together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import sin
from numbers import Integral, Real
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Faults, Integers, Limit, rounded_down
from fem.laws.helical_limits import check_helical
from fem.laws.line_candidates import SHORT_CELL
from fem.laws.pair_flanks import PairFlanks
from fem.laws.tip_geometry import chamfer_length
from fem.pair.face_setting import EVEN, FaceSetting
from fem.pair.options import USUAL_OPTIONS, Options
from gears import GearDeviations

if TYPE_CHECKING:
    from fem.laws.flank_forms import Deviations
    from fem.laws.relieved_lines import RelievedLines
    from fem.laws.tip_contact import Removed
    from fem.laws.tip_geometry import TipRound
    from gears import GearPair

__all__ = ["MeshSetup"]

LARGEST_ROUND = 0.2
"""Largest part of the flank [modules] that a rounding of the tip may take."""

COUNT = Limit(1, whole=True)
FRICTION = Limit(0.0, 0.5, remedy="dry steel has about 0.2, oiled 0.05")


@dataclass(frozen=True, eq=False)
class Stations:
    """Positions one by one.

    Attributes
    ----------
    within : (n,) array
        Base pitches, 0 to 1.
    pitch : (n,) array of int
        Number of the base pitch.
    """

    within: Array
    pitch: Integers


@dataclass(frozen=True)
class MeshSetup:
    """How a pair stands and what its flanks are like; `mesh_cycle` describes each of these.

    Nothing is checked before `check` is called. With `back` the loaded flanks are those in which a braking pinion
    bears: the same gears in a mirror, at the same positions. `two_sided`: their opposite flanks bear too.
    """

    pair: GearPair
    positions: int = 40
    beyond_path: bool = True
    deviations: Deviations | None = None
    pitches: int = 1
    first_teeth: tuple[int, int] = (0, 0)
    tip_rounding: float | tuple[float, float] = 0.0
    friction: float = 0.0
    stations: Stations | None = None
    moving_contact: bool = False
    base_pitch_difference: float = 0.0
    back: bool = False
    two_sided: bool = False
    face: FaceSetting = EVEN
    options: Options = USUAL_OPTIONS
    known_flanks: PairFlanks | None = field(default=None, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Share flanks with the setup that this one was made from, where they are the same: tables are found once."""
        flanks, known = (
            PairFlanks(self.pair, self.deviations, self.tip_rounding, self.options),
            self.known_flanks,
        )
        if known is None or not known.same(flanks):
            object.__setattr__(self, "known_flanks", flanks)

    @property
    def flanks(self) -> PairFlanks:
        """Flanks in the section, which all setups of the same gears share."""
        assert self.known_flanks is not None  # since the setup was made
        return self.known_flanks

    def at(self, position: Array) -> MeshSetup:
        """The same gears at given positions (n,) [base pitches] instead of equal intervals."""
        pitch = np.floor(position)
        stations = Stations(position - pitch, pitch.astype(np.int64))
        return replace(self, positions=len(position), pitches=1, stations=stations)

    @property
    def opposite(self) -> MeshSetup:
        """The same gears and positions with the other flanks loaded."""
        face = self.face.opposite(self.pair.working_pressure_angle)
        return replace(self, back=not self.back, face=face)

    @property
    def helical(self) -> bool:
        """Whether lines of contact cross the face."""
        return self.pair.helix_angle != 0.0

    @property
    def line_slope(self) -> float:
        """Change of rho1 by z along a line of contact: tan(beta_b), above 0 on front flanks of right-handed pinions."""
        slope = self.pair.helix.base_tangent
        return -slope if self.back else slope

    @property
    def backlash(self) -> float:
        """Backlash along the transverse line of action, along which D is counted [m]."""
        return self.pair.base_tangent_backlash

    @cached_property
    def mirror(self) -> float:
        """Sum c of a position and of that at which the mirrored gears stand alike, with the wheel where it is.

        The flanks of a tooth of the wheel are 2 r_b2 psi_b2 apart on its base circle, the two lines of action leave
        it 2 r_b2 alpha_w apart, and its back flank meets the tooth of the pinion that follows:
        c = 2 [L - rho1_A - r_b2 (psi_b2 + alpha_w)]/p_b + 1. With the pinion where it is c is less by j/p_b.
        """
        pair, wheel = self.pair, self.pair.teeth_profiles[1]
        turn = wheel.base_radius * (wheel.base_half_angle + pair.working_pressure_angle)
        return 2 * (pair.line_of_action - pair.points.A - turn) / pair.base_pitch + 1

    def seen(self, position: Array) -> Array:
        """Positions at which a corner in the law of a flank is met by the flanks that bear (n,), 0 to 1."""
        mirrored = (self.mirror - position) % 1.0
        if self.two_sided:
            return np.concatenate([position, mirrored])
        return mirrored if self.back else position

    def teeth(self, step: Integers) -> Integers:
        """Numbers of the teeth that meet (2, ...), from those that the pinion's has been gone on by.

        Behind a tooth of the pinion stands the wheel's following one.
        """
        first, second = self.first_teeth
        return np.stack([first + step, second + step + int(self.back)])

    def check(self, faults: Faults) -> None:
        """Note everything that is wrong."""
        if self.helical:
            check_helical(faults, self)
        faults.number("positions", self.positions, COUNT)
        faults.number("pitches", self.pitches, COUNT)
        faults.number("friction", self.friction, FRICTION)
        if faults.instance("options", self.options, Options, "as of fem.Options"):
            self.options.check(faults)
        for name in ("beyond_path", "moving_contact"):
            faults.instance(name, getattr(self, name), bool, "True or False")
        if self.face is not EVEN:
            self.face.check(faults, self.pair, self.positions)
        numbers = tuple(self.first_teeth) if isinstance(self.first_teeth, Sequence) else ()
        if len(numbers) != 2 or any(isinstance(n, bool) or not isinstance(n, Integral) for n in numbers):
            faults.add("first_teeth", self.first_teeth, "must be two whole numbers", "number from 0")
        if len(self.flanks.by_gear) != 2:
            gears = f"{len(self.flanks.by_gear)} gears"
            faults.add("deviations", gears, "must be of pinion and wheel", "give None for a perfect one")
        else:
            for k, (gear, spec) in enumerate(
                zip(self.flanks.by_gear, (self.pair.pinion, self.pair.wheel), strict=True)
            ):
                key = f"deviations[{k}]"
                if faults.instance(key, gear, GearDeviations, optional=True) and gear is not None:
                    faults.extend(gear.faults(key, spec.teeth))
        self._check_rounding(faults)

    def _check_rounding(self, faults: Faults) -> None:
        numbers = [
            isinstance(r, Real) and not isinstance(r, bool) and np.isfinite(r) and r >= 0
            for r in self.flanks.radii
        ]
        if len(self.flanks.radii) != 2 or not all(numbers):
            allowed = "must be a radius of at least 0 m, or one for each gear"
            faults.add("tip_rounding", self.tip_rounding, allowed, "give metres; 0 is sharp")
            return
        fits = True
        for k, (rounding, profile) in enumerate(zip(self.rounds, self.pair.teeth_profiles, strict=True)):
            if rounding.radius == 0.0:
                continue
            land = profile.tip_radius * sin(max(profile.tip_half_angle, 0.0))
            # with a chamfer the arc is between flank and chamfer, and must end on it
            length = chamfer_length(profile)
            room = min(LARGEST_ROUND * profile.module, length if length > 0 else land)
            if rounding.start > room:
                most = f"must be at most {rounded_down(room * rounding.radius / rounding.start, 3)} m"
                faults.add(f"tip_rounding[{k}]", f"{rounding.radius:g} m", most, "round the tip less")
                fits = False
        start, end = self.ends
        covered = end - start + self.pair.overlap_ratio * self.pair.base_pitch
        if self.helical and not self.beyond_path and covered < self.pair.base_pitch:
            ratio = f"{covered / self.pair.base_pitch:.4g} in all"
            remedy = "widen the face, or give more teeth or higher ones"
            faults.add("pair.total_contact_ratio", ratio, "must be above 1: a line must always touch", remedy)
        elif fits and not self.beyond_path and not self.helical and end - start < self.pair.base_pitch:
            remedy = "round the tips less, or let tip edges touch"
            faults.add("tip_rounding", self.tip_rounding, "must leave a contact ratio above 1", remedy)

    @property
    def rounds(self) -> tuple[TipRound, TipRound]:
        """Roundings of pinion's and wheel's tip edges."""
        return self.flanks.rounds

    @property
    def strips_at_corners(self) -> tuple[bool, bool]:
        """Whether contacts beside the tip corners of pinion and wheel press by strips of plain flanks that stay."""
        plain = self.beyond_path and self.removed is None and not self.moving_contact
        first, second = (plain and rounding.radius == 0.0 for rounding in self.rounds)
        return first, second

    @property
    def ends(self) -> tuple[float, float]:
        """rho1 at which contact of the two involutes starts and ends [m]: A and E but for roundings."""
        return self.flanks.ends

    @property
    def removed(self) -> tuple[Removed, Removed] | None:
        """Material missing from pinion's and wheel's flank at curvature radii, mean of their teeth; None if none is."""
        return self.flanks.removed

    @property
    def relieved(self) -> RelievedLines | None:
        """Where relieved flanks touch, as far as lines of contact go; None where they do so as involutes."""
        return self.flanks.relieved_beyond_path if self.beyond_path else self.flanks.relieved_on_path

    @property
    def even(self) -> bool:
        """Whether the flanks are true involutes at equal pitches."""
        return self.flanks.even and not self.base_pitch_difference

    @property
    def corners(self) -> Array:
        """Positions within a base pitch at which a flank's laws change by the geometry (n,), 0 to 1; see `seen`.

        The ends of the path, where flanks give way to tip edges; starts of tip relief; C with friction, which turns
        there; points of measured profiles unless there are very many, whose curvature alone steps there.
        """
        pair = self.pair
        line, places = pair.line_of_action, [*self.ends, pair.points.A, pair.points.E]
        if self.helical:
            return self._ends_of_lines
        for gear in (0, 1):
            rho = self.flanks.corners(gear)
            places += rho if gear == 0 else [line - radius for radius in rho]
        if self.friction:
            places.append(pair.points.C)
        inside = [place for place in places if self.ends[0] <= place <= self.ends[1]] + [pair.points.A]
        return np.unique((np.array(inside) - pair.points.A) / pair.base_pitch % 1.0)

    @property
    def _ends_of_lines(self) -> Array:
        """Positions at which a line of contact begins to touch, reaches the other end of the face, or leaves one."""
        start, end = self.ends
        half = 0.5 * self.pair.face_width * abs(self.line_slope)
        short = SHORT_CELL / self.face.cells * 2.0 * half
        bends = np.array([-half, half, -half + short, half - short])
        turns = self.pair.points.C + bends[:2] if self.friction else bends[:0]  # where a line's end crosses C
        middles = np.concatenate([start + bends, end + bends, turns])
        return np.unique((middles - self.pair.points.A) / self.pair.base_pitch % 1.0)

    def pitch_gap(self, teeth: Integers) -> Array:
        """Gap along the line of action by pitch deviations of teeth (2, ...) [m].

        A tooth of the pinion that comes late opens the gap of its loaded flank, one of the wheel closes it; behind a
        tooth it is the other way round.
        """
        first, second = self.flanks.by_gear
        gap = np.zeros(teeth.shape[1:])
        if first is not None:
            gap += first.late(teeth[0])
        if second is not None:
            gap -= second.late(teeth[1])
        return np.asarray(gap * self.pair.helix.transverse_cosine * (-1 if self.back else 1))

    def tooth_gap(self, teeth: Integers, rho: Array) -> Array:
        """Gap from what teeth (2, ...) lack compared with the mean of their gear at curvature radii (2, ...) [m].

        `removed` is that mean, by which tip edges have their laws: over a contact of their size what a tooth differs
        by is taken as even.
        """
        gap = np.zeros(np.broadcast_shapes(teeth.shape[1:], rho.shape[1:]))
        for deviations, tooth, place in zip(self.flanks.by_gear, teeth, rho, strict=True):
            if deviations is not None:
                gap -= deviations.of_tooth(tooth, place)
        return gap

    def rolling_gap(self, place: Array) -> Array:
        """Gap by unequal base pitches at places of the line of action [m]: none at C, p_b2 - p_b1 a base pitch on."""
        return np.asarray(self.base_pitch_difference / self.pair.base_pitch * (self.pair.points.C - place))
