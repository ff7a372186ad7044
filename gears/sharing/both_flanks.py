"""How flanks on both sides of the teeth share a load, where backlash is small, nil or negative."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Booleans, Faults
from gears.sharing.load_sharing import DeflectionLaw, LoadShare
from gears.tooth.errors import LoadSharingError

__all__ = ["share_between"]

_PATH, _FINAL = 80, 40
"""Most steps along the central path, and of Newton's method on the flanks that bear."""

_CENTRED = 1e-12
"""Mean product of force and gap, over force times deflection, at which the flanks that bear are known."""

_STEP = 1e-12
"""Change of the forces, relative to their size, at which Newton's method ends."""

_ROUNDING = 1e-13
"""Overlap, relative to the deflections, that takes no pair in."""

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
    arms = side * (np.ones(clear.shape[-1:]) if levers is None else np.asarray(levers, dtype=float))
    _check(whole, stiff, clear, side)
    clear = clear + np.zeros_like(whole[..., None] + arms)
    touchable = np.isfinite(clear)
    problem = _Problem(stiff, local, film, np.where(touchable, clear, 0.0), side, arms, whole, touchable)
    if np.any((problem.whole == 0.0) & (problem.play >= 0.0)):
        allowed = "must not be 0 where the gaps leave backlash: no flank bears there"
        raise LoadSharingError.at("force", "0", allowed, "give a force, or gaps that overlap")
    loads, approach, steps = problem.central_path()
    return problem.finished(loads, approach, steps)


class _Problem:
    """One problem with all its leading dimensions."""

    def __init__(
        self,
        bulk: Array,
        local: DeflectionLaw,
        film: DeflectionLaw | None,
        clear: Array,
        side: Array,
        arms: Array,
        whole: Array,
        touchable: Booleans,
    ) -> None:
        self.bulk, self.local, self.film = bulk, local, film
        self.clear, self.side, self.arms, self.whole, self.touchable = clear, side, arms, whole, touchable
        self.eye = np.eye(clear.shape[-1])
        self.bears = touchable
        # a scale of the forces at every place: what is asked for, and what closes the gaps' overlap
        bent = np.where(touchable, np.diagonal(bulk, axis1=-2, axis2=-1) + 0.0 * clear, np.nan)
        least = np.nanmin(bent, axis=-1)
        at_zero = clear if film is None else clear - film.approach(np.zeros_like(clear))
        self.play = sum(
            np.min(np.where(touchable & (side == sign), at_zero, np.inf), axis=-1) for sign in (1.0, -1.0)
        )
        self.force = np.abs(whole) + np.maximum(-self.play, 0.0) / least
        self.force = np.where(self.force > 0.0, self.force, 1.0)
        slope = self._slope(np.broadcast_to(self.force[..., None], clear.shape))
        self.length = self.force * np.nanmin(np.where(touchable, bent + slope, np.nan), axis=-1)

    def _slope(self, loads: Array) -> Array:
        """Slope of what depends on a pair's own force."""
        slope = self.local.slope(loads)
        return np.asarray(slope if self.film is None else slope - self.film.slope(loads))

    def _gap(self, loads: Array, approach: Array) -> Array:
        """Gaps that are left, negative where flanks overlap."""
        bent = (self.bulk @ loads[..., None])[..., 0] + self.local.approach(loads) + self.clear
        if self.film is not None:
            bent = bent - self.film.approach(loads)
        return np.asarray(bent - self.side * approach[..., None])

    def _solved(self, slope: Array, residual: Array, chosen: Booleans) -> tuple[Array, Array]:
        """Answers of chosen forces to D and to residuals of their gaps."""
        coupled = chosen[..., :, None] & chosen[..., None, :]
        scale = np.abs(self.bulk).max()
        matrix = np.where(coupled, (self.bulk + slope[..., None] * self.eye) / scale, self.eye)
        turned = np.where(chosen, self.side, 0.0)
        sides = np.stack([turned, np.where(chosen, residual, 0.0)], axis=-1) / scale
        solved = np.linalg.solve(matrix, sides)
        return solved[..., 0], solved[..., 1]

    def _balanced(self, loads: Array, unit: Array, response: Array) -> Array:
        """Step of D with which the torques balance."""
        want = self.whole - (self.arms * (loads + response)).sum(axis=-1)
        return np.asarray(want / (self.arms * unit).sum(axis=-1))

    def central_path(self) -> tuple[Array, Array, int]:
        """Forces near the solution, all positive, and D."""
        touchable = self.touchable
        loads = np.where(touchable, self.force[..., None], 0.0)
        approach = np.zeros_like(self.whole + self.length)
        slack = np.where(touchable, np.maximum(self._gap(loads, approach), self.length[..., None]), 1.0)
        count = touchable.sum(axis=-1)
        size = self.force * self.length
        for steps in range(_PATH):
            centre = (np.where(touchable, loads * slack, 0.0).sum(axis=-1) / count)[..., None]
            wanting = self._gap(loads, approach) - slack
            self.bears = touchable & (loads / self.force[..., None] > slack / self.length[..., None])
            off = np.abs(np.where(touchable, wanting, 0.0)).max(axis=-1) / self.length
            if np.all(centre[..., 0] <= _CENTRED * size) and np.all(off <= 1e-9):
                return loads, approach, steps
            share = np.where(touchable, loads, 1.0)
            aim = np.where(touchable, 0.1 * centre / share - slack - wanting, 0.0)
            unit, response = self._solved(self._slope(share) + slack / share, aim, touchable)
            lift = self._balanced(loads, unit, response)
            change = unit * lift[..., None] + response
            opening = np.where(touchable, (0.1 * centre - slack * change) / share - slack, 0.0)
            with np.errstate(divide="ignore", invalid="ignore"):
                room = np.minimum(
                    np.where(touchable & (change < 0.0), -loads / change, np.inf).min(axis=-1),
                    np.where(touchable & (opening < 0.0), -slack / opening, np.inf).min(axis=-1),
                )
            part = np.minimum(1.0, _SHORTEN * room)
            loads = loads + part[..., None] * change
            slack = slack + part[..., None] * opening
            approach = approach + part * lift
        return loads, approach, _PATH

    def finished(self, loads: Array, approach: Array, steps: int) -> LoadShare:
        """Solution on the pairs that bear; one that pulls is released, one that overlaps is taken in."""
        active = self.bears
        loads = np.where(active, loads, 0.0)
        # local laws bend down: from a force that is too small Newton's method rises without overshooting
        small = np.broadcast_to(1e-9 * self.force[..., None], loads.shape)
        least = 1.0 / (np.diagonal(self.bulk, axis1=-2, axis2=-1) + self._slope(small))
        for step in range(1, _FINAL + 1):
            safe = np.where(active, np.maximum(loads, 1e-12 * self.force[..., None]), 1.0)
            held = np.where(active, loads, 0.0)
            unit, response = self._solved(self._slope(safe), -self._gap(held, approach), active)
            lift = self._balanced(held, unit, response)
            change = np.where(active, unit * lift[..., None] + response, 0.0)
            approach = approach + lift
            moved = held + change
            pulls = active & (moved <= 0.0)
            loads = np.where(pulls, 0.0, moved)
            overlap = self._gap(loads, approach)
            taken = self.touchable & ~active & (overlap < -_ROUNDING * self.length[..., None])
            settled = np.abs(change).max(axis=-1) <= _STEP * self.force
            released = pulls & (overlap >= 0.0)
            loads = np.where(pulls & ~released, 0.1 * held, loads)
            loads = np.where(taken, np.minimum(-overlap * least, 1e-3 * self.force[..., None]), loads)
            active = (active & ~released) | taken
            if settled.all() and not (pulls.any() or taken.any()):
                slopes = np.where(active, unit, 0.0)
                tangent = (self.arms * slopes).sum(axis=-1)
                return LoadShare(loads, approach, tangent, slopes, steps + step)
        allowed = (
            "must have deflections that grow with the force, and gaps that overlap where no force is given"
        )
        said = f"no solution after {steps + _FINAL} steps"
        raise LoadSharingError.at("share_between", said, allowed, "check bulk, laws and gaps")


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
