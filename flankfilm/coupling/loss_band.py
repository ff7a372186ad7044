"""Losses at the ends of the band of Eyring's stress, in which that of most oils lies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from base import Array
from flankfilm.coupling.heated_films import HeatedFilms, heated_films
from flankfilm.coupling.losses_record import LossBand
from flankfilm.coupling.losses_rounds import Agreed, LossRounds
from flankfilm.coupling.mean_losses import Carried, Means

__all__ = ["loss_band"]

BAND = (5e6, 10e6)
"""Eyring's stress of most oils [Pa]."""


def loss_band(rounds: LossRounds, agreed: Agreed, path: HeatedFilms, few: int) -> LossBand:
    """Losses at the ends of the band of Eyring's stress, by the ratios of some films along the path.

    Parameters
    ----------
    rounds : LossRounds
    agreed : Agreed
        Load share and temperatures, which stay.
    path : HeatedFilms
        Films along the path.
    few : int
        How many of these are solved anew.
    """
    some = path.some(few)
    found, along, off = [], [], [0.0]
    for stress in BAND:
        ratios = _ratios(rounds, some, stress, agreed.bulk)
        means, coarser = (
            rounds.means(agreed.cycle, agreed.films, one) for one in (ratios, ratios.some((few + 1) // 2))
        )
        found.append(means)
        along.append(Carried.of(path, ratios).friction)
        off.append(coarser.off(means))
    return _record(found, np.array(along), max(off), rounds.power)


def _ratios(rounds: LossRounds, some: HeatedFilms, stress: float, bulk: tuple[float, float]) -> Carried:
    """Friction and rolling of some films at another stress, over those at the given one."""
    if stress == rounds.lubricant.eyring_stress:
        return Carried.ones(some.rho1)
    oil = replace(rounds.lubricant, eyring_stress=stress)
    contacts = [replace(one, lubricant=oil) for one in some.contacts]
    return Carried.of(heated_films(some.rho1, contacts, rounds.oil, bulk, some)).over(Carried.of(some))


def _record(found: Sequence[Means], along: Array, error: float, power: float) -> LossBand:
    def each(name: str) -> Array:
        return np.array([getattr(one, name) for one in found])

    loss = each("mesh_loss")
    return LossBand(
        eyring_stress=np.array(BAND),
        mean_friction=each("friction"),
        sliding_loss=each("sliding_loss"),
        rolling_loss=each("rolling_loss"),
        mesh_loss=loss,
        efficiency=1.0 - loss / power,
        friction_coefficient=along,
        error=error,
    )
