"""Section of the report about the oil film."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm import figures
from flankfilm.report.page import Drawing, Headline, Part, Table, picture
from flankfilm.report.text import number, percent

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import FilmAlongPath, LubricatedCycle


def film(stage: LubricatedCycle, results: xr.Dataset, tolerance: float) -> Part:
    """Film along the path, through chosen contacts, and its stiffness by every definition."""
    verdict = (
        f"In series with the teeth, before load sharing, the film changes the mean secant stiffness by "
        f"{100 * stage.secant_stiffness_change:+.3f} % and the mean tangent stiffness by "
        f"{100 * stage.stiffness_change:+.3f} %."
    )
    if abs(stage.secant_stiffness_change) < tolerance:
        verdict += (
            f" That is less than the tolerance of {percent(tolerance)}: for the stiffness the film could be "
            "left out."
        )
    rounds = (
        f"Films and load share agree after {stage.rounds} rounds; the last changed a pair's force by "
        f"{stage.mismatch:.1e} of the whole."
    )
    tables = [_definitions(stage.film)]
    if stage.otherwise:
        tables.insert(0, _otherwise(stage))
    return Part(
        "film",
        "Oil film",
        (verdict, *_supply(stage.film), *_mixed(stage.film)),
        tuple(_figures(stage, results)),
        tuple(tables),
        (rounds, "Steady, isothermal, " + {"flooded": "fully flooded."}.get(stage.film.supply, "starved.")),
    )


def _figures(stage: LubricatedCycle, results: xr.Dataset) -> list[Drawing]:
    caption = "Film thickness and Hertz pressure along the path of contact; steps where the load share steps."
    drawn = [picture(figures.film_along_path, results, caption)]
    if any(
        known is not None
        for known in (stage.film.starvation, stage.film.film_ratio, stage.film.asperity_share)
    ):
        caption = (
            "How far the contact is starved and how much its asperities carry, along the path of contact."
        )
        drawn.append(picture(figures.film_shares, results, caption))
    if stage.film.profiles:
        caption = (
            "Pressure and film thickness through the contact at points of the path; oil enters at the left. "
            "The grids resolve the pressure spike to 1 %, except where it is narrower than grids would."
        )
        drawn.append(picture(figures.film_profiles, results, caption))
    if stage.otherwise:
        caption = (
            "What the film changes the tangent stiffness by, as it is, and if the other of meniscus and oil "
            "layer stayed when the load changes."
        )
        drawn.append(picture(figures.film_changes, results, caption))
    return drawn


def _definitions(stage: FilmAlongPath) -> Table:
    """Film stiffness by every definition: at C with what it costs, and its range along the path."""
    if not stage.at_pitch:
        known = ("film stiffness by", "least [N/m]", "largest [N/m]")
        return Table(known, tuple((n, number(k.min()), number(k.max())) for n, k in stage.stiffness.items()))
    heads = (
        "film stiffness by",
        "what it is",
        "at C [N/m]",
        "error",
        "loss of the pair's stiffness at C",
        "least [N/m]",
        "largest [N/m]",
    )
    rows: list[tuple[str, ...]] = []
    for row in stage.at_pitch:
        k = stage.stiffness.get(row.definition)
        ends = ("-", "-") if k is None else (number(k.min()), number(k.max()))
        error = percent(row.error)
        loss = percent(row.loss) if np.isfinite(row.loss) else "-"
        rows.append((row.definition, row.meaning, number(row.stiffness), error, loss, *ends))
    note = "Formulas are of flooded contacts." if stage.supply != "flooded" else ""
    return Table(heads, tuple(rows), note)


def _otherwise(stage: LubricatedCycle) -> Table:
    """The mesh without film, flooded, and starved with either held."""
    dry = stage.dry
    cycles = {"no film": dry, _as_it_is(stage.film): stage, **stage.otherwise}
    heads = (
        "mesh stiffness with",
        "mean secant",
        "change",
        "mean tangent",
        "change",
        "first harmonic of the tangent over its mean",
    )
    rows = tuple(
        (
            name,
            number(cycle.mean_secant_stiffness),
            f"{100 * (cycle.mean_secant_stiffness / dry.mean_secant_stiffness - 1):+.3f} %",
            number(cycle.mean_stiffness),
            f"{100 * (cycle.mean_stiffness / dry.mean_stiffness - 1):+.3f} %",
            f"{2 * abs(np.fft.rfft(cycle.stiffness)[1]) / cycle.stiffness.sum():.4f}",
        )
        for name, cycle in cycles.items()
    )
    return Table(heads, rows, "Stiffness in N/m at the whole face.")


def _as_it_is(stage: FilmAlongPath) -> str:
    return f"this film, {stage.supply.replace('-', ' ')} held"


def _supply(stage: FilmAlongPath) -> tuple[str, ...]:
    if stage.starvation is None or stage.inlet is None or stage.flow is None:
        return ()
    held = {"meniscus": "The meniscus", "oil-layer": "The layer of oil"}[stage.supply]
    return (
        f"{held} stays as it is when the load changes. Along the path the central film is "
        f"{stage.starvation.min():.3f} to {stage.starvation.max():.3f} of the flooded one, the gap fills "
        f"{-stage.inlet.max():.4f} to {-stage.inlet.min():.4f} half-widths ahead of the contact's middle, and "
        f"a layer of {1e6 * stage.flow.min():.3g} to {1e6 * stage.flow.max():.3g} µm passes.",
    )


def _mixed(stage: FilmAlongPath) -> tuple[str, ...]:
    if stage.film_ratio is None or stage.asperity_share is None:
        return ()
    return (
        f"Between the rough flanks Lambda is {stage.film_ratio.min():.3g} to {stage.film_ratio.max():.3g}; the "
        f"asperities carry {percent(stage.asperity_share.min())} to {percent(stage.asperity_share.max())} of "
        "the load. Film and asperities are springs in parallel, and both in series with the teeth.",
    )


def headlines(cycle: LubricatedCycle) -> list[Headline]:
    """Numbers for the page's head."""
    stage = cycle.film
    note = f"error {percent(stage.error)}" if stage.error is not None else "by formula; model error unknown"
    shown = [
        Headline("least film on the path", f"{1e6 * stage.least_film:.3g}", note, "µm"),
        Headline(
            "what the film changes",
            f"{100 * cycle.secant_stiffness_change:+.2f}",
            "of the mean secant stiffness",
            "%",
        ),
    ]
    if stage.starvation is not None:
        supply = f"supply: {stage.supply}"
        shown.append(Headline("starved film over flooded", f"{stage.starvation.min():.3g}", supply))
    if stage.film_ratio is not None and stage.asperity_share is not None:
        share = f"asperities carry up to {percent(stage.asperity_share.max())}"
        shown.append(Headline("least film ratio Lambda", f"{stage.film_ratio.min():.3g}", share))
    return shown
