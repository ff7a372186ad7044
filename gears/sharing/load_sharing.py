"""How coupled tooth pairs in mesh share the load, by Newton's method."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Booleans, Faults, quantity, record
from gears.sharing.load_coupling import Coupling, DenseCoupling
from gears.tooth.errors import LoadSharingError

_ITERATIONS = 200
_STEP = 1e-11  # relative to the force; Newton's next step is of the order of its square
_NEAR = 1e-7  # part of each force: a step so small is the last where the next will be below the bound
_ROUNDING = 1e-14  # of deflections, relative to their size
_BACKOFF = 0.1  # part of a pair's force that is kept when a step would make it negative


Asked = Callable[[Array], tuple[Array, Array]]
"""Deflection and slope by forces."""


class DeflectionLaw(Protocol):
    """A deflection of each pair that depends on its own force only."""

    def approach(self, force: Array) -> Array:
        """Deflection, or for a film what it props the bodies apart, (..., pairs) [m]."""

    def slope(self, force: Array) -> Array:
        """Its derivative to the force, (..., pairs) [m/N]; infinite at zero force is allowed."""


@runtime_checkable
class JointLaw(DeflectionLaw, Protocol):
    """A law whose deflection and slope cost less together."""

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Deflection [m] and its derivative [m/N], (..., pairs)."""


@record
class LoadShare:
    """Forces of the tooth pairs at one mesh position, or at several."""

    no_error = "rounding of the iteration; that of the compliance is not known here"

    forces: Array = quantity("N", "normal forces F_i, zero where a pair does not touch", "... pair")
    transmission_error: Array = quantity(
        "m", "common approach D of the gears along the line of action", "...", shown="um"
    )
    stiffness: Array = quantity("N/m", "tangent dF/dD for the pairs in contact", "...")
    pair_stiffness: Array = quantity(
        "N/m", "slope dF_i/dD of each pair's force, zero where unloaded", "... pair"
    )
    iterations: int = quantity("1", "Newton steps")

    headline = ("transmission_error", "stiffness", "iterations")


def share_load(
    force: float | Array,
    bulk: ArrayLike | Coupling,
    hertz: DeflectionLaw,
    gaps: ArrayLike,
    film: DeflectionLaw | None = None,
    levers: ArrayLike | None = None,
    near: Array | None = None,
) -> LoadShare:
    """Share a force among coupled tooth pairs.

    Find F_i >= 0 and D with sum l_i F_i = F and, for every pair,

        g_i = sum_j bulk_ij F_j + hertz(F)_i - s_i(F_i) + gap_i - D >= 0,   F_i g_i = 0.

    With l_i = 1 this is the minimum of a convex energy, so the solution is unique. Newton's method runs on the pairs in
    contact, at first the one with the smallest gap; a pair that would overlap is taken in with a small force.
    hertz is concave, so from too small a force Newton rises monotonically; a step that would make a force
    negative releases the pair only if it stands clear at zero force, else keeps a tenth of the force. A pair that
    comes back is taken in with a tenth of what it had: about to touch, it bears less than any start would leave it.
    Leading dimensions are torques, mesh positions and so on, all solved together; arguments need only have
    those that they depend on.

    Parameters
    ----------
    force : float or (...) array
        F, sum of the normal forces, all above 0 or all 0 [N].
    bulk : (..., pairs, pairs) array, or Coupling
        Linear compliance of teeth and bodies, symmetric and positive semidefinite [m/N].
    hertz : DeflectionLaw
        Local deflection of each pair, zero at zero force, with slope > 0.
    gaps : (..., pairs) array
        Clearances left when the gears touch unloaded, >= 0; inf for a pair that cannot touch [m].
    film : DeflectionLaw or None
        s_i(F_i) >= 0, what an oil film props the flanks apart, finite at zero force, with slope <= 0; None is
        dry.
    levers : (..., pairs) array or None
        l_i > 0, lever arms of the forces over that for which F is given; 1 unless friction tilts them.
    near : (..., pairs) array or None
        Forces to begin with, such as those of a similar load; one at least is above 0 everywhere.

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
    Differentiating g_i = 0 over the pairs in contact gives J dF/dD = 1 with J = bulk + diag(hertz' - s'), so
    the tangent is l^T J^-1 1.

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
    stiff = bulk if isinstance(bulk, Coupling) else DenseCoupling(np.asarray(bulk, dtype=float))
    clear = np.asarray(gaps, dtype=float)
    whole = np.asarray(force, dtype=float)
    arms = np.ones(clear.shape[-1:]) if levers is None else np.asarray(levers, dtype=float)
    _check(whole, stiff, clear, arms)
    each = whole[..., None]
    clear = clear + np.zeros_like(each + arms)
    touchable = np.isfinite(clear)
    nothing = np.zeros_like(clear)
    at_zero = clear if film is None else clear - _finite(film.approach(nothing))
    if not whole.any():
        return _first_touch(stiff, hertz, film, at_zero, arms)
    clear = np.where(touchable, clear, 0.0)
    active = np.arange(clear.shape[-1]) == at_zero.argmin(axis=-1)[..., None]
    start = np.full(clear.shape, stiff.start)
    loads, approach = np.where(active, each / arms, 0.0), at_zero.min(axis=-1)
    if near is not None:
        loads = near + nothing
        active = loads > 0.0
    everywhere = np.ones(clear.shape[:-1], dtype=bool)
    wanted, slopes, bent = everywhere, nothing, stiff.applied(loads, everywhere, nothing)
    laws = _asked(hertz), None if film is None else _asked(film)
    before = np.zeros(clear.shape[:-1])
    if near is not None:
        deflection = _linearise(bent, *laws, clear, loads)[1]
        approach = np.mean(deflection, axis=-1, where=active)
    for iteration in range(1, _ITERATIONS + 1):
        slope, deflection = _linearise(bent, *laws, clear, loads)
        overlap = deflection - approach[..., None]
        step, lift, new = _newton_step(stiff, slope, overlap, loads, active, wanted, whole, arms)
        slopes = np.where(wanted[..., None], new, slopes)
        tangent = (arms * slopes).sum(axis=-1)
        approach = approach + lift
        moved = np.where(active, loads + step, 0.0)
        negative = active & (moved <= 0.0)
        kept = np.where(negative, 0.0, moved)
        bent = stiff.applied(kept, wanted, bent)
        unloaded = bent + at_zero - approach[..., None]
        size = np.abs(deflection).max(where=active, initial=0.0, axis=-1) + np.abs(approach)
        released = negative & (unloaded >= 0.0)
        taken = touchable & ~active & (unloaded < -_ROUNDING * size[..., None])
        ways, least = np.abs(moved - loads), _STEP * whole + _ROUNDING * size * tangent
        way = ways.max(axis=-1)
        # the next step falls at least as this one did, in truth by the square of that
        near = (ways <= _NEAR * moved).all(axis=-1)
        settled = (way <= least) | (near & (way**2 <= least * before))
        loads = np.where(negative & ~released, _BACKOFF * loads, kept)
        loads = np.where(taken, start * each, loads)
        start = np.where(taken, _BACKOFF * start, start)
        active = (active & ~released) | taken
        changed = np.any(negative | taken, axis=-1)
        settled &= ~changed
        before = np.where(changed, 0.0, way)
        if settled.all():
            return LoadShare(loads, approach, tangent, slopes, iteration)
        bent = stiff.applied(loads, changed, bent)
        wanted = ~settled if stiff.apart else everywhere
    remedy = "check that bulk is positive semidefinite, hertz has a positive and film a negative slope"
    allowed = "must have deflections that grow with the force"
    raise LoadSharingError.at("share_load", f"no solution after {_ITERATIONS} steps", allowed, remedy)


def _linearise(
    bent: Array, hertz: Asked, film: Asked | None, clear: Array, loads: Array
) -> tuple[Array, Array]:
    """Slopes of the laws, and deflections with clearance of all pairs (..., n) that are bent so far by all forces."""
    yields, slope = hertz(loads)
    residual = bent + yields + clear
    if film is not None:
        props, falls = film(loads)
        slope, residual = slope - falls, residual - props
    # an idle pair may have an infinite slope; its row is replaced in the Newton step
    return np.where(loads > 0.0, slope, 1.0), residual


def _asked(law: DeflectionLaw) -> Asked:
    """What gives deflection and slope of a law."""
    return (
        law.value_and_slope
        if isinstance(law, JointLaw)
        else lambda loads: (law.approach(loads), law.slope(loads))
    )


def _newton_step(
    bulk: Coupling,
    slope: Array,
    residual: Array,
    loads: Array,
    active: Booleans,
    wanted: Booleans,
    force: Array,
    levers: Array,
) -> tuple[Array, Array, Array]:
    """Step of the active forces, step of the approach and slopes dF_i/dD; zero where not wanted.

    Two right-hand sides, J a = 1 and J b = residual on the active pairs, give the bordered system's solution
    dF = a dD - b with dD from the sum of the moments.
    """
    unit, response, scale = bulk.solved(slope, residual, active, wanted)
    total = np.where(wanted, (levers * unit).sum(axis=-1), 1.0)
    carried = (levers * np.where(active, loads, 0.0)).sum(axis=-1)
    reduced = np.where(wanted, (force - carried + (levers * response).sum(axis=-1)) / total, 0.0)
    return unit * reduced[..., None] - response, reduced * scale, unit / scale


def _first_touch(
    bulk: Coupling, hertz: DeflectionLaw, film: DeflectionLaw | None, at_zero: Array, levers: Array
) -> LoadShare:
    """Share at zero force: the approach at which the first pair touches, and the stiffness there."""
    approach = at_zero.min(axis=-1)
    nothing = np.zeros_like(at_zero)
    slope = hertz.slope(nothing) if film is None else hertz.slope(nothing) - film.slope(nothing)
    compliance = bulk.diagonal + slope
    first = np.arange(at_zero.shape[-1]) == at_zero.argmin(axis=-1)[..., None]
    slopes = np.where(first, 1.0 / (compliance + nothing), 0.0)
    return LoadShare(nothing, approach, (levers * slopes).sum(axis=-1), slopes, 0)


def _finite(prop: Array) -> Array:
    """Refuse a film that grows without bound as the force falls; every pair would carry on it."""
    if not np.all(np.isfinite(prop)):
        remedy = "bound the film's thickness as the force goes to zero"
        raise LoadSharingError.at("film", "not finite at zero force", "must have a finite thickness", remedy)
    return prop


def _fit(*shapes: tuple[int, ...]) -> bool:
    """Whether leading dimensions agree, those of length 1 counted as any."""
    try:
        np.broadcast_shapes(*shapes)
    except ValueError:
        return False
    return True


def _check(force: Array, bulk: Coupling, gaps: Array, levers: Array) -> None:
    """Refuse malformed input, all faults at once."""
    pairs = gaps.shape[-1:]
    with Faults(LoadSharingError) as faults:
        if not (np.all(np.isfinite(force)) and (np.all(force > 0.0) or not force.any())):
            allowed = "must be finite, all above 0 N or all 0 N"
            faults.add("force", str(force), allowed, "give the forces' sizes")
        if not (
            gaps.ndim >= 1 and pairs > (0,) and bulk.shape[-2:] == 2 * pairs and levers.shape[-1:] == pairs
        ) or not _fit(force.shape, bulk.shape[:-2], gaps.shape[:-1], levers.shape[:-1]):
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
        if not bulk.finite:
            faults.add("bulk", "not finite", "must be finite", "check the compliance matrix")
