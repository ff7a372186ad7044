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
from fem.third_order import half_plane, large_strain

if TYPE_CHECKING:
    from fem.bodies import Compliance
    from fem.contact_candidates import ContactCandidates
    from fem.elasticity import PlaneElasticity
    from fem.local_law import PairLaws
    from fem.moving_corners import MovedFlanks
    from gears import LoadShare
    from gears.load_sharing import DeflectionLaw

__all__ = ["ContactMoves", "contact_moves", "model_error", "moved_places", "moved_share"]

ITERATIONS = 100
CLOSE = 1e-11
"""Change of forces, relative to the whole, at which Newton's method ends."""

ROUNDING = 1e-13
"""Overlap, relative to the deflection, that takes no pair in."""


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


def moved_share(
    share: LoadShare,
    force: Array,
    bulk: Array,
    laws: PairLaws,
    gaps: Array,
    film: DeflectionLaw | None,
    levers: Array,
    moves: ContactMoves,
    own: MovedFlanks | None = None,
) -> LoadShare | None:
    """Solve with moving contacts, from the solution without; arguments as for ``share_load``.

    With what the pinion's own flanks and corners yield (``fem.moving_corners``).

    Returns
    -------
    LoadShare or None
        None where Newton's method does not settle: the deflection is far beyond the first order.
    """
    whole = force + np.zeros_like(share.transmission_error)
    touchable = np.isfinite(gaps) & np.ones_like(share.forces, dtype=bool)
    clear = np.where(touchable, gaps, 0.0)
    at_zero = clear if film is None else clear - film.approach(np.zeros_like(share.forces))
    active, loads, approach = share.forces > 0, share.forces, share.transmission_error
    start = np.full(loads.shape, 1e-2)
    for iteration in range(1, ITERATIONS + 1):
        residual, jacobian, reach = _linearised(bulk, laws, film, clear, moves, loads, approach)
        carried, stiff = np.sum((levers - 0.5 * (1 - reach)) * loads, axis=-1), 0.0
        if own is not None:
            more = own.pushed(loads, approach)
            residual, reach = residual + more.approach, reach - more.less
            jacobian = jacobian + more.slope[..., None] * np.eye(loads.shape[-1])
            carried = carried - np.sum(np.where(active, more.push, 0.0), axis=-1)
            stiff = np.sum(np.where(active, more.stiff, 0.0), axis=-1)
        arms = levers - (1 - reach)
        unit, response = _solved(jacobian, reach, residual, active)
        tangent = np.sum(arms * unit, axis=-1) - stiff
        lift = (whole - carried + np.sum(arms * response, axis=-1)) / tangent
        step = np.where(active, unit * lift[..., None] - response, 0.0)
        moved = loads + step
        negative = active & (moved <= 0)
        kept = np.where(negative, 0.0, moved)
        approach = approach + lift
        # as in ``share_load``: a pair is released if it stands clear without force, else it keeps a part of it; one
        # that comes back is taken in with less
        unloaded = (bulk @ kept[..., None])[..., 0] + at_zero
        unloaded += approach[..., None] * (moves.rolled(kept) - 1)
        if own is not None:
            unloaded += own.opened(approach)
        released = negative & (unloaded >= 0)
        taken = touchable & ~active & (unloaded < -ROUNDING * np.abs(approach)[..., None])
        settled = np.all(np.abs(step) <= CLOSE * whole[..., None])
        loads = np.where(negative & ~released, 0.1 * loads, kept)
        loads = np.where(taken, start * whole[..., None], loads)
        start = np.where(taken, 0.1 * start, start)
        active = (active & ~released) | taken
        if not (np.all(np.isfinite(loads)) and np.all(tangent > 0)):
            return None
        if settled and not (np.any(negative) or np.any(taken)):
            per_pair = np.where(active, unit, 0.0)
            return replace(
                share,
                forces=loads,
                transmission_error=approach,
                stiffness=tangent,
                pair_stiffness=per_pair,
                iterations=share.iterations + iteration,
            )
    return None


def _linearised(
    bulk: Array,
    laws: PairLaws,
    film: DeflectionLaw | None,
    clear: Array,
    moves: ContactMoves,
    loads: Array,
    approach: Array,
) -> tuple[Array, Array, Array]:
    """Overlap wanting (..., n), its slopes by the forces (..., n, n) and, with the sign turned, by D (..., n)."""
    rolled, (thrust, stiffened) = moves.rolled(loads), moves.thrust(loads)
    residual = (bulk @ loads[..., None])[..., 0] + laws.approach(loads) + clear - thrust
    residual += approach[..., None] * (rolled - 1)
    slope = laws.slope(loads) - stiffened
    if film is not None:
        residual, slope = residual - film.approach(loads), slope - film.slope(loads)
    slope = np.where(loads > 0, slope, 1.0)
    jacobian = bulk + approach[..., None, None] * moves.roll + slope[..., None] * np.eye(loads.shape[-1])
    return residual, jacobian, 1 - rolled


def _solved(jacobian: Array, reach: Array, residual: Array, active: Booleans) -> tuple[Array, Array]:
    """Answers of the forces in contact to the turn and to the residual."""
    both = active[..., :, None] & active[..., None, :]
    scale = np.abs(jacobian).max()
    matrix = np.where(both, jacobian / scale, np.eye(active.shape[-1]))
    sides = np.stack([np.where(active, reach, 0.0), np.where(active, residual, 0.0)], axis=-1) / scale
    solved = np.linalg.solve(matrix, sides)
    return solved[..., 0], solved[..., 1]


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
    force : (..., pairs) array
        [N]
    approach : (...) array
        Deflection D [m].
    moving : bool
        Whether the contacts move in the solution.
    changed : (...) array, optional
        Part of D by which solutions with and without motion differ, where that is known.
    """
    part = force / force.sum(axis=-1, keepdims=True)
    turn = np.sum(part * moves.rolled(force), axis=-1)
    thrust, law = (np.sum(part * moves.thrust(force, k)[0], axis=-1) / approach for k in (0, 1))
    change = np.maximum(np.abs(1.5 * turn - thrust), changed)
    whole = np.abs(law) + change**2 + (0.0 if moving else change)
    return float(np.max(whole))
