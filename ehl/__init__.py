"""Elastohydrodynamic line contacts: lubricant, film and film stiffness. Knows no gears.

Start with :class:`Lubricant`, :class:`LineContact` and :func:`solve`.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ehl.asperities import Roughness
    from ehl.contact import LineContact
    from ehl.film import DEFINITIONS, Cost, Film, FilmErrors, Spike, hertz_approach
    from ehl.lubricant import Lubricant
    from ehl.mixed import MixedFilm, solve_mixed
    from ehl.path import solve_path
    from ehl.regressions import (
        FormulaFilm,
        dowson,
        dowson_higginson_minimum,
        dowson_toyoda_central,
        moes_central,
        nijenbanning_line_central,
        pan_hamrock_central,
        pan_hamrock_minimum,
    )
    from ehl.rheology import (
        Barus,
        ConstantDensity,
        ConstantViscosity,
        DensityLaw,
        DowsonHigginson,
        Roelands,
        ViscosityLaw,
    )
    from ehl.solver import solve
    from ehl.stiffness import StiffnessRow, stiffness_table
    from ehl.supply import Meniscus, OilLayer

__all__ = [
    "DEFINITIONS",
    "Barus",
    "ConstantDensity",
    "ConstantViscosity",
    "Cost",
    "DensityLaw",
    "DowsonHigginson",
    "Film",
    "FilmErrors",
    "FormulaFilm",
    "LineContact",
    "Lubricant",
    "Meniscus",
    "MixedFilm",
    "OilLayer",
    "Roelands",
    "Roughness",
    "Spike",
    "StiffnessRow",
    "ViscosityLaw",
    "dowson",
    "dowson_higginson_minimum",
    "dowson_toyoda_central",
    "hertz_approach",
    "moes_central",
    "nijenbanning_line_central",
    "pan_hamrock_central",
    "pan_hamrock_minimum",
    "solve",
    "solve_mixed",
    "solve_path",
    "stiffness_table",
]

_ROOMS = {
    "asperities": ("Roughness",),
    "mixed": ("MixedFilm", "solve_mixed"),
    "contact": ("LineContact",),
    "film": ("DEFINITIONS", "Cost", "Film", "FilmErrors", "Spike", "hertz_approach"),
    "lubricant": ("Lubricant",),
    "rheology": (
        "Barus",
        "ConstantDensity",
        "ConstantViscosity",
        "DensityLaw",
        "DowsonHigginson",
        "Roelands",
        "ViscosityLaw",
    ),
    "regressions": (
        "FormulaFilm",
        "dowson",
        "dowson_higginson_minimum",
        "dowson_toyoda_central",
        "moes_central",
        "nijenbanning_line_central",
        "pan_hamrock_central",
        "pan_hamrock_minimum",
    ),
    "path": ("solve_path",),
    "solver": ("solve",),
    "stiffness": ("StiffnessRow", "stiffness_table"),
    "supply": ("Meniscus", "OilLayer"),
}
_ROOM_OF = {name: room for room, names in _ROOMS.items() for name in names}


def __getattr__(name: str) -> object:
    """Import the room of a public name on first use (the solver needs scipy, the kernels numba)."""
    if name in _ROOM_OF:
        return getattr(import_module(f"ehl.{_ROOM_OF[name]}"), name)
    raise AttributeError(f"module 'ehl' has no attribute {name!r}")


def __dir__() -> list[str]:
    """List the public names."""
    return sorted(__all__)
