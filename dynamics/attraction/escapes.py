r"""Where chaos ends, by how long motions stay: past a crisis the attractor is a transient of ever shorter life.

Motions started on the attractor leave it past a crisis at :math:`p_c` at a rate that goes as
:math:`|p - p_c|^\gamma`, :math:`\gamma \ge 1/2` (Grebogi, Ott and Yorke 1987, 10.1103/PhysRevA.36.5365). A motion that
leaves shows that chaos has ended there; one that stays shows nothing but that the rate is small. So the bracket is as
narrow as the periods that are spent, and the law says how many a narrower one needs.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, InputError, Stopwatch, part, quantity, record
from base.results import EXACT
from dynamics.attraction.basins import Attractor
from dynamics.attraction.covers import Cover
from dynamics.model.limits import PERIODS, STARTS, ordered
from dynamics.model.options import OPTIONS
from dynamics.model.protocol import Oscillator, settling_periods
from dynamics.model.states import checked_state
from dynamics.motion.sweeps import APERIODIC, long_flow

STRETCH = 2048  # periods between two looks at a motion
AFTER = 512  # periods that a motion is followed on outside


@record
class ChaosEnd:
    """The parameter at which motions begin to leave a chaotic attractor."""

    headline = ("last", "first")

    parameter: str = quantity("", "what was varied")
    last: float = quantity("1", "last value at which no motion left within the periods", error="error")
    first: float = quantity("1", "first value at which motions left", error="error")
    values: Array = quantity("1", "values looked at, from where chaos lasts", "value", no_error=EXACT)
    escapes: Array = quantity("1", "motions that left at each value", "value", no_error=EXACT)
    followed: Array = quantity(
        "1", "periods followed at each value, of all motions together", "value", no_error=EXACT
    )
    attractor: Attractor = part("the chaos at the first bound, in many samples, as `edge_saddles` takes it")
    exponent: float = quantity(
        "1", "exponent of the rate over the distance from the middle of the bracket; nan from less than three rates",
        no_error="not estimated: crises have dips, and the law holds near them alone",
    )  # fmt: skip
    needed: float = quantity(
        "1",
        "periods that a bracket of half the width would take, by the last rate and an exponent of at least 1/2",
        no_error="an order of magnitude",
    )
    error: float = quantity("1", "width of the bracket, relative")
    cost: Cost
    converged: bool = quantity("1", "whether motions stay at the one bound and leave at the other")
    message: str

    @property
    def rates(self) -> Array:
        """Escapes per period at each value."""
        return np.asarray(self.escapes / np.maximum(self.followed, 1.0))


def chaos_end(
    oscillator: Oscillator,
    parameter: str,
    state: npt.ArrayLike,
    bounds: tuple[float, float],
    *,
    periods: int = 1_000_000,
    starts: int = 32,
) -> ChaosEnd:
    """Close in on the parameter at which a chaotic attractor becomes a transient.

    A motion has left where X and V lie outside the cells that the attractor covers; in several freedoms y and its rate.
    What leaves in another direction alone, with y and its rate where they were, is not seen to leave.

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator; its own value of the parameter is not used.
    parameter : str
        One of its `parameters`.
    state : array_like, shape (dimension,)
        From which the motion reaches the attractor at the first bound.
    bounds : (float, float)
        Where chaos lasts, and where motions leave it; the second may be the lower one.
    periods : int
        Periods spent at a value before its chaos counts as lasting, of all motions together.
    starts : int
        Motions from places of the attractor.

    Returns
    -------
    ChaosEnd
        The bracket, escapes and periods at every value, and how many periods a narrower one needs.

    Raises
    ------
    InputError
        If an argument is out of range, or the motion at the first bound repeats or grows without bound.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, chaos_end
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.5,), (0.0,)), 0.06, 0.1, 0.778, 0.4, half_backlash=0.8)
    >>> end = chaos_end(osc, "error_amplitude", (1.06, 0.459), (0.7795, 0.79), periods=20_000, starts=8)
    >>> end.converged, 0.7799 < end.first < 0.7825
    (True, True)
    """
    watch = Stopwatch()
    with Faults() as faults:
        _ = ordered(faults, "bounds", sorted(bounds))
        budget = faults.whole("periods", periods, *PERIODS._replace(low=1000))
        number = faults.whole("starts", starts, *STARTS)
    here = oscillator.with_parameter(parameter, float(bounds[0]))
    flow = long_flow(here, None)
    wait = settling_periods(here)
    motion = flow.follow(
        checked_state(state, size=here.dimension), OPTIONS.cover_periods, wait, derivatives=False
    )
    if motion.message:
        raise InputError.at(
            "state", motion.message, "must lead to a bounded motion", "take one of the attractor's"
        )
    cover = Cover.of(here.in_plane(motion.states))
    if len(np.unique(np.round(motion.states[-256:], 9), axis=0)) < 256:
        allowed = f"must lead to chaos at {parameter} = {bounds[0]:g}, where it repeats"
        raise InputError.at("state", state, allowed, "begin the bounds where the attractor is chaotic")
    at = motion.states[:: max(1, OPTIONS.cover_periods // number)][:number]
    looked: list[tuple[float, int, int]] = []

    def leaves(value: float) -> bool:
        escaped, used = _escapes(oscillator.with_parameter(parameter, value), at, cover, budget)
        looked.append((value, escaped, used))
        return escaped > 0

    stays, gone = float(bounds[0]), float(bounds[1])
    good = not leaves(stays) and leaves(gone)
    while good and abs(gone - stays) > 1e-12 * abs(gone):
        middle = 0.5 * (stays + gone)
        if leaves(middle):
            gone = middle
        else:
            stays = middle
        if _needed(looked, stays, gone) > budget:
            break
    looked.sort(key=lambda row: row[0], reverse=bounds[1] < bounds[0])
    values, escapes, followed = (np.array(column, dtype=np.float64) for column in zip(*looked, strict=True))
    needed = _needed(looked, stays, gone) if good else math.nan
    used = int(followed.sum()) + OPTIONS.cover_periods + wait
    said = (
        f"no motion left in {budget} periods at {stays:.10g}, at {gone:.10g} they leave; half the width needs about "
        f"{needed:.1g} periods a value"
        if good
        else "motions leave at the first bound, or stay at the second: move the bounds"
    )
    return ChaosEnd(
        parameter, stays, gone, values, escapes, followed,
        Attractor(APERIODIC, motion.states, None, 1.0, 0.0), _exponent(looked, 0.5 * (stays + gone)), needed,
        abs(gone - stays) / max(abs(gone), 1e-300), Cost(watch.seconds, periods=used), good, said,
    )  # fmt: skip


def _escapes(oscillator: Oscillator, starts: Array, cover: Cover, budget: int) -> tuple[int, int]:
    """Motions that leave, and periods that all were followed; at most the budget, and no longer than a few escapes."""
    flow = long_flow(oscillator, None)
    at, alive, used, escaped = starts.copy(), list(range(len(starts))), 0, 0
    while alive and used < budget:
        for k in tuple(alive):
            motion = flow.follow(at[k], STRETCH, derivatives=False)
            out = (
                np.flatnonzero(cover.outside(oscillator.in_plane(motion.states)))
                if not motion.message
                else np.zeros(1, dtype=int)
            )
            gone = bool(motion.message)
            if len(out) and not gone:
                after = flow.follow(motion.states[out[0]], AFTER, derivatives=False)
                gone = (
                    bool(after.message)
                    or float(np.mean(cover.outside(oscillator.in_plane(after.states)))) > OPTIONS.escape_share
                )
            used += (int(out[0]) + 1) if gone else STRETCH
            if gone:
                escaped += 1
                alive.remove(k)
            else:
                at[k] = motion.state
            if used >= budget:
                break
        if escaped >= max(4, len(starts) // 4):
            break
    return escaped, used


def _needed(looked: list[tuple[float, int, int]], stays: float, gone: float) -> float:
    """Periods at the middle of the bracket until an escape would have shown, by the rate at its end."""
    rate = max((escaped / max(used, 1) for value, escaped, used in looked if value == gone), default=math.nan)
    gamma = _exponent(looked, 0.5 * (stays + gone))
    more = 2.0 ** max(0.5, gamma if math.isfinite(gamma) else 1.0)
    return OPTIONS.escape_lives / rate * more if rate > 0.0 else math.inf


def _exponent(looked: list[tuple[float, int, int]], end: float) -> float:
    """Slope of the rate over the distance from the end, both as logarithms."""
    rates = [
        (abs(value - end), escaped / used) for value, escaped, used in looked if escaped > 0 and value != end
    ]
    if len(rates) < 3:
        return math.nan
    distance, rate = np.log(np.array(rates)).T
    distance = distance - distance.mean()
    return float(distance @ rate / (distance @ distance))
