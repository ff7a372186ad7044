"""Sections of the report about root stress, torques and a revolution."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.figures import loads as figures
from flankfilm.load_outputs import passing
from flankfilm.report.page import Part, Table, drawing
from flankfilm.report.text import number, percent

if TYPE_CHECKING:
    from fem import MeshCycle
    from flankfilm.stages.loads import TorqueStage
    from flankfilm.stages.roots import RootStage


def root_stress(stage: RootStage) -> Part:
    """Stress at the roots by finite elements, beside ISO 6336-3."""
    gears = {"pinion": stage.stress.pinion, "wheel": stage.stress.wheel}
    nominal = {} if stage.iso is None else dict(zip(gears, stage.iso.stresses, strict=True))
    rows: list[tuple[str, ...]] = []
    for name, gear in gears.items():
        for what, peak in (("tension", gear.greatest_tension), ("compression", gear.greatest_compression)):
            rows.append(
                (
                    f"{name}, greatest {what}",
                    number(1e-6 * peak.stress_Pa),
                    number(1e-6 * peak.von_mises_Pa),
                    f"{peak.way:.3f}",
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
    picture = drawing(
        figures.root_stress({name: passing(gear) for name, gear in gears.items()}, nominal), "roots", caption
    )
    return Part("roots", "Root stress", figures=(picture,), tables=tuple(tables), notes=tuple(notes))


def _iso(iso: Any) -> Table:
    rows = [
        (symbol, *(number(getattr(section, symbol), 5) for section in iso.sections))
        for symbol in ("Y_F", "Y_S", "s_Fn", "h_Fe", "rho_F", "q_s")
    ]
    rows.append(("Y_B", *(number(value, 4) for value in iso.Y_B)))
    rows.append(("nominal root stress sigma_F0 [MPa]", *(number(1e-6 * value, 5) for value in iso.stresses)))
    return Table(("ISO 6336-3, lengths in modules", "pinion", "wheel"), tuple(rows))


def over_torque(stage: TorqueStage, face_width: float) -> Part:
    """Stiffness and transmission error over torque."""
    scale = 1e-9 / face_width
    rows = tuple(
        (number(t), number(scale * s, 5), number(scale * k, 5), number(1e6 * e), number(h))
        for t, s, k, e, h in zip(
            *(
                column.tolist()
                for column in (
                    stage.torque,
                    stage.secant,
                    stage.tangent,
                    stage.transmission_error,
                    stage.harmonic,
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
    picture = drawing(figures.over_torque(stage, face_width), "torques", caption)
    notes = (f"Left out: {stage.message}",) if stage.message else ()
    return Part("torques", "Torque", figures=(picture,), tables=(Table(heads, rows),), notes=notes)


def revolution(cycle: MeshCycle) -> Part:
    """Transmission error tooth by tooth."""
    loaded, unloaded = cycle.transmission_error, cycle.unloaded_transmission_error
    caption = (
        "Transmission error tooth by tooth, with pitch deviations where the scene gives them, without film; positive "
        "when the wheel lags."
    )
    picture = drawing(figures.revolution(cycle.position, loaded, unloaded), "revolution", caption)
    rows = (
        ("under load", number(1e6 * float(np.ptp(loaded)))),
        ("without load", number(1e6 * float(np.ptp(unloaded)))),
    )
    table = Table(("transmission error", "peak to peak [µm]"), rows)
    return Part("revolution", "Revolution", figures=(picture,), tables=(table,), notes=(cycle.message,))
