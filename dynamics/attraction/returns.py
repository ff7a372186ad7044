"""Points of orbits of several periods at the start of each further one, for pictures of a diagram."""

from __future__ import annotations

from typing import Any

import numpy as np

from base import Array
from dynamics.attraction.diagrams import Diagram
from dynamics.branches.branch import Branch
from dynamics.flow.flows import flow_of


def returns(diagram: Diagram) -> Array:
    """Follow the orbits of a diagram from tau = 0 through their periods.

    Parameters
    ----------
    diagram : Diagram

    Returns
    -------
    (n, 6) array
        Columns branch, whole periods after tau = 0, parameter, X, V, stable (0 or 1), along each branch; orbits of one
        period have none.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, diagram
    >>> oscillator = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> returns(diagram(oscillator, bounds=(0.55, 0.6), periods=1, searches=2, swept=5, max_period=1)).shape
    (0, 6)
    """
    pieces = [
        np.column_stack([np.full(len(rows), number), rows])
        for number, branch in enumerate(diagram.branches)
        if len(rows := branch_returns(branch, diagram.oscillator))
    ]
    return np.concatenate(pieces) if pieces else np.empty((0, 6))


def branch_returns(branch: Branch, oscillator: Any) -> Array:
    """Follow the orbits of one branch of an oscillator likewise.

    Returns
    -------
    (n, 5) array
        Columns as of `returns`, without the branch.
    """
    if branch.periods == 1:
        return np.empty((0, 5))
    here = [oscillator.with_parameter(branch.parameter, value) for value in branch.values.tolist()]
    # (point, period, X and V): the last period ends where the orbit began
    points = np.array(
        [
            one.in_plane(flow_of(one).follow(state, branch.periods, 0, False).states[: branch.periods - 1])
            for one, state in zip(here, branch.states, strict=True)
        ]
    )
    pieces = [
        np.column_stack(
            [np.full(len(branch.values), period + 1), branch.values, points[:, period], branch.stable]
        )
        for period in range(branch.periods - 1)
    ]
    return np.concatenate(pieces)
