r"""Tip corners under contacts that move: what the laws beside A and E become when the pinion has taken up D.

The wheel is held, so that a contact keeps its distance from the wheel's corner and rolls on by D towards the pinion's:
beside E all is as if the involutes touched at x_1 = x + D, with the wheel turned back by D. There the force stands on
the wheel's flank and has the lever 1 about the wheel's axis; with the energy Psi(F, x_1) of the corner's law over
force and place (``fem.laws.corner_law``), in turns of the wheel,

    D = dPsi/dF + ...,        T/r_b1 = sum F - dPsi/dx_1 - ...,

which holds the lever kappa = 1 - d gap/dx_1 of an edge as well. Beside A the laws stay at x, and the pinion's flank is
touched where it has rolled on by D less the gap. On either side the tilt tau of the flank that is touched brings the
contact nearer to the corner, by R tau w along the flank.

Strips let a contact slide on the corner's tooth, to where it is stiffer, as contacts that move do: that energy,
(R/2)(tau + t/R)^2 w^3 with tau and t of the corner's gear, is in both laws, and is given back once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, record
from fem.laws.corner_law import CornerSurface, Pushed
from fem.laws.corner_surface import up_to
from fem.laws.local_law import PairLaws
from fem.laws.tip_geometry import gap_at

if TYPE_CHECKING:
    from fem.contact.loaded_flanks import LoadedFlanks
    from fem.influence.gear_compliance import GearCompliance
    from fem.laws.corner_laws import CornerLaws
    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["MovedFlanks", "moved_flanks"]

DEEPEST = 0.25
"""Maximum deflection [modules] at which the pinion's flank is looked at for its corner."""


@record
class MovedFlanks:
    """What contacts that move yield, in place of ``loaded_flanks``.

    Attributes
    ----------
    matrix : (positions, pairs, pairs) array
        Without the pinion's own flanks [m/N].
    laws : PairLaws
        Without what depends on D.
    gaps : (pitches, positions, pairs) array
        Along the normals [m], without those that the surface has.
    lever_ratios : (positions, pairs) array
        Of the normals without D: 1 where corners have surfaces, which hold what they close.
    surfaces : tuple of CornerSurface
        Of the corners of pinion and wheel; none where relief has laws of the corners at held places.
    beside : tuple of (positions, pairs) boolean arrays
        Contacts of either.
    beyond : (2, pitches, positions, pairs) array
        Places of the contacts beyond the ends of the flanks of pinion and wheel, without D [m].
    base : (pitches, positions, pairs) array
        Curvature radii of the pinion's flank without D [m].
    share : (positions, pairs) array
        1/width where the pinion's flank yields by itself [1/m].
    flank : GearCompliance
        Of the pinion.
    """

    matrix: Array
    laws: PairLaws
    gaps: Array
    lever_ratios: Array
    surfaces: tuple[CornerSurface, ...]
    beside: tuple[Booleans, ...]
    beyond: Array
    base: Array
    share: Array
    flank: GearCompliance

    def rolled(self, force: Array, turn: Array) -> Pushed:
        """What the pinion's flanks yield to forces (..., pairs) [N] where they have rolled on by D (..., pairs) [m]."""
        flank = self.flank
        at, first, second = up_to(self.base + turn, flank.rho_range[1], flank.module)
        slope = flank.own_slope(at) * self.share * (at > flank.rho_range[0])
        bend = flank.own_bend(at) * self.share * (at > flank.rho_range[0])
        own, square = (flank.own(at) - flank.hub_windup) * self.share, 0.5 * force**2
        return Pushed(
            own * force,
            own,
            slope * first * square,
            slope * first * force,
            (bend * first**2 + slope * second) * square,
        )

    def _places(self, corner: int, turn: Array) -> Array:
        """Places of the contacts beside a corner: those of the pinion roll on."""
        turned = turn if corner == 0 else np.zeros_like(turn)
        return np.asarray((self.beyond[corner] + turned)[..., self.beside[corner]])

    def cornered(self, force: Array, turn: Array) -> Pushed:
        """What the corners add to forces (..., pairs) [N] under turns D (..., pairs) [m]."""
        pushed = Pushed(*(np.zeros(np.broadcast(force, turn).shape) for _ in range(5)))
        size = force + pushed.approach
        for corner, (surface, contacts) in enumerate(zip(self.surfaces, self.beside, strict=True)):
            if contacts.any():
                at = surface.at(self._places(corner, turn), size[..., contacts])
                for name in (
                    ("approach", "slope") if corner else ("approach", "slope", "push", "less", "stiff")
                ):
                    getattr(pushed, name)[..., contacts] = getattr(at, name)
        return pushed

    def opened(self, turn: Array) -> Array:
        """Gaps of the corners without a force (..., pairs) under turns D (..., pairs) [m]."""
        gaps = np.zeros(np.broadcast(turn, self.base).shape)
        for corner, (surface, contacts) in enumerate(zip(self.surfaces, self.beside, strict=True)):
            if contacts.any():
                gaps[..., contacts] = surface.gap(self._places(corner, turn))
        return gaps

    def edge_rho(self, flanks: LoadedFlanks, setup: MeshSetup, approach: Array) -> Array:
        """Curvature radii at which tip edges touch pinion and wheel (2, ..., pairs) under a deflection (...) [m]."""
        candidates, pair, turned = flanks.candidates, setup.pair, approach[..., None]
        rho = np.broadcast_to(candidates.rho[:, None], (2, *self.base.shape)) + 0.0 * turned
        (_, before), (_, after) = candidates.corners()
        overlap = turned - np.where(
            np.isfinite(candidates.gap), candidates.gap - candidates.gap.min(axis=-1, keepdims=True), 0.0
        )
        rho[0] = np.where(before, candidates.rho[0] + np.maximum(overlap, 0.0), rho[0])
        if self.surfaces and after.any():
            end, line = setup.rounds[0].rho, pair.line_of_action
            place = line - end - self.beyond[0] - turned
            gap, touched = gap_at(
                pair.base_radii[::-1], line, np.where(after, place, line - end), np.array(end)
            )
            rho[1] = np.where(after, touched + np.maximum(turned - self.gaps - gap, 0.0), rho[1])
        return rho


def moved_flanks(
    setup: MeshSetup, bodies: PairCompliance, flanks: LoadedFlanks, corner_laws: CornerLaws
) -> MovedFlanks:
    """Laws for contacts that move, from those for contacts that stay; arguments as for ``loaded_flanks``.

    Flanks with relief keep the laws of both corners at the places of contacts that stay: there the slope of what they
    lack parts the corners from the contacts.
    """
    candidates, pair, width = flanks.candidates, setup.pair, setup.pair.face_width
    surfaces = corner_laws.surfaces if setup.removed is None else ()
    (_, before), (_, after) = candidates.corners()
    lever_ratios = np.ones_like(flanks.lever_ratios) if surfaces else flanks.lever_ratios
    clear = candidates.gap - candidates.gap.min(axis=-1, keepdims=True)
    if surfaces:
        clear = clear - np.where(candidates.edge, candidates.lacking, 0.0)
    held = np.where(np.isfinite(clear), clear, 0.0)
    matrix = flanks.matrix.copy()
    share = np.where(candidates.touchable & (bool(surfaces) | ~after), 1 / width, 0.0)
    diagonal = np.arange(matrix.shape[-1])
    own = (bodies.pinion.own(candidates.rho[0]) - bodies.pinion.hub_windup) * share
    matrix[..., diagonal, diagonal] -= np.where(after, 0.0, own)
    middle = 0.5 * (pair.points.A + pair.points.E)
    place = np.where(candidates.touchable, np.clip(candidates.place, *setup.ends), middle)
    beyond = np.zeros((2, *clear.shape))
    beside: tuple[Booleans, ...] = ()
    if surfaces:
        laws = PairLaws(bodies.hertz(place, candidates.curvature))
        wheel, other = bodies.wheel, pair.line_of_action - candidates.place
        rounded = up_to(other, wheel.rho_range[1], wheel.module)[0]
        known = np.where(before, wheel.hub_windup, wheel.own(candidates.rho[1]))
        matrix[..., diagonal, diagonal] += (
            np.where(candidates.touchable, wheel.own(rounded) - known, 0.0) / width
        )
        beyond[0], beyond[1] = candidates.place - held - setup.rounds[0].rho, other - setup.rounds[1].rho
        most = DEEPEST * pair.module, 0.0
        beside = tuple(
            candidates.touchable & (flat > surface.first - more)
            for flat, surface, more in zip(
                (candidates.place - setup.rounds[0].rho, beyond[1][0]), surfaces, most, strict=True
            )
        )
    else:
        laws, _ = corner_laws.at(candidates, moving=True)
    base = np.where(after, candidates.place, candidates.rho[0]) - held
    base = np.where(
        before & bool(surfaces), candidates.rho[0] - held - np.where(before, candidates.lacking, 0.0), base
    )
    return MovedFlanks(
        matrix,
        laws,
        lever_ratios * clear,
        lever_ratios,
        surfaces,
        beside,
        beyond,
        base,
        share,
        bodies.pinion,
    )
