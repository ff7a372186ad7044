r"""Tip corners under contacts that move: what the laws beside A and E become when the pinion has taken up D.

The wheel is held, so that a contact keeps its distance from the wheel's corner and rolls on by D towards the pinion's:
beside E all is as if the involutes touched at x_1 = x + D, with the wheel turned back by D. There the force stands on
the wheel's flank and has the lever 1 about the wheel's axis; with the energy Psi(F, x_1) of the corner's law over
force and place (``fem.laws.place_surface``), in turns of the wheel,

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
from fem.laws.cut_off import cut_offs
from fem.laws.local_law import PairLaws
from fem.laws.place_surface import PlaceSurface, Pushed, up_to
from fem.laws.tip_geometry import gap_at

if TYPE_CHECKING:
    from fem.contact.loaded_flanks import LoadedFlanks
    from fem.influence.gear_compliance import GearCompliance
    from fem.laws.edge_tables import EdgeTables
    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["MovedFlanks", "moved_flanks"]

DEEPEST = 0.25
"""Maximum deflection [modules] at which the pinion's flank is looked at for its corner."""


@record
class MovedFlanks:
    """What contacts that move yield, in place of ``loaded_flanks``: forces at the pinion's edges are not turned.

    Attributes
    ----------
    matrix : (positions, pairs, pairs) array
        Without the pinion's own flanks [m/N].
    laws : PairLaws
        Without what depends on D.
    gaps : (pitches, positions, pairs) array
        [m], without those that the surface has.
    levers : (positions, pairs) array
        Without D.
    surfaces : tuple of PlaceSurface
        Of the corners of pinion and wheel; none where relief has laws of the corners at held places.
    beside : tuple of (positions, pairs) boolean arrays
        Contacts of either.
    beyond : (2, pitches, positions, pairs) array
        Places of the contacts beyond the ends of the flanks of pinion and wheel, without D [m].
    base : (pitches, positions, pairs) array
        Curvature radii of the pinion's flank without D [m].
    share : (positions, pairs) array
        1/(width kappa^2) where the pinion's flank yields by itself [1/m].
    flank : GearCompliance
        Of the pinion.
    """

    matrix: Array
    laws: PairLaws
    gaps: Array
    levers: Array
    surfaces: tuple[PlaceSurface, ...]
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
        found = Pushed(*(np.zeros(np.broadcast(force, turn).shape) for _ in range(5)))
        size = force + found.approach
        for corner, (surface, some) in enumerate(zip(self.surfaces, self.beside, strict=True)):
            if some.any():
                at = surface.at(self._places(corner, turn), size[..., some])
                for name in (
                    ("approach", "slope") if corner else ("approach", "slope", "push", "less", "stiff")
                ):
                    getattr(found, name)[..., some] = getattr(at, name)
        return found

    def opened(self, turn: Array) -> Array:
        """Gaps of the corners without a force (..., pairs) under turns D (..., pairs) [m]."""
        found = np.zeros(np.broadcast(turn, self.base).shape)
        for corner, (surface, some) in enumerate(zip(self.surfaces, self.beside, strict=True)):
            if some.any():
                found[..., some] = surface.gap(self._places(corner, turn))
        return found

    def pushed(self, force: Array, turn: Array) -> Pushed:
        """Both together."""
        one, two = self.rolled(force, turn), self.cornered(force, turn)
        return Pushed(
            one.approach + two.approach,
            one.slope + two.slope,
            one.push + two.push,
            one.less + two.less,
            one.stiff + two.stiff,
        )

    def edge_rho(self, flanks: LoadedFlanks, given: MeshSetup, approach: Array) -> Array:
        """Curvature radii at which tip edges touch pinion and wheel (2, ..., pairs) under a deflection (...) [m]."""
        where, pair, turned = flanks.where, given.pair, approach[..., None]
        rho = np.broadcast_to(where.rho[:, None], (2, *self.base.shape)) + 0.0 * turned
        (_, before), (_, after) = where.corners()
        overlap = turned - np.where(
            np.isfinite(where.gap), where.gap - where.gap.min(axis=-1, keepdims=True), 0.0
        )
        rho[0] = np.where(before, where.rho[0] + np.maximum(overlap, 0.0), rho[0])
        if self.surfaces and after.any():
            end, line = given.rounds[0].rho, pair.line_of_action
            place = line - end - self.beyond[0] - turned
            gap, touched = gap_at(
                pair.base_radii[::-1], line, np.where(after, place, line - end), np.array(end)
            )
            rho[1] = np.where(after, touched + np.maximum(turned - self.gaps - gap, 0.0), rho[1])
        return rho


def moved_flanks(
    given: MeshSetup, bodies: PairCompliance, flanks: LoadedFlanks, force: float, tables: EdgeTables
) -> MovedFlanks:
    """Laws for contacts that move, from those for contacts that stay; arguments as for ``loaded_flanks``.

    Flanks with relief keep the laws of both corners at the places of contacts that stay: there the slope of what they
    lack parts the corners from the contacts.
    """
    where, pair, width = flanks.where, given.pair, given.pair.face_width
    surfaces = tables.surfaces if given.removed is None else ()
    (_, before), (_, after) = where.corners()
    kappa = np.ones_like(flanks.kappa) if surfaces else flanks.kappa
    clear = where.gap - where.gap.min(axis=-1, keepdims=True)
    if surfaces:
        clear = clear - np.where(where.edge, where.lacking, 0.0)
    held = np.where(np.isfinite(clear), clear, 0.0)
    ratio = flanks.kappa / kappa
    matrix = flanks.matrix * ratio[..., :, None] * ratio[..., None, :]
    share = np.where(where.touchable & (bool(surfaces) | ~after), 1 / (width * kappa**2), 0.0)
    diagonal = np.arange(matrix.shape[-1])
    own = (bodies.pinion.own(where.rho[0]) - bodies.pinion.hub_windup) * share
    matrix[..., diagonal, diagonal] -= np.where(after, 0.0, own)
    middle = 0.5 * (pair.points.A + pair.points.E)
    place = np.where(where.touchable, np.clip(where.place, *given.ends), middle)
    hertz, levers = bodies.hertz(place, where.curvature, kappa), flanks.levers * ratio
    beyond = np.zeros((2, *clear.shape))
    beside: tuple[Booleans, ...] = ()
    if surfaces:
        levers = np.where(after, levers - flanks.kappa + 1.0, levers)
        laws = PairLaws(hertz, np.zeros_like(where.edge))
        wheel, other = bodies.wheel, pair.line_of_action - where.place
        rounded = up_to(other, wheel.rho_range[1], wheel.module)[0]
        known = np.where(before, wheel.hub_windup, wheel.own(where.rho[1]))
        matrix[..., diagonal, diagonal] += np.where(where.touchable, wheel.own(rounded) - known, 0.0) / width
        beyond[0], beyond[1] = where.place - held - given.rounds[0].rho, other - given.rounds[1].rho
        most = DEEPEST * pair.module, 0.0
        beside = tuple(
            where.touchable & (flat > surface.first - more)
            for flat, surface, more in zip(
                (where.place - given.rounds[0].rho, beyond[1][0]), surfaces, most, strict=True
            )
        )
    else:
        table, _ = tables.at(where, slid=tables.slid)
        laws = PairLaws(hertz, where.edge, table, cut_offs(given, bodies, where, force, slid=tables.slid))
    base = np.where(after, where.place, where.rho[0]) - held
    base = np.where(before & bool(surfaces), where.rho[0] - held - np.where(before, where.lacking, 0.0), base)
    return MovedFlanks(matrix, laws, clear, levers, surfaces, beside, beyond, base, share, bodies.pinion)
