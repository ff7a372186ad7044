"""Section of the report about the oil film."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from base.units import factor
from ehl.discrete.regimes import MEASURED, regime
from flankfilm.coupling.films.least_film import parts_of
from flankfilm.figures.reading import PER_FACE, Pictures, read_figure, unit_text
from flankfilm.output.uncertainty import Uncertainty, uncertainty
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import counted, number, percent

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import FilmAlongPath, LubricatedCycle


LEAST, LEAST_WITH_HEAT = "minimum film on the path", "minimum film with heat"
"""Names of headlines."""

HELD = {"meniscus": "The meniscus", "oil-layer": "The layer of oil"}

PICTURES: Pictures = {
    "film_along_path": "film_central_thickness",
    "film_map": "film_face_minimum_thickness",
    "film_line_map": "film_lines_minimum_thickness",
    "film_shares": ("film_starvation", "film_ratio", "film_asperity_share"),
    "film_profiles": "film_profile",
    "film_changes": "held_tangent_stiffness",
}


def held_as_it_is(cycle: LubricatedCycle) -> str:
    """Label of a starved film beside others in which something else is held."""
    return f"this film, {cycle.film.supply.replace('-', ' ')} held"


def film(cycle: LubricatedCycle, results: xr.Dataset, tolerance: float) -> Part:
    """Film along the path, through chosen contacts, and its stiffness by every definition."""
    stage = cycle.film
    secant, tangent = (100 * change for change in (cycle.secant_stiffness_change, cycle.stiffness_change))
    verdict = said("film_changes", secant=secant, tangent=tangent)
    if abs(cycle.secant_stiffness_change) < tolerance:
        verdict += said("film_left_out", tolerance=percent(tolerance))
    rounds = said("film_rounds", cycle=cycle, rounds=counted(cycle.rounds, "round"))
    if cycle.mismatch == 0.0:  # films over place and line load
        rounds = said("film_table")
    face = factor(PER_FACE) * float(results["pair_face_width"])
    tables = (*((_otherwise(cycle, face),) if cycle.otherwise else ()), _definitions(stage, face))
    return Part(
        "film",
        "Oil film",
        (verdict, *_over_face(cycle), *_over_lines(cycle), *_supply(stage), *_mixed(stage)),
        pictures(results, PICTURES, **_captions(stage)),
        tables,
        (rounds, "Steady, isothermal, " + ("fully flooded." if stage.supply == "flooded" else "starved.")),
    )


def _captions(stage: FilmAlongPath) -> dict[str, str]:
    """Parts of the captions that depend on this film."""
    steps = len(parts_of(stage.load)) > 1
    shares = {
        "Starved over flooded film": stage.starvation,
        "the film ratio": stage.film_ratio,
        "the asperities' share of the load": stage.asperity_share,
    }
    shown = [name for name, known in shares.items() if known is not None]
    sought = [film.spike for film in stage.profiles.values()]
    narrow = any(spike is None or not np.isfinite(spike.error) for spike in sought)
    listed = " and ".join([", ".join(shown[:-1]), *shown[-1:]] if shown[1:] else shown)
    return {
        "steps": "; both jump where a pair enters or leaves the mesh" if steps else "",
        "shares": listed[:1].upper() + listed[1:],
        "rough": said("rough_pressure") if stage.film_ratio is not None else "",
        "spikes": said("narrow_spikes") if narrow else said("resolved_spikes"),
    }


def _over_face(cycle: LubricatedCycle) -> Iterator[str]:
    """Composition of films over the face, and the effects that they leave out."""
    face_films = cycle.over_face
    if face_films is not None:
        yield said(
            "film_over_face",
            least=number(1e6 * face_films.least_film),
            place=number(1e3 * face_films.least_film_place, 3),
            films=counted(face_films.films, "film"),
            table=percent(face_films.table_error),
            zone=number(1e3 * face_films.end_zone, 2),
            side=percent(face_films.side_flow, 2),
        )


def _over_lines(cycle: LubricatedCycle) -> Iterator[str]:
    """Composition of films on lines of contact, and the effects that they leave out."""
    films = cycle.over_lines
    if films is not None:
        yield said(
            "film_over_lines",
            least=number(1e6 * films.least_film),
            place=number(1e3 * films.least_film_place, 3),
            films=counted(films.films, "film"),
            table=percent(films.table_error),
            zone=number(1e3 * films.end_zone, 2),
            side=percent(films.side_flow, 2),
        )


def _definitions(stage: FilmAlongPath, face: float) -> Table:
    """Film stiffness by every definition: at C with the loss of the pair, and over the path; `face` in N/m."""
    ends = {name: (number(k.min() / face), number(k.max() / face)) for name, k in stage.stiffness.items()}
    caption = f"Stiffness in {unit_text(PER_FACE)}."
    if not stage.at_pitch:
        heads = ("film stiffness by", "minimum", "maximum")
        return Table(heads, tuple((name, *limits) for name, limits in ends.items()), caption)
    return Table.of(
        stage.at_pitch,
        {
            "film stiffness by": lambda row: row.definition.replace("-", " "),
            "meaning": lambda row: row.meaning,
            "at C": lambda row: number(row.stiffness / face),
            "error": lambda row: percent(row.error),
            "loss of the pair's stiffness at C": lambda row: (
                percent(row.loss) if np.isfinite(row.loss) else "-"
            ),
            "minimum": lambda row: ends.get(row.definition, "--")[0],
            "maximum": lambda row: ends.get(row.definition, "--")[1],
        },
        caption + (" Formulas are for flooded contacts." if stage.supply != "flooded" else ""),
    )


def _otherwise(lubricated: LubricatedCycle, face: float) -> Table:
    """The mesh without film, flooded, and starved with meniscus or layer held constant; `face` in N/m."""
    dry = lubricated.dry
    rows = tuple(
        (
            name,
            number(cycle.mean_secant_stiffness / face, 5),
            f"{100 * (cycle.mean_secant_stiffness / dry.mean_secant_stiffness - 1):+.3f} %",
            number(cycle.mean_stiffness / face, 5),
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
    error = percent(max((mesh.mean_error or 0.0 for mesh in (dry, lubricated)), default=None))
    caption = f"Stiffness in {unit_text(PER_FACE)}; the numerical error of the means is {error}."
    return Table(("mesh stiffness with", *means), rows, caption)


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
        low, high = _ends(stage.film_ratio)
        ratio = low if stage.least_film_ratio is None else min(low, stage.least_film_ratio), high
        yield said(
            "mixed", ratio=ratio, least=least, largest=largest, regimes=_regimes(*ratio), measured=MEASURED
        )


def _regimes(low: float, high: float) -> str:
    """Regimes between two film ratios."""
    return " to ".join(dict.fromkeys((regime(low), regime(high))))


def _ends(curve: Array) -> tuple[float, float]:
    """Minimum and maximum."""
    return float(curve.min()), float(curve.max())


def _off(cycle: LubricatedCycle) -> Uncertainty:
    """Error of the change of the mean secant stiffness by the film: of both cycles, which share their meshes."""
    known = [mesh.mean_error for mesh in (cycle, cycle.dry)]
    errors = [error for error in known if error is not None]
    if cycle.film.error is None or len(errors) < len(known):
        return Uncertainty(None)
    return Uncertainty(math.hypot(*errors), size=100.0, unit="points")


def regime_said(ratio: float, *, with_ratio: bool = False) -> str:
    """Regime at the minimum film ratio of a film, with its limits."""
    at = f" at Lambda = {ratio:.2g}" if with_ratio else ""
    return f"{regime(ratio)} lubrication{at} (below 1 boundary, below 3 mixed)"


def headlines(cycle: LubricatedCycle) -> list[Headline]:
    """Numbers for the page's head."""
    stage = cycle.film
    off, note = uncertainty(stage, "least_film"), "" if stage.error is not None else "by formula"
    least, change = read_figure(stage, "least_film"), read_figure(cycle, "secant_stiffness_change")
    changed = f"{float(change.values):+.2f}"
    ratio = stage.least_film_ratio
    kind = "" if ratio is None else regime_said(ratio, with_ratio=True)
    named = "; ".join(filter(None, (kind, note)))
    shown = [
        Headline(LEAST, f"{float(least.values):.3g}", named, least.unit, off),
        Headline("change of the mean secant stiffness by the film", changed, note, change.unit, _off(cycle)),
    ]
    if stage.starvation is not None:
        supply = f"supply: {stage.supply}"
        error = Uncertainty(None if stage.error is None else math.sqrt(2.0) * stage.error)
        least_part = f"{stage.starvation.min():.3g}"
        name = "starved over flooded film, minimum"
        shown.append(Headline(name, least_part, supply, uncertainty=error))
    if ratio is not None and stage.asperity_share is not None:
        share = f"{regime_said(ratio)}; asperities carry up to {percent(stage.asperity_share.max())}"
        error = uncertainty(stage, "least_film_ratio")
        shown.append(Headline("minimum film ratio Lambda", f"{ratio:.3g}", share, uncertainty=error))
    return shown
