"""Section of the report about the oil film."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures import film as film_figures
from flankfilm.report.mesh_parts import path_marks
from flankfilm.report.page import Headline, Part, Table, drawing
from flankfilm.report.text import number, percent

if TYPE_CHECKING:
    from flankfilm.stages.film import FilmStage
    from gears import GearPair


def film(pair: GearPair, stage: FilmStage, tolerance: float) -> Part:
    """Film along the path, through chosen contacts, and its stiffness by every definition."""
    position = stage.rho1 - pair.points.A
    figures = [
        drawing(
            film_figures.film_along_path(
                position, stage.central, stage.minimum, stage.hertz_pressure, path_marks(pair)
            ),
            "filmpath",
            "Film thickness and Hertz pressure along the path of contact; steps where the load share steps.",
        )
    ]
    if stage.profiles:
        figures.append(
            drawing(
                film_figures.film_profiles(stage.profiles),
                "filmprofile",
                "Pressure and film thickness through the contact at points of the path; oil enters at the left. The "
                "error estimate covers the thicknesses; the height of the pressure spike is not held to it.",
            )
        )
    at_pitch = int(np.argmin(np.abs(stage.rho1 - pair.points.C)))
    tooth = float(stage.cycle.secant.mean())
    rows = tuple(
        (name, number(k[at_pitch]), percent(-tooth / (tooth + k[at_pitch])), number(k.min()), number(k.max()))
        for name, k in stage.stiffness.items()
    )
    heads = (
        "film stiffness by",
        "at C [N/m]",
        "in series with the mean stiffness",
        "least [N/m]",
        "largest [N/m]",
    )
    change = stage.change_secant
    verdict = (
        f"In series with the teeth, before load sharing, the film changes the mean secant stiffness by "
        f"{100 * change:+.3f} % and the mean tangent stiffness by {100 * stage.change_tangent:+.3f} %."
    )
    if abs(change) < tolerance:
        verdict += (
            f" That is less than the tolerance of {percent(tolerance)}: for the stiffness the film could be "
            "left out."
        )
    rounds = (
        f"Films and load share agree after {stage.rounds} rounds; the last changed a pair's force by "
        f"{stage.mismatch:.1e} of the whole."
    )
    return Part(
        "film",
        "Oil film",
        (verdict,),
        tuple(figures),
        (Table(heads, rows),),
        (rounds, "Steady, isothermal, fully flooded."),
    )


def headlines(stage: FilmStage) -> list[Headline]:
    """Numbers for the page's head."""
    thinnest = int(np.argmin(stage.minimum))
    note = f"error {percent(stage.error)}" if stage.error is not None else "by formula; model error unknown"
    return [
        Headline("least film on the path", f"{1e6 * stage.minimum[thinnest]:.3g} µm", note),
        Headline(
            "what the film changes", f"{100 * stage.change_secant:+.2f} %", "of the mean secant stiffness"
        ),
    ]
