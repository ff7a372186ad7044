"""Result of the loaded tooth contact: forces, stiffness, transmission error, pressures."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from base import (
    Array,
    Booleans,
    Cost,
    Faults,
    Integers,
    SolverError,
    described,
    part,
    quantity,
    record,
)
from base.results import EXACT, ITSELF
from fem.contact.opposite_flanks import OppositeFlanks
from fem.cycle.events import ContactProblem, measured_less
from fem.cycle.face_loads import FaceLoads
from fem.cycle.line_edges import BeyondPath, LoadedLines
from fem.cycle.line_loads import LineLoads
from fem.cycle.model_error import LoadedContacts
from fem.cycle.pair_figures import PairFigures
from fem.elasticity.support import FIXED, Support
from fem.laws.contact_candidates import ContactCandidates
from fem.laws.mesh_setup import MeshSetup
from fem.pair.references import check_reference, turns
from gears import GearPair
from gears.sharing.mesh_arcs import MeshArcs
from gears.sharing.mesh_figures import MeshFigures

__all__ = ["MeshCycle"]


@record
class MeshCycle(PairFigures, MeshFigures):
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
        "deflection up to `reference`, relief and deviations, what shafts under the face give way, and the backlash "
        "where back flanks bear; positive when the wheel lags",
        "position",
        shown="um",
        error="error",
    )
    stiffness: Array = quantity(
        "N/m",
        "tangent dF/dD: small vibration about the load; shafts under the face held",
        "position",
        error="error",
        called="tangent_stiffness",
    )
    secant_stiffness: Array = quantity(
        "N/m",
        "F/(D - D_0), D_0 the transmission error without torque, on shafts that are held where it has brought them; "
        "the tangent where there is none",
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
    lines: LineLoads | None = part(
        "line loads over the lines of contact of a helical pair; None of spur pairs", default=None
    )
    reference: str = quantity(
        "", 'what the deflection is measured against: "body", "bore" or "teeth"', default="bore"
    )
    bore_inertia: tuple[float, float] = quantity(
        "kg m2", 'inertia on the bores, for "body"', "gear", default=(0.0, 0.0), no_error=EXACT
    )
    loaded: LoadedContacts | LoadedLines | None = part(
        "what `model_error` is found from; None where the contact has no solution", default=None
    )
    problem: ContactProblem | None = part(
        "what the arcs are found from when they are first asked for; None where the contact has no solution, and in "
        "copies that were pickled",
        default=None,
    )
    origin: tuple[MeshCycle, Array] | None = part(
        "the cycle that this one was measured from, and the turn by which their arcs differ (2,) [m/N]; None where the "
        "arcs are its own",
        default=None,
    )
    known_arcs: MeshArcs | str | None = part(
        "the arcs, or why there are none, in copies that were pickled", default=None
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
        """Maximum line load of the most loaded pair over that pair's mean (positions,); None without cells."""
        return None if self.face is None else self.face.face_load_factor

    def against(self, reference: str, bore_inertia: tuple[float, float] = (0.0, 0.0)) -> MeshCycle:
        """Measure the deflection against something else; no force changes (``fem.pair.references``).

        Parameters
        ----------
        reference : {"body", "bore", "teeth"}
            The rotation of the bodies weighted by their inertia, of what holds the bores, or of the root circles.
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
        faults = Faults()
        check_reference(faults, self.reference, reference, bore_inertia)
        faults.raise_if_any()
        less = turns(self.pair, self.supports, self.reference, self.bore_inertia)
        less = less - turns(self.pair, self.supports, reference, bore_inertia)
        moments, slopes = self._moments()
        shift = (less @ moments) * (1.0 if self.flank == "front" else -1.0)
        slope = 1.0 - less @ slopes  # dD'/dD
        secant = self.secant_stiffness / slope
        if self.force:
            # of pressed flanks it starts where they rest, with moments about the wheel that are not zero
            since = self.force * (less @ (slopes / slopes[0])) if self.pair.tight else shift
            secant = self.force / (self.force / self.secant_stiffness - since)
        return replace(
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
            face=None if self.face is None else self.face.less(slope),
            lines=None if self.lines is None else self.lines.less(slope),
            origin=(self, less),
        )

    @property
    def arcs(self) -> MeshArcs | None:
        """Curves on smooth arcs between events, found when they are first asked for; None without a solution.

        A cycle that was measured from another one has that one's, less the turn: the contact is solved once.

        Raises
        ------
        base.SolverError
            The contact has a solution at the cycle's positions, but not between them.
        """
        if isinstance(self._arcs, str):
            raise SolverError(self._arcs)
        return self._arcs

    @cached_property
    def _arcs(self) -> MeshArcs | str | None:
        """Arcs, or why there are none."""
        if self.origin is not None:
            cycle, turn = self.origin
            arcs = cycle._arcs
            return (
                measured_less(arcs, self.force, turn, self.pair.tight) if isinstance(arcs, MeshArcs) else arcs
            )
        if self.problem is None:
            return self.known_arcs
        try:
            return self.problem.arcs()
        except SolverError as error:
            return str(error)

    def without_arcs(self) -> MeshCycle:
        """The positions alone, for what asks for no errors: a copy to send, for which nothing more is solved."""
        return replace(self, problem=None, origin=None, known_arcs=None)

    def __getstate__(self) -> dict[str, Any]:
        """Take the arcs along instead of what they are found from."""
        state = {field.name: getattr(self, field.name) for field in fields(self)}
        return {**state, "known_arcs": self._arcs, "problem": None, "origin": None}

    @described("1", no_error=ITSELF, kept=True)
    def model_error(self) -> float:
        """Estimated relative error by the model of the contacts, apart from `error`.

        Of transmission error and secant stiffness, against `reference`: large strain, second order, the width of
        contacts in Hertz's law, and the motion of contacts that stay; of a helical pair, whose lines end with the path,
        also all that contact of tip edges and corners beyond it changes.
        Of the tangent about twice that. Found when it is first asked for.
        """
        if self.loaded is None:
            return float("nan")
        beyond = self.beyond_path_change
        if beyond is None:
            return self.flank_error
        return self.flank_error + beyond.of_deflection(abs(self.force), self.secant_stiffness)

    @property
    def flank_error(self) -> float:
        """The part of `model_error` by contacts on flanks, and on tip edges where these are in the model."""
        if self.loaded is None:
            return float("nan")
        error, held = self.loaded.model_error(), self.loaded.reference
        if held in ("", self.reference):
            return error
        # of a smaller D the same error is a larger part
        return error * float(np.max(self.secant_stiffness / self.against(held).secant_stiffness))

    @property
    def beyond_path_change(self) -> BeyondPath | None:
        """What contact beyond the path changes of a helical pair held to it; None with it, and of spur pairs."""
        if not isinstance(self.loaded, LoadedLines) or self.beyond_path:
            return None
        return self.loaded.beyond_path

    @described("m", "position", shown="um", no_error=EXACT)
    def unloaded_transmission_error(self) -> Array:
        """D at which the loaded flanks touch without load: the smallest gap, beyond the backlash for back flanks."""
        least = self.gaps.min(axis=1)
        play = MeshSetup(self.pair).backlash
        return np.asarray(least if self.flank == "front" else -(play + least))

    @described("1", "position", no_error=EXACT)
    def loaded_position(self) -> Array:
        """Positions at which the loaded flanks stand on the path of contact: of back flanks in the mirror."""
        if self.flank == "front":
            return self.position
        return np.asarray((MeshSetup(self.pair).mirror - self.position) % 1.0)

    @property
    def teeth(self) -> Integers:
        """Numbers of the teeth of pinion and wheel in each pair (2, n, pairs)."""
        return self.candidates.teeth

    @described("m", "position", shown="um", no_error=EXACT)
    def back_gap(self) -> Array:
        """Smallest gap of the flanks on the other side without load: below zero the teeth jam."""
        return self.candidates.back_gap
