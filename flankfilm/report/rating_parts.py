"""Section of the report about a rating: safeties, load factors and strength factors, each with its source."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from flankfilm.figures.reading import GEARS, Pictures, read_figure
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.rating_tables import (
    deviations,
    flanks,
    load_factors,
    scuffing,
    spectrum,
    strength_factors,
)
from flankfilm.report.text import counted, number, percent
from flankfilm.scene.sections.key import ZERO_CELSIUS
from gears.rating.load_factors import RESONANCE

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import OwnRating
    from gears.rating import Rating

PICTURES: Pictures = {"safeties": "rating_S_H", "spectrum_damage": "rating_spectrum_parts_H"}

BY_STANDARD = "by the standard, error unknown"


def both_gears(values: Sequence[float], digits: int = 4) -> str:
    """Figures of pinion and wheel, once where they are the same."""
    return " and ".join(dict.fromkeys(number(value, digits) for value in values))


def headlines(rating: Rating, own: OwnRating | None) -> list[Headline]:
    """Smallest safeties, and the damage of a spectrum, for the page's head."""
    asked = rating.required
    shown = [_least("pitting", rating.S_H, asked.S_H, *_ours(own, "S_H"))]
    if rating.S_F is not None:
        shown.append(_least("breakage", rating.S_F, asked.S_F, *_ours(own, "S_F")))
    if rating.S_S is not None:
        shown.append(_least("scuffing", (rating.S_S,), asked.S_S))
    faults = (("breakage", rating.bending_fault), ("scuffing", rating.scuffing_fault))
    shown += [Headline(f"safety against {name}", "none", fault) for name, fault in faults if fault]
    low, high = RESONANCE
    if low <= rating.factors.N <= high:
        advice = f"within {low:g} to {high:g}, which ISO 6336-1 advises against: change the speed"
        shown.append(Headline("resonance ratio N", number(rating.factors.N, 3), advice))
    if rating.spectrum is not None:
        worst = max(*rating.spectrum.damage_H, *(rating.spectrum.damage_F or ()))
        said_of_it = f"Miner's sum at the required safeties, 1 is failure; {BY_STANDARD}"
        shown.append(Headline("damage by the load spectrum, maximum", number(worst, 3), said_of_it))
    return shown


def _ours(own: OwnRating | None, name: str) -> tuple[tuple[float, float] | None, float | None]:
    """Safeties of both gears with our own load factors, and their error; None where there are none."""
    return (None, None) if own is None else (getattr(own, name), getattr(own, f"{name}_error"))


def _least(
    name: str,
    safeties: Sequence[float],
    required: float,
    own: Sequence[float] | None = None,
    error: float | None = None,
) -> Headline:
    """Headline of the smallest safety; the smaller one of both gears."""
    verdict = "enough" if min(safeties) >= required else "not enough"
    note = f"{verdict}: {required:g} is required; {BY_STANDARD}"
    if own is not None:
        note += f"; {min(own):.3f} ± {percent(error)} with our own load factors"
    return Headline(f"safety against {name}", f"{min(safeties):.3f}", note)


def section(rating: Rating, own: OwnRating | None, results: xr.Dataset) -> Part:
    """Everything that an engineer signs: safeties with limits, every factor with its source, the spectrum."""
    speed, torque = read_figure(rating, "speed"), read_figure(rating, "torque")
    life = read_figure(rating, "life")
    paragraphs = [
        said(
            "rating",
            verdict="meets" if rating.enough else "does not meet",
            torque=number(float(torque.values), 6),
            speed=number(float(speed.values), 6),
            hours=number(float(life.values), 6),
            cycles=both_gears(rating.pitting.cycles),
            grade=rating.tolerances.grade,
            own=_verdict(rating, own),
            ratio=number(rating.factors.N, 3),
            regime=rating.factors.regime,
        )
    ]
    tables = [_safeties(rating, own), load_factors(rating, own), strength_factors(rating), deviations(rating)]
    if (thermal := scuffing(rating)) is not None:
        tables.append(thermal)
    if own is not None and own.flanks is not None:
        tables.append(flanks(rating, own.flanks))
    if rating.spectrum is not None:
        tables.append(spectrum(rating.spectrum))
        paragraphs.append(_of_spectrum(rating))
    if own is not None and own.root_ratio is not None:
        tables.append(_stresses(rating, own))
    return Part(
        "rating",
        "Rating",
        tuple(paragraphs),
        pictures(results, PICTURES),
        tuple(tables),
        tuple(_notes(rating, own)),
        seen=len(PICTURES),
        unfolded=True,
    )


def _verdict(rating: Rating, own: OwnRating | None) -> str:
    """Whether the safeties with our own load factors are enough too; nothing where there are none."""
    if own is None or (own.motion is None and own.loaded is None):
        return ""
    asked = rating.required
    names = [
        f"{min(safeties):.3f} against {name}, below {required:g}"
        for name, safeties, required in (("pitting", own.S_H, asked.S_H), ("breakage", own.S_F, asked.S_F))
        if safeties is not None and min(safeties) < required
    ]
    if not names:
        return " With our own load factors pitting and breakage have enough safety too."
    return f" With our own load factors the safety is {' and '.join(names)}."


def _notes(rating: Rating, own: OwnRating | None) -> Iterator[str]:
    """What the tables are of, and what is left out."""
    yield said("rating_standard")
    if own is not None:
        yield said("rating_own")
    if own is not None and own.motion is not None and own.motion.greatest is not None:
        peak, place = read_figure(own.motion, "greatest"), read_figure(own.motion, "greatest_at")
        figures = {"greatest": number(float(peak.values)), "speed": number(float(place.values), 5)}
        yield said("rating_swept", **figures, error=percent(own.motion.swept_error))
    if own is not None and own.flanks is not None:
        yield said("rating_flanks")
    if own is not None and own.root_ratio is not None:
        yield said("rating_ratio")
    for name, fault in (("ISO 6336-3", rating.bending_fault), ("Scuffing", rating.scuffing_fault)):
        if fault:
            yield f"{name} gives no result: {fault}"


def _safeties(rating: Rating, own: OwnRating | None) -> Table:
    """Stress, limit and safety of both gears, with the required one and a verdict."""
    heads = (
        "",
        "value",
        "limit",
        "safety",
        "required",
        "verdict",
        "safety, our factors",
        "its numerical error",
    )
    rows = [
        *_of_stress("pitting", "H", rating, *_ours(own, "S_H")),
        *_of_stress("breakage", "F", rating, *_ours(own, "S_F")),
    ]
    if (scuffed := rating.scuffing) is not None:
        value, limit = (
            f"{kelvin - ZERO_CELSIUS:.2f} °C" for kelvin in (scuffed.theta_int, scuffed.theta_Sint)
        )
        rows.append(
            ("scuffing, theta_int", value, limit, *_against(scuffed.S_intS, rating.required.S_S), "", "")
        )
    caption = "Values contain K_A and all load factors by the standard, whose error is unknown."
    return Table(heads, tuple(rows), caption).filled


def _of_stress(
    name: str, letter: str, rating: Rating, own: Sequence[float] | None, error: float | None
) -> Iterator[tuple[str, ...]]:
    """Rows of both gears of pitting or breakage."""
    safe = rating.pitting if letter == "H" else rating.bending
    if safe is None:
        return
    required = getattr(rating.required, f"S_{letter}")
    for gear, called in enumerate(GEARS):
        stress, limit = (
            f"{1e-6 * getattr(safe, f'sigma_{figure}')[gear]:.2f} MPa" for figure in (letter, f"{letter}G")
        )
        safety = getattr(safe, f"S_{letter}")[gear]
        ours = ("", "") if own is None else (f"{own[gear]:.3f}", f"± {percent(error)}")
        yield f"{name} of the {called}, sigma_{letter}", stress, limit, *_against(safety, required), *ours


def _against(safety: float, required: float) -> tuple[str, str, str]:
    """Safety, required one and verdict."""
    return f"{safety:.3f}", f"{required:g}", "enough" if safety >= required else "not enough"


def _of_spectrum(rating: Rating) -> str:
    """What the spectrum does, in words."""
    steps = rating.spectrum
    assert steps is not None
    roots = "" if steps.damage_F is None else f", of the roots {both_gears(steps.damage_F, 3)}"
    safe = "" if steps.S_F is None else f" and {both_gears(steps.S_F)} against breakage"
    hours = steps.life / 3600.0
    return said(
        "rating_spectrum",
        steps=counted(steps.torque.size, "step"),
        hours=number(steps.duration / 3600.0, 5),
        flanks=both_gears(steps.damage_H, 3),
        roots=roots,
        pitting=both_gears(steps.S_H),
        breakage=safe,
        life="no end of life" if hours == float("inf") else f"a life of {number(hours, 3)} h",
    )


def _stresses(rating: Rating, own: OwnRating) -> Table:
    """Root stress by finite elements over the nominal one."""
    assert own.root_ratio is not None
    assert rating.bending is not None
    nominal = (number(1e-6 * value, 5) for value in rating.bending.nominal.stresses)
    rows = (
        ("nominal root stress sigma_F0 [MPa]", *nominal),
        ("maximum tension by finite elements over it", *(f"{ratio:.3f}" for ratio in own.root_ratio)),
        ("numerical error of that tension", *(percent(own.root_error),) * 2),
    )
    return Table(("root stress without factors", "pinion", "wheel"), rows)
