"""What may touch where before any load: positions, teeth, points, levers and unloaded gaps."""

from __future__ import annotations

from dataclasses import replace
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, Faults, Integers, record
from fem.laws.line_candidates import ContactLines, LineCells, contact_lines, line_offsets
from fem.laws.mesh_setup import MeshSetup
from fem.laws.relieved_flanks import touch
from fem.laws.tip_edges import edges_at
from fem.pair.face_setting import EVEN, FREE_ENDS, face_setting

if TYPE_CHECKING:
    from fem.laws.flank_forms import Deviations
    from gears import Alignment, GearPair

__all__ = [
    "SEEN_ALONG",
    "ContactCandidates",
    "contact_candidates",
    "line_gaps",
    "unloaded_transmission_error",
]

LINES_REACH = 0.4
"""Base pitches beyond which lines of contact do not go on: farther ones need waves to more teeth than are solved."""

REACHES = (0.6, 1.0)
"""Base pitches outside the path within which tip edges are looked for; the second if the first is not enough."""

SEEN_ALONG = 128
"""Places over the face at which the smallest gap of lines of contact is looked for."""


@record
class ContactCandidates:
    """Pairs that might touch. n positions of all pitches; a base pitch has its own n_1 of them.

    Attributes
    ----------
    position : (n,) array
        Base pitches from A, of the pair that entered last at first.
    offset : (pairs,) array of int
        Base pitches that each column is ahead of the pair that entered last.
    place : (n_1, pairs) array
        rho1 of the unlimited involutes on the line of action [m].
    rho : (2, n_1, pairs) array
        Curvature radii where pinion and wheel are touched [m].
    touchable, edge : (n_1, pairs) boolean arrays
        Candidates, and those of a tip edge: outside the path, or where relief lets a corner be nearest.
    curvature : (n_1, pairs) array
        Of relieved flanks over that of the involutes, R/R'.
    lacking : (n_1, pairs) array
        Part of the gap from the material that the gears' flanks lack, but for that of single teeth [m].
    lever : (2, n, pairs) array
        Lever of the normal about the axes, over the base radii.
    tangent_arm : (2, n, pairs) array
        Distance from the foot of each axis on the normal to the contact [m], rho on the path.
    leaning : (2, n_1, pairs) array
        Angle from the normal of pinion's and wheel's involute to the force [rad], away from the tip; not zero at the
        gear's own tip edge and where it is relieved.
    gap : (pitches, n_1, pairs) array
        Unloaded gaps [m], inf where not touchable.
    teeth : (2, n, pairs) array of int
        Numbers of the teeth.
    back_gap : (n,) array
        Smallest gap of the back flanks when the gears touch without load [m].
    chamfered : (n_1, pairs) boolean array
        Candidates whose chamfer is nearer than the corner before it.
    reach_gap : float
        Gap of the nearest contact that is not among the candidates [m].
    lines : ContactLines or None
        Where lines of contact cross the face, of which ``place`` is the middle; None of spur pairs, where they lie
        along it.
    """

    position: Array
    offset: Integers
    place: Array
    rho: Array
    touchable: Booleans
    edge: Booleans
    curvature: Array
    lacking: Array
    lever: Array
    tangent_arm: Array
    leaning: Array
    gap: Array
    teeth: Integers
    back_gap: Array
    chamfered: Booleans
    reach_gap: float
    lines: ContactLines | None = None

    def at(self, rows: slice) -> ContactCandidates:
        """Contacts at some positions of a base pitch, with what bodies and laws need; gaps stay those of all."""
        return replace(
            self,
            place=self.place[rows],
            rho=self.rho[:, rows],
            touchable=self.touchable[rows],
            edge=self.edge[rows],
            leaning=self.leaning[:, rows],
            teeth=self.teeth[:, rows],
            lines=None if self.lines is None else self.lines.at(rows),
        )

    def on_cells(self, cells: LineCells, curvature: float) -> ContactCandidates:
        """Cells of all lines of a helical pair as pairs of a section, one after the other (n_1, pairs cells).

        Parameters
        ----------
        cells : LineCells
        curvature : float
            Of the flanks across the line, over that of the section: cos(beta_b).
        """
        lines = self.lines
        assert lines is not None
        shape, place = (len(self.place), -1), lines.places(cells)
        edge = cells.used & lines.edge_touches(place)
        return replace(
            self,
            place=place.reshape(shape),
            rho=cells.rho.reshape(2, *shape),
            touchable=cells.used.reshape(shape),
            edge=edge.reshape(shape),
            curvature=(curvature * lines.curvatures(place)).reshape(shape),
            lines=None,
        )

    def corners(self) -> tuple[tuple[int, Booleans], ...]:
        """Which gear's tip edge touches where: the wheel's (1) before A, the pinion's (0) after E."""
        before = self.edge & (self.place < 0.5 * (self.place.min() + self.place.max()))
        return (1, before), (0, self.edge & ~before)


def contact_candidates(setup: MeshSetup, reach: float = REACHES[0]) -> ContactCandidates:
    """Candidates for contact at midpoints of equal intervals of each base pitch, and their unloaded gaps."""
    pair, positions = setup.pair, setup.positions
    start, end = setup.ends
    pitch, line = pair.base_pitch, pair.line_of_action
    last = ceil(pair.contact_ratio)
    offset = np.arange(-1, last + 1) if setup.beyond_path else np.arange(last)
    if setup.helical:
        return _lines(setup, reach)
    stations = setup.stations
    position, within, turned = _standing(setup)
    place = pair.points.A + (within[:, None] + offset) * pitch
    outside = (place < start) | (place > end)
    edge = outside & (np.maximum(start - place, place - end) < reach * pitch) & setup.beyond_path
    touchable = ~outside | edge
    middle = 0.5 * (pair.points.A + pair.points.E)
    # places of pairs that cannot touch are never used, but must be places
    place = np.where(touchable, place, middle)
    rho = np.stack([place, line - place])
    lever, arm, leaning = np.ones_like(rho), rho.copy(), np.zeros_like(rho)
    gap, curvature = np.where(touchable, 0.0, np.inf), np.ones_like(place)
    chamfered = np.zeros_like(edge)
    if setup.removed is not None and setup.flanks.gentle:
        near = touch(setup.flanks, place[touchable], setup.removed)
        beyond = np.zeros_like(touchable)
        beyond[touchable] = near.beyond
        edge = (beyond if setup.beyond_path else beyond & outside) & touchable
        gap[touchable], curvature[touchable] = near.gap, near.curvature
        rho[:, touchable], lever[:, touchable], arm[:, touchable] = near.rho, near.lever, near.arm
        leaning[:, touchable] = near.leaning
    elif setup.removed is not None:
        on_path = touchable & ~edge
        gap[on_path] = setup.removed[0](rho[0][on_path]) + setup.removed[1](rho[1][on_path])
    other_place = pair.points.A + setup.mirror * pitch - (place - pair.points.A)
    for corner, chosen in ((1, edge & (place < middle)), (0, edge & (place > middle))):
        if chosen.any():
            at = edges_at(setup.flanks, corner, place[chosen])
            rho[1 - corner][chosen], rho[corner][chosen] = at.touched_rho, setup.rounds[corner].rho
            lever[corner][chosen], lever[1 - corner][chosen] = at.lever, 1.0
            arm[corner][chosen], arm[1 - corner][chosen] = at.arm, at.touched_rho
            leaning[corner][chosen], leaning[1 - corner][chosen], gap[chosen] = at.leaning, 0.0, at.gap
            chamfered[chosen], curvature[chosen] = at.chamfered, 1.0
    missed = touchable & ~np.isfinite(gap)  # the tip passes over the other tip
    touchable, edge = touchable & ~missed, edge & ~missed
    # (pitches, positions, pairs): every position in every pitch, or each in its own
    number = np.arange(setup.pitches)[:, None, None] if stations is None else stations.pitch[:, None]
    ahead = offset - turned[:, None] if setup.back else -offset
    steps = np.broadcast_to(number + ahead, (setup.pitches, positions, len(offset)))
    teeth, other = setup.teeth(steps), setup.opposite
    by_tooth = setup.pitch_gap(teeth) + setup.tooth_gap(teeth, rho) / np.where(touchable, lever[0], 1.0)
    rolling = setup.rolling_gap(place)
    held = np.clip(other_place, start, end)
    along = setup.face.least_gap(pair, rho)
    along_behind = other.face.least_gap(pair, np.stack([held, line - held]))
    gaps = gap + rolling + by_tooth + along
    least = float(np.min(by_tooth) + np.min(rolling))
    behind = other.pitch_gap(other.teeth(steps)) + setup.rolling_gap(held)
    back = np.where(touchable, behind + along_behind, np.inf).min(axis=-1)
    numbers = np.array([pair.pinion.teeth, pair.wheel.teeth])[:, None, None]
    tiles = (1, setup.pitches, 1)
    return ContactCandidates(
        position=(number[..., 0] + position).ravel(),
        offset=offset,
        place=place,
        rho=rho,
        touchable=touchable,
        edge=edge,
        curvature=curvature,
        lacking=gap,
        lever=np.tile(lever, tiles),
        tangent_arm=np.tile(np.where(touchable, arm, np.nan), tiles),
        leaning=leaning,
        gap=gaps,
        teeth=teeth.reshape(2, -1, len(offset)) % numbers,
        back_gap=(pair.backlash + gaps.min(axis=-1) + back).ravel(),
        chamfered=chamfered,
        reach_gap=_reach_gap(setup, reach) + least if setup.beyond_path else np.inf,
    )


def _standing(setup: MeshSetup) -> tuple[Array, Array, Integers]:
    """Positions within a base pitch, those of the loaded flanks in it, and by how many these are turned on (n,)."""
    stations = setup.stations
    position = (np.arange(setup.positions) + 0.5) / setup.positions if stations is None else stations.within
    within, turned = position, np.zeros(len(position), dtype=np.int64)
    if setup.back:
        within = setup.mirror - position
        turned = np.floor(within).astype(np.int64)
        within = within - turned
    return position, within, turned


def _lines(setup: MeshSetup, reach: float) -> ContactCandidates:
    """Candidates of a helical pair: lines of contact, each with its smallest gap."""
    pair, edges = setup.pair, None
    if setup.beyond_path:
        edges = setup.flanks.edges(min(reach, LINES_REACH))
    offset = line_offsets(pair, 0.0 if edges is None else edges.beyond_path)
    position, within, turned = _standing(setup)
    middle = pair.points.A + (within[:, None] + offset) * pair.base_pitch
    lines = contact_lines(pair, setup.line_slope, setup.ends, middle, edges, setup.relieved)
    touchable = lines.touches
    place = np.where(touchable, lines.place, 0.5 * (pair.points.A + pair.points.E))
    rho = lines.rho(place)
    number = np.arange(setup.pitches)[:, None, None]
    if setup.stations is not None:
        number = setup.stations.pitch[:, None]
    ahead = offset - turned[:, None] if setup.back else -offset
    steps = np.broadcast_to(number + ahead, (setup.pitches, *place.shape))
    teeth, other = setup.teeth(steps), setup.opposite
    cells = lines.divided(SEEN_ALONG)
    seen = line_gaps(setup, cells.z, cells.rho, teeth) + setup.rolling_gap(middle)[..., None]
    seen = seen + lines.further_gaps(lines.places(cells))
    gap = np.where(cells.used, seen, np.inf).min(axis=-1)
    numbers = np.array([pair.pinion.teeth, pair.wheel.teeth])[:, None, None]
    tiles = 1, setup.pitches, 1
    # the other flanks of these teeth stand at the mirrored place, where it touches at all
    beyond = 0.5 * pair.face_width * abs(setup.line_slope)
    mirrored = 2.0 * pair.points.A + setup.mirror * pair.base_pitch - middle
    held = np.clip(mirrored, setup.ends[0] - beyond, setup.ends[1] + beyond)
    apart = other.pitch_gap(other.teeth(steps)) + setup.rolling_gap(held)
    behind = np.where(touchable, apart, np.inf).min(axis=-1)
    return ContactCandidates(
        position=(number[..., 0] + position).ravel(),
        offset=offset,
        place=place,
        rho=rho,
        touchable=touchable,
        edge=touchable & lines.edge_touches(place),
        curvature=np.ones_like(place),
        lacking=np.where(touchable, 0.0, np.inf),
        lever=np.tile(np.full_like(rho, pair.helix.base_cosine), tiles),
        tangent_arm=np.tile(np.where(touchable, lines.arms(place, pair.base_radii), np.nan), tiles),
        leaning=np.zeros_like(rho),
        gap=gap,
        teeth=teeth.reshape(2, -1, len(offset)) % numbers,
        back_gap=(setup.backlash + gap.min(axis=-1) + behind + other.face.least_gap(pair)).ravel(),
        chamfered=np.zeros_like(touchable),
        reach_gap=np.inf if edges is None else float(edges.gap[:, -1].min()),
        lines=lines,
    )


def line_gaps(setup: MeshSetup, z: Array, rho: Array, teeth: Integers | None = None) -> Array:
    """Gaps along the transverse line of action without load (..., cells) [m], but for unequal base pitches.

    Parameters
    ----------
    setup : MeshSetup
        Of a helical pair.
    z : (..., cells) array
        Places along the face [m].
    rho : (2, ..., cells) array
        Curvature radii on pinion and wheel there [m].
    teeth : (2, pitches, ...) array of int, optional
        Numbers of the teeth of each line, whose own deviations count then (pitches, ..., cells).
    """
    gaps = setup.face.gaps_at(setup.pair, z, rho)
    if setup.removed is not None:
        gaps = gaps + setup.removed[0](rho[0]) + setup.removed[1](rho[1])
    if teeth is not None:
        gaps = gaps + setup.pitch_gap(teeth)[..., None] + setup.tooth_gap(teeth[..., None], rho)
    return np.asarray(gaps)


def _reach_gap(setup: MeshSetup, reach: float) -> float:
    """Smaller gap of the two contacts at the ends of the reach; farther out gaps are larger."""
    start, end = setup.ends
    apart = reach * setup.pair.base_pitch
    outside = ((1, start - apart), (0, end + apart))
    before, after = (edges_at(setup.flanks, corner, np.array([place])) for corner, place in outside)
    return float(min(before.gap[0], after.gap[0]))


def unloaded_transmission_error(
    pair: GearPair,
    positions: int = 40,
    beyond_path: bool | None = None,
    deviations: Deviations | None = None,
    pitches: int = 1,
    first_teeth: tuple[int, int] = (0, 0),
    tip_rounding: float | tuple[float, float] = 0.0,
    alignment: Alignment | None = None,
) -> Array:
    """Transmission error of rigid gears under no load, from the geometry alone (pitches*positions,) [m].

    The smallest gap of all pairs, D_0: zero for perfect involutes while one of them is between A and E; with
    relief or deviations the pair that touches first, which may do so with a tip edge outside A..E. Positive
    when the wheel lags. Parameters as for ``mesh_cycle``. Of spur pairs leads and alignment shift it by a constant,
    which is left out; with a helix they decide where on the lines of contact teeth touch first.

    Raises
    ------
    base.InputError
        Input that makes no sense.

    Examples
    --------
    >>> from fem import unloaded_transmission_error
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> unloaded_transmission_error(pair, positions=3)
    array([0., 0., 0.])
    """
    tip_edges = pair.helix_angle == 0.0 if beyond_path is None else beyond_path
    face = EVEN
    if pair.helix_angle != 0.0:
        face = face_setting(pair, alignment, None, FREE_ENDS) or EVEN
    setup = MeshSetup(pair, positions, tip_edges, deviations, pitches, first_teeth, tip_rounding, face=face)
    faults = Faults()
    setup.check(faults)
    faults.raise_if_any()
    return np.asarray(contact_candidates(setup, REACHES[-1]).gap.min(axis=-1).ravel())
