"""Section of the report about the oscillator: its numbers, physical and dimensionless."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.coupling.mesh.references import MEANINGS
from flankfilm.coupling.vibration.excitation import peak_to_peak
from flankfilm.report.page import Part, Table, said

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import PairOscillator

LISTED = 6
"""Harmonics of the error that are listed."""


def scaling(stage: PairOscillator, _: xr.Dataset) -> Part:
    """Physical and dimensionless quantities side by side; dimensionless ones alone where there are no scales."""
    if stage.scales is None:
        table = Table(
            ("quantity", "dimensionless"), tuple((name, value) for name, _, value in oscillator_rows(stage))
        )
        return Part("scaling", "Oscillator", tables=(table,))
    table = Table(("quantity", "physical", "dimensionless"), oscillator_rows(stage))
    notes = [said("measured_against", what=MEANINGS[stage.reference])] if stage.reference else []
    return Part("scaling", "Physical and dimensionless", tables=(table,), notes=tuple(notes))


def oscillator_rows(stage: PairOscillator) -> tuple[tuple[str, str, str], ...]:
    """Quantities, physical and dimensionless, as text for tables."""
    osc, scales = stage.oscillator, stage.scales
    damping = "" if scales is None else f"{scales.damping(osc.damping_ratio):.4g} N s/m"
    rpm = "" if scales is None else f"{scales.rpm(osc.frequency):.6g} rpm of the pinion"
    own = [
        ("mean force F_m", f"{stage.force:.6g} N", f"{osc.mean_force:.6g}"),
        *_error_rows(stage),
        ("half backlash D", f"{1e6 * stage.backlash / 2:.4g} µm", f"{osc.half_backlash:.6g}"),
        ("damping ratio zeta", damping, f"{osc.damping_ratio:.6g}"),
        *_free_rows(stage),
        ("mesh frequency omega", rpm, f"{osc.frequency:.6g}"),
    ]
    if scales is None:
        return tuple((name, "", value) for name, _, value in own)
    return (
        *own,
        ("length scale b_c", f"{1e6 * scales.length:.5g} µm", "1"),
        ("mean stiffness k_m", f"{scales.mean_stiffness:.5g} N/m", "1"),
        ("equivalent mass m_e", f"{scales.equivalent_mass:.5g} kg", "1"),
        ("natural frequency", f"{scales.natural_frequency:.5g} Hz", "1"),
        ("resonance speed n_E1", f"{scales.rpm(1.0):.5g} rpm of the pinion", "1"),
        ("inertias J1, J2", ", ".join(f"{j:.4g}" for j in stage.inertias) + " kg m²", ""),
    )


def _free_rows(stage: PairOscillator) -> list[tuple[str, str, str]]:
    """Damping in the backlash, where it is another one."""
    free = stage.oscillator.free_damping_ratio
    if free is None:
        return []
    damping = "" if stage.scales is None else f"{stage.scales.damping(free):.4g} N s/m"
    return [("damping ratio in the backlash zeta_0", damping, f"{free:.6g}")]


def _error_rows(stage: PairOscillator) -> list[tuple[str, str, str]]:
    """Amplitudes of the error, the first of many, and its range where there are several."""
    own = stage.oscillator.error_series[0]
    physical = np.resize(stage.error_amplitude, len(own)) if stage.scales else np.zeros(len(own))
    if len(own) == 1:
        return [("error amplitude epsilon", f"{1e6 * physical[0]:.4g} µm", f"{own[0]:.6g}")]
    rows = [
        (f"error amplitude epsilon_{j}", f"{1e6 * e:.4g} µm", f"{x:.6g}")
        for j, (e, x) in enumerate(zip(physical[:LISTED], own[:LISTED], strict=True), start=1)
    ]
    rest = f", {len(own)} harmonics" if len(own) > LISTED else ""
    whole = peak_to_peak(*stage.oscillator.error_series)
    return [*rows, (f"error, peak to peak{rest}", f"{1e6 * stage.error_range:.4g} µm", f"{whole:.6g}")]
