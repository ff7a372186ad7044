"""Sections of the report about root stress, torques and a revolution."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm import figures
from flankfilm.report.page import Part, Table, picture
from flankfilm.report.text import number, percent

if TYPE_CHECKING:
    import xarray as xr

    from fem import MeshCycle
    from flankfilm.coupling import RootStresses, TorqueCurves


def root_stress(stage: RootStresses, results: xr.Dataset) -> Part:
    """Stress at the roots by finite elements, beside ISO 6336-3."""
    gears = {"pinion": stage.stress.pinion, "wheel": stage.stress.wheel}
    rows: list[tuple[str, ...]] = []
    for name, gear in gears.items():
        for what, peak in (("tension", gear.greatest_tension), ("compression", gear.greatest_compression)):
            rows.append(
                (
                    f"{name}, greatest {what}",
                    number(1e-6 * peak.stress_Pa),
                    number(1e-6 * peak.von_mises_Pa),
                    f"{peak.position:.3f}",
                    f"{math.degrees(peak.tangent_angle):.1f}",
                )
            )
    heads = (
        "",
        "principal [MPa]",
        "von Mises [MPa]",
        "at [base pitches after A]",
        "tangent of the fillet [deg]",
    )
    tables = [Table(heads, tuple(rows), f"Numerical error: {percent(stage.stress.error)}.")]
    notes = []
    if stage.iso is not None:
        tables.append(_iso(stage.iso))
        notes.append(
            "ISO 6336-3 puts the whole force on one pair at D and knows neither neighbours nor the bore; its error "
            "is unknown."
        )
    else:
        notes.append(f"ISO 6336-3 has no answer: {stage.iso_fault}")
    caption = (
        "Stress along the fillets of one tooth as it passes through the mesh: largest under the loaded flank, least "
        "on the other side."
    )
    drawn = picture(figures.root_stress, results, caption)
    return Part("roots", "Root stress", figures=(drawn,), tables=tuple(tables), notes=tuple(notes))


def _iso(iso: Any) -> Table:
    rows = [
        (symbol, *(number(getattr(section, symbol), 5) for section in iso.sections))
        for symbol in ("Y_F", "Y_S", "s_Fn", "h_Fe", "rho_F", "q_s")
    ]
    rows.append(("Y_B", *(number(value, 4) for value in iso.Y_B)))
    rows.append(("nominal root stress sigma_F0 [MPa]", *(number(1e-6 * value, 5) for value in iso.stresses)))
    return Table(("ISO 6336-3, lengths in modules", "pinion", "wheel"), tuple(rows))


def over_torque(stage: TorqueCurves, face_width: float, results: xr.Dataset) -> Part:
    """Stiffness and transmission error over torque."""
    scale = 1e-9 / face_width
    rows = tuple(
        (number(t), number(scale * s, 5), number(scale * k, 5), number(1e6 * e), number(h))
        for t, s, k, e, h in zip(
            *(
                column.tolist()
                for column in (
                    stage.torque,
                    stage.secant_stiffness,
                    stage.stiffness,
                    stage.transmission_error,
                    stage.harmonic_1,
                )
            ),
            strict=True,
        )
    )
    heads = (
        "torque [N m]",
        "mean secant [N/(mm µm)]",
        "mean tangent [N/(mm µm)]",
        "transmission error, peak to peak [µm]",
        "first harmonic over the mean",
    )
    caption = "Mean stiffness and transmission error over torque, without film."
    drawn = picture(figures.over_torque, results, caption)
    notes = (f"Left out: {stage.message}",) if stage.message else ()
    return Part("torques", "Torque", figures=(drawn,), tables=(Table(heads, rows),), notes=notes)


def revolution(cycle: MeshCycle, results: xr.Dataset) -> Part:
    """Transmission error tooth by tooth."""
    loaded, unloaded = cycle.transmission_error, cycle.unloaded_transmission_error
    caption = (
        "Transmission error tooth by tooth, with pitch deviations where the scene gives them, without film; positive "
        "when the wheel lags."
    )
    drawn = picture(figures.revolution, results, caption)
    rows = (
        ("under load", number(1e6 * float(np.ptp(loaded)))),
        ("without load", number(1e6 * float(np.ptp(unloaded)))),
    )
    table = Table(("transmission error", "peak to peak [µm]"), rows)
    return Part("revolution", "Revolution", figures=(drawn,), tables=(table,), notes=(cycle.message,))
