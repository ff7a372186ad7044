"""Mixed lubrication with heat: film with heat and shear thinning, and asperities that rub, share the load."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import KW_ONLY, replace
from functools import partial

import numpy as np

from base import Faults, RangeWarning, Stopwatch, described, part, quantity, record, shorten
from base.results import EXACT
from ehl.discrete.asperities import Roughness
from ehl.discrete.contact import LineContact
from ehl.discrete.regimes import BOUNDARY, BOUNDARY_FRICTION
from ehl.discrete.solids import STEEL, Solid
from ehl.discrete.supply import Supply
from ehl.films.mixed import solve_mixed
from ehl.films.mixed_film import MixedFilm, RoughFilm
from ehl.films.result import central_error
from ehl.films.thermal import ThermalFilm, solve_thermal
from ehl.films.thermal_search import at_bulk
from ehl.solving.load_share import KnownGap, eased, excess, odds_of, share_error, share_of, usual_growth
from ehl.solving.share_search import NoFilmError, ShareSearch

_FALLS = (
    "roughness: elastic asperities carry {share:.0%} of the load here and less of a higher one: their part of the "
    "friction falls, about {loses:.0%} of it all for twice the load, where friction of gears is measured to rise; "
    "leave out law, density and tip radius, and the film ratio shares the load"
)
_FLATTEST = -0.05  # slope of the excess by the odds


@record
class MixedThermalFilm(RoughFilm):
    """A film with heat between rough surfaces. Figures are NaN when ``converged`` is False.

    ``film`` is that of the load and modulus that are left to it. What asperities make of heat is `asperity_loss`; it
    goes into the bodies and does not warm the film. Slopes by the load and stiffnesses are NaN until
    :func:`with_load_slopes` adds them.
    """

    headline = ("minimum_thickness", "film_ratio", "asperity_share", "traction_coefficient")

    film: ThermalFilm = part("film with heat that carries the rest of the load")
    _: KW_ONLY
    isothermal: MixedFilm = part("the same without heat and shear thinning, at the mean bulk temperature")
    boundary_friction: float = quantity("1", "coefficient of friction of the asperities", no_error=EXACT)

    @described("1")
    def traction_coefficient(self) -> float:
        """Friction of film and asperities over the load, positive where u1 > u2."""
        rubbing = math.copysign(self.boundary_friction, self.contact.sliding) if self.contact.sliding else 0.0
        return (1.0 - self.asperity_share) * self.film.traction_coefficient + self.asperity_share * rubbing

    @described("W/m")
    def asperity_loss(self) -> float:
        """Power that the asperities lose by rubbing per length of face."""
        rubbed = self.boundary_friction * self.asperity_share * self.contact.load
        return rubbed * abs(self.contact.sliding)


def solve_mixed_thermal(
    contact: LineContact,
    roughness: Roughness,
    solids: tuple[Solid, Solid] | None = (STEEL, STEEL),
    bulk_temperatures: tuple[float, float] | None = None,
    tolerance: float = 0.01,
    supply: Supply | None = None,
    boundary_friction: float = BOUNDARY_FRICTION,
    start: MixedThermalFilm | None = None,
    nodes: int | None = None,
) -> MixedThermalFilm:
    """Share the load between asperities and a film with heat and shear thinning.

    The share s is where asperities carry at the warm film's central mean gap what is asked of them, as in
    :func:`ehl.solve_mixed`. Warm films follow the share as the isothermal one does, which gives the first share: two
    or three of them are solved.

    Parameters
    ----------
    contact : LineContact
        The whole load, with its sliding speed.
    roughness : Roughness
        Of both surfaces together.
    solids, bulk_temperatures, tolerance, supply
        As of :func:`ehl.solve_thermal`.
    boundary_friction : float
        Coefficient of friction of what asperities carry.
    start : MixedThermalFilm, optional
        Of a similar contact.
    nodes : int, optional
        Solve all films on this many nodes instead and report the error that this leaves.

    Returns
    -------
    MixedThermalFilm
        With ``converged=False`` and the reason where a film fails.

    Raises
    ------
    InputError
        With every fault of the arguments.

    Warns
    -----
    RangeWarning
        Where the share of elastic asperities falls with the load, and friction with it by more than the tolerance for
        twice the load: at a given gap they carry a given pressure, and the gap hardly follows the load.

    Examples
    --------
    >>> from ehl import Lubricant
    >>> oil = Lubricant(0.02, 17e-9, 860.0, temperature=363.15, eyring_stress=5e6)
    >>> ground = Roughness(deviation=0.3e-6, density=3.3e9, tip_radius=4e-5)
    >>> rough = solve_mixed_thermal(LineContact(2e5, 2.5, 6e-3, 2.26e11, oil, sliding=1.0), ground)
    >>> rough.converged, rough.asperity_share > rough.isothermal.asperity_share
    (True, True)
    """
    watch = Stopwatch()
    with Faults() as faults:
        faults.number("boundary_friction", boundary_friction, BOUNDARY)
        if not isinstance(roughness, Roughness):
            faults.add("roughness", shorten(roughness), "must be a Roughness", "build one with ehl.Roughness")
    oil = contact.lubricant
    bulk = bulk_temperatures or (oil.temperature, oil.temperature)
    # the warm film of the whole load checks what remains of the arguments
    near, near_cold = (None, None) if start is None else (start.film, start.isothermal)
    solved_at = partial(
        solve_thermal,
        solids=solids,
        bulk_temperatures=bulk_temperatures,
        tolerance=tolerance,
        nodes=nodes,
        supply=supply,
    )
    warm = solved_at(contact, start=near)
    cold = solve_mixed(at_bulk(contact, np.array(bulk)), roughness, tolerance, supply, near_cold, nodes)
    films = _Films(contact, solved_at, cold.asperity_share, supply, warm)
    share, off, reason = math.nan, math.nan, cold.message
    if cold.converged:
        try:
            odds = ShareSearch(contact, roughness, films, tolerance).odds()
            known = KnownGap(films.film.central_thickness, odds, films.growth())
            off = share_error(contact, roughness, known, central_error(films.film), tolerance)
            share = share_of(odds)
            reason = "converged"
        except NoFilmError as failure:
            reason = str(failure)
        if roughness.elastic and contact.sliding and 0.0 < share < 1.0:
            loses = _loses_by_load(contact, roughness, films, cold, share, boundary_friction)
            if loses > tolerance:
                warnings.warn(_FALLS.format(share=share, loses=loses), RangeWarning, stacklevel=2)
    cost = replace(films.cost + cold.cost, seconds=watch.seconds)
    solved = math.isfinite(share)
    return MixedThermalFilm(
        contact,
        roughness,
        films.film,
        cost,
        solved,
        reason,
        share,
        asperity_share_error=off,
        isothermal=cold,
        boundary_friction=boundary_friction,
    )


class _Films:
    """Films with heat at trial shares; the first, of the whole load, is there."""

    def __init__(
        self,
        contact: LineContact,
        solved_at: Callable[..., ThermalFilm],
        cold_share: float,
        supply: Supply | None,
        film: ThermalFilm,
    ) -> None:
        self.contact, self.solved_at, self.film, self.cost = contact, solved_at, film, film.cost
        self.cold_share, self.supply = cold_share, supply

    def gap(self, odds: float) -> float:
        """Central film [m] at odds of the asperities' share."""
        contact = eased(self.contact, share_of(-odds))
        if contact != self.film.contact:
            self.film = self.solved_at(contact, start=self.film)
            self.cost += replace(self.film.cost, counts={**self.film.cost.counts, "films": 1})
        if not self.film.converged:
            raise NoFilmError(self.film.message)
        return self.film.central_thickness

    def growth(self) -> float:
        """Power of what is left to it with which a film grows, by Moes' formula at the share without heat."""
        return usual_growth(self.contact, 1.0 - self.cold_share, self.supply)


def _loses_by_load(
    contact: LineContact, roughness: Roughness, films: _Films, cold: MixedFilm, share: float, friction: float
) -> float:
    """Part of its friction that a contact loses by the share of its asperities as the load doubles; < 0: gains."""
    gap, odds = films.film.central_thickness, odds_of(share)
    grows = usual_growth(contact, 1.0 - share, films.supply)
    at = excess(contact, roughness, gap, odds)
    by_load = cold.film.contact.load * cold.film.central_slope / cold.film.central_thickness
    slope = min(at.by_odds - at.by_gap * gap * grows * share, _FLATTEST)
    follow = -(at.by_load + at.by_gap * gap * by_load) / slope
    film = abs(films.film.traction_coefficient)
    rubbed = (friction - film) * share * (1.0 - share) * follow
    return -math.log(2.0) * rubbed / ((1.0 - share) * film + share * friction)
