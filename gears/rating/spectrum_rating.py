"""A load spectrum rated step by step: Miner's sum, safety and life of both gears, flanks and roots."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from base import Array, described, quantity, record
from base.results import EXACT
from gears.closed_form.record import STANDARD
from gears.pair.gear_pair import GearPair
from gears.rating.bending import bending_safety
from gears.rating.life import BENDING, LifeCurve, contact_curve
from gears.rating.load_factors import LoadFactors
from gears.rating.pitting import pitting_safety
from gears.rating.rating_data import RatingData
from gears.rating.spectrum import LoadBin, SpectrumDamage, miner, spectrum_safety
from gears.tooth.errors import GeometryError


@record
class SpectrumRating:
    """Damage of both gears by a load spectrum at the required safeties, and the safety at which it is 1."""

    torque: Array = quantity("N m", "torque of the pinion", "step", no_error=EXACT)
    speed: Array = quantity("rad/s", "speed of the pinion", "step", shown="rpm", no_error=EXACT)
    cycles: Array = quantity("1", "load cycles of the pinion", "step", no_error=EXACT)
    duration: float = quantity("s", "time of the spectrum", shown="h", no_error=EXACT)
    K_v: Array = quantity("1", "dynamic factor, method B; nan without load", "step")
    K_Hbeta: Array = quantity("1", "face-load factor of the contact stress; nan without load", "step")
    parts_H: Array = quantity("1", "damage of the flanks by a step, at the required safety", "gear step")
    damage_H: tuple[float, float] = quantity("1", "Miner's sum of the flanks at the required safety", "gear")
    S_H: tuple[float, float] = quantity("1", "safety against pitting at which Miner's sum is 1", "gear")
    parts_F: Array | None = quantity(
        "1", "damage of the roots by a step, at the required safety; None without ISO 6336-3", "gear step"
    )
    damage_F: tuple[float, float] | None = quantity(
        "1", "Miner's sum of the roots at the required safety; None without ISO 6336-3", "gear"
    )
    S_F: tuple[float, float] | None = quantity(
        "1", "safety against breakage at which Miner's sum is 1; None without ISO 6336-3", "gear"
    )

    no_error = STANDARD
    headline = ("damage_H", "damage_F", "S_H", "S_F")

    @described("s", shown="h")
    def life(self) -> float:
        """Time until the first flank or root fails at the required safety; infinite where none is damaged."""
        worst = max(*self.damage_H, *(self.damage_F or ()))
        return self.duration / worst if worst > 0.0 else math.inf

    @property
    def error(self) -> None:
        """Model error, which a standard cannot know: None is unknown, never zero."""
        return


class _Step(NamedTuple):
    """Load factors and life factors that the stress of one step requires, of both gears."""

    K_v: float
    K_Hbeta: float
    flanks: tuple[float, float]
    roots: tuple[float, float] | None


IDLE = _Step(math.nan, math.nan, (0.0, 0.0), (0.0, 0.0))
"""A step without load."""


def rate_spectrum(
    pair: GearPair, data: RatingData, factors: Callable[[LoadBin], LoadFactors]
) -> SpectrumRating:
    """Rate every step of the spectrum of `data`, each with the load factors at its torque and speed.

    Parameters
    ----------
    pair : GearPair
    data : RatingData
        With a spectrum that `check_spectrum` accepts.
    factors : callable
        Gives the load factors of a step with torque.

    Returns
    -------
    SpectrumRating

    References
    ----------
    ISO 6336-6:2006, clause 4.
    """
    rated = [_rated(pair, data, factors, step) for step in data.spectrum]
    turns = np.array([step.cycles for step in data.spectrum])
    speeds = np.array([step.speed for step in data.spectrum])
    counts = turns, turns / pair.ratio
    flanks = _of_gears(
        counts,
        [[step.flanks[gear] for step in rated] for gear in range(2)],
        [contact_curve(steel.kind, data.pitting_permitted) for steel in data.steels],
        data.required.S_H,
    )
    roots = None
    if all(step.roots is not None for step in rated):
        required = [[step.roots[gear] for step in rated if step.roots is not None] for gear in range(2)]
        roots = _of_gears(counts, required, [BENDING[s.kind] for s in data.steels], data.required.S_F)
    return SpectrumRating(
        np.array([step.torque for step in data.spectrum]),
        speeds,
        turns,
        float(np.sum(2.0 * math.pi * turns / speeds)),
        np.array([step.K_v for step in rated]),
        np.array([step.K_Hbeta for step in rated]),
        *flanks,
        *(roots or (None, None, None)),
    )


def _rated(
    pair: GearPair, data: RatingData, factors: Callable[[LoadBin], LoadFactors], step: LoadBin
) -> _Step:
    """Life factors that a step requires: Z_NT/S_H and Y_NT/S_F, which no longer depend on the life rated."""
    if step.torque == 0.0:
        return IDLE
    loads, at = factors(step), replace(data, life=2.0 * math.pi * step.cycles / step.speed)
    pitting = pitting_safety(
        pair,
        step.torque,
        step.speed,
        loads,
        at.steels,
        viscosity_40=at.viscosity_40,
        roughness=at.flank_roughness,
        life=at.life,
        Z_W=at.Z_W,
        Z_X=at.Z_X,
        pitting_permitted=at.pitting_permitted,
    )
    first, second = (n / s for n, s in zip(pitting.Z_NT, pitting.S_H, strict=True))
    try:
        bending = bending_safety(
            pair,
            step.torque,
            step.speed,
            loads,
            at.steels,
            root_roughness=at.root_roughness,
            life=at.life,
        )
    except GeometryError:
        return _Step(loads.K_v, loads.K_Hbeta, (first, second), None)
    pinion, wheel = (n / s for n, s in zip(bending.Y_NT, bending.S_F, strict=True))
    return _Step(loads.K_v, loads.K_Hbeta, (first, second), (pinion, wheel))


def _of_gears(
    counts: tuple[Array, Array], required: list[list[float]], curves: list[LifeCurve], safety: float
) -> tuple[Array, tuple[float, float], tuple[float, float]]:
    """Parts and sums of damage of both gears, and safeties at which the sums are 1."""
    damages, safeties = list[SpectrumDamage](), list[float]()
    for cycles, needed, curve in zip(counts, required, curves, strict=True):
        damages.append(miner(cycles.tolist(), needed, curve, safety))
        safeties.append(spectrum_safety(partial(_damage, cycles, np.array(needed), curve)))
    parts = np.array([damage.parts for damage in damages])
    return parts, (damages[0].damage, damages[1].damage), (safeties[0], safeties[1])


def _damage(cycles: Array, required: Array, curve: LifeCurve, safety: float) -> float:
    """Miner's sum as of `miner`, of arrays that were checked."""
    with np.errstate(divide="ignore"):
        return float(np.sum(cycles / curve.lives(safety * required)))
