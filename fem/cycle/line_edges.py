"""What the model of a helical contact leaves out: contact beyond the path, and on flanks what that of spur pairs does.

Under load a line of contact goes on past the ends of the path: a tip edge touches the other flank where the deflection
closes its gap, and a line touches before its first place on the path does, where tip and end face meet. A mesh cycle
ends its lines at the path. Here they go on as far as gaps close, with the laws of tip edges and of flanks beside them
that spur pairs have (``fem.laws.corner_laws``), each cell for its line load and its place in the section.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.contact.line_contact import WINDOW
from fem.contact.loaded_flanks import loaded_flanks
from fem.contact.moving_contact import ContactMoves, contact_moves, left_out
from fem.contact.solver import solve_one_side
from fem.laws.contact_candidates import LINES_REACH
from fem.laws.corner_laws import CornerLaws
from fem.pair.references import held_turns
from gears.tooth.errors import LoadSharingError

if TYPE_CHECKING:
    from fem.contact.contact_state import ContactState
    from fem.laws.contact_candidates import ContactCandidates
    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["BeyondPath", "LoadedLines"]

FARTHER = 1.25
"""Times the deflection whose closed gaps lines go on to: leads and alignments may close some of a gap as well."""

PARTS = 2
"""Cells that part of a line beyond the path has, where twice the usual number are enough for it."""


@record
class BeyondPath:
    """What contact beyond the path changes.

    Attributes
    ----------
    deflection : (positions,) array
        By which the deflection is too large, at all positions of all pitches [m].
    compliance : (positions,) array
        By which the tangent's inverse is too large [m/N].
    share : (positions,) array
        Part of the load beyond the path.
    line_load : float
        Relative change of the maximum line load.
    """

    deflection: Array
    compliance: Array
    share: Array
    line_load: float

    def of_deflection(self, force: Array | float, secant: Array) -> float:
        """Largest relative change of a deflection by a force [N] and secant stiffness (positions,) [N/m]."""
        return float(np.max(self.deflection * secant / force))

    def of_mean_secant(self, force: float, secant: Array) -> float:
        """Relative change of the mean of a secant stiffness (positions,) [N/m] under a force [N]."""
        return abs(float(np.mean(1.0 / (1.0 / secant - self.deflection / force)) / np.mean(secant)) - 1.0)

    def of_mean_tangent(self, tangent: Array) -> float:
        """Relative change of the mean of a tangent stiffness (positions,) [N/m]."""
        return abs(float(np.mean(1.0 / (1.0 / tangent - self.compliance)) / np.mean(tangent)) - 1.0)

    def of_range(self, deflection: Array) -> float:
        """Change of the peak-to-peak value of a deflection (positions,) by all of the change, or by half of it [m]."""
        changes = (np.ptp(deflection - part * self.deflection) - np.ptp(deflection) for part in (0.5, 1.0))
        return max(abs(float(change)) for change in changes)


@record
class LoadedLines:
    """What the model error of a helical pair's mesh cycle is found from when it is first asked for.

    Attributes
    ----------
    setup : MeshSetup
    bodies : PairCompliance
    candidates : ContactCandidates
        Whose lines end with the path.
    forces : (pitches, positions, lines, cells) array
        On cells [N].
    approach : (pitches, positions) array
        Deflection [m].
    load : float
        Torque over the pinion's base radius [N].
    """

    setup: MeshSetup
    bodies: PairCompliance
    candidates: ContactCandidates
    forces: Array
    approach: Array
    load: float

    @property
    def reference(self) -> str:
        """What `approach` is measured against; empty where that is not one turn for all pairs."""
        return held_turns(self.bodies)[0]

    def model_error(self) -> float:
        """Estimate what the model of contacts on flanks leaves out of the deflection, largest over the positions."""
        return float(np.max(self.of_flanks))

    @cached_property
    def of_flanks(self) -> Array:
        """What large strain, second order, the width of contacts and their motion change (positions,), relative.

        By sections of the lines (``fem.contact.moving_contact.left_out``): cells of the same number on all lines count
        as pairs of a section, which they are without a helix.
        """
        lines, count = self.candidates.lines, self.forces.shape[-1]
        assert lines is not None  # of a helical pair
        length = lines.divided(count).length[..., None] / self.setup.pair.helix.base_cosine
        on_faces = np.moveaxis(self.forces * (self.setup.pair.face_width / length), -1, 0)
        along_normals = self.approach * self.setup.pair.helix.base_cosine
        return left_out(self._moves(count), on_faces, along_normals, self.setup.moving_contact).ravel()

    def _moves(self, count: int) -> ContactMoves:
        lines = self.candidates.lines
        assert lines is not None
        cells, (positions, pairs) = lines.divided(count), self.candidates.place.shape
        rho = np.moveaxis(cells.rho, -1, 1).reshape(2, -1, pairs)
        used = np.moveaxis(cells.used, -1, 0).reshape(-1, pairs)
        edges = np.moveaxis(lines.edge_touches(lines.places(cells)), -1, 0).reshape(-1, pairs) & used
        sections = replace(self.candidates, rho=rho, touchable=used, edge=edges)
        moves, shape = contact_moves(self.bodies, sections), (count, 1, positions, pairs)
        return ContactMoves(
            moves.roll.reshape(*shape, pairs),
            *(values.reshape(2, *shape) for values in (moves.cubic, moves.local, moves.shift)),
            *(values.reshape(shape) for values in (moves.slide, moves.spread)),
        )

    @cached_property
    def beyond_path(self) -> BeyondPath:
        """What contact beyond the path changes, by solutions without and with it, both dry."""
        pair, count = self.setup.pair, self.forces.shape[-1]
        edges = self.setup.flanks.edges(LINES_REACH)
        try:
            ends = self._solved(self.setup, 0.0)
            farthest = edges.closed_by(FARTHER * float(ends.deflection(0).max()))
            # as many cells as part the line beyond the path, but no more than twice the usual number
            part = farthest / (PARTS * FARTHER * pair.face_width * abs(self.setup.line_slope))
            cells = 2 * count if 2 * count * part < 1.0 else max(count, ceil(1.0 / part))
            setup = replace(self.setup, face=replace(self.setup.face, cells=cells))
            if cells != count:
                ends = self._solved(setup, 0.0)
            goes_on = self._solved(replace(setup, beyond_path=True), farthest / pair.base_pitch)
        except LoadSharingError:  # nothing is known, not even a bound
            whole = self.approach.ravel()
            return BeyondPath(whole, whole / abs(self.load), np.ones_like(whole), 1.0)
        compliance = 1.0 / ends.share.stiffness - 1.0 / goes_on.share.stiffness
        held, further = (self._maximum_line_load(state) for state in (ends, goes_on))
        lines, forces = goes_on.candidates.lines, goes_on.cell_forces(0)
        assert lines is not None
        place, (start, end) = lines.places(lines.divided(forces.shape[-1])), edges.path
        outside = (place < start) | (place > end)
        return BeyondPath(
            np.maximum(ends.deflection(0) - goes_on.deflection(0), 0.0).ravel(),
            compliance[0].ravel(),
            ((forces * outside).sum(axis=(-2, -1)) / forces.sum(axis=(-2, -1))).ravel(),
            abs(further / held - 1.0),
        )

    def _solved(self, setup: MeshSetup, reach: float) -> ContactState:
        laws, force = CornerLaws(setup, self.bodies), np.array([abs(self.load)])
        return solve_one_side(
            setup, self.bodies, force, loaded_flanks(setup, self.bodies, None, reach, laws), laws
        )

    def _maximum_line_load(self, state: ContactState) -> float:
        """Largest mean over half a module of a line, per length of the axis [N/m]."""
        lines, forces = state.candidates.lines, state.cell_forces(0)
        assert lines is not None
        window = WINDOW * self.setup.pair.module * self.setup.pair.helix.base_cosine
        return float(lines.divided(forces.shape[-1]).largest_mean(forces, window).max())
