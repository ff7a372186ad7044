"""Contact that moves under load: the first order in the deflection over the module.

The position is that of the wheel, held; the pinion takes up the deflection D, so that its flank has rolled on by D
when it bears: x_1 = x_2 + D on the line of action. A turned involute is a parallel curve, so this is exact. With
U*(F; x_1, x_2) = (1/2) F.B F + sum Int Hertz dF - sum U_3, the complementary energy of the forces at these places,

    D = dU*/dF_i + gap_i,     T/r_b1 = sum l_i F_i - dU*/dx_1,

where U_3 is the third-order energy of a contact (``flank_motion``). To the first order in D, with B' = dB/dx_1,

    D = (B F)_i + Hertz_i + gap_i + D (B' F)_i - U_3'(F_i),     T/r_b1 = sum_i [l_i - (B' F)_i/2] F_i,

Hertz's share of B' among it: R grows as the pinion's flank rolls on. The wheel turned back instead, with the pinion
held, is the same state named by another position: its stiffness is that of the pinion turned at x - D. Contacts
of tip edges keep their places, gaps (tip relief too) are read there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.elasticity.flamant import hertz_half_width
from fem.elasticity.nonlinear_energy import half_plane, large_strain

if TYPE_CHECKING:
    from fem.elasticity.plane_elasticity import PlaneElasticity
    from fem.laws.contact_candidates import ContactCandidates
    from fem.pair.pair_compliance import PairCompliance
    from gears import GearPair

__all__ = [
    "ContactMoves",
    "contact_moves",
    "contacts_move",
    "left_out",
    "model_error",
    "moved_places",
]

SPREAD = 2.0
"""How often the curved answer of the teeth over a contact's width is counted for all that its width leaves out."""

BESIDE = 0.16
"""Distance from the corner [modules] within which this stays the same."""

COMPLIANT = 30e9
"""Young's modulus below which contacts move unless it is said [Pa]: plastics, not metals."""


def contacts_move(pair: GearPair, asked: bool | None) -> bool:
    """Whether contacts on the path move under load: the one default of `moving_contact`, by the softer material.

    With metals their motion changes the stiffness by 0.1 %, no more than the law of the material leaves open, and what
    corners of the tips do just inside the path counts for more, which only contacts that stay have; with a plastic
    gear it is 1 to 5 %.

    Parameters
    ----------
    pair : gears.GearPair
    asked : bool or None
        What was asked for; None decides by the material: plastics move, metals stay.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> contacts_move(pair, None), contacts_move(pair, True)
    (False, True)
    """
    return min(material.youngs_modulus for material in pair.materials) < COMPLIANT if asked is None else asked


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
    slide, spread : (..., pairs) arrays
        What Hertz's law at a held place leaves out of D over the force's square (`_of_the_width`) [m/N^2].
    """

    roll: Array
    cubic: Array
    local: Array
    shift: Array
    slide: Array
    spread: Array

    def thrust(self, force: Array, law: int = 0) -> tuple[Array, Array]:
        """U_3'(F) [m] and U_3''(F) [m/N], or what Hencky's law adds."""
        root = np.sqrt(np.maximum(force, 0.0))
        first = 3 * self.cubic[law] * force**2 + 2.5 * self.local[law] * root**3
        return first, 6 * self.cubic[law] * force + 3.75 * self.local[law] * root

    def rolled(self, force: Array) -> Array:
        """B' F (..., pairs)."""
        return np.asarray((self.roll @ force[..., None])[..., 0])


def contact_moves(
    bodies: PairCompliance, candidates: ContactCandidates, corners: bool = False
) -> ContactMoves:
    """Moves of the contacts of a pair at all positions.

    With ``corners`` those of tip edges too, with energies of the flanks' ends, and B' without the flanks' own part
    (``fem.contact.moving_corners``).
    """
    pair, width = bodies.pair, bodies.pair.face_width
    flat = candidates.touchable & ~candidates.edge
    on_path = candidates.touchable if corners else flat
    gears, radii = (bodies.pinion, bodies.wheel), pair.base_radii
    rho = np.where(on_path, candidates.rho, 0.5 * pair.line_of_action)
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
    roll, held = np.zeros((*on_path.shape, on_path.shape[-1])), _of_the_width(bodies, rho, tilt, along, a)
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
        *(np.where(flat, width_term, 0.0) / width**2 for width_term in held),
    )


def _of_the_width(
    bodies: PairCompliance, rho: Array, tilt: list[Array], along: list[Array], half_width: Array
) -> tuple[Array, Array]:
    """What Hertz's law at a held place leaves out of D, over the line load's square [m per (N/m)^2].

    A pressure that is resolved slides by itself to where the teeth are stiffer, even with normals and levers of the
    undeformed flanks: with K' = 2 (tau_1 - tau_2 - t_2/R) along the pinion's normals, by R K' w/2, which takes
    (3/8) R K'^2 w^2 from D; along the wheel's normals it has t_1 for -t_2. The greater one is given. Over its width
    the teeth's answer curves, by K'' a^2 w/8, of which ``SPREAD`` times as much holds what is left in resolved
    contacts, but for a fifth of what they slide (docs/validation/local_law.md).
    """
    radius = rho[0] * rho[1] / (rho[0] + rho[1])
    leaning = [tilt[0] - tilt[1] - along[1] / radius, tilt[0] - tilt[1] + along[0] / radius]
    slide, curved = 1.5 * radius * np.maximum(leaning[0] ** 2, leaning[1] ** 2), np.zeros_like(radius)
    for gear, place, base in zip((bodies.pinion, bodies.wheel), rho, bodies.pair.base_radii, strict=True):
        # nearer to the corner the law is that of strips, if any
        last = np.sqrt(max(gear.rho_end**2 - 2 * base * BESIDE * gear.module, 0.0))
        at = np.minimum(place, last)
        curved = curved + (base / at) ** 2 * (gear.own_bend(at) - gear.own_slope(at) / at)
    return slide, SPREAD * np.abs(curved) * half_width**2 / 8


def _energies(parts: Array, law: PlaneElasticity) -> Array:
    """Third-order energies (2, ...): St. Venant and Kirchhoff's, and what Hencky's law adds to it."""
    return np.stack([parts[0], large_strain(parts, law)])


def moved_places(moves: ContactMoves, force: Array, approach: Array) -> Array:
    """Growth of rho on pinion and wheel (2, ..., pairs) [m] under forces [N] and the deflection D (...) [m]."""
    on_path = np.diagonal(moves.roll, axis1=-2, axis2=-1) != 0
    roll = np.where(on_path, approach[..., None], 0.0)
    return np.stack([roll + moves.shift[0] * force, moves.shift[1] * force])


def model_error(
    moves: ContactMoves, force: Array, approach: Array, moving: bool, changed: Array | float = 0.0
) -> float:
    """Estimate what the model of the contacts leaves out, relative to the deflection, largest over the positions.

    Arguments as of ``left_out``.
    """
    return float(np.max(left_out(moves, force, approach, moving, changed)))


def left_out(
    moves: ContactMoves, force: Array, approach: Array, moving: bool, changed: Array | float = 0.0
) -> Array:
    """Estimate what the model of the contacts leaves out, relative to the deflection (...).

    What Hencky's law would change, and what the width of contacts leaves out of Hertz's law, plus the square of what
    the moving contact changes to the first order; plus that itself where contacts stay, or what a resolved pressure
    takes from D by sliding, if that is more.

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
    axes = (0, -1) if force.ndim > approach.ndim + 1 else -1
    part = force / force.sum(axis=axes, keepdims=True)
    turn = np.sum(part * moves.rolled(force), axis=axes)
    thrust, law = (np.sum(part * moves.thrust(force, k)[0], axis=axes) / approach for k in (0, 1))
    change = np.maximum(np.abs(1.5 * turn - thrust), changed)
    slide, wide = (
        np.sum(part * coefficient * force**2, axis=axes) / approach
        for coefficient in (moves.slide, moves.spread)
    )
    return np.asarray(np.abs(law) + wide + change**2 + (0.0 if moving else np.maximum(change, slide)))
