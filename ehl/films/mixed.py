"""Mixed lubrication: film and asperities share the load.

Johnson, Greenwood and Poon's load sharing: asperities and film carry the shares s and 1 - s of the load at every
point alike. The bodies then deform under the film's pressure as a contact of load w (1 - s) and modulus
E' (1 - s) would: the half-width stays. The film of that contact is the mean gap between the surfaces; the mean planes
of their heights are as far apart as leaves that gap, less than it and at thin films less than nothing. Asperities carry
their pressure at that distance, and s is where this is what the share asks for at the middle of the contact. So the
share tends to 1 as films vanish, whatever the load.
"""

from __future__ import annotations

import math
from dataclasses import replace

from base import Cost, InputError, shorten
from ehl.discrete.asperities import Roughness
from ehl.discrete.contact import LineContact
from ehl.discrete.regressions import moes_central
from ehl.discrete.supply import OilLayer, Supply
from ehl.films.film import Film
from ehl.films.mixed_film import MixedFilm
from ehl.films.result import GridSolution, central_error
from ehl.films.rough_slopes import rough_slopes
from ehl.films.solver import solve_checked
from ehl.solving.levels import State, figures
from ehl.solving.load_share import KnownGap, eased, foreseen, odds_of, share_error, share_of, usual_growth
from ehl.solving.options import Options, warn_of_range
from ehl.solving.response import by_share
from ehl.solving.share_search import NoFilmError, ShareSearch


def solve_mixed(
    contact: LineContact,
    roughness: Roughness,
    tolerance: float = 0.005,
    supply: Supply | None = None,
    start: Film | MixedFilm | None = None,
    nodes: int | None = None,
) -> MixedFilm:
    """Share the load between film and asperities.

    Parameters
    ----------
    contact : LineContact
        The whole load, and the bodies' modulus.
    roughness : Roughness
        Of both surfaces together.
    tolerance : float
        Wanted relative error of the film, as for :func:`ehl.solve`.
    supply : Meniscus or OilLayer, optional
        As for :func:`ehl.solve`.
    start : Film or MixedFilm, optional
        A film to start from; one with asperities gives their share to start with as well.
    nodes : int, optional
        Solve on this many nodes instead and report the error that this leaves.

    Returns
    -------
    MixedFilm
        With ``converged=False`` where a film fails, or where the asperities would have to carry more than
        all but a millionth of the load.

    Raises
    ------
    InputError
        With every fault of the arguments.

    Notes
    -----
    The share is sought in ln[s/(1-s)] between bounds, each film giving the next share. The asperities' pressure falls
    as their share rises, since the film that carries less is thicker, and what the share asks for rises. The film's
    derivative by the share comes from its own Newton matrix at first, then from the last two films.

    References
    ----------
    K. L. Johnson, J. A. Greenwood and S. Y. Poon, A simple theory of asperity contact in elastohydrodynamic
    lubrication, Wear 19 (1972) 91-108, doi:10.1016/0043-1648(72)90445-0;
    :func:`ehl.discrete.asperities.plane_distance`.

    Examples
    --------
    >>> ground = Roughness(deviation=0.1e-6, density=4e10, tip_radius=1e-5)
    >>> mixed = solve_mixed(LineContact.from_moes(M=20.0, L=10.0), ground)
    >>> f"film ratio {mixed.film_ratio:.2f}, asperities carry {100 * mixed.asperity_share:.1f} %"
    'film ratio 2.43, asperities carry 0.2 %'
    """
    if not isinstance(roughness, Roughness):
        raise InputError.at(
            "roughness", shorten(roughness), "must be a Roughness", "build one with ehl.Roughness"
        )
    options = Options(tolerance, nodes, supply=supply).checked(contact)
    before = start.film if isinstance(start, MixedFilm) else start
    films = _Films(contact, options, None if before is None else before.state)
    try:
        odds = ShareSearch(contact, roughness, films).odds(_likely_odds(contact, roughness, supply, start))
    except NoFilmError as reason:
        blank = replace(films.last.film(), converged=False, central_thickness=math.nan)
        return MixedFilm(contact, roughness, blank, films.cost, False, str(reason))
    film = films.last.film()
    warn_of_range(film.contact)
    by = by_share(films.last.fine, films.last.run.supply) if math.isfinite(odds) else None
    answers = rough_slopes(contact, roughness, film, odds, by)
    grows = 0.0 if by is None else by.central / film.central_thickness
    off = share_error(contact, roughness, KnownGap(film.central_thickness, odds, grows), central_error(film))
    return MixedFilm(contact, roughness, film, films.cost, True, "converged", share_of(odds), *answers, off)


class _Films:
    """Isothermal films at trial shares."""

    def __init__(self, contact: LineContact, options: Options, state: State | None) -> None:
        self.contact, self.options, self.state = contact, options, state
        self.cost = Cost(0.0)
        self.last: GridSolution

    def gap(self, odds: float) -> float:
        """Central film [m] at odds of the asperities' share."""
        self.last = film = solve_checked(eased(self.contact, share_of(-odds)), self.options, self.state)
        self.cost += film.run.cost() + Cost(0.0, counts={"films": 1})
        if not film.converged:
            raise NoFilmError(film.film().message)
        self.state = film.state.bare()
        return figures(film.fine).central_thickness

    def growth(self) -> float:
        """Power of what is left to it with which the last film grows, by its derivative."""
        by = by_share(self.last.fine, self.last.run.supply)
        return by.central / figures(self.last.fine).central_thickness


def _likely_odds(
    contact: LineContact, roughness: Roughness, supply: Supply | None, start: Film | MixedFilm | None
) -> float:
    """Odds that a neighbour makes likely: its film, changed as Moes' formula has it; behind a layer as it is."""
    if not isinstance(start, MixedFilm) or not start.converged or start.asperity_share == 0.0:
        return -math.inf
    share, near = start.asperity_share, start.film.contact
    film_share, ratio = 1.0 - share, 1.0
    if not isinstance(supply, OilLayer):
        ratio = moes_central(eased(contact, film_share)) / moes_central(near)
    grows = usual_growth(contact, film_share, supply)
    return foreseen(contact, roughness, KnownGap(ratio * start.central_thickness, odds_of(share), grows))
