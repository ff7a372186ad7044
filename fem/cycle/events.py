"""The loaded contact as a function of position: arcs between the events of a mesh cycle, on both meshes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from base import Array, SolverError
from base.later import Later
from fem.contact.contact_state import ContactState
from fem.contact.face_errors import half_as_many
from fem.contact.shared_contacts import yielding_over_face
from fem.contact.solver import solve_contact
from fem.cycle.fit_errors import doubts
from fem.influence.helix_ends import BETWEEN, OFF_BY
from fem.laws.corner_laws import CornerLaws
from fem.laws.local_law import Film
from fem.laws.mesh_setup import MeshSetup
from fem.laws.relieved_flanks import starts_of_relief
from fem.pair.pair_compliance import PairCompliance
from gears.sharing.arcs import Arcs
from gears.sharing.events import Division, Sampled, Sampler, arcs_alike, arcs_between_events
from gears.sharing.mesh_arcs import CURVES, Compared, FewerCells, MeshArcs, Scatter, compared_later

__all__ = ["ContactProblem", "measured_less"]

NAMES = (*CURVES, "moment_pinion", "moment_wheel", "slope_pinion", "slope_wheel")
"""Curves on the arcs: those of every mesh cycle, N_g/F, and dN_g/dD of pinion and wheel (``fem.pair.references``)."""

LINES = 30.0
"""Times the tolerance of arcs that those of lines of contact have: their curves range over some hundredths of their
size, while a doubled one moves means by less than 1e-5."""

GRADING = 6.0
"""Growth of the arcs away from a tip corner."""


@dataclass(frozen=True, eq=False)
class ContactProblem:
    """A loaded contact that can be solved at any position.

    Attributes
    ----------
    setup : MeshSetup
    bodies : PairCompliance
    force : float
        Torque over the pinion's base radius [N], negative where back flanks bear.
    film : Film or None
    tolerance : float
        Relative, of the figures.
    corners : (n,) array, optional
        Positions within a base pitch at which the film's law has corners.
    film_yields : bool
        Whether the secant counts what the film yields (``fem.laws.local_law.film_yielding``).
    turn : (2,) array, optional
        Turn of pinion and wheel per force that is left out of the deflection (``fem.pair.references``) [m/N].
    corner_laws : CornerLaws, optional
        Laws of the tip edges that are known already.
    varied : tuple of (Film, float)
        Other films, and how much of what they change is error.
    scatter : mapping, optional
        What cells of the face leave at positions, as of ``gears.sharing.mesh_arcs.FewerCells``.
    ends_error : float
        Relative, of stiffness and deflection by free ends of the face.
    ends_scatter : mapping, optional
        What free ends of helical gears leave at positions, likewise.
    """

    setup: MeshSetup
    bodies: PairCompliance
    force: float
    film: Film | None = None
    tolerance: float = 1e-3
    corners: Array | None = None
    film_yields: bool = False
    turn: Array | None = None
    corner_laws: CornerLaws | None = None
    varied: tuple[tuple[Film, float], ...] = ()
    scatter: Mapping[str, Scatter] | None = None
    ends_error: float = 0.0
    ends_scatter: Mapping[str, Scatter] | None = None

    def less(self, turn: Array) -> ContactProblem:
        """Leave a further turn of pinion and wheel per force (2,) [m/N] out of the deflection."""
        return replace(self, turn=turn if self.turn is None else self.turn + turn)

    def arcs(self) -> MeshArcs:
        """Curves between events; what they are compared with is solved when an error is first asked for.

        Raises
        ------
        base.SolverError
            A contact somewhere on them has no solution.
        """
        fine = self.divided()
        others = compared_later(partial(self._compared, fine))
        return MeshArcs(fine, others, self.bodies.gain, self.ends_error)

    def _compared(self, fine: Division) -> Compared:
        """Other meshes, films and cells, on arcs like those that are known."""
        coarse = self._alike(self.bodies.coarser, fine)
        others = [(replace(self, film=film), share) for film, share in self.varied]
        varied = [(other._alike(self.bodies, fine), share) for other, share in others]
        for doubt in doubts(self.setup.moving_contact, self.setup.two_sided):
            varied.append((self._alike(self.bodies.doubtful(doubt), fine), 1.0))
        fewer = None
        if self.scatter:
            few, share = half_as_many(self.setup.face, self.setup.helical)
            problem = replace(self, setup=replace(self.setup, face=few))
            fewer = FewerCells(problem._alike(self.bodies, fine), share, self.scatter)
            if self.ends_scatter:
                off = problem._alike(self.bodies.doubtful(BETWEEN), fine)
                fewer = replace(fewer, ends=(off, 1.0 / OFF_BY), ends_scatter=self.ends_scatter)
        return Compared(coarse, tuple(varied), fewer)

    def divided(self) -> Division:
        """Arcs and events on the mesh in use alone."""
        return self._divided(self.bodies)

    def _sampler(self, bodies: PairCompliance) -> Sampler:
        known = self.corner_laws
        corner_laws = CornerLaws(self.setup, bodies) if known is None else known.serving(bodies)

        def sample(position: Array) -> Sampled:
            state = solve_contact(
                self.setup.at(position), bodies, np.array([abs(self.force)]), self.film, corner_laws
            )
            if why := state.refusal(0):
                raise SolverError(f"between the positions of the mesh cycle {why}")
            reserve = _reserve(state, abs(self.force), self.setup)
            return Sampled(self._curves(state), reserve, self._pairs(state))

        return sample

    def _alike(self, bodies: PairCompliance, known: Division) -> Arcs:
        """Arcs with another mesh, whose events are close to those that are known, but for a very near miss."""
        arcs = arcs_alike(self._sampler(bodies), NAMES, known, self.setup.pitches)
        return self._divided(bodies).arcs if arcs is None else arcs

    def _divided(self, bodies: PairCompliance) -> Division:
        """Arcs with a mesh."""
        sample, tolerance = self._sampler(bodies), self.setup.options.sampling * self.tolerance
        if self.setup.helical:
            tolerance *= LINES
        return arcs_between_events(sample, NAMES, self._corners(bodies), self.setup.pitches, tolerance)

    def _corners(self, bodies: PairCompliance) -> Array:
        """Corners of the geometry, and places near the tips that part what the compliance does there.

        Nearer to a tip corner than its fit goes, a flank's compliance stays the same; up to there it grows as a
        logarithm, which arcs resolve that grow with the distance.
        """
        if self.setup.helical:
            return self.setup.seen(self.setup.corners)
        pair, (start, end) = self.setup.pair, self.setup.ends
        clear = np.array(
            [end - bodies.pinion.rho_range[1], pair.line_of_action - bodies.wheel.rho_range[1] - start]
        )
        places = []
        for sign, first, at in ((-1.0, clear[0], end), (1.0, clear[1], start)):
            if first > 0.0:
                steps = first * GRADING ** np.arange(3)
                places += (at + sign * steps[steps < 0.25 * pair.base_pitch]).tolist()
        flanks = self.setup.flanks
        if flanks.removed is not None:
            places += [*flanks.touching_ends, *(starts_of_relief(flanks) if flanks.gentle else [])]
        if self.setup.moving_contact:  # beyond these ends the flanks' motion stays the same
            pinion, wheel = bodies.motions
            places += [*pinion.rho_range, *(pair.line_of_action - rho for rho in wheel.rho_range)]
        more = (np.array(places) - pair.points.A) / pair.base_pitch % 1.0
        film = np.zeros(0) if self.corners is None else self.corners
        return self.setup.seen(np.concatenate([self.setup.corners, more, film]))

    def _pairs(self, state: ContactState) -> Array | None:
        """Share, normal force, places and line loads of every pair (positions, pairs, kinds), as of ``arcs.Arc``.

        None without a torque to share.
        """
        if not self.force:
            return None
        rho = state.flank_rho(0)[:, 0]
        whole = np.stack([state.torques(0)[0] / abs(self.force), state.share.forces[0, 0], *rho], axis=-1)
        cells = state.cell_forces(0)[0]
        return np.concatenate([whole, cells * cells.shape[-1] / self.setup.pair.face_width], axis=-1)

    def _curves(self, state: ContactState) -> Array:
        """Transmission error, tangent and secant stiffness, moments and their slopes (7, positions)."""
        share = state.share
        size, deflection = abs(self.force), state.deflection(0)[0]
        moved, tangent = state.turn(0)[0], share.stiffness[0, 0]
        secant = size / deflection if size else tangent
        if self.film is not None and self.film_yields:
            torques = share.forces[0, 0] * state.flanks.tilted_lever_ratios + state.by_cells(0)[0]
            shares = torques / (size or torques.sum(axis=-1, keepdims=True))
            added = self._yielding(self.film, state, shares)
            secant = size / (size / secant + added) if size else secant
        if self.setup.back:
            moved = -(self.setup.backlash + moved)
        moments, slopes = state.moments(0)
        moments = moments / size if size else np.zeros_like(moments)
        curves = np.stack([moved, tangent, secant, *moments, *slopes])
        return curves if self.turn is None else _less(curves, self.force, self.turn, self.setup.pair.tight)

    def _yielding(self, film: Film, state: ContactState, shares: Array) -> Array:
        """What films yield beyond the transmission error (positions,) [m], by shares of the pairs."""
        candidates, forces, pair = state.candidates, state.cell_forces(0)[0], self.setup.pair
        if candidates.lines is None:
            on_path = candidates.touchable & ~candidates.edge
            rho1 = np.where(on_path, np.clip(candidates.place, *self.setup.ends), np.nan)
            return yielding_over_face(film, rho1, forces, shares)
        lines, cosine = candidates.lines, pair.helix.base_cosine
        cells = lines.divided(forces.shape[-1])
        faces, wet = cells.faces(pair.face_width, cosine), lines.on_path(cells)
        return yielding_over_face(film, lines.film_places(cells), forces, shares, faces, wet) / cosine


def measured_less(mesh_arcs: MeshArcs, force: float, turn: Array, pressed: bool = False) -> MeshArcs:
    """Arcs with a turn of pinion and wheel per force (2,) [m/N] left out of the deflection (``fem.pair.references``).

    Parameters
    ----------
    mesh_arcs : MeshArcs
        By finite elements.
    force : float
        [N]
    turn : (2,) array
    pressed : bool
        Whether the teeth are pressed together without a torque already.
    """

    def less(arcs: Arcs) -> Arcs:
        shifted = tuple(replace(arc, values=_less(arc.values, force, turn, pressed)) for arc in arcs.arcs)
        return replace(arcs, arcs=shifted)

    def others() -> Compared | str:
        compared = mesh_arcs.others.value
        if isinstance(compared, str):
            return compared
        before, few = compared.before, compared.fewer
        if few is not None:
            ends = None if few.ends is None else (less(few.ends[0]), few.ends[1])
            few = replace(few, arcs=less(few.arcs), ends=ends)
        varied = tuple((less(arcs), share) for arcs, share in compared.varied)
        return Compared(None if before is None else less(before), varied, few)

    division = replace(mesh_arcs.division, arcs=less(mesh_arcs.division.arcs))
    return replace(mesh_arcs, division=division, others=Later(others))


def _less(curves: Array, force: float, turn: Array, pressed: bool) -> Array:
    """Curves (7, n) with a turn per force left out of the deflection."""
    moved, tangent, secant = curves[:3]
    moments, slopes = curves[3:5], curves[5:]
    shift, slope = force * (turn @ moments), 1.0 - turn @ slopes
    # of pressed flanks the secant starts where they rest, with moments about the wheel that are not zero
    since = force * (turn @ (slopes / slopes[0])) if pressed else shift
    secant = force / (force / secant - since) if force else secant / slope
    return np.stack([moved - shift, tangent / slope, secant, *moments, *(slopes / slope)])


def _reserve(state: ContactState, force: float, setup: MeshSetup) -> Array:
    """Reserves of contacts by force or gap, and of the nearest pair by its lead over the next one.

    Which pair is nearest without load changes between pairs on the path only where flanks deviate.
    """
    size = float(np.mean(state.share.transmission_error))
    loads, gaps = state.share.forces[0, 0], state.contacts.open[0, 0]
    if setup.two_sided and state.opposite is not None:
        # both sides may be pressed together without a torque, or with next to none
        loads = np.concatenate([loads, state.opposite.share.forces[0, 0]], axis=-1)
        gaps = np.concatenate([gaps, state.opposite.contacts.open[0, 0]], axis=-1)
        force, size = (
            float(loads.sum(axis=-1).mean()),
            float(loads.sum(axis=-1).mean() / np.mean(state.share.stiffness)),
        )
    bears = np.where(loads > 0.0, loads / force, -np.maximum(gaps, 0.0) / size - 1e-300)
    if setup.helical and setup.beyond_path:
        # lines are looked for no farther than gaps may close: beyond that they stay as far away, not without bound
        bears = np.maximum(bears, -1.0)
    if setup.even:
        return np.asarray(bears)
    # flanks that both fit touch together: what is less than rounding is no difference
    return np.concatenate([bears, _nearest(state.candidates.gap[0]) / size + 1e-10], axis=1)


def _nearest(gap: Array) -> Array:
    """By how much every pair is nearer than the nearest of the others (n, pairs) [m]; nan where it cannot touch."""
    order = np.sort(gap, axis=1)
    others = np.where(gap == order[:, :1], order[:, 1:2], order[:, :1]) if gap.shape[1] > 1 else gap
    with np.errstate(invalid="ignore"):
        return np.where(np.isfinite(gap) & np.isfinite(others), others - gap, np.nan)
