"""Line contacts along a path, each started from its neighbour."""

from __future__ import annotations

from collections.abc import Iterable

from ehl.contact import LineContact
from ehl.film import Film
from ehl.solver import solve
from ehl.supply import Supply

__all__ = ["solve_path"]


def solve_path(
    contacts: Iterable[LineContact],
    tolerance: float = 0.005,
    nodes: int | None = None,
    domain: tuple[float, float] | None = None,
    start: Film | None = None,
    grid: str = "graded",
    supply: Supply | None = None,
    spike: float | None = None,
) -> tuple[Film, ...]:
    """Solve a sequence of contacts, each started from the one before it: quasi-steady along a path.

    Parameters
    ----------
    contacts : iterable of LineContact
        In the order of the path; the load may jump.
    tolerance, nodes, domain, start, grid, supply, spike
        As for :func:`ehl.solve`; ``start`` serves the first contact.

    Returns
    -------
    tuple of Film
        One for each contact. A contact that fails does not stop the path; its film says so.
    """
    films: list[Film] = []
    last = start
    for contact in contacts:
        film = solve(contact, tolerance, nodes, domain, last, grid, supply, spike)
        films.append(film)
        if film.converged:
            last = film
    return tuple(films)
