"""How a film with heat answers to its load: separation and central film at neighbouring loads."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from base import Array, Faults
from ehl.discrete.equations import Groups
from ehl.discrete.newton import newton
from ehl.discrete.thermal_oil import ThermalOil
from ehl.films.film import FilmErrors
from ehl.films.thermal import ThermalFilm
from ehl.solving.levels import Level, figures, transfer

_STEP = 0.01  # relative change of the load
_DONE = (
    1e-6  # last step of the pressure: a hundredth of what the load's step does to the separation, and less
)
_MOST_STEPS = 40


def with_load_slopes(film: ThermalFilm) -> ThermalFilm:
    """Return the film with the slopes of its separation and of its central thickness by the load.

    Two films at neighbouring loads, on the grid of the film and from it, at the same speeds, bulk temperatures and
    supply. With the slopes the film has its stiffnesses ``"approach"`` and ``"tangent"``.

    Parameters
    ----------
    film : ThermalFilm
        A solved film.

    Returns
    -------
    ThermalFilm
        With ``separation_slope``, ``central_slope`` and the errors of both stiffnesses, from two grids; as it was
        where a neighbouring load could not be solved.

    Raises
    ------
    InputError
        For a film without solution.

    Examples
    --------
    >>> from ehl import LineContact, Lubricant, solve_thermal
    >>> oil = Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
    >>> film = solve_thermal(LineContact(2e5, 2.5, 6e-3, 2.26e11, oil, sliding=1.0))
    >>> f"{with_load_slopes(film).stiffness():.1e}"
    '2.2e+12'
    """
    with Faults() as faults:
        if not isinstance(film, ThermalFilm) or film.state is None or film.oils is None:
            faults.add("film", film, "must be a solved ThermalFilm", "solve_thermal makes one")
        elif film.state is not None and film.state.plan.fixed:
            faults.add(
                "film", film, "must be flooded", "slopes of starved films with heat are not known: use solve"
            )
    assert film.state is not None
    assert film.oils is not None
    before, after = (
        _slopes(level, oil)
        for level, oil in zip((film.state.coarse, film.state.fine), film.oils, strict=True)
    )
    if not np.isfinite(after).all():
        return film
    change = np.abs(before / after - 1.0)
    errors: FilmErrors = replace(
        film.errors, approach_stiffness=float(change[0]), tangent_stiffness=float(change[1])
    )
    return replace(film, separation_slope=float(after[0]), central_slope=float(after[1]), errors=errors)


def _slopes(level: Level, oil: ThermalOil) -> Array:
    """Differences of separation and central film by the load [m2/N]; NaN where a load was not solved."""
    gaps = []
    for growth in (1.0 - _STEP, 1.0 + _STEP):
        contact = replace(oil.contact, load=growth * oil.contact.load)
        groups = Groups.on(contact, level.grid)
        near = ThermalOil(contact, level.grid, groups, oil.solids, oil.bulk)
        near.start_from(oil)
        P, H0 = transfer(level, contact, level.plan, level.grid)
        with np.errstate(all="ignore"):
            solved = newton(level.grid, groups, P, H0, oil=near, done=_DONE, max_iterations=_MOST_STEPS)
        if not solved.converged:
            return np.full(2, math.nan)
        shown = figures(replace(level, contact=contact, solution=solved))
        gaps.append((shown.separation, shown.central_thickness))
    rise: Array = np.diff(gaps, axis=0)[0] / (2.0 * _STEP * oil.contact.load)
    return rise
