"""Tangent or secant? The motion with the loaded law itself: force over deflection and angle by finite elements.

A torque sweep of the loaded contact gives the deflection under each force at each position. `TabulatedContact` makes a
law of it. The same pair moves under three laws of the same number of harmonics: the secant stiffness and the tangent
stiffness at the mean load (both by the exact flow), and the law itself (by the stepwise flow).

    python examples/motion/loaded_law.py --out out/loaded_law [--order 1 2 4] [--held]
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from drawing import where_stable
from matplotlib.figure import Figure
from numpy.typing import NDArray

import dynamics
import fem
from dynamics import (
    Branch,
    GearOscillator,
    Scaling,
    SmoothOscillator,
    SpecialPoint,
    TabulatedContact,
    fit_fourier,
)
from dynamics.flow.motions import turning_points
from flankfilm.figures.style import COLOURS, MARK, legend_over, save, sheet
from gears import BasicRack, Gear, GearPair, Material

Array = NDArray[np.float64]
TORQUE = 600.0  # N m
SHARES = (0.003, 0.01, 0.03, 0.08, 0.2, 0.4, 0.7, 1.0, 1.5, 2.2, 3.2, 4.5)  # of it, in the sweep
SPEEDS = (6000.0, 13000.0)  # rpm
DAMPING, ERROR, BACKLASH, POSITIONS = 0.05, 10e-6, 50e-6, 40
LAWS = {"secant": COLOURS[0], "tangent": COLOURS[1], "loaded law": COLOURS[6]}


@dataclass(frozen=True)
class MeshSetup:
    """The pair, its sweep and its scales.

    Attributes
    ----------
    force : (p,) array
        Normal forces of the sweep [N].
    deflection : (positions, p) array
        Their deflections [m].
    secant, tangent : (positions,) array
        Stiffness at the mean load [N/m].
    load : float
        Mean normal force [N].
    scales : Scaling
        By the mean secant stiffness.
    play : float
        Half the backlash along the line of action [m].
    """

    force: Array
    deflection: Array
    secant: Array
    tangent: Array
    load: float
    scales: Scaling
    play: float


@dataclass(frozen=True)
class Curve:
    """Motions of period 1 over the speed under one law.

    Attributes
    ----------
    name : str
        Law.
    rpm, swing, highest : (m,) array
        Pinion speed, peak-to-peak and maximum displacement [um].
    stable : (m,) array of bool
        Stability.
    jumps : tuple of (float, float)
        Speed [rpm] and swing [um] of the folds.
    others : tuple of str
        Other special points, with speed.
    branch : Branch
        As computed.
    """

    name: str
    rpm: Array
    swing: Array
    highest: Array
    stable: NDArray[np.bool_]
    jumps: tuple[tuple[float, float], ...]
    others: tuple[str, ...]
    branch: Branch


def article_pair() -> GearPair:
    steel = Material(youngs_modulus=200.2e9, poisson_ratio=0.3, density=7850.0)
    pair = GearPair(
        pinion=Gear(teeth=36, profile_shift=0.0, bore_radius=0.5 * 0.0335),
        wheel=Gear(teeth=40, profile_shift=0.0, bore_radius=0.5 * 0.0375),
        module=2e-3,
        face_width=40e-3,
        rack=BasicRack(),
        material=steel,
        centre_distance=None,
    )
    return pair.with_backlash(BACKLASH)


def setting(held: bool) -> MeshSetup:
    """Finite elements: deflections under every force, and the scales."""
    pair = article_pair()
    cycles = fem.mesh_cycle(
        pair, TORQUE * np.array(SHARES), POSITIONS, fem.compliance(pair, tolerance=0.002), not held
    )
    if not all(cycle.converged for cycle in cycles):
        raise SystemExit("\n".join(c.message for c in cycles if not c.converged))
    mean = cycles[SHARES.index(1.0)]
    force = np.array([cycle.force for cycle in cycles])
    deflection = np.stack([cycle.force / cycle.secant_stiffness for cycle in cycles], axis=1)
    scales = Scaling.from_inertias(
        inertias=pair.moments_of_inertia,
        base_radii=pair.base_radii,
        mean_stiffness=float(mean.secant_stiffness.mean()),
        cycles_per_revolution=pair.pinion.teeth,
        force=mean.force,
        mean_force=0.1,
    )
    return MeshSetup(
        force, deflection, mean.secant_stiffness, mean.stiffness, mean.force, scales, 0.5 * pair.backlash
    )


def law(setup: MeshSetup, order: int) -> TabulatedContact:
    """The loaded law, dimensionless."""
    scales = setup.scales
    return TabulatedContact.from_deflections(
        setup.force / (scales.mean_stiffness * scales.length),
        setup.deflection / scales.length,
        half_backlash=scales.scaled(setup.play),
        order=order,
        first_angle=math.pi / POSITIONS,
    )


def oscillators(setup: MeshSetup, order: int) -> dict[str, GearOscillator | SmoothOscillator]:
    """The three laws at the lowest speed."""
    scales = setup.scales
    linear = {
        name: scales.oscillator(
            stiffness=fit_fourier(samples, order=order).stiffness,
            damping_ratio=DAMPING,
            force=setup.load,
            error_amplitude=ERROR,
            half_backlash=setup.play,
            speed=SPEEDS[0] * math.pi / 30.0,
        )
        for name, samples in (("secant", setup.secant), ("tangent", setup.tangent))
    }
    secant = linear["secant"]
    loaded = SmoothOscillator(
        law(setup, order), DAMPING, secant.mean_force, secant.error_amplitude, secant.frequency
    )
    return {**linear, "loaded law": loaded}


def curve(name: str, osc: GearOscillator | SmoothOscillator, setup: MeshSetup) -> Curve:
    """Follow the motion of period 1 from the lowest speed."""
    low, high = (setup.scales.frequency_from_rpm(rpm) for rpm in SPEEDS)
    smooth = isinstance(osc, SmoothOscillator)
    start = (osc.floor if smooth else osc.floor + osc.mean_force, 0.0)
    orbit = dynamics.find_orbit(osc, start, transient=300, tolerance=1e-10 if smooth else None)
    branch = dynamics.continue_branch(orbit, "frequency", (low, high))
    ends = np.array([extent(osc, w, x) for w, x in zip(branch.values, branch.states, strict=True)])
    um = 1e6 * setup.scales.length * ends
    folds = branch.special("saddle-node")

    def swing(point: SpecialPoint) -> float:
        ends = extent(osc, point.parameter, point.state)
        return 1e6 * setup.scales.length * (ends[1] - ends[0])

    rest = [p for p in branch.points if p.kind != "saddle-node"]
    return Curve(
        name, np.array([setup.scales.rpm(w) for w in branch.values]), um[:, 1] - um[:, 0], um[:, 1], branch.stable,
        tuple((setup.scales.rpm(p.parameter), swing(p)) for p in folds),
        tuple(f"{p.kind} {setup.scales.rpm(p.parameter):.0f}" for p in rest), branch,
    )  # fmt: skip


def extent(osc: GearOscillator | SmoothOscillator, frequency: float, state: Array) -> tuple[float, float]:
    """Minimum and maximum X of the motion of period 1 through a state."""
    here = osc.with_parameter("frequency", float(frequency))
    if isinstance(here, SmoothOscillator):
        events = dynamics.period_map(here, state, extrema=True, tolerance=1e-8).events
        x = events[events[:, 1] == events[:, 1].max(), 3]
    else:
        x = turning_points(here, state)[:, 1]
    return float(x.min()), float(x.max())


def figure(setup: MeshSetup, curves: Sequence[Curve], order: int) -> Figure:
    """Laws at the stiffest and the softest position, and the swing over the speed: stable solid, folds as dots."""
    with sheet(None, 1, 2, width=7.6, height=3.8, legend=0, width_ratios=(1, 1.5)) as (page, (left, right)):
        for row, dash in ((int(np.argmax(setup.secant)), "-"), (int(np.argmin(setup.secant)), "--")):
            end = "stiffest" if dash == "-" else "softest"
            at = setup.load / setup.secant[row]
            line = np.array([0.0, 2.0 * at])
            x, force = 1e6 * line, {"secant": setup.secant[row] * line}
            force["tangent"] = setup.load + setup.tangent[row] * (line - at)
            left.plot(1e6 * setup.deflection[row], 1e-3 * setup.force, "k.", markersize=4)
            for law, curve in force.items():
                left.plot(x, 1e-3 * curve, dash, color=LAWS[law], label=f"{law}, {end}")
        left.plot([], [], "k.", markersize=6, label="finite elements")
        left.axhline(1e-3 * setup.load, color=MARK, linestyle="-", linewidth=0.8)
        left.set(xlabel="deflection [µm]", ylabel="normal force [kN]", xlim=(0, 60), ylim=(0, 50))
        for response in curves:
            for wanted, dash in ((True, "-"), (False, ":")):
                swing = where_stable(response.stable, response.swing, wanted)
                label = response.name if wanted else None
                right.plot(response.rpm, swing, dash, color=LAWS[response.name], linewidth=1.2, label=label)
            for speed, reached in response.jumps:
                right.plot(speed, reached, "o", color=LAWS[response.name], markersize=4)
        harmonics = "one harmonic" if order == 1 else f"{order} harmonics"
        right.set(xlabel="pinion speed [rpm]", ylabel=f"peak to peak, {harmonics} [µm]", xlim=SPEEDS)
        right.set_ylim(bottom=0.0)
        legend_over(left, 2)
        legend_over(right, 3)
    return page


def summary(setup: MeshSetup, curves: Sequence[Curve], order: int) -> str:
    """Jump speeds, maximum swings, and what differs."""
    lines = [f"{order} harmonic(s)"]
    for response in curves:
        jumps = ", ".join(f"{speed:.0f}" for speed, _ in response.jumps) or "none"
        steady = np.where(response.stable, response.swing, -np.inf)
        peak = int(np.argmax(steady))
        lines.append(
            f"  {response.name:10s} jumps at {jumps} rpm; maximum stable swing {response.swing[peak]:.1f} um at "
            f"{response.rpm[peak]:.0f} rpm, contact {response.highest[peak] - 1e6 * setup.play:.0f} um deep; "
            f"{response.branch.message}"
        )
        lines.append(f"             {'; '.join(response.others) or 'no other special points'}")
    for rpm in (6500.0, 7500.0, 8500.0, 11000.0, 12500.0):
        swings = [float(np.interp(rpm, *lowest_branch(response, rpm))) for response in curves]
        row = ", ".join(
            f"{response.name} {swing:.2f}" for response, swing in zip(curves, swings, strict=True)
        )
        lines.append(f"  swing at {rpm:.0f} rpm [um]: {row}")
    return "\n".join(lines)


def lowest_branch(response: Curve, rpm: float) -> tuple[Array, Array]:
    """The two neighbours of a speed between which the stable swing is smallest."""
    between = (response.rpm[:-1] - rpm) * (response.rpm[1:] - rpm) <= 0.0
    good = np.flatnonzero(between & response.stable[:-1] & response.stable[1:])
    if not good.size:
        return np.array([rpm]), np.array([np.nan])
    at = good[np.argmin(response.swing[good])]
    pair = np.argsort(response.rpm[at : at + 2]) + at
    return response.rpm[pair], response.swing[pair]


def main(arguments: Sequence[str] | None = None) -> list[Path]:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True, help="folder of the figures")
    parser.add_argument("--order", type=int, nargs="+", default=[1, 2, 4], help="harmonics kept")
    parser.add_argument("--held", action="store_true", help="hold the contact to the path")
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    here = setting(options.held)
    mean = here.scales
    text = [
        f"mean load {here.load:.0f} N, mean secant {here.secant.mean():.4g} N/m, mean tangent "
        f"{here.tangent.mean():.4g} N/m, natural frequency {mean.natural_frequency:.0f} Hz"
    ]
    files = []
    for order in options.order:
        loaded = law(here, order)
        curves = [curve(name, osc, here) for name, osc in oscillators(here, order).items()]
        text.append(summary(here, curves, order))
        text.append(
            f"  the loaded law leaves out {100 * loaded.remainder:.2g} % of the mean force at most, and reaches to "
            f"{1e6 * mean.length * loaded.reach:.0f} um"
        )
        files.append(options.out / f"loaded_law_{order}.png")
        save(figure(here, curves, order), files[-1])
    files.append(options.out / "loaded_law.txt")
    files[-1].write_text("\n".join(text) + "\n", encoding="utf-8")
    sys.stdout.write("\n".join(text) + "\n")
    return files


if __name__ == "__main__":
    main()
