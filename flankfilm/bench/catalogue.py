"""Solvers that can be measured, by the name that a user calls them."""

from __future__ import annotations

from collections.abc import Callable

from flankfilm.bench.application_cases import application
from flankfilm.bench.case import Case
from flankfilm.bench.element_cases import elements
from flankfilm.bench.film_cases import films
from flankfilm.bench.gear_cases import closed_forms, meshes
from flankfilm.bench.motion_cases import motions
from flankfilm.bench.stiffness_cases import compliance, contact, root_stress

__all__ = ["SOLVERS", "Builder"]

Builder = Callable[[bool], tuple[Case, ...]]
"""Gives a solver's cases; true asks for few and coarse levels."""

SOLVERS: dict[str, Builder] = {
    "gears": closed_forms,
    "mesh": meshes,
    "elements": elements,
    "compliance": compliance,
    "contact": contact,
    "root-stress": root_stress,
    "film": films,
    "motion": motions,
    "application": application,
}
