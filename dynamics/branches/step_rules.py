"""How long a step along a branch may be: numbers that single steps and many at a time share."""

import math

from dynamics.model.options import OPTIONS

ITERATIONS = 8  # of Newton's method, at most
EASY = 4  # iterations after which the next step may be longer
LONGER = 1.4  # by how much
ASTRAY = 2.0  # steps from the last point at most
ROUND = 50.0  # the same of the shortest steps, which go round corners
PATIENT = 16.0  # minimum steps down to which corners and jumps make a step shorter
STRAIGHT = 1e-5  # between neighbours: from there on the difference of their tangents is more than rounding
NEAR = 0.05  # of the orbit's period: how far an extremum may move between neighbours
FALLEN = 1e-3  # of the halves' distance at the last point: Newton's method has reached the orbit of half the period
# a cubic leaves the chord of its values by 4/27 of its slopes at most
SWAY = (1.0 + OPTIONS.hidden_dip) * 4.0 / 27.0
FAR = 1.02  # squared steps from a place: too far to pass it


def touches_twice(
    x: float, rise: float, later: float, climb: float, levels: tuple[list[float], list[float]],
    widening: tuple[float, float], scale: float, length: float,
) -> bool:  # fmt: skip
    """Whether an extremum may touch a flank twice between neighbours, as of `hides`.

    Parameters
    ----------
    x, later : float
        The extremum at the one and at the other.
    rise, climb : float
        Its slopes there, over the scale.
    levels : (list of float, list of float)
        Where the flanks lie at the one and at the other, the upper one first.
    widening : (float, float)
        Slopes of the upper one, over the scale; the lower one moves the other way.
    scale : float
        Of the states.
    length : float
        From the one to the other.
    """
    side = 1.0
    for level, after in zip(*levels, strict=True):
        here, there = (x - level) / scale, (later - after) / scale
        begin, end = rise - side * widening[0], climb - side * widening[1]
        near = min(abs(here), abs(there)) <= SWAY * length * (abs(begin) + abs(end))
        if near and here * there > 0.0 and hides(here, begin, there, end, length):
            return True
        side = -1.0
    return False


def hides(before: float, rise: float, after: float, climb: float, length: float) -> bool:
    """Whether a function changes its sign more often between neighbours than its values there show, or nearly so.

    It is taken as the cubic that has these values and slopes.

    Parameters
    ----------
    before, after : float
        Values at the one and at the other.
    rise, climb : float
        Slopes there.
    length : float
        From the one to the other.
    """
    rise, climb = rise * length, climb * length
    same = before * after > 0.0
    if same and min(abs(before), abs(after)) > SWAY * (abs(rise) + abs(climb)):
        return False
    chord = after - before
    bend, twist = 3.0 * chord - 2.0 * rise - climb, rise + climb - 2.0 * chord
    root = bend * bend - 3.0 * twist * rise
    if not root > 0.0:
        return False
    # turning points as roots of rise + 2 bend t + 3 twist t^2, without cancellation
    large = -(bend + math.copysign(math.sqrt(root), bend))
    places = [rise / large if large else math.inf, large / (3.0 * twist) if twist else math.inf]
    turns = [before + t * (rise + t * (bend + t * twist)) for t in sorted(places) if 0.0 < t < 1.0]
    if not same:
        return len(turns) == 2 and before * turns[0] <= 0.0 and before * turns[1] >= 0.0
    side, nearest = math.copysign(1.0, before), min(abs(before), abs(after))
    return any(side * value < OPTIONS.hidden_dip * (nearest - side * value) for value in turns)
