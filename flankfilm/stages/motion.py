"""Fourier stiffness of the mesh, and the oscillator that it drives."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from base import SolverError
from flankfilm.build import pinion_torque
from flankfilm.mesh_stiffness import MeshStiffness
from flankfilm.stages.series_choice import asked_order, choose_order, left_out

if TYPE_CHECKING:
    from collections.abc import Sequence

    from dynamics import FourierFit, FourierStiffness, GearOscillator, Scaling
    from flankfilm.scene.dynamics import DynamicsSection
    from flankfilm.stages.decisions import Decision
    from flankfilm.stages.engine import Engine

MEAN_FORCE = 0.1
"""Dimensionless mean force that the length scale is chosen for, unless the scene gives the scale."""


@dataclass(frozen=True)
class FourierStage:
    """Fourier series of the mesh stiffness that the motion uses.

    Attributes
    ----------
    stiffness : FourierStiffness
        Mean and amplitudes [N/m], or over the mean where the scene gives no mean.
    fit : FourierFit or None
        The fit with its remainder; None for a given stiffness.
    kind : str
        ``"secant"``, ``"tangent"`` or ``"given"``.
    source : str
        Label of the mesh stiffness.
    other : FourierFit or None
        Fit of the kind that was not chosen, to compare.
    decision : Decision or None
        Order of the series and what it leaves out; None for a given stiffness.
    """

    stiffness: FourierStiffness
    fit: FourierFit | None
    kind: str
    source: str
    other: FourierFit | None
    decision: Decision | None = None


@dataclass(frozen=True)
class ScalingStage:
    """Oscillator of the scene, and its scales where there are physical ones.

    Attributes
    ----------
    oscillator : GearOscillator
        At the scene's speed, or at the start of the sweep.
    scales : Scaling or None
        None for a scene in the oscillator's own units.
    force : float
        Normal force [N]; 0 without scales.
    error_amplitude, backlash : float
        Unloaded error amplitude and whole backlash along the line of action [m]; 0 without scales.
    inertias : tuple of float
        Moments of inertia of pinion and wheel [kg m2]; zeros without scales.
    """

    oscillator: GearOscillator
    scales: Scaling | None
    force: float = 0.0
    error_amplitude: float = 0.0
    backlash: float = 0.0
    inertias: tuple[float, float] = (0.0, 0.0)

    def rows(self) -> tuple[tuple[str, str, str], ...]:
        """Quantities, physical and dimensionless, as text for tables."""
        osc, scales = self.oscillator, self.scales
        own = {
            "mean force F_m": osc.mean_force,
            "error amplitude epsilon": osc.error_amplitude,
            "half backlash D": osc.half_backlash,
            "damping ratio zeta": osc.damping_ratio,
            "mesh frequency omega": osc.frequency,
        }
        if scales is None:
            return tuple((name, "", f"{value:.6g}") for name, value in own.items())
        damping = scales.damping(osc.damping_ratio)
        physical = (
            f"{self.force:.6g} N",
            f"{1e6 * self.error_amplitude:.4g} µm",
            f"{1e6 * self.backlash / 2:.4g} µm",
            f"{damping:.4g} N s/m",
            f"{scales.rpm(osc.frequency):.6g} rpm of the pinion",
        )
        rows = [
            (name, text, f"{value:.6g}") for (name, value), text in zip(own.items(), physical, strict=True)
        ]
        rows += [
            ("length scale b_c", f"{1e6 * scales.length:.5g} µm", "1"),
            ("mean stiffness k_m", f"{scales.mean_stiffness:.5g} N/m", "1"),
            ("equivalent mass m_e", f"{scales.equivalent_mass:.5g} kg", "1"),
            ("natural frequency", f"{scales.natural_frequency:.5g} Hz", "1"),
            ("inertias J1, J2", ", ".join(f"{j:.4g}" for j in self.inertias) + " kg m²", ""),
        ]
        return tuple(rows)


def mesh(engine: Engine) -> MeshStiffness:
    """Mesh stiffness that the motion uses: with the film where there is one."""
    if engine["plan"].film.choice == "none":
        dry: MeshStiffness = engine["dry cycle"]
        return dry
    lubricated: MeshStiffness = engine["film"].cycle
    return lubricated


def fourier(engine: Engine) -> FourierStage:
    """Fit the mesh stiffness, or take the given one."""
    from dynamics import FourierStiffness, fit_fourier

    scene = engine.scene
    if scene.stiffness.model == "given":
        mean = scene.stiffness.mean_N_per_m or 1.0
        kappa = scene.stiffness.amplitudes or ()
        phases = scene.stiffness.phases_deg or (0.0,) * len(kappa)
        series = FourierStiffness(
            mean, tuple(mean * k for k in kappa), tuple(math.radians(p) for p in phases)
        )
        return FourierStage(series, None, "given", "given in the scene", None)
    section = scene.dynamics
    kind = section.stiffness if section else "secant"
    cycle: MeshStiffness = engine["mesh"]
    samples = cycle.stiffness(kind)
    spectrum = np.abs(np.fft.rfft(samples))
    resolved = 2.0 * spectrum[1 : (samples.size + 1) // 2] / spectrum[0]
    beyond = left_out(
        resolved, _range(engine, float(samples.mean())), section.damping_ratio if section else 0.0
    )
    if section is not None and section.fourier_order == "auto":
        share = engine["plan"].series
        order, decision = choose_order(beyond, share if share is not None else scene.tolerance)
    else:
        order = int(section.fourier_order) if section else 1
        decision = asked_order(beyond, order)
    fit = fit_fourier(samples, order=order)
    other = fit_fourier(cycle.stiffness("tangent" if kind == "secant" else "secant"), order=order)
    return FourierStage(fit.stiffness, fit, kind, cycle.label, other, decision)


def _range(engine: Engine, mean: float) -> tuple[float, float] | None:
    """Range of the mesh frequency over the natural one that sweep and diagram cover; None without either."""
    section, wants = engine.scene.dynamics, engine.scene.wants
    asked = [r for r in (section.sweep, section.diagram) if r is not None] if section else []
    if section is None or not asked or not {"sweep", "diagram"} & set(wants):
        return None
    if section.dimensionless:
        return _hull([r.frequency for r in asked if r.frequency is not None])
    scales = _scales(engine, section, mean)
    return _hull(
        [
            (scales.frequency_from_rpm(r.speed_rpm[0]), scales.frequency_from_rpm(r.speed_rpm[1]))
            if r.speed_rpm is not None
            else r.frequency
            for r in asked
            if r.speed_rpm is not None or r.frequency is not None
        ]
    )


def _hull(ranges: Sequence[tuple[float, float] | None]) -> tuple[float, float]:
    """Least and largest of all bounds."""
    ends = [end for both in ranges if both is not None for end in both]
    return min(ends), max(ends)


def scaling(engine: Engine) -> ScalingStage:
    """Build the oscillator."""
    from dynamics import GearOscillator

    scene, series = engine.scene, engine["fourier"].stiffness
    section = _section(engine)
    phase = math.radians(section.error_phase_deg)
    if section.dimensionless:
        assert section.error_amplitude is not None
        assert section.half_backlash is not None
        assert section.mean_force is not None
        ranged = section.sweep or section.diagram
        frequency = ranged.frequency[0] if ranged and ranged.frequency else 1.0
        oscillator = GearOscillator(
            stiffness=series.normalised(),
            damping_ratio=section.damping_ratio,
            mean_force=section.mean_force,
            error_amplitude=section.error_amplitude,
            frequency=frequency,
            half_backlash=section.half_backlash,
            error_phase=phase,
            one_sided=section.one_sided,
        )
        return ScalingStage(oscillator, None)
    pair = engine["pair"]
    force = pair.normal_force(pinion_torque(scene))
    scales = _scales(engine, section, series.mean)
    error = 1e-6 * (section.error_amplitude_um or 0.0)
    rpm = scene.operating.pinion_speed_rpm if scene.operating else None
    if rpm is None:
        ranged = section.sweep or section.diagram
        rpm = ranged.speed_rpm[0] if ranged and ranged.speed_rpm else 60.0
    oscillator = scales.oscillator(
        stiffness=series,
        damping_ratio=section.damping_ratio,
        force=force,
        error_amplitude=error,
        half_backlash=0.5 * pair.backlash,
        speed=rpm * math.pi / 30,
        error_phase=phase,
    )
    oscillator = replace(oscillator, one_sided=section.one_sided)
    return ScalingStage(oscillator, scales, force, error, pair.backlash, _inertias(engine, section))


def _inertias(engine: Engine, section: DynamicsSection) -> tuple[float, float]:
    """Moments of inertia of pinion and wheel with what turns with them [kg m2]."""
    (first, second), extra = engine["pair"].moments_of_inertia, section.extra_inertia_kg_m2
    return first + extra.pinion, second + extra.wheel


def _scales(engine: Engine, section: DynamicsSection, mean: float) -> Scaling:
    """Scales of the oscillator for a mean stiffness [N/m]."""
    from dynamics import Scaling

    pair, scale = engine["pair"], section.length_scale_um
    return Scaling.from_inertias(
        inertias=_inertias(engine, section),
        base_radii=pair.base_radii,
        mean_stiffness=mean,
        cycles_per_revolution=pair.pinion.teeth,
        length=None if scale is None else 1e-6 * scale,
        force=pair.normal_force(pinion_torque(engine.scene)) if scale is None else None,
        mean_force=MEAN_FORCE if scale is None else None,
    )


def _section(engine: Engine) -> DynamicsSection:
    section = engine.scene.dynamics
    if section is None:
        raise SolverError("the motion needs a section [dynamics]")
    return section
