"""What each part of a lubricated mesh cycle may err by, from one tolerance of the whole, for the lowest cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from base import SolverError
from flankfilm.coupling.mesh.tolerance import CostLaw, split, step_below

POSITIONS = 120
"""Positions of curves; figures follow from arcs, whatever the positions."""

COMPLIANCE = CostLaw("tooth compliance", coarsest=5e-4, seconds=0.3, power=1.0, finest=3e-6)
"""Meshing, factors and loads of both gears by finite elements."""

SAMPLING = {
    ("fem", "coupled"): CostLaw("sampling of the mesh cycle", coarsest=4e-4, seconds=0.03, power=2 / 3),
    ("fem", "independent"): CostLaw("sampling of the mesh cycle", coarsest=2e-3, seconds=0.03, power=1.0),
}
"""From 120 positions on; independent pairs make the curve step."""

CLOSED_SAMPLING = CostLaw("sampling of the mesh cycle", coarsest=2e-3, seconds=0.02, power=1.0)

FILMS = CostLaw("film", coarsest=6e-3, seconds=1.0, power=0.7)
"""Of the films of a mesh cycle, their relative error, solved twice."""

LEAST_CHANGE = 1e-6
"""Change of the stiffness below which no film is resolved for the stiffness' sake."""

ASSUMED_CHANGE = 0.2
"""Change of the stiffness by films where it need not or cannot be foreseen; light loads at high speed reach it."""

COARSEST_FILMS = 0.1
"""The largest tolerance that films are solved to."""

AGREEMENT = 0.02
"""Part of the tolerance by which forces may still change when films and load share are iterated."""


@dataclass(frozen=True)
class Resolution:
    """What the parts of a lubricated mesh cycle may err by, relative.

    Attributes
    ----------
    compliance : float
        Tooth compliance by finite elements.
    sampling : float
        Mean stiffness, by the number of positions.
    transmission_error : float
        Peak to peak, by the number of positions.
    films : float
        Film thickness.
    agreement : float
        Forces of the pairs over the whole, when films and load share are iterated.
    """

    compliance: float
    sampling: float
    transmission_error: float
    films: float
    agreement: float

    @classmethod
    def from_shares(cls, tolerance: float, shares: Mapping[str, float], films: float) -> Resolution:
        """Resolution from a tolerance of the whole, its split among stages, and the tolerance of films."""
        # figures beside the mesh stiffness, such as fields, have finite elements all the same
        compliance = min(shares.get(COMPLIANCE.name, tolerance), COMPLIANCE.coarsest)
        return cls(
            step_below(compliance),
            step_below(shares[CLOSED_SAMPLING.name]),
            tolerance,
            films,
            AGREEMENT * tolerance,
        )


def stiffness_laws(model: str, pairs: str) -> tuple[CostLaw, ...]:
    """Cost of what a stiffness model has to resolve."""
    return (COMPLIANCE, SAMPLING[model, pairs]) if model == "fem" else (CLOSED_SAMPLING,)


def film_law_of_cost(change: float, tolerance: float = 1.0) -> CostLaw:
    """Cost of solved films by the error that they leave in the mean stiffness.

    Parameters
    ----------
    change : float
        Relative change of the mean stiffness by the films: by that their error counts.
    tolerance : float
        Largest relative error of the films themselves.
    """
    coarsest = min(FILMS.coarsest, tolerance)
    return CostLaw(FILMS.name, change * coarsest, FILMS.cost(coarsest), FILMS.power)


def film_tolerance(shares: Mapping[str, float], change: float, wanted: float = COARSEST_FILMS) -> float:
    """Relative error that solved films may have.

    Parameters
    ----------
    shares : mapping
        Split of the tolerance by stages; its share of the films counts by their change of the stiffness.
    change : float
        As of `film_law_of_cost`.
    wanted : float
        Tolerance of the films as separate figures.
    """
    return min(wanted, step_below(shares[FILMS.name] / change))


def resolution_of(
    tolerance: float, model: str = "fem", pairs: str = "coupled", film: str = "ehl"
) -> Resolution:
    """Split a tolerance for given models; the film itself is to be known to it as well.

    Raises
    ------
    SolverError
        Where no resolution meets the tolerance.

    Examples
    --------
    >>> found = resolution_of(0.005)
    >>> found.compliance, found.films
    (0.0005, 0.005)
    """
    laws = stiffness_laws(model, pairs)
    if film == "ehl":
        laws += (film_law_of_cost(ASSUMED_CHANGE, tolerance),)
    shares = split(tolerance, laws)
    if shares is None:
        raise SolverError(f"no resolution meets a tolerance of {tolerance:g}; raise it")
    films = film_tolerance(shares, ASSUMED_CHANGE, tolerance) if film == "ehl" else COARSEST_FILMS
    return Resolution.from_shares(tolerance, shares, films)
