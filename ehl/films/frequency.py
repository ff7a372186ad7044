"""What a film answers to a small oscillation of its load: complex compliance, stiffness and damping."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from base import Array, Cost, Faults, Integers, Limit, Stopwatch, described, part, quantity, record, unclocked
from base.results import ITSELF
from ehl.discrete.contact import LineContact
from ehl.discrete.equations import Grid, Residual, film_gap
from ehl.discrete.squeeze import Content, Storage, by_parameter
from ehl.discrete.supply import OilLayer
from ehl.films.film import Film
from ehl.films.mixed_film import MixedFilm
from ehl.films.mixed_thermal import MixedThermalFilm
from ehl.films.thermal import ThermalFilm
from ehl.solving.levels import Level, figures
from ehl.solving.load_share import excess, odds_of
from ehl.solving.response import STEP, eased_by_step, explicit, heavier_by_step

Complex = NDArray[np.complex128]

_FREQUENCY = Limit(-1e12, 1e12, "rad/s", "give the angular frequency in rad/s")
_NO_ERROR = "not estimated; its change between two grids is part of the compliance's error"
_SLOWEST = 1e-4  # u/b: below it stiffness and damping are those of this frequency, to 1e-8


@record
class FilmResponse:
    """Answer of a film to a load w + dw exp(i omega t), per metre of face; one entry for each frequency."""

    headline = ("static_stiffness",)

    film: Film | MixedFilm = part("the steady film")
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
        return self.dynamic_stiffness.imag / _not_slower(self.frequency, self.film.contact)

    @described("N/m2", no_error="not estimated here; the film's errors.approach_stiffness")
    def static_stiffness(self) -> float:
        """Stiffness at frequency 0, by the film's own derivative."""
        return -1.0 / self.film.separation_slope


def film_response(film: Film | MixedFilm, frequency: ArrayLike) -> FilmResponse:
    """Linear response of a solved film to an oscillating load.

    Reynolds' equation with its squeeze term, ``d/dx[rho h^3/(12 eta) dp/dx] = u d(rho h)/dx + d(rho h)/dt``, linearised
    about the steady film: one complex solution of the Newton matrix less ``i omega`` times what the gap stores, for
    every frequency.

    Parameters
    ----------
    film : Film or MixedFilm
        Flooded, in a given domain, or with its meniscus held, isothermal. Between rough surfaces the asperities share
        the load with the film at every moment: their share follows the gap.
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
        For frequencies that are no numbers; for a film that did not converge; for films with heat, whose oil answers
        too; behind a layer, whose meniscus moves and stores oil.

    Notes
    -----
    Equations: docs/theory/ehl.md, "Time".

    Examples
    --------
    >>> from ehl import solve
    >>> film = solve(LineContact.from_moes(M=20.0, L=10.0))
    >>> contact = film.contact
    >>> answer = film_response(film, [0.0, 0.5 * contact.entrainment / contact.half_width])
    >>> [f"{k:.2e} N/m, {c:.2e} N s/m" for k, c in zip(answer.stiffness, answer.damping, strict=True)]
    ['5.78e+12 N/m, 4.13e+09 N s/m', '1.66e+12 N/m, 2.47e+09 N s/m']
    """
    at = _checked(film, frequency)
    smooth = film.film if isinstance(film, MixedFilm) else film
    assert smooth.state is not None
    with unclocked():
        import ehl.kernels.film_kernels  # noqa: F401  numba
    watch = Stopwatch()
    coarse, fine = (
        _answers(level, film, at.ravel()).reshape(*at.shape, 3) / film.contact.load
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
        converged=True,
        message="converged",
    )


def _checked(film: Film | MixedFilm, frequency: ArrayLike) -> Array:
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
    if isinstance(film, ThermalFilm | MixedThermalFilm):
        return (
            "must be isothermal: with heat the oil's temperature answers too, which is not computed",
            "solve(contact) or solve_mixed with the oil at the film's mean temperature",
        )
    smooth = film.film if isinstance(film, MixedFilm) else film
    if not isinstance(film, Film | MixedFilm) or not isinstance(smooth, Film):
        return "must be a solved Film or MixedFilm", "ehl.solve(contact) gives one"
    if not film.converged or smooth.state is None:
        return "must have converged", film.message
    if isinstance(smooth.supply, OilLayer) and smooth.starved:
        return (
            "must be flooded or hold its meniscus: behind a layer that moves and stores oil, which is not computed",
            f"give supply=Meniscus({smooth.inlet:.4g})",
        )
    return None


def _answers(level: Level, film: Film | MixedFilm, frequencies: Array) -> Complex:
    """Derivatives of separation, central and minimum film by ln of the whole load (k, 3) [m]."""
    supply = film.film.supply if isinstance(film, MixedFilm) else film.supply
    by_load = _Linear.of(level, *heavier_by_step(level, supply))
    alone = np.array([by_load.answer(frequency) for frequency in frequencies])
    if not isinstance(film, MixedFilm) or film.asperity_share == 0.0:
        return alone
    by_part = _Linear.of(level, *eased_by_step(level, supply))
    eased = np.array([by_part.answer(frequency) for frequency in frequencies])
    return _shared(film, figures(level).central_thickness, alone, eased)


def _shared(film: MixedFilm, gap: float, alone: Complex, eased: Complex) -> Complex:
    """Let the asperities share the load at every moment: their excess at the gap x = 0 stays 0.

    From the answers to ln of the film's load and to ln of the part of load and modulus that asperities leave to it.
    """
    by_odds = -film.asperity_share * eased  # ln(1 - s) falls by s
    at = excess(film.contact, film.roughness, gap, odds_of(film.asperity_share))
    follow = -(at.by_load + at.by_gap * alone[:, 1]) / (at.by_gap * by_odds[:, 1] + at.by_odds)
    answer: Complex = alone + by_odds * follow[:, None]
    answer[:, 0] += (film.roughness.planes(gap)[1] - 1.0) * answer[:, 1]
    return answer


def _not_slower(frequency: Array, contact: LineContact) -> Array:
    """Frequencies, those near 0 so far from it that damping can be distinguished from rounding."""
    least = _SLOWEST * contact.entrainment / contact.half_width
    frequencies: Array = np.where(np.abs(frequency) < least, least, frequency)
    return frequencies


@dataclass(frozen=True)
class _Linear:
    """One grid's linear problem (matrix - i omega stored) change = forced + i omega swept, by ln of a parameter."""

    level: Level
    matrix: Array
    stored: Array  # [s]
    forced: Array
    swept: Array  # [s]
    central: float  # explicit parts of the figures [m]
    separation: float
    thinned: Array  # change of the film at the nodes where they are, with P and H0 held [m]
    free: Integers

    @classmethod
    def of(cls, level: Level, other: LineContact, moved: Grid) -> _Linear:
        """Linearise about the steady film, towards a contact a step away on nodes that follow it."""
        from ehl.kernels.film_kernels import newton_matrix

        grid, groups, solution = level.grid, level.groups, level.solution
        before = Residual.of(grid, groups, solution.P, solution.H0)
        own = explicit(level, before, other, moved)
        influence = -groups.compliance * grid.potential
        free = np.flatnonzero(solution.P[1:-1] > 0.0) + 1
        system = newton_matrix(before.slopes, influence, grid.weights, free)
        scale = system[:-1, -1]
        storage = Storage.of(grid, groups, solution.P, solution.H)
        seconds = groups.length / level.contact.entrainment
        stored = np.zeros((free.size + 1, free.size + 1))
        stored[:-1] = seconds * scale[:, None] * storage.rows(influence, free)
        after = level.groups.on(other, moved)
        content = Content.of(grid, groups, solution.P, solution.H0)
        swept = by_parameter(content, Content.of(moved, after, solution.P, solution.H0), STEP)
        swept /= groups.gap * level.contact.entrainment
        return cls(
            level=level,
            matrix=np.ascontiguousarray(system[:, :-1]),
            stored=stored,
            forced=np.append(-scale * own.net_flux[free - 1], own.short),
            swept=np.append(scale * swept[free - 1], 0.0),
            central=own.central,
            separation=own.separation,
            thinned=_thinned(level, other, moved),
            free=free,
        )

    def answer(self, frequency: float) -> Complex:
        """Derivatives of separation, central and minimum film by ln of the parameter [m]."""
        level, grid, groups = self.level, self.level.grid, self.level.groups
        at = 1j * float(_not_slower(np.array(frequency), level.contact))
        change = np.linalg.solve(self.matrix - at * self.stored, self.forced + at * self.swept)
        dP, dH0 = np.zeros(grid.nodes.size, complex), change[-1]
        dP[self.free] = change[:-1]
        centre = dH0 - groups.compliance * (grid.centre @ dP)
        film = self.thinned + groups.gap * (dH0 - groups.compliance * (grid.potential @ dP))
        least = np.interp(figures(level).minimum_position / groups.length, grid.nodes, film)
        derivatives: Complex = np.array(
            [self.separation + groups.gap * dH0, self.central + groups.gap * centre, least]
        )
        return derivatives


def _thinned(level: Level, heavier: LineContact, moved: Grid) -> Array:
    """Differentiate the gap at fixed places by ln w, with P and H0 of the moving nodes held [m]."""
    grid, groups, solution = level.grid, level.groups, level.solution
    after = groups.on(heavier, moved)
    x, x_moved = grid.nodes * groups.length, moved.nodes * after.length
    film = solution.H * groups.gap
    carried = film_gap(moved, after, solution.P, solution.H0) * after.gap
    change: Array = (carried - film - np.gradient(film, x) * (x_moved - x)) / STEP
    return change
