"""Errors of period maps that sweeps have met, by finer flows."""

from __future__ import annotations

from threading import Lock

import numpy as np

from base import Array
from dynamics.flow.protocol import Flow


class MapErrors:
    """Largest relative changes of one period's map on a finer flow, by direction of the sweep.

    Tables of the finer flow take twice those of the flow. The sweep that meets a value last makes them, for all.

    Parameters
    ----------
    sweeps : int
        How many meet every value, each perhaps on another core.
    """

    def __init__(self, sweeps: int) -> None:
        self.sweeps = sweeps
        self.largest: dict[str, float] = {}
        self._met: dict[int, list[tuple[str, Array]]] = {}
        self._lock = Lock()

    def met(self, value: int, direction: str, flow: Flow, states: Array) -> None:
        """Take the states of a motion that a sweep has met, nan if it was lost.

        Parameters
        ----------
        value : int
            Index of the value.
        direction : str
            Of the sweep.
        flow : Flow
            At this value.
        states : ndarray, shape (kept, dimension)
            The last two are compared.
        """
        with self._lock:
            here = self._met.setdefault(value, [])
            here.append((direction, states))
            if len(here) < self.sweeps:
                return
            del self._met[value]
        known = [(way, kept) for way, kept in here if np.isfinite(kept).all()]
        finer = flow.finer() if known else flow
        for way, kept in known:
            change = _changed(finer, kept[-2], kept[-1])
            with self._lock:
                self.largest[way] = max(self.largest.get(way, 0.0), change)


def _changed(finer: Flow, before: Array, after: Array) -> float:
    """Relative change of one period's map."""
    again = finer.follow(before, derivatives=False).state
    return float(np.max(np.abs(again - after))) / max(float(np.max(np.abs(after))), 1e-300)
