"""Numerical settings that decide an answer and that a user could have to know: one record read by all functions."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["OPTIONS", "Options"]


@dataclass(frozen=True)
class Options:
    """What decides whether a motion is an orbit, an attractor or chaos, and how long it is looked at.

    What changes from call to call are keywords of the functions. `OPTIONS` are the numbers in use;
    docs/theory/dynamics.md has them in a table.

    Attributes
    ----------
    step_tolerance, long_step_tolerance : float
        Tolerance of steps of the stepwise flow where none is given: of orbits and branches, and of motions that are
        followed for long.
    settling_factor : float
        By how much damping shrinks a disturbance in the periods that a transient is given.
    least_settling, most_settling : int
        Bounds of these periods.
    repeats : float
        Change over n periods, over the size of the motion, below which it repeats; at least a thousand tolerances.
    creep : float
        Change over n periods, over the size, below which a motion may creep to an orbit.
    creep_periods, leaving_periods : int
        Most periods that a motion is followed on which creeps to an orbit, and those of one that creeps away.
    same_motion : float
        Distance from an orbit, over the size, at which a motion has settled on it.
    same_orbit : float
        Distance, over the size, below which two orbits are one.
    orbit_error : float
        Estimated relative error of an orbit above which it has not converged.
    shot_stretch : float
        Stretch of the map beyond which one shot loses too many digits, and orbits are sought by many.
    least_batches : int
        Batches of starts without deflation at least; twice as many as the last new orbit took.
    region_growths : int
        Searches of a region that grows, at most.
    corner : float
        Smallest cosine between tangents of neighbours on a branch.
    multiplier_jump : float
        Largest change of the multipliers' sum between neighbours, over its size or 1.
    hidden_dip : float
        How near to zero, over its depth, a dip of a test function between neighbours may come without a closer look.
    unbounded : float
        Size, over that at the start, at which a branch or a sweep's motion counts as grown without bound.
    batches : int
        Parts of a motion that the standard error of an exponent is taken from.
    sure : float
        Standard errors by which an exponent must differ from zero for its sign to be certain.
    lag : float
        Change of the frequency in a decay time, over the width of a resonance, above which a run-up's motion lags.
    spectrum_periods, spectrum_stretches : int
        Periods of the stretches of a motion without a period, and their number, that its spectrum is averaged over.
    seeds : int
        Starts of a basin that are followed to the end first.
    patience : int
        Times the limit that a start is followed which has not settled and is not known to be chaos.
    chaos_trials : int
        Motions so followed to distinguish chaos from a long transient.
    cover_periods, cover_cells, cover_margin : int
        Periods that show where a chaotic attractor lies, cells along each side of it, and cells around that belong to
        it: an attractor moves and grows a little with the parameter.
    escape_share : float
        Part of the time outside by which a motion has left an attractor that has not only grown.
    escape_lives : float
        Mean lives without an escape after which it would have shown.
    shared_box : float
        Part of the union of their boxes that two aperiodic motions share if they are one.
    tangency_jump : float
        Jump of the overshoot, over the size of the saddle, above which its change of sign is no tangency.
    event_units : float
        Units of the last decimal within which a reported event is met.
    outlier_weight : float
        Weight below which a reported event counts as an outlier.
    chance : float
        Probability below which a match of reported events is not put down to chance.

    Examples
    --------
    >>> from dynamics.model.options import OPTIONS
    >>> OPTIONS.repeats
    1e-06
    """

    step_tolerance: float = 1e-12
    long_step_tolerance: float = 1e-9
    settling_factor: float = 1e6
    least_settling: int = 200
    most_settling: int = 5000
    repeats: float = 1e-6
    creep: float = 0.02
    creep_periods: int = 20_000
    leaving_periods: int = 2000
    same_motion: float = 1e-3
    same_orbit: float = 1e-7
    orbit_error: float = 1e-3
    shot_stretch: float = 1e6
    least_batches: int = 18
    region_growths: int = 4
    corner: float = 0.9
    multiplier_jump: float = 0.3
    hidden_dip: float = 0.25
    unbounded: float = 1e4
    batches: int = 20
    sure: float = 3.0
    lag: float = 0.1
    spectrum_periods: int = 64
    spectrum_stretches: int = 8
    seeds: int = 48
    patience: int = 20
    chaos_trials: int = 3
    cover_periods: int = 400_000
    cover_cells: int = 128
    cover_margin: int = 4
    escape_share: float = 0.2
    escape_lives: float = 3.0
    shared_box: float = 0.5
    tangency_jump: float = 1e-3
    event_units: float = 10.0
    outlier_weight: float = 0.1
    chance: float = 0.01


OPTIONS = Options()
"""The numbers in use."""
