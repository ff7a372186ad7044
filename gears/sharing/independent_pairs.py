"""How tooth pairs that know nothing of each other share the load: in proportion to their stiffness."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from base import Faults
from gears.sharing.active_set import LoadShare
from gears.tooth.errors import LoadSharingError

__all__ = ["independent_pairs"]


def independent_pairs(force: float, stiffness: ArrayLike, film: ArrayLike | None = None) -> LoadShare:
    """Share a force among independent pairs in proportion to their stiffness, the article's way.

    k_i = 1 / (1/k_tooth,i + 1/k_film,i); F_i = F k_i / sum k; D = F / sum k.

    Parameters
    ----------
    force : float
        Sum of the normal forces [N].
    stiffness : (positions, pairs) array
        Secant stiffness of each pair by itself, 0 for a pair that does not touch [N/m].
    film : (positions, pairs) array or None
        Stiffness of each pair's film [N/m]; None is dry.

    Returns
    -------
    LoadShare
        `stiffness` holds the sum of the secant ones, which is all that this model knows.

    Raises
    ------
    LoadSharingError
        For negative stiffness, or positions where no pair carries.

    Examples
    --------
    >>> independent_pairs(1e4, [[6e8, 4e8], [5e8, 0.0]]).forces
    array([[ 6000.,  4000.],
           [10000.,     0.]])
    """
    teeth = np.asarray(stiffness, dtype=float)
    films = np.full_like(teeth, np.inf) if film is None else np.asarray(film, dtype=float)
    sound = np.all(teeth >= 0.0) and np.all(np.isfinite(teeth)) and np.all(films >= 0.0)
    carries = (teeth > 0.0) & (films > 0.0)
    with Faults(LoadSharingError) as faults:
        if not (sound and np.isfinite(force) and force >= 0.0):
            allowed = "must be finite and at least 0 (a film may be inf)"
            faults.add("force, stiffness, film", "negative or not finite", allowed, "check the stiffness")
        if not np.all(carries.any(axis=-1)):
            allowed = "must have a pair that carries at each position"
            faults.add("stiffness", "zero for every pair", allowed, "add pairs")
    compliance = 1.0 / np.where(carries, teeth, 1.0) + 1.0 / np.where(carries, films, 1.0)
    series = np.where(carries, 1.0 / compliance, 0.0)
    total = series.sum(axis=-1)
    forces = force * series / total[..., None]
    return LoadShare(forces, np.asarray(force / total), np.asarray(total), series, 0)
