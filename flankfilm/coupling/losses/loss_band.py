"""Losses at the ends of the bands of Eyring's stress and of the asperities' friction, where those of most oils lie."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from base import Array
from flankfilm.coupling.losses.heated_films import HeatedFilms, heated_films
from flankfilm.coupling.losses.losses_record import BoundaryBand, LossBand
from flankfilm.coupling.losses.losses_rounds import Agreed, LossRounds
from flankfilm.coupling.losses.mean_losses import Carried, Means

__all__ = ["boundary_band_of", "loss_band"]

BAND = (5e6, 10e6)
"""Eyring's stress of most oils [Pa]."""


def loss_band(rounds: LossRounds, agreed: Agreed, path: HeatedFilms, few: int, error: float) -> LossBand:
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
    error : float
        Relative, of the losses at the stress that was given.
    """
    films = path.thinned_to(few)
    averages, along, off = [], [], []
    for stress in BAND:
        ratios = _ratios(rounds, films, stress, agreed.bulk)
        means, coarser = (
            rounds.means(agreed.cycle, agreed.films, carried)
            for carried in (ratios, ratios.thinned_to((few + 1) // 2))
        )
        averages.append(means)
        along.append(Carried.of(path, ratios).friction)
        off.append(error + coarser.off(means))
    return _record(averages, np.array(along), np.array(off), rounds.power)


def _ratios(rounds: LossRounds, films: HeatedFilms, stress: float, bulk: tuple[float, float]) -> Carried:
    """Friction and rolling of some films at another stress, over those at the given one."""
    if stress == rounds.lubricant.eyring_stress:
        return Carried.ones(films.rho1)
    oil = replace(rounds.lubricant, eyring_stress=stress)
    contacts = [replace(contact, lubricant=oil) for contact in films.contacts]
    return Carried.of(heated_films(films.rho1, contacts, rounds.oil, bulk, films)).over(Carried.of(films))


def _record(means: Sequence[Means], along: Array, error: Array, power: float) -> LossBand:
    def each(name: str) -> Array:
        return np.array([getattr(mean, name) for mean in means])

    loss = each("mesh_loss")
    return LossBand(
        eyring_stress=np.array(BAND),
        mean_friction=each("friction"),
        sliding_loss=each("sliding_loss"),
        rolling_loss=each("rolling_loss"),
        mesh_loss=loss,
        efficiency=1.0 - loss / power,
        friction_coefficient=along,
        end_error=error,
    )


def boundary_band_of(rounds: LossRounds, agreed: Agreed, ends: tuple[float, float]) -> BoundaryBand:
    """Losses of rough flanks at the ends of the band of their asperities' friction.

    Parameters
    ----------
    rounds : LossRounds
    agreed : Agreed
        Load share, temperatures and films, which stay.
    ends : (float, float)
        Coefficients of friction.
    """
    means = [rounds.means(agreed.cycle, agreed.films.rubbing(end)) for end in ends]
    rubbed = rounds.means(agreed.cycle, agreed.films.rubbing(0.0)).mesh_loss
    whole = agreed.means.mesh_loss

    def each(name: str) -> Array:
        return np.array([getattr(mean, name) for mean in means])

    return BoundaryBand(
        boundary_friction=np.array(ends),
        mean_friction=each("friction"),
        sliding_loss=each("sliding_loss"),
        mesh_loss=each("mesh_loss"),
        efficiency=1.0 - each("mesh_loss") / rounds.power,
        loss_part=1.0 - rubbed / whole if whole else 0.0,
    )
