"""Answers that take milliseconds: geometry, sliding, sizes of inspection, and the formulas of ISO 6336."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

import gears
from base import InputError
from base.results import quantities
from flankfilm.building.pair import pinion_speed_if_any, pinion_torque
from flankfilm.coupling import standards
from flankfilm.report import pair_parts, standards_parts
from flankfilm.report.page import Headline
from flankfilm.report.text import number
from flankfilm.scene import Scene

__all__ = ["Answer", "answers_of", "instant"]

EXACT = "exact to rounding"

GEARS = ("pinion", "wheel")


@dataclass(frozen=True)
class Answer:
    """A figure as the page shows it.

    Attributes
    ----------
    group, name : str
        Under which head it is, and what it is.
    text, unit : str
        Value with its unit.
    error : str
        How far it may be off, or why that is unknown.
    """

    group: str
    name: str
    text: str
    unit: str
    error: str


def instant(scene: Scene, pair: gears.GearPair) -> tuple[Answer, ...]:
    """Geometry and closed forms of a scene's pair.

    Parameters
    ----------
    scene : Scene
        Without faults.
    pair : gears.GearPair
        That of the scene.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the check has said it
        shown = [*answers_of("Geometry", pair_parts.headlines(pair)), *_helix(pair), *_sliding(scene, pair)]
        shown += _iso(scene, pair)
        return (*shown, *_inspection(pair))


def answers_of(group: str, headlines: list[Headline]) -> Iterator[Answer]:
    """Figures of a report's head as answers.

    Parameters
    ----------
    group : str
    headlines : list of Headline
        With what they may be off by, in their notes.

    Examples
    --------
    >>> next(answers_of("Geometry", [Headline("contact ratio", "1.7", "exact")]))
    Answer(group='Geometry', name='contact ratio', text='1.7', unit='', error='exact')
    """
    for shown in headlines:
        yield Answer(
            group,
            shown.name,
            shown.text,
            shown.unit,
            "; ".join(filter(None, (shown.bound, shown.remark or shown.note))),
        )


def _helix(pair: gears.GearPair) -> Iterator[Answer]:
    if pair.helix_angle:
        yield Answer("Geometry", "overlap ratio", number(pair.overlap_ratio, 5), "", EXACT)
        yield Answer("Geometry", "total contact ratio", number(pair.total_contact_ratio, 5), "", EXACT)


def _sliding(scene: Scene, pair: gears.GearPair) -> Iterator[Answer]:
    """Sliding of the flanks at the ends of the path."""
    ends = pair.path_at(np.array([pair.points.A, pair.points.E]))
    for gear, specific in zip(GEARS, ends.specific_sliding, strict=True):
        text = " and ".join(number(float(value), 4) for value in specific)
        yield Answer("Sliding", f"specific sliding of the {gear} at A and E", text, "", EXACT)
    if (speed := pinion_speed_if_any(scene)) is not None:
        text = " and ".join(number(float(value), 4) for value in ends.sliding(speed))
        yield Answer("Sliding", "sliding speed at A and E", text, "m/s", EXACT)


def _iso(scene: Scene, pair: gears.GearPair) -> Iterator[Answer]:
    """Stiffness and nominal stresses by ISO 6336; why there are none."""
    if scene.operating is None:
        return
    try:
        iso = standards(pair, pinion_torque(scene))
    except InputError as error:
        yield Answer("ISO 6336", "none", "-", "", "; ".join(fault.allowed for fault in error.faults))
        return
    yield from answers_of("ISO 6336", standards_parts.headlines(iso))
    if iso.root is None:
        yield Answer("ISO 6336", "nominal root stress", "-", "", iso.root_fault)


def _inspection(pair: gears.GearPair) -> Iterator[Answer]:
    """Sizes that an inspection measures."""
    try:
        sizes = gears.dimensions(pair)
    except InputError as error:
        yield Answer("Inspection", "none", "-", "", "; ".join(map(str, error.faults)))
        return
    for figure in quantities(sizes).values():
        values = np.atleast_1d(figure.figure.in_shown(figure.value))
        if values.size <= len(GEARS) and np.issubdtype(values.dtype, np.number):
            text = " and ".join(number(float(value), 7) for value in values)
            of_both = ", pinion and wheel" if values.size == len(GEARS) else ""
            unit = figure.figure.read_in
            yield Answer(
                "Inspection", figure.figure.meaning + of_both, text, "" if unit == "1" else unit, EXACT
            )
