"""How flanks on both sides of the teeth share a load, where backlash is small, nil or negative."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Booleans, Faults, record
from gears.sharing.active_set import LoadShare, share_forces
from gears.sharing.load_coupling import DenseCoupling
from gears.sharing.staying_contacts import DeflectionLaw, StayingContacts
from gears.tooth.errors import LoadSharingError

__all__ = ["share_between"]

_PATH = 80
"""Most steps along the central path."""

_CENTRED = 1e-12
"""Mean product of force and gap, over force times deflection, at which the flanks that bear are known."""

_OPEN = 1e-9
"""Part of the gaps' size by which they may differ from their place on the path at its end."""

_SHORTEN = 0.9
"""Part of the way to the nearest bound that a step takes."""


def share_between(
    force: float | Array,
    bulk: ArrayLike,
    local: DeflectionLaw,
    gaps: ArrayLike,
    sides: ArrayLike,
    film: DeflectionLaw | None = None,
    levers: ArrayLike | None = None,
) -> LoadShare:
    """Share a force among tooth pairs that bear on either side of the teeth.

    Find F_i >= 0 and D with sum s_i l_i F_i = F and, for every pair, s_i = 1 where D closes its gap and -1 where D
    opens it,

        g_i = sum_j bulk_ij F_j + local(F)_i - film_i(F_i) + gap_i - s_i D >= 0,   F_i g_i = 0.

    With l_i = 1 this is the minimum of a convex energy under a unilateral constraint for each pair, and D the
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
        l_i > 0; 1 unless friction tilts the forces.

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
    arms = np.ones(clear.shape[-1:]) if levers is None else np.asarray(levers, dtype=float)
    _check(whole, stiff, clear, side)
    clear = clear + np.zeros_like(whole[..., None] + arms)
    contacts = StayingContacts(DenseCoupling(stiff), local, film, clear, arms, side)
    path = _CentralPath.of(contacts, whole, stiff)
    if np.any((whole == 0.0) & (path.play >= 0.0)):
        allowed = "must not be 0 where the gaps leave backlash: no flank bears there"
        raise LoadSharingError.at("force", "0", allowed, "give a force, or gaps that overlap")
    loads, approach, steps = path.followed()
    share = share_forces(contacts, whole + np.zeros_like(approach), loads, approach)
    if share is None:
        allowed = (
            "must have deflections that grow with the force, and gaps that overlap where no force is given"
        )
        raise LoadSharingError.at("share_between", "no solution", allowed, "check bulk, laws and gaps")
    return replace(share, iterations=share.iterations + steps)


@record
class _CentralPath:
    """The central path of all positions.

    Attributes
    ----------
    contacts : StayingContacts
    whole : (...) array
        Torque over the base radius [N].
    play : (...) array
        Turn between the first touches of both sides [m].
    force, length : (...) arrays
        Size of forces and gaps: what is asked for, and what closes the gaps' overlap [N], [m].
    """

    contacts: StayingContacts
    whole: Array
    play: Array
    force: Array
    length: Array

    @classmethod
    def of(cls, contacts: StayingContacts, whole: Array, bulk: Array) -> _CentralPath:
        """Path of contacts with a linear compliance under a torque."""
        touchable, gaps, side = contacts.touchable, contacts.at_zero, contacts.side
        diagonal = np.diagonal(bulk, axis1=-2, axis2=-1)
        bent = np.where(touchable, diagonal + np.zeros_like(gaps), np.nan)
        first = (np.min(np.where(touchable & (side == sign), gaps, np.inf), axis=-1) for sign in (1.0, -1.0))
        play = np.asarray(sum(first))
        force = np.abs(whole) + np.maximum(-play, 0.0) / np.nanmin(bent, axis=-1)
        force = np.where(force > 0.0, force, 1.0)
        slope = contacts.laws(np.broadcast_to(force[..., None], gaps.shape))[1]
        length = force * np.nanmin(np.where(touchable, bent + slope, np.nan), axis=-1)
        return cls(contacts, whole, play, force, length)

    def followed(self) -> tuple[Array, Array, int]:
        """Forces near the solution on the flanks that bear, zero on the others, D, and the steps."""
        contacts, touchable, wanted = self.contacts, self.contacts.touchable, np.ones(self.play.shape, bool)
        loads = np.where(touchable, self.force[..., None], 0.0)
        approach, count, size = np.zeros_like(self.length), touchable.sum(axis=-1), self.force * self.length
        at = contacts.linearised(loads, approach, contacts.bent(loads, wanted, None))
        slack = np.where(touchable, np.maximum(at.residual, self.length[..., None]), 1.0)
        steps = 0
        while steps < _PATH:
            centre = (np.where(touchable, loads * slack, 0.0).sum(axis=-1) / count)[..., None]
            wanting = np.where(touchable, at.residual - slack, 0.0)
            off = np.abs(wanting).max(axis=-1) / self.length
            if np.all(centre[..., 0] <= _CENTRED * size) and np.all(off <= _OPEN):
                break
            share = np.where(touchable, loads, 1.0)
            aim = slack + wanting - 0.1 * centre / share
            unit, response = at.jacobian.solved(at.own + slack / share, at.reach, aim, touchable, wanted)
            total = np.sum(at.further_lever_ratios * unit, axis=-1)
            lift = (self.whole - at.carried + np.sum(at.further_lever_ratios * response, axis=-1)) / total
            change = unit * lift[..., None] - response
            opening = np.where(touchable, (0.1 * centre - slack * change) / share - slack, 0.0)
            bounds = _room(loads, change, touchable), _room(slack, opening, touchable)
            part = np.minimum(1.0, _SHORTEN * np.minimum(*bounds))
            loads = loads + part[..., None] * change
            slack = slack + part[..., None] * opening
            approach, steps = approach + part * lift, steps + 1
            at = contacts.linearised(loads, approach, contacts.bent(loads, wanted, None))
        bears = touchable & (loads / self.force[..., None] > slack / self.length[..., None])
        return np.where(bears, loads, 0.0), approach, steps


def _room(values: Array, change: Array, touchable: Booleans) -> Array:
    """How much of a change takes the first of positive values to zero (...)."""
    falls = touchable & (change < 0.0)
    return np.asarray(np.where(falls, -values / np.where(falls, change, 1.0), np.inf).min(axis=-1))


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
