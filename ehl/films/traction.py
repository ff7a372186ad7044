"""Traction curves: friction over the slide-roll ratio, as a disc machine measures it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Cost, Faults, Limit, Stopwatch, described, part, quantity, record, shorten
from base.results import EXACT
from ehl.discrete.contact import LineContact
from ehl.discrete.solids import STEEL, Solid
from ehl.films.thermal import ThermalFilm, solve_thermal
from ehl.oil.lubricant import Lubricant

_PRESSURE = Limit.above(0.0, 1e11, "Pa", "1e9 is 1 GPa")
_HALVINGS = 2  # of the way to a ratio that is not solved at once
_RATIO = Limit(-2.0, 2.0, remedy="(u1 - u2)/u with u their mean: 2 is one disc at rest")


@record
class TractionCurve:
    """Friction of a lubricated line contact over the slide-roll ratio at one pressure, speed and temperature.

    Figures are NaN where a film was not found; `message` has the first reason.
    """

    headline = ("hertz_pressure", "entrainment", "temperature", "greatest_traction")

    contact: LineContact = part("the contact without sliding")
    hertz_pressure: float = quantity("Pa", "Hertz pressure", shown="GPa", no_error=EXACT)
    entrainment: float = quantity("m/s", "mean speed of both surfaces", no_error=EXACT)
    temperature: float = quantity("K", "bulk temperature of both bodies", no_error=EXACT)
    slide_roll: Array = quantity("1", "slide-roll ratio, (u1 - u2)/u", "point", no_error=EXACT)
    traction_coefficient: Array = quantity(
        "1", "mean shear stress over the load, positive where u1 > u2", "point", error="traction_error"
    )
    central_thickness: Array = quantity(
        "m", "film thickness at x = 0", "point", shown="um", error="film_error"
    )
    minimum_thickness: Array = quantity(
        "m", "minimum film thickness", "point", shown="um", error="film_error"
    )
    oil_temperature_rise: Array = quantity(
        "K", "highest oil temperature above the bulk's", "point", error="temperature_error"
    )
    surface_temperature_rise: Array = quantity(
        "K", "maximum surface temperature above the bulk's", "point", error="temperature_error"
    )
    traction_error: Array = quantity("1", "change of the traction between two grids", "point")
    film_error: Array = quantity("1", "estimated error of the films", "point")
    temperature_error: Array = quantity("1", "estimated error of the temperature rises", "point")
    no_error = "an error estimate itself"
    cost: Cost
    converged: bool
    message: str

    @described("1", error="error")
    def greatest_traction(self) -> float:
        """Largest traction coefficient of the curve."""
        known = np.abs(self.traction_coefficient[np.isfinite(self.traction_coefficient)])
        return float(known.max()) if known.size > 0 else math.nan

    @described("1")
    def error(self) -> float:
        """Largest error of the traction, of points that slide."""
        slides = np.isfinite(self.traction_error) & (self.slide_roll != 0.0)
        return float(self.traction_error[slides].max()) if slides.any() else math.nan


def traction_curve(
    lubricant: Lubricant,
    pressure: float,
    entrainment: float,
    slide_roll: ArrayLike,
    *,
    radius: float,
    reduced_modulus: float = 2.26e11,
    temperature: float | None = None,
    solids: tuple[Solid, Solid] = (STEEL, STEEL),
    tolerance: float = 0.01,
) -> TractionCurve:
    """Friction over the slide-roll ratio at a given pressure, speed and temperature.

    A film with heat and shear thinning is solved at every ratio, from the smallest sliding on, each from its neighbour.

    Parameters
    ----------
    lubricant : Lubricant
        With Eyring's stress or a limiting one, and what heat does with it.
    pressure : float
        Hertz pressure [Pa].
    entrainment : float
        Mean speed u of both surfaces [m/s].
    slide_roll : array_like (n,)
        (u1 - u2)/u, -2 to 2, in any order.
    radius : float
        Of relative curvature, R1 R2/(R1 + R2) of the discs [m].
    reduced_modulus : float
        E' [Pa]; of steel unless given.
    temperature : float, optional
        Bulk temperature of both discs, which the oil arrives with [K]; that of the lubricant's data unless given.
    solids : tuple of Solid
        The first and the second disc.
    tolerance : float
        Wanted relative error of films and traction.

    Returns
    -------
    TractionCurve
        With ``converged=False`` where a ratio has no film; the others stay.

    Raises
    ------
    InputError
        With every fault of the arguments.

    Warns
    -----
    RangeWarning
        As :func:`solve_thermal`.

    Notes
    -----
    Discs are crowned; the curve is that of a line contact of the same pressure, whose friction differs by the side
    flow and by the pressure's mean (pi/4 of the Hertz pressure, 2/3 in points). Compare at equal **mean** pressure.

    Examples
    --------
    >>> oil = Lubricant(0.02, 17e-9, 860.0, temperature=353.15, eyring_stress=6e6)
    >>> curve = traction_curve(oil, 0.9e9, 5.0, [0.0, 0.02, 0.1], radius=0.02)
    >>> curve.converged, [round(float(mu), 3) for mu in np.abs(curve.traction_coefficient)]
    (True, [0.0, 0.014, 0.021])
    """
    watch = Stopwatch()
    ratios = np.atleast_1d(np.asarray(slide_roll, dtype=float))
    with Faults() as faults:
        faults.number("pressure", pressure, _PRESSURE)
        if ratios.ndim != 1 or ratios.size == 0:
            faults.add("slide_roll", shorten(slide_roll), "must be one or more ratios", "[0, 0.01, 0.1], say")
        for ratio in ratios.ravel().tolist():
            faults.number("slide_roll", ratio, _RATIO)
        if not isinstance(lubricant, Lubricant):
            faults.add("lubricant", shorten(lubricant), "must be a Lubricant", "build one with ehl.Lubricant")
        elif lubricant.eyring_stress is None and lubricant.limiting_shear_ratio is None:
            remedy = "5e6 to 1e7 Pa is usual; a Newtonian oil's friction has no bound"
            faults.add("lubricant.eyring_stress", None, "must be given, or limiting_shear_ratio", remedy)
    at = lubricant.temperature if temperature is None else float(temperature)
    load = (
        2.0 * math.pi * radius * pressure**2 / reduced_modulus if radius > 0.0 < reduced_modulus else math.nan
    )
    contact = LineContact(load, entrainment, radius, reduced_modulus, lubricant)
    points = _Points(contact, solids, at, tolerance)
    films: dict[int, ThermalFilm] = {}
    for i in np.argsort(np.abs(ratios), kind="stable").tolist():
        films[i] = points.film(float(ratios[i]), _HALVINGS)
    return _curve(contact, at, ratios, [films[i] for i in range(ratios.size)], watch)


class _Points:
    """Films of one contact at one ratio after another, each from the last."""

    def __init__(
        self, contact: LineContact, solids: tuple[Solid, Solid], at: float, tolerance: float
    ) -> None:
        self.contact, self.solids, self.at, self.tolerance = contact, solids, at, tolerance
        self.near: ThermalFilm | None = None

    def film(self, ratio: float, halvings: int) -> ThermalFilm:
        """Solve at a ratio; where that fails, half way there first."""
        sliding = replace(self.contact, sliding=ratio * self.contact.entrainment)
        near = self.near
        if near is not None and near.contact.sliding * sliding.sliding < 0.0:
            near = None  # the other disc is the faster
        solved = solve_thermal(sliding, self.solids, (self.at, self.at), self.tolerance, start=near)
        if not solved.converged and near is not None and halvings > 0:
            half = 0.5 * (near.contact.sliding / self.contact.entrainment + ratio)
            if self.film(half, halvings - 1).converged:
                return self.film(ratio, halvings - 1)
        if solved.converged:
            self.near = solved
        return solved


def _curve(
    contact: LineContact, at: float, ratios: Array, films: list[ThermalFilm], watch: Stopwatch
) -> TractionCurve:
    """Gather the films."""
    lost = [
        f"at {ratio:g}: {film.message}"
        for ratio, film in zip(ratios, films, strict=True)
        if not film.converged
    ]
    cost = sum((film.cost for film in films), Cost(0.0))

    def over(name: str) -> Array:
        return np.array([getattr(film, name) if film.converged else math.nan for film in films])

    return TractionCurve(
        contact=contact,
        hertz_pressure=contact.peak_pressure,
        entrainment=contact.entrainment,
        temperature=at,
        slide_roll=ratios,
        traction_coefficient=over("traction_coefficient"),
        central_thickness=over("central_thickness"),
        minimum_thickness=over("minimum_thickness"),
        oil_temperature_rise=over("oil_temperature_rise"),
        surface_temperature_rise=over("surface_temperature_rise"),
        traction_error=over("traction_error"),
        film_error=over("error"),
        temperature_error=over("temperature_error"),
        cost=Cost(watch.seconds, cost.unknowns, cost.iterations),
        converged=not lost,
        message=lost[0] if lost else "converged",
    )
