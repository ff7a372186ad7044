"""How a film with heat answers to its load: derivatives of separation and central film, with asperities and without."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TypeVar

from base import Faults
from ehl.films.film import FilmErrors
from ehl.films.mixed_thermal import MixedThermalFilm
from ehl.films.result import slope_errors
from ehl.films.rough_slopes import rough_slopes
from ehl.films.thermal import ThermalFilm
from ehl.solving.levels import WarmLevel
from ehl.solving.load_share import odds_of
from ehl.solving.oil_following import BALANCED
from ehl.solving.response import by_share, slopes, with_matrix

_FILM_SHARE = 0.25  # of the film's error, by which a film is off that Newton's method has not led to its end

Hot = TypeVar("Hot", ThermalFilm, MixedThermalFilm)


def with_load_slopes(film: Hot) -> Hot:
    """Return the film with the slopes of its separation and of its central thickness by the load.

    At the same speeds, bulk temperatures and supply: a meniscus stays, that of a layer moves until the flow is that of
    the layer again, asperities share the load anew. From the Newton matrix of the film, corrected for the temperatures
    that follow. With the slopes the film has its stiffnesses ``"approach"`` and ``"tangent"``.

    Parameters
    ----------
    film : ThermalFilm or MixedThermalFilm
        A solved film.

    Returns
    -------
    ThermalFilm or MixedThermalFilm
        With ``separation_slope``, ``central_slope`` and the errors of both stiffnesses, from two grids (those of a
        rough film are the errors of its ``film``); as it was where temperatures do not settle as the load changes.

    Raises
    ------
    InputError
        For a film without solution.

    Notes
    -----
    Method: docs/theory/ehl.md.

    Examples
    --------
    >>> from ehl import LineContact, Lubricant, solve_thermal
    >>> oil = Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
    >>> film = solve_thermal(LineContact(2e5, 2.5, 6e-3, 2.26e11, oil, sliding=1.0))
    >>> f"{with_load_slopes(film).stiffness():.1e}"
    '2.2e+12'
    """
    with Faults() as faults:
        smooth = film.film if isinstance(film, MixedThermalFilm) else film
        if not isinstance(smooth, ThermalFilm) or smooth.levels is None or not film.converged:
            remedy = "solve_thermal or solve_mixed_thermal makes one"
            faults.add("film", film, "must be a solved ThermalFilm or MixedThermalFilm", remedy)
    assert smooth.levels is not None
    coarse, fine = (with_matrix(level) for level in smooth.levels)
    if coarse.solution.factors is None or fine.solution.factors is None:
        return film
    sloped = _with_slopes(smooth, coarse, fine)
    if math.isnan(sloped.separation_slope):
        return film
    if isinstance(film, MixedThermalFilm):
        return _rough(film, sloped, fine)
    return sloped


def _with_slopes(film: ThermalFilm, coarse: WarmLevel, fine: WarmLevel) -> ThermalFilm:
    """Differentiate by the load on both grids."""
    before, after = (slopes(level, film.supply) for level in (coarse, fine))
    load = film.contact.load
    rest = 2.0 * BALANCED + _FILM_SHARE * film.errors.film  # corrections on both grids
    errors: FilmErrors = replace(film.errors, **slope_errors(before, after, film.errors.inlet, rest))
    return replace(
        film, separation_slope=after.separation / load, central_slope=after.central / load, errors=errors
    )


def _rough(film: MixedThermalFilm, sloped: ThermalFilm, fine: WarmLevel) -> MixedThermalFilm:
    """Let the asperities follow the load."""
    odds, by = odds_of(film.asperity_share), by_share(fine, sloped.supply)
    stiffness, separation, central = rough_slopes(film.contact, film.roughness, sloped, odds, by)
    return replace(
        film, film=sloped, asperity_stiffness=stiffness, separation_slope=separation, central_slope=central
    )
