"""Solvers that can be measured, by the name that a user calls them."""

from __future__ import annotations

from collections.abc import Callable

from flankfilm.bench.application_cases import work_application
from flankfilm.bench.case import Case
from flankfilm.bench.element_cases import elements
from flankfilm.bench.film_cases import films
from flankfilm.bench.gear_cases import gears, mesh
from flankfilm.bench.motion_cases import motions
from flankfilm.bench.stiffness_cases import compliances, contacts, root_stress

Builder = Callable[[bool], tuple[Case, ...]]
"""Gives a solver's cases; true asks for few and coarse levels."""


def _alone(build: Callable[[bool], Case]) -> Builder:
    return lambda quick: (build(quick),)


SOLVERS: dict[str, Builder] = {
    "gears": gears,
    "mesh": _alone(mesh),
    "elements": _alone(elements),
    "compliance": compliances,
    "contact": contacts,
    "root-stress": _alone(root_stress),
    "film": films,
    "motion": motions,
    "application": _alone(work_application),
}
