"""Flanks on the other side of the teeth: whether they bear beside the loaded ones, and what both carry then.

The gap of a flank on the other side is the backlash, its own gap and the transmission error D, less what loads on both
sides bend it by:

    g_k = j + gap_k + D + sum_i X_ki F_i + sum_l B_kl G_l + local(G_k) >= 0,   sum l_i F_i - sum l_k G_k = T/r_b1,

with B of the mirrored gears and X of loads on one side seen from the other (``fem.influence.back_compliance``).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, Integers, part, quantity, record
from fem.contact.loaded_flanks import FlanksInPlace, LoadedFlanks, hub_lever, loaded_flanks
from fem.laws.contact_candidates import ContactCandidates
from fem.laws.edge_tables import EdgeTables
from fem.laws.local_law import Film
from fem.laws.mesh_setup import MeshSetup
from gears import LoadShare
from gears.tooth.errors import LoadSharingError

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance
    from gears.sharing.staying_contacts import DeflectionLaw

__all__ = ["BothSides", "OppositeFlanks", "OppositeShare", "between", "both_sides", "share_with_opposite"]

ROUNDING = 1e-12
"""Overlap over the deflection that is none."""

NOTHING = 1e-14
"""Overlap that is rounding [m]."""


@record
class OppositeFlanks:
    """Contacts on the other side of the teeth at the positions of a cycle; rho and levers of the mirrored gears."""

    no_error = "not estimated in single positions; the cycle has errors of its means and extremes"

    forces: Array = quantity("N", "normal force; zero where unloaded", "position pair")
    pair_stiffness: Array = quantity("N/m", "slope of the force by D, not above zero", "position pair")
    flank_rho: Array = quantity("m", "curvature radii on pinion and wheel", "gear position pair", shown="mm")
    edge: Booleans = quantity("1", "whether a tip edge touches outside the path", "position pair")
    teeth: Integers = quantity("1", "numbers of the teeth of pinion and wheel", "gear position pair")
    lever: Array = quantity(
        "1", "lever of the normal about the axes, over the base radii", "gear position pair"
    )
    gap: Array = quantity("m", "gap that is left where no force is", "position pair", shown="um")
    lever_loss: Array | float = part("as of the cycle, where contacts move", default=0.0)
    further_lever_loss: Array | float = part("the same of further forces", default=0.0)

    def per_deflection(self, slope: Array) -> OppositeFlanks:
        """Measure slopes by another deflection, whose slope by D is given (n,)."""
        return replace(self, pair_stiffness=self.pair_stiffness / slope[:, None])


@record
class OppositeShare:
    """What the flanks on the other side carry; leading dimensions (torques, pitches, positions of one).

    Attributes
    ----------
    candidates : ContactCandidates
        Of the mirrored gears.
    lever_ratios, tilted_lever_ratios, largest : arrays
        As of the loaded flanks.
    forces, pair_stiffness, open : (..., pairs) arrays
        kappa G [N], its slope dG/dD, not above 0 [N/m], and the gap that is left [m].
    rest : (pitches, positions) array
        Transmission error without torque, from where the loaded flanks touch: not 0 where teeth overlap that are
        pressed together [m].
    cells : bool
        Whether loads were to vary along the face.
    reached : (torques,) array
        By how much D closes gaps on this side [m].
    lost : tuple of int
        Numbers of the torques for which no load sharing was found.
    """

    candidates: ContactCandidates
    lever_ratios: Array
    tilted_lever_ratios: Array
    largest: Array
    forces: Array
    pair_stiffness: Array
    open: Array
    rest: Array
    cells: bool
    reached: Array
    lost: tuple[int, ...] = ()

    @property
    def bears(self) -> bool:
        """Whether a flank on this side bears anywhere."""
        return bool(np.any(self.forces > 0.0))

    def flanks(self, number: int) -> OppositeFlanks:
        """Contacts under one of the torques, pitch after pitch."""
        candidates, pairs = self.candidates, len(self.candidates.offset)
        pitches = len(candidates.gap)
        rho = np.tile(np.where(candidates.touchable, candidates.rho, np.nan), (1, pitches, 1))
        return OppositeFlanks(
            (self.forces[number] / self.lever_ratios).reshape(-1, pairs),
            (self.pair_stiffness[number] / self.lever_ratios).reshape(-1, pairs),
            rho,
            np.tile(candidates.edge, (pitches, 1)),
            candidates.teeth,
            candidates.lever,
            np.where(self.forces[number] > 0.0, 0.0, self.open[number]).reshape(-1, pairs),
        )

    def refusal(self, number: int) -> str:
        """Why the solution for a torque is not to be believed, empty if it is."""
        candidates, turned = self.candidates, self.forces[number]
        if number in self.lost:
            return "no load sharing with back flanks was found; give more backlash, or reduce the torque"
        if self.cells and (np.any(turned > 0.0) or np.any(self.open[number] < -NOTHING)):
            return (
                "flanks on both sides bear, which know no cells of the face; give more backlash, raise the torque, "
                "or leave leads, alignment and cells out"
            )
        if candidates.edge.any() and np.any(turned[..., candidates.edge] > self.largest):
            return "a tip edge of a back flank presses over more than the strips cover; give more backlash"
        if self.reached[number] > candidates.reach_gap:
            return "back flanks overlap by more than was looked for outside the path; give more backlash"
        if np.any(turned[..., candidates.chamfered] > 0.0):
            return (
                "the face of a chamfer touches on a back flank, for which there is no law; give more backlash"
            )
        return ""


@record
class _Joined:
    """Laws of the pairs on either side, one after the other."""

    first: DeflectionLaw
    second: DeflectionLaw
    count: int

    def approach(self, force: Array) -> Array:
        """Deflection or separation (..., pairs) [m]."""
        return self._of(self.first.approach, self.second.approach, force)

    def slope(self, force: Array) -> Array:
        """Its derivative [m/N]."""
        return self._of(self.first.slope, self.second.slope, force)

    def _of(self, first: Callable[[Array], Array], second: Callable[[Array], Array], force: Array) -> Array:
        sides = first(force[..., : self.count]), second(force[..., self.count :])
        return np.concatenate(sides, axis=-1)


def across(
    bodies: PairCompliance, front: ContactCandidates, back: ContactCandidates, before: bool = False
) -> Array:
    """Compliance between contacts of front and back flanks (positions, front pairs, back pairs) [m/N].

    The rotation of each body on its hub is felt by all teeth, by the levers of the forces about its axis, as in the
    compliance of either side: with a weak hub it is all but a small part, and what both sides yield would else not be
    that of one body. The rest dies away with the teeth between; forces at tip edges are taken along the normals of the
    flanks in it. By the mesh before the last refinement if asked.
    """
    positions, pair = len(front.place), bodies.pair
    if "coupling" in bodies.left_out:
        return np.zeros((positions, len(front.offset), len(back.offset)))
    moved = np.zeros((positions, len(front.offset), len(back.offset)))
    back_flanks = (bodies.back_before if before else None) or bodies.back_flanks
    numbers, hubs = (pair.pinion.teeth, pair.wheel.teeth), (bodies.pinion, bodies.wheel)
    for gear, (flexible, teeth, hub) in enumerate(zip(back_flanks, numbers, hubs, strict=True)):
        here, there = front.teeth[gear, :positions, :, None], back.teeth[gear, :positions, None, :]
        # following teeth of the pinion stand clockwise, those of the wheel anticlockwise
        tooth = _nearest(here - there if gear == 0 else there - here, teeth)
        seen = flexible.across(tooth, front.rho[gear][:, :, None], back.rho[gear][:, None, :])
        felt = np.isin(tooth, list(flexible.series))
        first, second = (hub_lever(hub, side.rho[gear], side.leaning[gear]) for side in (front, back))
        turned = first[:, :, None] * second[:, None, :]  # torques of the two sides are opposed
        moved = moved + seen + hub.hub_windup * (felt - turned)
    return np.asarray(moved / pair.face_width + bodies.common_across)


def _nearest(steps: Integers, teeth: int) -> Integers:
    """Steps round a gear by the shorter way."""
    half = teeth // 2
    return np.asarray((steps + half) % teeth - half)


@record
class BothSides:
    """Loaded flanks and those on the other side, one after the other, as ``share_between`` asks for them."""

    count: int
    matrix: Array
    laws: _Joined
    oil: _Joined | None
    gaps: Array
    sides: Array
    tilted_lever_ratios: Array | None

    def open(self, loads: Array, approach: Array) -> Array:
        """Gaps that are left where pairs do not bear."""
        bent = (self.matrix @ loads[..., None])[..., 0] + self.gaps - self.sides * approach[..., None]
        return np.asarray(bent if self.oil is None else bent - self.oil.approach(np.zeros_like(bent)))

    def pressed(self) -> Array:
        """Where teeth overlap without a torque (pitches, positions).

        Films alone float them within their backlash, of any size: they thicken without bound as they bear less.
        """
        clear = self.gaps
        return np.asarray(clear[..., : self.count].min(axis=-1) + clear[..., self.count :].min(axis=-1) < 0.0)

    def share(self, force: Array) -> LoadShare:
        """Share forces (torques, 1 or pitches, 1 or positions) [N]."""
        from gears.sharing.both_flanks import share_between

        return share_between(
            force, self.matrix, self.laws, self.gaps, self.sides, self.oil, self.tilted_lever_ratios
        )


def between(
    setup: MeshSetup,
    bodies: PairCompliance,
    flanks: FlanksInPlace,
    other: FlanksInPlace,
    before: bool = False,
) -> Array:
    """Compliance between the loaded flanks and the others, for F' = kappa F (positions, pairs, others) [m/N]."""
    front, back = (other, flanks) if setup.back else (flanks, other)
    compliance = across(bodies, front.candidates, back.candidates, before) / (
        front.lever_ratios[:, :, None] * back.lever_ratios[:, None, :]
    )
    return np.swapaxes(compliance, 1, 2) if setup.back else compliance


def both_sides(
    setup: MeshSetup, bodies: PairCompliance, flanks: LoadedFlanks, other: LoadedFlanks
) -> BothSides:
    """Put the loaded flanks of a setting and the others together."""
    count, more = len(flanks.candidates.offset), len(other.candidates.offset)
    matrix = np.zeros((setup.positions, count + more, count + more))
    matrix[:, :count, :count], matrix[:, count:, count:] = flanks.matrix, other.matrix
    cross = between(setup, bodies, flanks, other)
    matrix[:, :count, count:], matrix[:, count:, :count] = cross, np.swapaxes(cross, 1, 2)
    touch = flanks.candidates.gap.min(axis=-1, keepdims=True)
    behind = setup.pair.backlash + other.candidates.gap + touch
    oil = None if flanks.oil is None or other.oil is None else _Joined(flanks.oil, other.oil, count)
    return BothSides(
        count,
        matrix,
        _Joined(flanks.laws, other.laws, count),
        oil,
        np.concatenate([flanks.candidates.gap - touch, behind], axis=-1),
        np.repeat([1.0, -1.0], [count, more]),
        np.concatenate([flanks.tilted_lever_ratios, other.tilted_lever_ratios], axis=-1)
        if setup.friction
        else None,
    )


def _lost(sides: BothSides, force: Array) -> bool:
    """Whether no load sharing is found under the force of one torque (pitches, positions) [N]."""
    try:
        sides.share(force[None])
    except LoadSharingError:
        return True
    return False


def share_with_opposite(
    setup: MeshSetup,
    bodies: PairCompliance,
    force: Array,
    film: Film | None,
    flanks: LoadedFlanks,
    alone: LoadShare | None,
    apart: Booleans,
    reach: float,
    tables: EdgeTables,
) -> tuple[LoadShare, OppositeShare, Array]:
    """Share forces (torques,) [N] among the flanks on both sides.

    Parameters
    ----------
    setup, bodies, film, reach, tables
        As for ``loaded_flanks``.
    force : (torques,) array
        [N]
    flanks : LoadedFlanks
        Of the side that the torque loads.
    alone : LoadShare or None
        Solution without the other side, kept where it lets nothing overlap; None without a torque.
    apart : (torques,) boolean array
        Torques for which it is kept whatever it lets overlap.

    Returns
    -------
    (LoadShare, OppositeShare, array)
        Of the loaded flanks and of the others, and the gaps that are left on the loaded side.
    """
    other = loaded_flanks(setup.opposite, bodies, film, reach, float(np.max(force)), tables)
    sides = both_sides(setup, bodies, flanks, other)
    whole, count = force[:, None, None], sides.count
    pressed = sides.pressed()
    loaded_share, clear = alone, np.zeros((len(force), *pressed.shape), dtype=bool)
    loads = np.zeros((len(force), *sides.gaps.shape))
    if alone is not None:
        loads[..., :count] = alone.forces
        remaining_gaps = sides.open(loads, alone.transmission_error)[..., count:]
        clear = np.all(remaining_gaps >= -ROUNDING * np.abs(alone.transmission_error)[..., None], axis=-1)
        clear |= apart[:, None, None]
    slopes, rest = np.zeros_like(loads), np.zeros(pressed.shape)
    if alone is not None:
        slopes[..., :count] = alone.pair_stiffness
    if not (
        clear.all() or (alone is not None and setup.face is not None)
    ):  # loads of cells have no both sides
        asked = np.where(apart, float(np.min(force, where=~apart, initial=np.inf)), force)
        try:
            joint = sides.share(asked[:, None, None] + 0.0 * pressed)
        except LoadSharingError:
            lost = tuple(n for n in np.flatnonzero(~apart).tolist() if _lost(sides, asked[n] + 0.0 * pressed))
            if alone is None or not lost:
                raise
            without = apart | np.isin(np.arange(len(force)), lost)
            kept, opposite, remaining_gaps = share_with_opposite(
                setup, bodies, force, film, flanks, alone, without, reach, tables
            )
            return kept, replace(opposite, lost=lost), remaining_gaps
        loads = np.where(clear[..., None], loads, joint.forces)
        slopes = np.where(clear[..., None], slopes, joint.pair_stiffness)
        moved, tangent = joint.transmission_error, joint.stiffness
        if alone is not None:
            moved = np.where(clear, alone.transmission_error, moved)
            tangent = np.where(clear, alone.stiffness, tangent)
        loaded_share = LoadShare(loads[..., :count], moved, tangent, slopes[..., :count], joint.iterations)
    assert loaded_share is not None
    if pressed.any():
        small = np.where(pressed, 0.0, max(float(np.max(force, where=~apart, initial=0.0)), 1.0))
        rest = np.where(pressed, sides.share(small).transmission_error, 0.0)
    remaining_gaps = sides.open(loads, loaded_share.transmission_error)
    touch = flanks.candidates.gap.min(axis=-1)
    closing = bodies.turning * whole - loaded_share.transmission_error - touch - setup.pair.backlash
    opposite = OppositeShare(
        other.candidates,
        other.lever_ratios,
        other.tilted_lever_ratios,
        other.largest,
        loads[..., count:],
        slopes[..., count:],
        remaining_gaps[..., count:],
        rest,
        setup.face is not None,
        closing.max(axis=(1, 2)),
    )
    return loaded_share, opposite, remaining_gaps[..., :count]
