"""Why figures of a motion have no separate error, in the words of files and tables.

Public, in `dynamics.model.reasons`: `FLOW`, `OF_A_GRID`, `OF_A_SEARCH`, `FITTED`.
"""

from __future__ import annotations

__all__ = ["FITTED", "FLOW", "OF_A_GRID", "OF_A_SEARCH"]

FLOW = "rounding of the flow: the result's error is that of a period's map"
"""States, and what follows from them by the flow."""

OF_A_GRID = "not estimated: shares and counts of a grid of states, which a finer one may change"
"""Basins, boundaries and attractors."""

OF_A_SEARCH = "a count of a search: it is as it was made"
"""Places that were looked at, and what was found there."""

FITTED = "not estimated by itself: what is said of a fit to given speeds, whose own errors are not known"
"""Identified oscillators."""
