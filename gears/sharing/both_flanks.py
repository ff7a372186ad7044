"""How flanks on both sides of the teeth share a load, where backlash is small, nil or negative."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Faults
from gears.sharing.active_set import LoadShare, share_forces
from gears.sharing.central_path import central_path
from gears.sharing.load_coupling import DenseCoupling
from gears.sharing.staying_contacts import DeflectionLaw, StayingContacts
from gears.tooth.errors import LoadSharingError

__all__ = ["share_between"]


def share_between(
    force: float | Array,
    bulk: ArrayLike,
    local: DeflectionLaw,
    gaps: ArrayLike,
    sides: ArrayLike,
    film: DeflectionLaw | None = None,
    levers: ArrayLike | None = None,
    reach: ArrayLike | None = None,
) -> LoadShare:
    """Share a force among tooth pairs that bear on either side of the teeth.

    Find F_i >= 0 and D with sum s_i l_i F_i = F and, for every pair, s_i = 1 where D closes its gap and -1 where D
    opens it,

        g_i = sum_j bulk_ij F_j + local(F)_i - film_i(F_i) + gap_i - s_i c_i D >= 0,   F_i g_i = 0.

    With l_i = c_i this is the minimum of a convex energy under a unilateral constraint for each pair, and D the
    multiplier of the torque: the forces are unique. With gaps that overlap they exist without a force, and the
    solution is unique for either sign of F. An interior-point method follows the central path F_i g_i = mu down to
    where it shows which pairs bear; Newton's method ends on these. Leading dimensions as for `share_load`.

    Parameters
    ----------
    force : float or (...) array
        F, of any sign; 0 where the gaps overlap [N].
    bulk : (..., pairs, pairs) array
        Linear compliance, symmetric and positive semidefinite [m/N]; forces are those along the flanks' own normals.
    local : DeflectionLaw
        Local deflection of each pair, zero at zero force, with slope > 0.
    gaps : (..., pairs) array
        Gaps at D = 0, of any sign; inf for a pair that cannot touch [m].
    sides : (pairs,) array
        s_i, 1 or -1.
    film : DeflectionLaw or None
        As for `share_load`.
    levers : (..., pairs) array or None
        l_i > 0; c_i unless friction tilts the forces.
    reach : (..., pairs) array or None
        c_i > 0, as for `share_load`.

    Returns
    -------
    LoadShare
        Forces (none negative), D, tangent stiffness dF/dD, and dF_i/dD, negative on the side that D opens.

    Raises
    ------
    LoadSharingError
        If the input is malformed or no solution was found.

    Examples
    --------
    Two springs that are pressed together by 2 um, without a force from outside:

    >>> import numpy as np
    >>> class Nothing:
    ...     def approach(self, force):
    ...         return 0.0 * force
    ...
    ...     def slope(self, force):
    ...         return 0.0 * force
    >>> share = share_between(0.0, 2e-9 * np.eye(2), Nothing(), [0.0, -2e-6], [1, -1])
    >>> share.forces.round(6), float(share.transmission_error.round(12))
    (array([500., 500.]), 1e-06)
    """
    stiff, clear, side = np.asarray(bulk, float), np.asarray(gaps, float), np.asarray(sides, float)
    whole = np.asarray(force, dtype=float)
    closes = np.ones(clear.shape[-1:]) if reach is None else np.asarray(reach, dtype=float)
    arms = closes if levers is None else np.asarray(levers, dtype=float)
    _check(whole, stiff, clear, side)
    clear = clear + np.zeros_like(whole[..., None] + arms)
    contacts = StayingContacts(DenseCoupling(stiff), local, film, clear, side * closes, side * arms)
    play, size, length = _sizes(contacts, whole, stiff)
    if np.any((whole == 0.0) & (play >= 0.0)):
        allowed = "must not be 0 where the gaps leave backlash: no flank bears there"
        raise LoadSharingError.at("force", "0", allowed, "give a force, or gaps that overlap")
    loads, approach, steps = central_path(contacts, whole, size, length)
    share = share_forces(contacts, whole + np.zeros_like(approach), loads, approach)
    if share is None:
        allowed = (
            "must have deflections that grow with the force, and gaps that overlap where no force is given"
        )
        raise LoadSharingError.at("share_between", "no solution", allowed, "check bulk, laws and gaps")
    return replace(share, iterations=share.iterations + steps)


def _sizes(contacts: StayingContacts, whole: Array, bulk: Array) -> tuple[Array, Array, Array]:
    """Turn between the first touches of both sides [m], and sizes of forces [N] and gaps [m] at each position (...).

    Of what is asked for, and of what closes the gaps' overlap.
    """
    touchable, gaps, reach = contacts.touchable, contacts.at_zero, contacts.reach
    diagonal = np.diagonal(bulk, axis1=-2, axis2=-1)
    bent = np.where(touchable, diagonal + np.zeros_like(gaps), np.nan)
    touches = gaps / np.abs(reach)
    first = (
        np.min(touches, axis=-1, where=touchable & (sign * reach > 0.0), initial=np.inf) for sign in (1, -1)
    )
    play = np.asarray(sum(first))
    force = np.abs(whole) + np.maximum(-play, 0.0) / np.nanmin(bent, axis=-1)
    force = np.where(force > 0.0, force, 1.0)
    slope = contacts.laws(np.broadcast_to(force[..., None], gaps.shape))[1]
    length = force * np.nanmin(np.where(touchable, bent + slope, np.nan), axis=-1)
    return play, force, length


def _check(force: Array, bulk: Array, gaps: Array, sides: Array) -> None:
    """Refuse malformed input, all faults at once."""
    pairs = gaps.shape[-1:]
    with Faults(LoadSharingError) as faults:
        if not np.all(np.isfinite(force)):
            faults.add("force", str(force), "must be finite", "give the force in newtons")
        if bulk.shape[-2:] != 2 * pairs or sides.shape != pairs:
            shapes = f"bulk {bulk.shape}, gaps {gaps.shape}, sides {sides.shape}"
            allowed = "must be (..., pairs, pairs), (..., pairs) and (pairs,)"
            faults.add("bulk, gaps, sides", shapes, allowed, "give one row for each pair")
        elif not np.all(np.abs(sides) == 1.0):
            faults.add("sides", str(sides), "must be 1 or -1", "1 where D closes the gap")
        if np.any(np.isnan(gaps)) or not np.all(np.isfinite(gaps).any(axis=-1)):
            faults.add("gaps", "nan, or inf for all pairs", "must hold a finite gap", "one pair must touch")
        if not np.all(np.isfinite(bulk)):
            faults.add("bulk", "not finite", "must be finite", "check the compliance matrix")
