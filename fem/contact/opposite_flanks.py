"""Flanks on the other side of the teeth: whether they bear beside the loaded ones, and what both carry then.

The gap of a flank on the other side is the backlash, its own gap and the transmission error D, less what loads on both
sides bend it by:

    g_k = j + gap_k + D + sum_i X_ki F_i + sum_l B_kl G_l + local(G_k) >= 0,   sum l_i F_i - sum l_k G_k = T/r_b1,

with B of the mirrored gears and X of loads on one side seen from the other (``fem.influence.back_compliance``).
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, Integers, part, quantity, record
from fem.contact.cell_contact import CellContact
from fem.contact.contact_sides import ContactSides, both_sides
from fem.contact.face_share import FaceShare, share_over_face
from fem.contact.loaded_flanks import LoadedFlanks, loaded_flanks
from fem.laws.contact_candidates import ContactCandidates
from fem.laws.edge_tables import EdgeTables
from fem.laws.local_law import Film
from fem.laws.mesh_setup import MeshSetup
from gears.sharing.active_set import LoadShare
from gears.tooth.errors import LoadSharingError

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["OppositeFlanks", "OppositeShare", "SharedBySides", "SharedContacts", "share_with_opposite"]

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
    reached : (torques,) array
        By how much D closes gaps on this side [m].
    refused : bool
        Whether flanks on both sides are refused together.
    lost : tuple of int
        Numbers of the torques for which no load sharing was found.
    face : FaceShare or None
        Cells of this side.
    """

    candidates: ContactCandidates
    lever_ratios: Array
    tilted_lever_ratios: Array
    largest: Array
    forces: Array
    pair_stiffness: Array
    open: Array
    rest: Array
    reached: Array
    refused: bool = False
    lost: tuple[int, ...] = ()
    face: FaceShare | None = None

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
        if self.refused and (np.any(turned > 0.0) or np.any(self.open[number] < -NOTHING)):
            return (
                "flanks on both sides bear, which is not known on shafts that give way; give more backlash, or leave "
                "the shafts out"
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
class SharedBySides:
    """Forces shared among the flanks on both sides.

    Attributes
    ----------
    share : LoadShare
        Of the loaded flanks.
    opposite : OppositeShare
        Of the others.
    open : (torques, pitches, positions, pairs) array
        Gaps that are left on the loaded side [m].
    face : FaceShare or None
        Cells of the loaded side.
    """

    share: LoadShare
    opposite: OppositeShare
    open: Array
    face: FaceShare | None


def share_with_opposite(
    setup: MeshSetup,
    bodies: PairCompliance,
    force: Array,
    film: Film | None,
    flanks: LoadedFlanks,
    alone: tuple[LoadShare, FaceShare | None] | None,
    apart: Booleans,
    reach: float,
    tables: EdgeTables,
) -> SharedBySides:
    """Share forces (torques,) [N] among the flanks on both sides.

    Parameters
    ----------
    setup, bodies, film, reach, tables
        As for ``loaded_flanks``.
    force : (torques,) array
        [N]
    flanks : LoadedFlanks
        Of the side that the torque loads.
    alone : (LoadShare, FaceShare or None) or None
        Solution without the other side, and its cells, kept where it lets nothing overlap; None without a torque.
    apart : (torques,) boolean array
        Torques for which it is kept whatever it lets overlap.
    """
    other = loaded_flanks(setup.opposite, bodies, film, reach, float(np.max(force)), tables)
    sides = both_sides(setup, bodies, flanks, other)
    refused = on_shafts(setup)
    kept = None if alone is None else SharedContacts.alone(sides, bodies, *alone, even=refused)
    joint, lost = kept, np.zeros(len(force), dtype=bool)
    if kept is None or not (np.all(kept.clear | apart[:, None, None]) or refused):
        asked = np.where(apart, float(np.min(force, where=~apart, initial=np.inf)), force)
        try:
            joint = SharedContacts.jointly(sides, bodies, asked)
        except LoadSharingError:
            lost = ~apart & np.array([_lost(sides, bodies, one_force) for one_force in asked])
            if kept is None or not lost.any():
                raise
            if not np.all(lost | apart):
                asked = np.where(lost | apart, np.min(asked[~(lost | apart)]), asked)
                joint = SharedContacts.jointly(sides, bodies, asked)
        if kept is not None and joint is not None:
            joint = joint.with_kept(kept, kept.clear | (apart | lost)[:, None, None])
    assert joint is not None
    return joint.by_sides(bodies, force, other, refused, tuple(np.flatnonzero(lost).tolist()))


def on_shafts(setup: MeshSetup) -> bool:
    """Whether shafts give way under the face, which is not known where both sides bear."""
    return setup.face is not None and setup.face.shafts != (None, None)


def _lost(sides: ContactSides, bodies: PairCompliance, force: float) -> bool:
    """Whether no load sharing is found under a force [N]."""
    try:
        SharedContacts.jointly(sides, bodies, np.array([force]))
    except LoadSharingError:
        return True
    return False


@record
class SharedContacts:
    """Share of all pairs on both sides.

    Attributes
    ----------
    sides : ContactSides
    share : LoadShare
    face : FaceShare or None
    open : (torques, pitches, positions, pairs) array
        Gaps that are left [m].
    """

    sides: ContactSides
    share: LoadShare
    face: FaceShare | None
    open: Array

    @classmethod
    def alone(
        cls, sides: ContactSides, bodies: PairCompliance, share: LoadShare, over: FaceShare | None, even: bool
    ) -> SharedContacts:
        """Of a loaded side that bears alone; gaps of the other side by even loads where asked for."""
        more, setup = sides.matrix.shape[-1] - sides.count, sides.setups[0]
        nothing = np.zeros((*share.stiffness.shape, more))
        forces, slopes = (
            np.concatenate([values, nothing], axis=-1) for values in (share.forces, share.pair_stiffness)
        )
        whole = replace(share, forces=forces, pair_stiffness=slopes)
        if over is None or setup.face is None:
            return cls(sides, whole, None, sides.open(whole))
        cells = np.zeros((*nothing.shape, setup.face.cells))
        loads = np.concatenate([over.forces, cells], axis=-2)
        if even:
            left = np.repeat(sides.open(whole)[..., sides.count :, None], setup.face.cells, axis=-1)
        else:
            contact = CellContact(bodies, np.zeros((len(loads), 1, 1)), sides)
            left = contact.open(setup.face, loads, share.transmission_error)[..., sides.count :, :]
        gaps = np.concatenate([over.remaining_gaps, left], axis=-2)
        rise = np.concatenate([over.rise, cells], axis=-2)
        face = replace(over, forces=loads, remaining_gaps=gaps, rise=rise)
        return cls(sides, whole, face, face.open)

    @classmethod
    def jointly(cls, sides: ContactSides, bodies: PairCompliance, force: Array) -> SharedContacts:
        """Of forces (torques,), or (torques, pitches, positions) [N]."""
        whole = force[:, None, None] if force.ndim == 1 else force
        if sides.setups[0].face is None:
            share = sides.share(whole + np.zeros(sides.gaps.shape[:-1]))
            return cls(sides, share, None, sides.open(share))
        share, face = share_over_face(bodies, whole, sides)
        return cls(sides, share, face, face.open)

    @property
    def clear(self) -> Booleans:
        """Where nothing overlaps on the other side (torques, pitches, positions)."""
        gaps, turn = self.open[..., self.sides.count :], self.share.transmission_error
        return np.asarray(np.all(gaps >= -ROUNDING * np.abs(turn)[..., None], axis=-1))

    def with_kept(self, kept: SharedContacts, clear: Booleans) -> SharedContacts:
        """The same with another share where that holds."""
        chosen = clear[..., None]
        names, mine, other = ("transmission_error", "stiffness"), self.share, kept.share
        share = replace(
            mine,
            forces=np.where(chosen, other.forces, mine.forces),
            pair_stiffness=np.where(chosen, other.pair_stiffness, mine.pair_stiffness),
            **{name: np.where(clear, getattr(other, name), getattr(mine, name)) for name in names},
        )
        face = self.face
        if face is not None and kept.face is not None:
            cells, arrays = chosen[..., None], ("forces", "remaining_gaps", "rise")
            mixed = {name: np.where(cells, getattr(kept.face, name), getattr(face, name)) for name in arrays}
            face = replace(face, **mixed)
        open_ = self.sides.open(share) if face is None else face.open
        return SharedContacts(self.sides, share, face, open_)

    def rest(self, bodies: PairCompliance, force: Array) -> Array:
        """Transmission error without torque (pitches, positions) [m]; 0 where teeth are not pressed together."""
        pressed = self.sides.pressed()
        if not pressed.any() or (on_shafts(self.sides.setups[0])):
            return np.zeros(pressed.shape)
        small = np.where(pressed, 0.0, max(float(np.max(force, initial=0.0)), 1.0))
        free = SharedContacts.jointly(self.sides, bodies, small[None])
        return np.where(pressed, free.share.transmission_error[0], 0.0)

    def by_sides(
        self,
        bodies: PairCompliance,
        force: Array,
        other: LoadedFlanks,
        refused: bool,
        lost: tuple[int, ...],
    ) -> SharedBySides:
        """Both sides by themselves, for forces (torques,) [N]."""
        sides, share, setup = self.sides, self.share, self.sides.setups[0]
        loaded, behind = slice(0, sides.count), slice(sides.count, None)
        touch = sides.flanks[0].candidates.gap.min(axis=-1)
        closing = bodies.turning * force[:, None, None] - share.transmission_error - touch
        opposite = OppositeShare(
            other.candidates,
            other.lever_ratios,
            other.tilted_lever_ratios,
            other.largest,
            share.forces[..., behind],
            share.pair_stiffness[..., behind],
            self.open[..., behind],
            self.rest(bodies, force),
            (closing - setup.pair.backlash).max(axis=(1, 2)),
            refused,
            lost,
            None if self.face is None else self.face.of_pairs(behind),
        )
        front = replace(
            share, forces=share.forces[..., loaded], pair_stiffness=share.pair_stiffness[..., loaded]
        )
        face = None if self.face is None else self.face.of_pairs(loaded)
        return SharedBySides(front, opposite, self.open[..., loaded], face)
