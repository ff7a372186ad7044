"""Sections of the report about root stress, torques and a revolution."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from flankfilm import figures
from flankfilm.figures.reading import read, read_figure
from flankfilm.report.page import Headline, Part, Table, picture, table_of
from flankfilm.report.text import number, percent

if TYPE_CHECKING:
    import xarray as xr

    from fem import MeshCycle
    from flankfilm.coupling import RootStresses, TorqueCurves
    from gears.closed_form import Iso6336RootStress


def root_stress(stage: RootStresses, results: xr.Dataset) -> Part:
    """Stress at the roots by finite elements, beside ISO 6336-3."""
    gears = {"pinion": stage.stress.pinion, "wheel": stage.stress.wheel}
    rows = tuple(
        (
            f"{name}, greatest {what}",
            number(1e-6 * peak.stress_Pa),
            number(1e-6 * peak.von_mises_Pa),
            f"{peak.position:.3f}",
            f"{math.degrees(peak.tangent_angle):.1f}",
        )
        for name, gear in gears.items()
        for what, peak in (("tension", gear.greatest_tension), ("compression", gear.greatest_compression))
    )
    heads = (
        "",
        "principal [MPa]",
        "von Mises [MPa]",
        "at [base pitches after A]",
        "tangent of the fillet [deg]",
    )
    tables = [Table(heads, rows, f"Numerical error: {percent(stage.error)}.")]
    note = f"ISO 6336-3 has no answer: {stage.iso_fault}"
    if stage.iso is not None:
        tables.append(_iso(stage.iso))
        note = (
            "ISO 6336-3 puts the whole force on one pair at D and knows neither neighbours nor the bore; its error "
            "is unknown."
        )
    caption = (
        "Stress along the fillets of one tooth as it passes through the mesh: largest under the loaded flank, least "
        "on the other side."
    )
    drawn = picture(figures.root_stress, results, caption)
    return Part("roots", "Root stress", figures=(drawn,), tables=tuple(tables), notes=(note,))


def headline(stage: RootStresses) -> Headline:
    """Greatest stresses of both gears."""
    largest = [read_figure(stage.stress, f"{gear}_tension_Pa") for gear in ("pinion", "wheel")]
    values = " and ".join(f"{float(one.values):.4g}" for one in largest)
    note = f"error {percent(stage.error)}"
    return Headline("greatest root stress, pinion and wheel", values, note, largest[0].unit)


def _iso(iso: Iso6336RootStress) -> Table:
    rows = [
        (symbol, *(number(getattr(section, symbol), 5) for section in iso.sections))
        for symbol in ("Y_F", "Y_S", "s_Fn", "h_Fe", "rho_F", "q_s")
    ]
    rows.append(("Y_B", *(number(value, 4) for value in iso.Y_B)))
    rows.append(("nominal root stress sigma_F0 [MPa]", *(number(1e-6 * value, 5) for value in iso.stresses)))
    return Table(("ISO 6336-3, lengths in modules", "pinion", "wheel"), tuple(rows))


def over_torque(stage: TorqueCurves, results: xr.Dataset) -> Part:
    """Stiffness and transmission error over torque."""
    names = (
        "torque",
        "torque_secant_stiffness",
        "torque_stiffness",
        "torque_transmission_error",
        "torque_harmonic_1",
    )
    table = table_of([read(results, name, per_face=name.endswith("stiffness")) for name in names], 5)
    caption = "Mean stiffness and transmission error over torque, without film."
    drawn = picture(figures.over_torque, results, caption)
    notes = (f"Left out: {stage.message}",) if stage.message else ()
    return Part("torques", "Torque", figures=(drawn,), tables=(table,), notes=notes)


def revolution(cycle: MeshCycle, results: xr.Dataset) -> Part:
    """Transmission error tooth by tooth."""
    caption = (
        "Transmission error tooth by tooth, with pitch deviations where the scene gives them, without film; positive "
        "when the wheel lags."
    )
    drawn = picture(figures.revolution, results, caption)
    curves = {
        name: read(results, f"revolution_{name}")
        for name in ("transmission_error", "unloaded_transmission_error")
    }
    rows = tuple(
        (label, number(float(np.ptp(curve.values))))
        for label, curve in zip(("under load", "without load"), curves.values(), strict=True)
    )
    head = curves["transmission_error"].named("peak to peak")
    table = Table(("transmission error", head), rows)
    return Part("revolution", "Revolution", figures=(drawn,), tables=(table,), notes=(cycle.message,))
