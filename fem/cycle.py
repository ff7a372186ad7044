"""Result of the loaded tooth contact: forces, stiffness, transmission error, pressures, sliding, losses."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from base import (
    Array,
    Booleans,
    Cost,
    Faults,
    Integers,
    Limit,
    SolverError,
    described,
    part,
    quantity,
    record,
)
from base.results import EXACT, ITSELF
from fem.contact_candidates import ContactCandidates
from fem.elasticity import reduced_modulus
from fem.events import ContactProblem, measured_less
from fem.face_loads import FaceLoads
from fem.model_error import LoadedContacts
from fem.opposite_flanks import OppositeFlanks
from fem.references import check_reference, turns
from fem.setting import Setting
from fem.support import FIXED, Support
from gears import GearPair, half_width, peak_pressure
from gears.mesh_figures import MeshArcs, MeshFigures

__all__ = ["MeshCycle", "check_row", "require_row"]


HERTZ = "not estimated: Hertz's law of the contact's force, whose error is not known in single positions"


@record
class MeshCycle(MeshFigures):
    """Some base pitches of a loaded pair; rows are positions, columns pairs in order of growing rho1.

    Means, extremes and harmonics are those of the curves on smooth arcs between events, whatever the positions. Where
    the contact has no solution at some position, ``converged`` is False and they are nan; where it has none between
    the positions, which is known when they are first asked for, they raise ``base.SolverError``.

    ``cost`` includes the compliance if it was computed here; of several torques it is that of all together.
    """

    headline = ("torque", "mean_stiffness", "mean_secant_stiffness", "transmission_error_range")

    torque: float = quantity("N m", "torque of the pinion", no_error=EXACT)
    force: float = quantity(
        "N", "torque over the pinion's base radius, negative where back flanks bear", no_error=EXACT
    )
    position: Array = quantity(
        "1", "base pitches from A, of the pair that entered last at first: midpoints of intervals", "position"
    )
    pair_offset: Integers = quantity(
        "1", "base pitches ahead of the pair that entered last", "pair", no_error=EXACT
    )
    rho1: Array = quantity(
        "m",
        "curvature radius on the pinion; nan where there is no contact between A and E",
        "position pair",
        shown="mm",
    )
    edge: Booleans = quantity(
        "1",
        "whether a candidate is outside the path, where a tip edge touches if it is loaded",
        "position pair",
        no_error=EXACT,
    )
    flank_rho: Array = quantity(
        "m",
        "curvature radius of pinion's and wheel's flank at the contact, tip edges included",
        "gear position pair",
        shown="mm",
        no_error=EXACT,
    )
    forces: Array = quantity("N", "normal force; zero where unloaded", "position pair")
    load_share: Array = quantity(
        "1",
        "share of the torque; rows sum to one, to more where flanks on the other side bear against them, nan without a "
        "torque",
        "position pair",
    )
    gaps: Array = quantity(
        "m",
        "unloaded gap along the line of action, from the position without any deviation, so it may be negative; "
        "inf where a pair cannot touch",
        "position pair",
        shown="um",
        no_error=EXACT,
    )
    transmission_error: Array = quantity(
        "m",
        "loaded static transmission error D, the pinion's turn times its base radius with the wheel held: all "
        "deflection up to `reference`, relief and deviations, and the backlash where back flanks bear; positive when "
        "the wheel lags",
        "position",
        shown="um",
        error="error",
    )
    stiffness: Array = quantity(
        "N/m", "tangent dF/dD: small vibration about the load", "position", error="error"
    )
    secant_stiffness: Array = quantity(
        "N/m",
        "F/(D - D_0), D_0 the transmission error without torque; the tangent where there is none",
        "position",
        error="error",
    )
    pair_stiffness: Array = quantity(
        "N/m", "slope dF_i/dD of each pair's force; zero where unloaded", "position pair"
    )
    plane: str = part('"strain" or "stress", as of the compliance')
    beyond_path: bool = part("whether tip edges were among the candidates")
    error: float = quantity("1", "estimated relative numerical error of stiffness and transmission error")
    cost: Cost
    converged: bool
    message: str
    pair: GearPair = part("the gears, with their deviations")
    candidates: ContactCandidates = part(
        "places, teeth, levers and unloaded gaps of all contacts that were looked for"
    )
    friction: float = quantity(
        "1", "coefficient of friction with which the forces were tilted", default=0.0, no_error=EXACT
    )
    moving_contact: bool = part("whether contacts on the path move under load", default=False)
    strips_at_corners: tuple[bool, bool] = part(
        "whether contacts beside the tip corners of pinion and wheel press on them by strips of plain flanks that stay",
        default=(False, False),
    )
    lever_loss: Array | float = part(
        "parts of the base radii by which the levers of each force are shorter where contacts move: by the tilt of "
        "loaded flanks, and by the pinion's corner that moves with D",
        default=0.0,
    )
    further_lever_loss: Array | float = part("the same of further forces", default=0.0)
    supports: tuple[Support, Support] = part(
        "how the bores are held, of what the compliance counts", default=(FIXED, FIXED)
    )
    flank: str = quantity(
        "",
        '"front": flanks of a driving pinion; "back": of a braking one, rho and levers of the mirror',
        default="front",
    )
    opposite: OppositeFlanks | None = part("flanks on the other side, where they bear as well", default=None)
    face: FaceLoads | None = part("line loads over the face; None where they are even", default=None)
    reference: str = quantity(
        "", 'what the deflection is measured against: "bore", "body" or "teeth"', default="bore"
    )
    bore_inertia: tuple[float, float] = quantity(
        "kg m2", 'inertia on the bores, for "body"', "gear", default=(0.0, 0.0), no_error=EXACT
    )
    loaded: LoadedContacts | None = part(
        "what `model_error` is found from; None where the contact has no solution", default=None
    )
    problem: ContactProblem | None = part(
        "what the arcs are found from when they are first asked for; None where the contact has no solution, and in "
        "copies that were pickled",
        default=None,
    )

    @property
    def face_position(self) -> Array | None:
        """Middles of the cells of the face (cells,) [m], 0 at mid-face; None where the face has none."""
        return None if self.face is None else self.face.face_position

    @property
    def line_load(self) -> Array | None:
        """Force per length of face (positions, pairs, cells) [N/m]; None where the face has no cells."""
        return None if self.face is None else self.face.line_load

    @property
    def face_load_factor(self) -> Array | None:
        """Greatest line load of the most loaded pair over that pair's mean (positions,); None without cells."""
        return None if self.face is None else self.face.face_load_factor

    def against(self, reference: str, bore_inertia: tuple[float, float] = (0.0, 0.0)) -> MeshCycle:
        """Measure the deflection against something else; no force changes (``fem.references``).

        Parameters
        ----------
        reference : {"bore", "body", "teeth"}
            The turn of what holds the bores, of the bodies weighted by their inertia, or of the root circles.
        bore_inertia : (float, float)
            What turns with the bores of pinion and wheel beside their own bodies, for "body" [kg m2].

        Returns
        -------
        MeshCycle
            With its transmission error, secant and tangent stiffness, and the error of these.

        Raises
        ------
        base.InputError
            No such reference, a negative inertia, or a compliance without coupling.
        """
        found = Faults()
        check_reference(found, self.reference, reference, bore_inertia)
        found.raise_if_any()
        less = turns(self.pair, self.supports, self.reference, self.bore_inertia)
        less = less - turns(self.pair, self.supports, reference, bore_inertia)
        moments, slopes = self._moments()
        shift = np.sign(self.force) * (less @ moments)
        slope = 1.0 - less @ slopes  # dD'/dD
        secant = self.secant_stiffness / slope
        if self.force:
            secant = self.force / (self.force / self.secant_stiffness - shift)
        known = self.__dict__.get("_found")
        measured = replace(
            self,
            reference=reference,
            bore_inertia=bore_inertia if reference == "body" else (0.0, 0.0),
            transmission_error=self.transmission_error - shift,
            stiffness=self.stiffness / slope,
            secant_stiffness=secant,
            pair_stiffness=self.pair_stiffness / slope[:, None],
            opposite=None if self.opposite is None else self.opposite.per_deflection(slope),
            # the turns are exact, so that the error of D is as large as before, of a smaller or larger D
            error=self.error * max(1.0, float(np.max(1.0 / slope))),
            problem=None if self.problem is None else self.problem.less(less),
        )
        if known is not None:
            # copies that were pickled have nothing else, and all others need not solve the contact anew
            measured.__dict__["_found"] = (
                known if isinstance(known, str) else measured_less(known, self.force, less)
            )
        return measured

    def _moments(self) -> tuple[Array, Array]:
        """Net normal force by its levers about both gears, and its slope by D (2, n)."""
        lever = np.where(self.forces > 0, self.candidates.lever, 0.0)
        sums = [
            np.sum((lever - np.where(self.forces > 0, lost, 0.0)) * one, axis=-1)
            for lost, one in (
                (self.lever_loss, self.forces),
                (self.further_lever_loss, self.pair_stiffness),
            )
        ]
        if self.opposite is not None:
            other = self.opposite
            lever = np.where(other.forces > 0, other.lever, 0.0)
            for total, one in zip(sums, (other.forces, other.pair_stiffness), strict=True):
                total -= np.sum(lever * one, axis=-1)
        return sums[0], sums[1]

    @property
    def arcs(self) -> MeshArcs | None:
        """Curves on smooth arcs between events, found when they are first asked for; None without a solution.

        Raises
        ------
        base.SolverError
            The contact has a solution at the cycle's positions, but not between them.
        """
        if isinstance(self._found, str):
            raise SolverError(self._found)
        return self._found

    @cached_property
    def _found(self) -> MeshArcs | str | None:
        """Arcs, or why there are none."""
        if self.problem is None:
            return None
        try:
            return self.problem.arcs()
        except SolverError as error:
            return str(error)

    def __getstate__(self) -> dict[str, Any]:
        """Take the arcs along instead of what they are found from."""
        return {**self.__dict__, "_found": self._found, "problem": None}

    @described("1", no_error=ITSELF, kept=True)
    def model_error(self) -> float:
        """Estimated relative error by the model of the contacts, apart from `error`.

        Of transmission error and secant stiffness: large strain, second order, and the motion of contacts that stay.
        Of the tangent about twice that. Found when it is first asked for.
        """
        return float("nan") if self.loaded is None else self.loaded.model_error()

    @described("m", "position", shown="um", no_error=EXACT)
    def unloaded_transmission_error(self) -> Array:
        """D at which the loaded flanks touch without load: the smallest gap, beyond the backlash for back flanks."""
        least = self.gaps.min(axis=1)
        return np.asarray(least if self.flank == "front" else -(self.pair.backlash + least))

    @described("1", "position", no_error=EXACT)
    def loaded_position(self) -> Array:
        """Positions at which the loaded flanks stand on the path of contact: of back flanks in the mirror."""
        if self.flank == "front":
            return self.position
        return np.asarray((Setting(self.pair).mirror - self.position) % 1.0)

    @described("N", "position")
    def opposite_force(self) -> Array:
        """Normal force of all flanks on the other side together; zero where they do not bear."""
        zero = np.zeros(len(self.position))
        return zero if self.opposite is None else np.asarray(self.opposite.forces.sum(axis=-1))

    @described("N", "position")
    def separating_force(self) -> Array:
        """Force of the flanks on both sides that pushes the gears apart, along the line of centres."""
        both = self.forces.sum(axis=-1) + self.opposite_force
        return np.asarray(both * np.sin(self.pair.working_pressure_angle))

    @described("N", "position")
    def bearing_force(self) -> Array:
        """Force on the bearings of either gear by the normal forces: separating and tangential part together.

        Tip edges are taken along the line of action.
        """
        across = self.forces.sum(axis=-1) - self.opposite_force
        return np.asarray(np.hypot(self.separating_force, across * np.cos(self.pair.working_pressure_angle)))

    @property
    def teeth(self) -> Integers:
        """Numbers of the teeth of pinion and wheel in each pair (2, n, pairs)."""
        return self.candidates.teeth

    @described("m", "position", shown="um", no_error=EXACT)
    def back_gap(self) -> Array:
        """Smallest gap of the flanks on the other side without load: below zero the teeth jam."""
        return self.candidates.back_gap

    def _loaded_radius(self) -> tuple[Array, Array, float]:
        """Line loads [N/m] and radii of relative curvature [m] of contacts of two flanks, else nan; E'."""
        touching = np.isfinite(self.rho1) & (self.forces > 0)
        rho1, rho2 = self.flank_rho
        load = np.where(touching, self.forces / self.pair.face_width, np.nan)
        return load, rho1 * rho2 / (rho1 + rho2), reduced_modulus(self.pair, self.plane)

    @described("Pa", "position pair", shown="MPa", no_error=HERTZ)
    def hertz_pressure(self) -> Array:
        """Greatest Hertz pressure; nan where two flanks do not touch.

        nan at tip edges too: there the pressure is no ellipse, and at a sharp corner it has no bound.
        """
        return peak_pressure(*self._loaded_radius())

    @described("m", "position pair", shown="um", no_error=HERTZ)
    def half_width(self) -> Array:
        """Half-width of the Hertz contact; nan where two flanks do not touch."""
        return half_width(*self._loaded_radius())

    def surface_speeds(self, speed: float = 1.0) -> Array:
        """Speeds of pinion's and wheel's surface along the tangent of each contact (2, n, pairs) [m/s].

        The gears turn evenly; tip edges included, along the tangent of the flank that they touch. Towards the tip of
        the pinion; back flanks move the other way.

        Parameters
        ----------
        speed : float
            Of the pinion [rad/s].
        """
        first, second = self.pair.base_radii
        speed = speed if self.flank == "front" else -speed
        return np.asarray(
            speed * self.candidates.tangent_arm * np.array([1.0, first / second])[:, None, None]
        )

    def sliding(self, speed: float = 1.0) -> Array:
        """Sliding speed u1 - u2 of each contact (n, pairs) [m/s], negative before C; pinion at [rad/s]."""
        first, second = self.surface_speeds(speed)
        return np.asarray(first - second)

    @described("1", "gear position pair", no_error=EXACT)
    def specific_sliding(self) -> Array:
        """Sliding over the surface's own speed, (u1 - u2)/u1 and (u2 - u1)/u2.

        Infinite where a flank is touched on its base circle.
        """
        speeds = self.surface_speeds()
        with np.errstate(divide="ignore"):
            return np.asarray((speeds - speeds[::-1]) / speeds)

    @described("N m", "position")
    def wheel_torque(self) -> Array:
        """Torque on the wheel of the normal forces, tilted by friction if there is any; of the loaded flanks alone.

        Where a tip edge presses it differs from the torque of the pinion times the ratio even without
        friction, by what the yielding teeth store; over a cycle that evens out.
        """
        slip = np.sign(self.sliding())
        arm = self.candidates.lever[1] * self.pair.base_radii[1]
        arm = arm + self.friction * slip * self.candidates.tangent_arm[1]
        total = np.sum(self.forces * arm, axis=1, where=np.isfinite(arm))
        return np.asarray(total if self.flank == "front" else -total)

    def friction_loss(self, speed: float) -> Array:
        """Power lost by sliding (n,) [W], sum of ``mu F_i |u1 - u2|``; speed of the pinion [rad/s]."""
        slip = np.abs(self.sliding(speed))
        return np.asarray(np.sum(self.friction * self.forces * slip, axis=1, where=np.isfinite(slip)))

    @described("1")
    def efficiency(self) -> float:
        """Power put in less the mean power lost by sliding, over the power put in; 1 without friction."""
        return float(1.0 - np.mean(self.friction_loss(1.0)) / abs(self.torque))


def check_row(found: Faults, cycle: MeshCycle, row: int) -> None:
    """Note a row that the cycle does not have, that has no finite forces, or with flanks that bear on both sides."""
    last = len(cycle.position) - 1
    known = np.isfinite(
        found.number("row", row, Limit(0, last, remedy="give a row of the cycle", whole=True))
    )
    if known and not np.all(np.isfinite(cycle.forces[row])):
        found.add("cycle", f"row {row} without forces", "must have converged", cycle.message)
    elif known and cycle.face is not None:
        remedy = "leave cells, alignment and leads out"
        found.add(
            "cycle", "with cells of the face", "must be even along the face for fields and stresses", remedy
        )
    elif known and cycle.opposite_force[row] > 0.0:
        allowed = "must have flanks that bear on one side of the teeth, where fields and stresses are wanted"
        found.add("cycle", f"row {row} with flanks that bear on both sides", allowed, "give more backlash")


def require_row(cycle: MeshCycle, row: int) -> None:
    """Raise unless the cycle has that row, with finite forces."""
    found = Faults()
    check_row(found, cycle, row)
    found.raise_if_any()
