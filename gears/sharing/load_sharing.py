"""How coupled tooth pairs in mesh share the load that one side of the teeth bears."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Faults
from gears.sharing.active_set import LoadShare, share_forces
from gears.sharing.load_coupling import DenseCoupling
from gears.sharing.staying_contacts import DeflectionLaw, StayingContacts
from gears.tooth.errors import LoadSharingError

__all__ = ["share_load"]


def share_load(
    force: float | Array,
    bulk: ArrayLike,
    hertz: DeflectionLaw,
    gaps: ArrayLike,
    film: DeflectionLaw | None = None,
    levers: ArrayLike | None = None,
    reach: ArrayLike | None = None,
) -> LoadShare:
    """Share a force among coupled tooth pairs.

    Find F_i >= 0 and D with sum l_i F_i = F and, for every pair,

        g_i = sum_j bulk_ij F_j + hertz(F)_i - s_i(F_i) + gap_i - c_i D >= 0,   F_i g_i = 0.

    With l_i = c_i this is the minimum of a convex energy, so the solution is unique. Newton's method
    (``gears.sharing.active_set``) begins with the pair that has the smallest gap. Leading
    dimensions are torques, mesh positions and so on, all solved together; arguments need only have those that they
    depend on.

    Parameters
    ----------
    force : float or (...) array
        F, sum of the normal forces, all above 0 or all 0 [N].
    bulk : (..., pairs, pairs) array
        Linear compliance of teeth and bodies, symmetric and positive semidefinite [m/N].
    hertz : DeflectionLaw
        Local deflection of each pair, zero at zero force, with slope > 0.
    gaps : (..., pairs) array
        Clearances left when the gears touch unloaded, >= 0; inf for a pair that cannot touch [m].
    film : DeflectionLaw or None
        s_i(F_i) >= 0, what an oil film props the flanks apart, finite at zero force, with slope <= 0; None is
        dry.
    levers : (..., pairs) array or None
        l_i > 0, lever arms of the forces over that for which F is given; c_i unless friction tilts them.
    reach : (..., pairs) array or None
        c_i > 0, lever arms of the flanks' normals over the same, by which a turn closes their gaps; 1 on the line of
        action.

    Returns
    -------
    LoadShare
        Forces, transmission error and tangent stiffness, for zero force the stiffness at first touch.

    Raises
    ------
    LoadSharingError
        If the input is malformed or no solution was found.

    Notes
    -----
    Differentiating g_i = 0 over the pairs in contact gives J dF/dD = c with J = bulk + diag(hertz' - s'), so
    the tangent is l^T J^-1 c.

    Examples
    --------
    Two pairs on springs, the second 2 um away when the first touches:

    >>> class NoHertz:
    ...     def approach(self, force):
    ...         return 0.0 * force
    ...
    ...     def slope(self, force):
    ...         return 0.0 * force
    >>> share_load(1e4, [[2e-9, 0.0], [0.0, 2e-9]], NoHertz(), gaps=[0.0, 2e-6]).forces
    array([5500., 4500.])
    """
    stiff = np.asarray(bulk, dtype=float)
    clear = np.asarray(gaps, dtype=float)
    whole = np.asarray(force, dtype=float)
    closes = np.ones(clear.shape[-1:]) if reach is None else np.asarray(reach, dtype=float)
    arms = closes if levers is None else np.asarray(levers, dtype=float)
    _check(whole, stiff, clear, arms, closes)
    each = whole[..., None]
    clear = clear + np.zeros_like(each + arms)
    problem = StayingContacts(DenseCoupling(stiff), hertz, film, clear, closes, arms)
    touches = _finite(problem.at_zero) / closes
    if not whole.any():
        return _first_touch(problem, stiff)
    first = np.arange(clear.shape[-1]) == touches.argmin(axis=-1)[..., None]
    loads, approach = np.where(first, each / arms, 0.0), touches.min(axis=-1)
    share = share_forces(problem, whole + np.zeros_like(approach), loads, approach)
    if share is None:
        remedy = "check that bulk is positive semidefinite, hertz has a positive and film a negative slope"
        allowed = "must have deflections that grow with the force"
        raise LoadSharingError.at("share_load", "no solution", allowed, remedy)
    return share


def _first_touch(problem: StayingContacts, bulk: Array) -> LoadShare:
    """Share at zero force: the approach at which the first pair touches, and the stiffness there."""
    touches = problem.at_zero / problem.reach
    nothing = np.zeros_like(touches)
    compliance = np.diagonal(bulk, axis1=-2, axis2=-1) + problem.laws(nothing)[1]
    first = np.arange(touches.shape[-1]) == touches.argmin(axis=-1)[..., None]
    slopes = np.where(first, problem.reach / (compliance + nothing), 0.0)
    return LoadShare(nothing, touches.min(axis=-1), (problem.lever_ratios * slopes).sum(axis=-1), slopes, 0)


def _finite(at_zero: Array) -> Array:
    """Refuse a film that grows without bound as the force falls; every pair would carry on it."""
    if np.any(np.isnan(at_zero) | np.isneginf(at_zero)):
        remedy = "bound the film's thickness as the force goes to zero"
        raise LoadSharingError.at("film", "not finite at zero force", "must have a finite thickness", remedy)
    return at_zero


def _fit(*shapes: tuple[int, ...]) -> bool:
    """Whether leading dimensions agree, those of length 1 counted as any."""
    try:
        np.broadcast_shapes(*shapes)
    except ValueError:
        return False
    return True


def _check(force: Array, bulk: Array, gaps: Array, levers: Array, reach: Array) -> None:
    """Refuse malformed input, all faults at once."""
    pairs = gaps.shape[-1:]
    with Faults(LoadSharingError) as faults:
        if not (np.all(np.isfinite(force)) and (np.all(force > 0.0) or not force.any())):
            allowed = "must be finite, all above 0 N or all 0 N"
            faults.add("force", str(force), allowed, "give the forces' sizes")
        if not (
            gaps.ndim >= 1
            and pairs > (0,)
            and bulk.shape[-2:] == 2 * pairs
            and levers.shape[-1:] == reach.shape[-1:] == pairs
        ) or not _fit(force.shape, bulk.shape[:-2], gaps.shape[:-1], levers.shape[:-1], reach.shape[:-1]):
            shapes = f"bulk {bulk.shape}, gaps {gaps.shape}"
            allowed = "must be (..., pairs, pairs) and (..., pairs)"
            faults.add("bulk, gaps", shapes, allowed, "give one row for each pair")
        if not np.all(gaps >= 0.0):
            remedy = "measure from the pair that touches"
            faults.add("gaps", "negative or not a number", "must be at least 0 m, or inf", remedy)
        elif gaps.ndim and not np.all(np.isfinite(gaps).any(axis=-1)):
            faults.add("gaps", "inf for all pairs", "must hold a finite gap", "one pair at least must touch")
        if not np.all((levers > 0.0) & np.isfinite(levers)):
            remedy = "reduce the friction, which tilts a force past the axis"
            faults.add("levers", "not above 0", "must be finite and more than 0", remedy)
        if not np.all((reach > 0.0) & np.isfinite(reach)):
            remedy = "leave out pairs whose gap no turn closes"
            faults.add("reach", "not above 0", "must be finite and more than 0", remedy)
        if not np.all(np.isfinite(bulk)):
            faults.add("bulk", "not finite", "must be finite", "check the compliance matrix")
