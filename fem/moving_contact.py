"""Contact that moves under load: the first order in the deflection over the module.

The position is that of the wheel, held; the pinion takes up the deflection D, so that its flank has rolled on by D
when it bears: x_1 = x_2 + D on the line of action. A turned involute is a parallel curve, so this is exact. With
U*(F; x_1, x_2) = (1/2) F.B F + sum Int Hertz dF - sum U_3, the complementary energy of the forces at these places,

    D = dU*/dF_i + gap_i,     T/r_b1 = sum l_i F_i - dU*/dx_1,

where U_3 is the third-order energy of a contact (``fem.flank_motion``). To the first order in D, with B' = dB/dx_1,

    D = (B F)_i + Hertz_i + gap_i + D (B' F)_i - U_3'(F_i),     T/r_b1 = sum_i [l_i - (B' F)_i/2] F_i,

Hertz's share of B' among it: R grows as the pinion's flank rolls on. The wheel turned back instead, with the pinion
held, is the same state named by another position: its stiffness is that of the pinion turned at x - D. Contacts
of tip edges keep their places, gaps (tip relief too) are read there.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, record
from fem.flamant import hertz_half_width
from fem.moving_newton import Linearised, moved_forces
from fem.third_order import half_plane, large_strain

if TYPE_CHECKING:
    from fem.bodies import Compliance
    from fem.contact_candidates import ContactCandidates
    from fem.elasticity import PlaneElasticity
    from fem.local_law import FilmLaw, PairLaws
    from fem.moving_corners import MovedFlanks
    from gears import LoadShare

__all__ = [
    "ContactMoves",
    "MovingPairs",
    "contact_moves",
    "model_error",
    "moved_places",
    "moved_share",
    "moving_pairs",
]


@record
class ContactMoves:
    """What the moves of all contacts depend on; (..., pairs), zero for tip edges.

    Attributes
    ----------
    roll : (..., pairs, pairs) array
        B', with Hertz's share [1/N].
    cubic, local : (2, ..., pairs) arrays
        U_3 = cubic F^3 + local F^2.5; the second row is what Hencky's law adds [m/N^2], [m/N^1.5].
    shift : (2, ..., pairs) array
        Growth of rho on pinion and wheel per force, but for the roll by D [m/N].
    """

    roll: Array
    cubic: Array
    local: Array
    shift: Array

    def thrust(self, force: Array, law: int = 0) -> tuple[Array, Array]:
        """U_3'(F) [m] and U_3''(F) [m/N], or what Hencky's law adds."""
        root = np.sqrt(np.maximum(force, 0.0))
        first = 3 * self.cubic[law] * force**2 + 2.5 * self.local[law] * root**3
        return first, 6 * self.cubic[law] * force + 3.75 * self.local[law] * root

    def rolled(self, force: Array) -> Array:
        """B' F (..., pairs)."""
        return np.asarray((self.roll @ force[..., None])[..., 0])


def contact_moves(bodies: Compliance, where: ContactCandidates, corners: bool = False) -> ContactMoves:
    """Moves of the contacts of a pair at all positions.

    With ``corners`` those of tip edges too, with energies of the flanks' ends, and B' without the flanks' own part
    (``fem.moving_corners``).
    """
    pair, width = bodies.pair, bodies.pair.face_width
    flat = where.touchable & ~where.edge
    on_path = where.touchable if corners else flat
    gears, radii = (bodies.pinion, bodies.wheel), pair.base_radii
    rho = np.where(on_path, where.rho, 0.5 * pair.line_of_action)
    motions = bodies.motions
    rho = np.stack([np.clip(r, *motion.rho_range) for motion, r in zip(motions, rho, strict=True)])
    radius = rho[0] * rho[1] / (rho[0] + rho[1])
    laws = [gear.law for gear in gears]
    tilt = [0.5 * gear.own_slope(r) * base / r for gear, r, base in zip(gears, rho, radii, strict=True)]
    along = [motion.tangential(r) for motion, r in zip(motions, rho, strict=True)]
    cubic = np.sum(
        [_energies(motion.energy(r), law) for motion, r, law in zip(motions, rho, laws, strict=True)], axis=0
    )
    cubic[0] += 0.5 * radius * (tilt[0] - tilt[1]) ** 2
    for t, tau, r in zip(along, tilt, rho, strict=True):
        cubic[0] += t * tau + 0.5 * t**2 / r
    reduced = 2 / sum(1 / law.plane_modulus for law in laws)
    a = hertz_half_width(1.0, radius, reduced)  # of 1 N/m
    local = np.sum([_energies(half_plane(law), law) for law in laws], axis=0)[:, None, None] / a
    part = [0.5 * reduced / law.plane_modulus for law in laws]
    slip = [(1 - law.plane_poisson) / law.plane_modulus for law in laws]
    local[0] += 64 / (45 * np.pi**2) * (part[0] / rho[1] - part[1] / rho[0]) * (slip[0] - slip[1]) * a
    shift = np.stack(
        [
            (radius * (tilt[1] - tilt[0]) - along[0]) * radii[0] / rho[0],
            (radius * (tilt[0] - tilt[1]) - along[1]) * radii[1] / rho[1],
        ]
    )
    roll = np.zeros((*on_path.shape, on_path.shape[-1]))
    hertz = -sum(1 / law.plane_modulus for law in laws) / np.pi * rho[1] / (rho[0] * (rho[0] + rho[1]))
    count, pinion = on_path.shape[-1], bodies.pinion
    for i in range(count):
        roll[..., i, i] = hertz[..., i] + (0.0 if corners else pinion.own_slope(rho[0][..., i]))
        for j in range(i + 1, min(count, i + bodies.reach + 1)):
            slope = pinion.cross_slope(j - i, rho[0][..., i], rho[0][..., j])
            roll[..., i, j] = roll[..., j, i] = slope
    roll = np.where(on_path[..., :, None] & on_path[..., None, :], roll, 0.0) / width
    return ContactMoves(
        roll,
        np.where(on_path, cubic, 0.0) / width**2,
        np.where(on_path, local, 0.0) / width**1.5,
        np.where(flat, shift, 0.0) / width,
    )


def _energies(parts: Array, law: PlaneElasticity) -> Array:
    """Third-order energies (2, ...): St. Venant and Kirchhoff's, and what Hencky's law adds to it."""
    return np.stack([parts[0], large_strain(parts, law)])


@record
class MovingPairs:
    """Pairs whose contacts move (``fem.moving_newton``).

    Attributes
    ----------
    bulk, laws, film, levers
        As for ``share_load``.
    clear : (..., pairs) array
        Gaps, 0 where there is no contact [m].
    touchable : (..., pairs) boolean array
    moves : ContactMoves
    own : MovedFlanks or None
        What the pinion's own flanks and corners yield (``fem.moving_corners``).
    start : float
        Part of the whole force with which a pair is taken in.
    """

    bulk: Array
    laws: PairLaws
    film: FilmLaw | None
    clear: Array
    touchable: Booleans
    levers: Array
    moves: ContactMoves
    own: MovedFlanks | None
    start: float = 1e-2

    def linearised(self, loads: Array, approach: Array) -> Linearised:
        """As of ``MovingForces``."""
        rolled, (thrust, stiffened) = self.moves.rolled(loads), self.moves.thrust(loads)
        residual = (self.bulk @ loads[..., None])[..., 0] + self.laws.approach(loads) + self.clear - thrust
        residual += approach[..., None] * (rolled - 1)
        slope = self.laws.slope(loads) - stiffened
        if self.film is not None:
            residual, slope = residual - self.film.approach(loads), slope - self.film.slope(loads)
        slope, reach = np.where(loads > 0, slope, 1.0), 1 - rolled
        carried, stiff = np.sum((self.levers - 0.5 * rolled) * loads, axis=-1), np.zeros_like(approach)
        if self.own is not None:
            more = self.own.pushed(loads, approach[..., None])
            residual, slope, reach = residual + more.approach, slope + more.slope, reach - more.less
            carried = carried - np.sum(np.where(loads > 0, more.push, 0.0), axis=-1)
            stiff = np.sum(np.where(loads > 0, more.stiff, 0.0), axis=-1)
        return Linearised(residual, reach, self.levers - (1 - reach), carried, stiff, slope)

    def solved(self, at: Linearised, approach: Array, active: Booleans) -> tuple[Array, Array]:
        """As of ``MovingForces``."""
        jacobian = self.bulk + approach[..., None, None] * self.moves.roll
        jacobian = jacobian + at.own[..., None] * np.eye(active.shape[-1])
        both = active[..., :, None] & active[..., None, :]
        scale = np.abs(jacobian).max()
        matrix = np.where(both, jacobian / scale, np.eye(active.shape[-1]))
        sides = np.stack([np.where(active, at.reach, 0.0), np.where(active, at.residual, 0.0)], axis=-1)
        solved = np.linalg.solve(matrix, sides / scale)
        return solved[..., 0], solved[..., 1]

    def unloaded(self, loads: Array, approach: Array) -> Array:
        """As of ``MovingForces``."""
        clear = self.clear if self.film is None else self.clear - self.film.approach(np.zeros_like(loads))
        found = (self.bulk @ loads[..., None])[..., 0] + clear
        found += approach[..., None] * (self.moves.rolled(loads) - 1)
        return np.asarray(found if self.own is None else found + self.own.opened(approach[..., None]))


def moving_pairs(
    bulk: Array,
    laws: PairLaws,
    film: FilmLaw | None,
    gaps: Array,
    levers: Array,
    moves: ContactMoves,
    own: MovedFlanks | None = None,
) -> MovingPairs:
    """Put contacts that move together, arguments as for ``share_load``."""
    touchable = np.isfinite(gaps)
    return MovingPairs(bulk, laws, film, np.where(touchable, gaps, 0.0), touchable, levers, moves, own)


def moved_share(share: LoadShare, force: Array, pairs: MovingPairs) -> LoadShare | None:
    """Solve with moving contacts, from the solution without.

    Returns
    -------
    LoadShare or None
        None where Newton's method does not settle: the deflection is far beyond the first order.
    """
    whole = force + np.zeros_like(share.transmission_error)
    found = moved_forces(pairs, whole, share.forces, share.transmission_error)
    return None if found is None else replace(found, iterations=share.iterations + found.iterations)


def moved_places(moves: ContactMoves, force: Array, approach: Array) -> Array:
    """Growth of rho on pinion and wheel (2, ..., pairs) [m] under forces [N] and the deflection D (...) [m]."""
    on_path = np.diagonal(moves.roll, axis1=-2, axis2=-1) != 0
    roll = np.where(on_path, approach[..., None], 0.0)
    return np.stack([roll + moves.shift[0] * force, moves.shift[1] * force])


def model_error(
    moves: ContactMoves, force: Array, approach: Array, moving: bool, changed: Array | float = 0.0
) -> float:
    """Estimate what the model of the contacts leaves out, relative to the deflection, greatest over the positions.

    What Hencky's law would change, plus the square of what the moving contact changes to the first order; plus
    that itself where contacts stay.

    Parameters
    ----------
    moves : ContactMoves
    force : (..., pairs) array, or (cells, ..., pairs) array
        Of whole faces, at the line loads of the cells where there are any [N].
    approach : (...) array
        Deflection D [m].
    moving : bool
        Whether the contacts move in the solution.
    changed : (...) array, optional
        Part of D by which solutions with and without motion differ, where that is known.
    """
    every = (0, -1) if force.ndim > approach.ndim + 1 else -1
    part = force / force.sum(axis=every, keepdims=True)
    turn = np.sum(part * moves.rolled(force), axis=every)
    thrust, law = (np.sum(part * moves.thrust(force, k)[0], axis=every) / approach for k in (0, 1))
    change = np.maximum(np.abs(1.5 * turn - thrust), changed)
    whole = np.abs(law) + change**2 + (0.0 if moving else change)
    return float(np.max(whole))
