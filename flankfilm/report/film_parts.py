"""Section of the report about the oil film."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from flankfilm.figures.reading import read_figure
from flankfilm.output.run import held_as_it_is
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import number, percent

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import FilmAlongPath, LubricatedCycle


HELD = {"meniscus": "The meniscus", "oil-layer": "The layer of oil"}


def film(cycle: LubricatedCycle, results: xr.Dataset, tolerance: float) -> Part:
    """Film along the path, through chosen contacts, and its stiffness by every definition."""
    stage = cycle.film
    secant, tangent = (100 * one for one in (cycle.secant_stiffness_change, cycle.stiffness_change))
    verdict = said("film_changes", secant=secant, tangent=tangent)
    if abs(cycle.secant_stiffness_change) < tolerance:
        verdict += said("film_left_out", tolerance=percent(tolerance))
    rounds = said("film_rounds", cycle=cycle)
    tables = (*((_otherwise(cycle),) if cycle.otherwise else ()), _definitions(stage))
    return Part(
        "film",
        "Oil film",
        (verdict, *_supply(stage), *_mixed(stage)),
        pictures(results, *_pictured(cycle)),
        tables,
        (rounds, "Steady, isothermal, " + ("fully flooded." if stage.supply == "flooded" else "starved.")),
    )


def _pictured(cycle: LubricatedCycle) -> Iterator[str]:
    """Names of the figures of a film."""
    stage = cycle.film
    yield "film_along_path"
    if any(known is not None for known in (stage.starvation, stage.film_ratio, stage.asperity_share)):
        yield "film_shares"
    if stage.profiles:
        yield "film_profiles"
    if cycle.otherwise:
        yield "film_changes"


def _definitions(stage: FilmAlongPath) -> Table:
    """Film stiffness by every definition: at C with what it costs, and its range along the path."""
    ends = {name: (number(k.min()), number(k.max())) for name, k in stage.stiffness.items()}
    if not stage.at_pitch:
        heads = ("film stiffness by", "least [N/m]", "largest [N/m]")
        return Table(heads, tuple((name, *both) for name, both in ends.items()))
    return Table.of(
        stage.at_pitch,
        {
            "film stiffness by": lambda row: row.definition,
            "what it is": lambda row: row.meaning,
            "at C [N/m]": lambda row: number(row.stiffness),
            "error": lambda row: percent(row.error),
            "loss of the pair's stiffness at C": lambda row: (
                percent(row.loss) if np.isfinite(row.loss) else "-"
            ),
            "least [N/m]": lambda row: ends.get(row.definition, "--")[0],
            "largest [N/m]": lambda row: ends.get(row.definition, "--")[1],
        },
        "Formulas are of flooded contacts." if stage.supply != "flooded" else "",
    )


def _otherwise(lubricated: LubricatedCycle) -> Table:
    """The mesh without film, flooded, and starved with either held."""
    dry = lubricated.dry
    rows = tuple(
        (
            name,
            number(cycle.mean_secant_stiffness),
            f"{100 * (cycle.mean_secant_stiffness / dry.mean_secant_stiffness - 1):+.3f} %",
            number(cycle.mean_stiffness),
            f"{100 * (cycle.mean_stiffness / dry.mean_stiffness - 1):+.3f} %",
            f"{2 * abs(np.fft.rfft(cycle.stiffness)[1]) / cycle.stiffness.sum():.4f}",
        )
        for name, cycle in {
            "no film": dry,
            held_as_it_is(lubricated): lubricated,
            **lubricated.otherwise,
        }.items()
    )
    means = ("mean secant", "change", "mean tangent", "change", "first harmonic of the tangent over its mean")
    return Table(("mesh stiffness with", *means), rows, "Stiffness in N/m at the whole face.")


def _supply(stage: FilmAlongPath) -> Iterator[str]:
    if stage.starvation is not None and stage.inlet is not None and stage.oil_layer is not None:
        layer = read_figure(stage, "oil_layer")
        starved, inlet, passing = (_ends(curve) for curve in (stage.starvation, -stage.inlet, layer.values))
        yield said(
            "supply", held=HELD[stage.supply], starved=starved, inlet=inlet, layer=passing, unit=layer.unit
        )


def _mixed(stage: FilmAlongPath) -> Iterator[str]:
    if stage.film_ratio is not None and stage.asperity_share is not None:
        least, largest = (percent(share) for share in _ends(stage.asperity_share))
        yield said("mixed", ratio=_ends(stage.film_ratio), least=least, largest=largest)


def _ends(curve: Array) -> tuple[float, float]:
    """Least and largest value."""
    return float(curve.min()), float(curve.max())


def headlines(cycle: LubricatedCycle) -> list[Headline]:
    """Numbers for the page's head."""
    stage = cycle.film
    off = stage.least_film_error
    note = f"error {percent(off)}" if off is not None else "by formula; model error unknown"
    least, change = read_figure(stage, "least_film"), read_figure(cycle, "secant_stiffness_change")
    changed = f"{float(change.values):+.2f}"
    shown = [
        Headline("least film on the path", f"{float(least.values):.3g}", note, least.unit),
        Headline("what the film changes", changed, "of the mean secant stiffness", change.unit),
    ]
    if stage.starvation is not None:
        supply = f"supply: {stage.supply}"
        shown.append(Headline("starved film over flooded", f"{stage.starvation.min():.3g}", supply))
    if stage.film_ratio is not None and stage.asperity_share is not None:
        share = f"asperities carry up to {percent(stage.asperity_share.max())}"
        shown.append(Headline("least film ratio Lambda", f"{stage.least_film_ratio:.3g}", f"{note}; {share}"))
    return shown
