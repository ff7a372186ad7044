"""What a film answers to a small oscillation of its load: complex compliance, stiffness and damping."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Cost, Faults, Limit, Stopwatch, described, part, quantity, record, unclocked
from base.results import ITSELF
from ehl.discrete.supply import OilLayer
from ehl.films.film import Film
from ehl.films.mixed_film import RoughFilm
from ehl.films.mixed_thermal import MixedThermalFilm
from ehl.films.thermal import ThermalFilm
from ehl.films.thermal_slopes import with_load_slopes
from ehl.solving.levels import Level, WarmLevel, figures
from ehl.solving.load_share import excess, odds_of
from ehl.solving.oil_following import Complex
from ehl.solving.oscillation import LinearFilm, not_slower
from ehl.solving.response import (
    eased_by_step,
    farther_by_step,
    heavier_by_step,
    with_matrix,
)

_FREQUENCY = Limit(-1e12, 1e12, "rad/s", "give the angular frequency in rad/s")
_NO_ERROR = "not estimated; its change between two grids is part of the compliance's error"
_UNSETTLED = (
    "the temperatures do not settle as the load oscillates so fast, or as it changes: take lower frequencies, or the "
    "isothermal film"
)


@record
class FilmResponse:
    """Answer of a film to a load w + dw exp(i omega t), per metre of face; one entry for each frequency."""

    headline = ("static_stiffness",)

    film: Film | RoughFilm = part("the steady film, with its slopes by the load")
    frequency: Array = quantity("rad/s", "angular frequency of the load", "frequency")
    compliance: Complex = quantity(
        "m2/N", "complex -d(film separation)/dw", "frequency", error="relative_error"
    )
    central_compliance: Complex = quantity(
        "m2/N", "complex -d(film thickness at x = 0)/dw", "frequency", no_error=_NO_ERROR
    )
    least_compliance: Complex = quantity(
        "m2/N", "complex -d(minimum film thickness)/dw", "frequency", no_error=_NO_ERROR
    )
    relative_error: Array = quantity(
        "1",
        "changes of the compliances of separation and central film between two grids, over the former",
        "frequency",
        no_error=ITSELF,
    )
    cost: Cost
    converged: bool
    message: str

    @described("1", no_error=ITSELF)
    def error(self) -> float:
        """Largest of the relative errors of the compliance."""
        return float(np.max(self.relative_error))

    @described("N/m2", "frequency", error="relative_error")
    def dynamic_stiffness(self) -> Complex:
        """Complex stiffness, load over yielding."""
        return 1.0 / self.compliance

    @described("N/m2", "frequency", error="relative_error")
    def stiffness(self) -> Array:
        """Part of the load in phase with the yielding, per yielding."""
        return self.dynamic_stiffness.real

    @described("N s/m2", "frequency", error="relative_error")
    def damping(self) -> Array:
        """Part of the load in phase with the velocity of yielding, per velocity."""
        return self.dynamic_stiffness.imag / not_slower(self.frequency, self.film.contact)

    @described("N/m2", no_error="not estimated here; the film's errors.approach_stiffness")
    def static_stiffness(self) -> float:
        """Stiffness at frequency 0, by the film's own derivative."""
        return -1.0 / self.film.separation_slope


def film_response(film: Film | RoughFilm, frequency: ArrayLike) -> FilmResponse:
    """Linear response of a solved film to an oscillating load.

    Reynolds' equation with its squeeze term, ``d/dx[rho h^3/(12 eta) dp/dx] = u d(rho h)/dx + d(rho h)/dt``, linearised
    about the steady film: one complex solution of the Newton matrix less ``i omega`` times what the gap stores, for
    every frequency.

    Parameters
    ----------
    film : Film, ThermalFilm, MixedFilm or MixedThermalFilm
        However it is supplied. The meniscus of a layer moves so that it takes up what the layer brings. Between rough
        surfaces the asperities share the load with the film at every moment: their share follows the gap. With heat oil
        and surfaces store heat and take it along; a film without slopes by the load gets them.
    frequency : float or array_like
        omega [rad/s]; at 0 stiffness and damping are the limits for slow oscillations.

    Returns
    -------
    FilmResponse
        Arrays of the frequency's shape. The film separation oscillates as ``-compliance dw exp(i omega t)``. The
        error is the change from the next coarser grid: large where disturbances that travel with u are shorter than
        some cells.

    Raises
    ------
    InputError
        For frequencies that are no numbers; for a film that did not converge.

    Notes
    -----
    Equations: docs/theory/ehl.md, "Time".

    Examples
    --------
    >>> from ehl import LineContact, solve
    >>> film = solve(LineContact.from_moes(M=20.0, L=10.0))
    >>> contact = film.contact
    >>> answer = film_response(film, [0.0, 0.5 * contact.entrainment / contact.half_width])
    >>> [f"{k:.2e} N/m, {c:.2e} N s/m" for k, c in zip(answer.stiffness, answer.damping, strict=True)]
    ['5.78e+12 N/m, 4.13e+09 N s/m', '1.66e+12 N/m, 2.47e+09 N s/m']
    """
    at = _checked(film, frequency)
    if math.isnan(film.separation_slope):
        film = _with_slopes(film)
    smooth = film.film if isinstance(film, RoughFilm) else film
    assert smooth.state is not None
    with unclocked():
        import ehl.kernels.film_kernels  # noqa: F401  numba
    watch = Stopwatch()
    coarse, fine = (
        _answers(_differentiable(level), film, at.ravel()).reshape(*at.shape, 3) / film.contact.load
        for level in (smooth.state.coarse, smooth.state.fine)
    )
    # waves of the film may leave the separation as it is by accident: the central film's change counts as well
    changes = np.abs(coarse - fine)[..., :2].sum(axis=-1)
    still = smooth.errors.approach_stiffness * abs(film.separation_slope)
    error = (changes + still) / np.abs(fine[..., 0])
    unknowns = smooth.x.size - 1
    return FilmResponse(
        film=film,
        frequency=at,
        compliance=-fine[..., 0],
        central_compliance=-fine[..., 1],
        least_compliance=-fine[..., 2],
        relative_error=error,
        cost=Cost(watch.seconds, unknowns=unknowns, iterations=at.size),
        converged=bool(np.isfinite(error).all()),
        message="converged" if np.isfinite(error).all() else _UNSETTLED,
    )


def _with_slopes(film: Film | RoughFilm) -> Film | RoughFilm:
    """Add the slopes of a film with heat by its load."""
    if isinstance(film, ThermalFilm):
        return with_load_slopes(film)
    return with_load_slopes(film) if isinstance(film, MixedThermalFilm) else film


def _differentiable(level: Level) -> Level:
    """Return a level with heat with its Newton matrix; another as it is."""
    return with_matrix(level) if isinstance(level, WarmLevel) else level


def _checked(film: Film | RoughFilm, frequency: ArrayLike) -> Array:
    """Raise every fault of the arguments; return the frequencies."""
    at = np.zeros(0)
    with Faults() as faults:
        refused = _why_not(film)
        if refused:
            faults.add("film", film, *refused)
        try:
            at = np.asarray(frequency, dtype=float)
        except (TypeError, ValueError):
            faults.add("frequency", frequency, "must be numbers", "give the angular frequency in rad/s")
        else:
            if at.size == 0:
                faults.add("frequency", frequency, "must hold a frequency", "give one in rad/s")
            for value in at.ravel():
                faults.number("frequency", float(value), _FREQUENCY)
    return at


def _why_not(film: object) -> tuple[str, str] | None:
    """What a film must be and is not, and the remedy."""
    smooth = film.film if isinstance(film, RoughFilm) else film
    if not isinstance(film, Film | RoughFilm) or not isinstance(smooth, Film):
        return "must be a solved Film or MixedFilm", "ehl.solve(contact) gives one"
    if not film.converged or smooth.state is None:
        return "must have converged", film.message
    return None


def _answers(level: Level, film: Film | RoughFilm, frequencies: Array) -> Complex:
    """Derivatives of separation, central and minimum film by ln of the whole load (k, 3) [m].

    The meniscus of a layer and the asperities' share follow so that the layer's oil is taken up and the asperities
    carry what is asked of them at every moment.
    """
    smooth = film.film if isinstance(film, RoughFilm) else film
    ways = [heavier_by_step(level, smooth.supply)]
    fed = isinstance(smooth.supply, OilLayer) and level.plan.fixed
    rough = isinstance(film, RoughFilm) and film.asperity_share > 0.0
    if fed:
        ways.append(farther_by_step(level))
    if rough:
        ways.append(eased_by_step(level, smooth.supply))
    linear = LinearFilm.of(level, ways)
    answers = np.array([linear.answer(frequency) for frequency in frequencies])  # (k, ways, 4)
    gap = figures(level).central_thickness
    rows = []
    if fed:
        rows.append(answers[:, :, 3])
    if isinstance(film, RoughFilm) and rough:
        at = excess(film.contact, film.roughness, gap, odds_of(film.asperity_share))
        balance = at.by_gap * answers[:, :, 1]
        balance[:, 0] += at.by_load
        balance[:, -1] -= at.by_odds / film.asperity_share  # ln(1 - s) falls by s
        rows.append(balance)
    answer: Complex = _followed(answers[:, :, :3], np.array(rows))
    if isinstance(film, RoughFilm) and rough:
        answer[:, 0] += (film.roughness.planes(gap)[1] - 1.0) * answer[:, 1]
    return answer


def _followed(answers: Complex, rows: Complex) -> Complex:
    """Let all ways but the first follow it, so that every row of conditions stays 0: (k, ways, 3) to (k, 3)."""
    if rows.size == 0:
        return answers[:, 0]
    conditions = np.moveaxis(rows, 0, 1)  # (k, rows, ways)
    follow = np.linalg.solve(conditions[:, :, 1:], -conditions[:, :, :1])
    followed: Complex = answers[:, 0] + (answers[:, 1:] * follow).sum(axis=1)
    return followed
