"""Bifurcation diagram of the scene: ranges, jumps with their error budgets, dynamic factors."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from base import SolverError

if TYPE_CHECKING:
    from dynamics import Diagram, FourierStiffness, GearOscillator, SpecialPoint
    from dynamics.labelling import Stretch
    from flankfilm.stages.engine import Engine
    from flankfilm.stages.motion import FourierStage, ScalingStage

Array = NDArray[np.float64]

DROPPED = 4
"""Harmonics beyond the series that the error budget looks at."""


@dataclass(frozen=True)
class Jump:
    """End of a stable motion at a saddle node, where the motion jumps.

    Attributes
    ----------
    frequency : float
        Mesh frequency over the natural frequency.
    rising : bool
        Whether the motion ends as the speed rises.
    label : str
        The motion that ends.
    budget : mapping
        Source of error to relative error of the speed: ``"stiffness"``, ``"series"``, ``"flow"``; empty for a
        scene in the oscillator's own units.
    second : float
        Relative change of the speed by the first harmonic that the series leaves out, to first order; 0 if none.
    """

    frequency: float
    rising: bool
    label: str
    budget: Mapping[str, float]
    second: float

    @property
    def error(self) -> float:
        """Sum of the budget."""
        return math.fsum(self.budget.values())


@dataclass(frozen=True)
class DiagramStage:
    """Diagram and what follows from it.

    Attributes
    ----------
    diagram : dynamics.Diagram
        Branches over the mesh frequency.
    rpm_per_frequency : float or None
        Pinion speed of frequency 1 [rpm].
    stable : tuple of Stretch
        Stable motions with their ranges.
    separated, back_contact : tuple of (float, float)
        Frequencies at which some stable motion loses contact, and touches the back flank.
    jumps : tuple of Jump
        By frequency.
    variants : mapping
        Name to jump frequencies with another law or a longer series.
    factor : ndarray, shape (any, 3)
        Frequency, greatest force over mean force, and its standard: ISO 6336-1's K_v, NaN without a pair.
    half_backlash : float
        D.
    seconds : float
        Cost [s].
    """

    diagram: Diagram
    rpm_per_frequency: float | None
    stable: tuple[Stretch, ...]
    separated: tuple[tuple[float, float], ...]
    back_contact: tuple[tuple[float, float], ...]
    jumps: tuple[Jump, ...]
    variants: Mapping[str, tuple[float, ...]]
    factor: Array
    half_backlash: float
    seconds: float


def diagram(engine: Engine) -> DiagramStage:
    """Build the diagram of the scene's oscillator."""
    from dynamics import diagram as build

    start = time.perf_counter()
    scaled: ScalingStage = engine["scaling"]
    section = engine.scene.dynamics
    if section is None or section.diagram is None:
        raise SolverError("the diagram needs dynamics.diagram")
    asked, scales = section.diagram, scaled.scales
    if asked.speed_rpm is not None and scales is not None:
        low, high = (scales.frequency_from_rpm(rpm) for rpm in asked.speed_rpm)
    else:
        assert asked.frequency is not None
        low, high = asked.frequency
    found = build(
        scaled.oscillator, "frequency", (low, high), searches=asked.searches, max_period=asked.max_period
    )
    stable = tuple(found.stretches(stable=True))
    ends = jump_points(found)
    return DiagramStage(
        diagram=found,
        rpm_per_frequency=None if scales is None else scales.rpm(1.0),
        stable=stable,
        separated=_union([s for s in stable if _counts(s.label)[0] > 0]),
        back_contact=_union([s for s in stable if _counts(s.label)[1] > 0]),
        jumps=tuple(_jump(engine, scaled.oscillator, stretch, point) for stretch, point in ends),
        variants=_variants(engine, scaled, (low, high)),
        factor=_factors(engine, scaled, found),
        half_backlash=scaled.oscillator.half_backlash,
        seconds=time.perf_counter() - start,
    )


def jump_points(found: Diagram) -> list[tuple[Stretch, SpecialPoint]]:
    """Saddle nodes at which a stable stretch ends, by frequency."""
    ends = [
        (stretch, point)
        for stretch in found.stretches(stable=True)
        for point in stretch.limits
        if point.kind == "saddle-node"
    ]
    return sorted(ends, key=lambda end: end[1].parameter)


def _jump(engine: Engine, oscillator: GearOscillator, stretch: Stretch, point: SpecialPoint) -> Jump:
    """Carry the errors of the stages through the exact derivatives of a jump's speed.

    The speed is the frequency times sqrt(k_m): half the relative error of the mean stiffness, less what the mean
    force, which is over k_m, changes of the frequency. The amplitudes over the mean err by twice that at most.
    """
    from dynamics import special_sensitivities

    rising = stretch.high - point.parameter < point.parameter - stretch.low
    fourier: FourierStage = engine["fourier"]
    if fourier.fit is None:
        return Jump(point.parameter, rising, stretch.label, {}, 0.0)
    cycle = engine["mesh"]
    order = len(fourier.stiffness.amplitudes)
    extended, dropped = _longer(engine, oscillator, order + DROPPED)
    slopes = special_sensitivities(extended, "frequency", point)
    here = point.parameter
    stiffness = (cycle.mean_error or 0.0) + _film_error(engine, fourier.kind)
    force = abs(0.5 - slopes["mean_force"] * oscillator.mean_force / here)
    kept = [
        abs(slopes[f"stiffness.amplitudes[{j}]"]) * oscillator.stiffness.amplitudes[j] / here
        for j in range(order)
    ]
    left = [
        slopes[f"stiffness.amplitudes[{order + i}]"] * amplitude / here for i, amplitude in enumerate(dropped)
    ]
    budget = {
        "stiffness": stiffness * (force + 2.0 * math.fsum(kept)),
        "series": math.fsum(abs(change) for change in left),
        "flow": point.error,
    }
    return Jump(here, rising, stretch.label, budget, left[0] if left else 0.0)


def _film_error(engine: Engine, kind: str) -> float:
    """Relative error of the stiffness from that of the films: in proportion to what the films change it by."""
    if engine["plan"].film.choice == "none":
        return 0.0
    film = engine["film"]
    change: float = film.change_secant if kind == "secant" else film.change_tangent
    return abs(change) * (film.error or 0.0)


def _longer(
    engine: Engine, oscillator: GearOscillator, order: int
) -> tuple[GearOscillator, tuple[float, ...]]:
    """Oscillator with room for further harmonics, of amplitude zero at their phases, and the amplitudes they have."""
    from dynamics import FourierStiffness, fit_fourier

    fourier: FourierStage = engine["fourier"]
    samples = engine["mesh"].stiffness(fourier.kind)
    own = oscillator.stiffness
    whole = fit_fourier(samples, order=min(order, (len(samples) - 1) // 2)).stiffness
    further = tuple(a / whole.mean for a in whole.amplitudes[own.order :])
    series = FourierStiffness(
        own.mean, own.amplitudes + (0.0,) * len(further), own.phases + whole.phases[own.order :]
    )
    return replace(oscillator, stiffness=series), further


def _variants(
    engine: Engine, scaled: ScalingStage, bounds: tuple[float, float]
) -> dict[str, tuple[float, ...]]:
    """Jump frequencies with the other law of stiffness and with one more harmonic, in this scene's frequency."""
    from dynamics import diagram as build
    from dynamics import fit_fourier

    fourier: FourierStage = engine["fourier"]
    if fourier.fit is None or scaled.scales is None:
        return {}
    cycle, order = engine["mesh"], len(fourier.stiffness.amplitudes)
    other = "tangent" if fourier.kind == "secant" else "secant"
    found = {}
    for name, kind, number in (
        (f"{fourier.kind}, order {order}", fourier.kind, order),
        (f"{fourier.kind}, order {order + 1}", fourier.kind, order + 1),
        (f"{other}, order {order}", other, order),
    ):
        series = fit_fourier(cycle.stiffness(kind), order=number).stiffness
        mean = series.mean / scaled.scales.mean_stiffness
        changed = replace(scaled.oscillator, stiffness=_over(series, scaled.scales.mean_stiffness))
        ends = jump_points(build(changed, "frequency", bounds, periods=(1,), searches=5, max_period=1))
        found[f"{name}, mean {mean:.4f}"] = tuple(point.parameter for _, point in ends)
    return found


def _over(series: FourierStiffness, mean: float) -> FourierStiffness:
    """Series over a given mean."""
    from dynamics import FourierStiffness

    return FourierStiffness(series.mean / mean, tuple(a / mean for a in series.amplitudes), series.phases)


def _factors(engine: Engine, scaled: ScalingStage, found: Diagram) -> Array:
    """Greatest force over the mean force along stable branches of period 1 and 2, and ISO 6336-1's K_v."""
    from dynamics.robustness import force_range

    rows = []
    for branch in found.branches:
        for value, state, stable in zip(branch.values, branch.states, branch.stable, strict=True):
            if stable and branch.periods <= 2 and scaled.oscillator.mean_force != 0.0:
                here = scaled.oscillator.with_parameter("frequency", float(value))
                rows.append((float(value), force_range(here, state, branch.periods).greatest))
    curve = np.array(sorted(rows)).reshape(-1, 2)
    return np.column_stack([curve, _standard(engine, scaled, curve[:, 0])])


def _standard(engine: Engine, scaled: ScalingStage, frequency: Array) -> Array:
    """K_v after ISO 6336-1, method B; the pitch deviation is the peak-to-peak value of the scene's error."""
    from gears.closed_form import iso6336_dynamic

    scales = scaled.scales
    if scales is None:
        return np.full(len(frequency), np.nan)
    pair = engine["pair"]
    reliefs = [gear.tip_relief.amount for gear in (pair.pinion, pair.wheel) if gear.tip_relief is not None]
    factor = iso6336_dynamic(
        pair, scaled.force, scales.equivalent_mass, scales.speed(1.0) * frequency,
        pitch_deviation=2.0 * scaled.error_amplitude, relief=max(reliefs, default=0.0),
    )  # fmt: skip
    return factor.K_v


def _counts(label: str) -> tuple[int, int]:
    """Losses of contact and contacts of the back flank in a label."""
    _, p, q = label.removeprefix("U").split("-")
    return int(p), int(q)


def _union(parts: list[Stretch]) -> tuple[tuple[float, float], ...]:
    """Ranges covered by stretches, joined where they touch or overlap."""
    joined: list[tuple[float, float]] = []
    for low, high in sorted((s.low, s.high) for s in parts):
        if joined and low <= joined[-1][1] * (1.0 + 1e-9):
            joined[-1] = (joined[-1][0], max(high, joined[-1][1]))
        else:
            joined.append((low, high))
    return tuple(joined)
