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
from ehl.films.thermal import ThermalFilm, solve_thermal
from ehl.films.thermal_search import at_bulk
from ehl.solving.load_share import NOTHING, KnownGap, eased, excess, foreseen, odds_of, share_of, usual_growth

_TRIES = 20
_FALLS = (
    "roughness: elastic asperities carry {share:.0%} of the load here and less of a higher one: their part of the "
    "friction falls, about {loses:.0%} of it all for twice the load, where friction of gears is measured to rise; "
    "leave out law, density and tip radius, and the film ratio shares the load"
)
_REACH = 1.5  # largest step of the odds


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
    search = _Search(contact, roughness, solved_at, tolerance, supply, warm)
    share, reason = math.nan, warm.message if cold.converged else cold.message
    if cold.converged and warm.converged:
        share, reason = search.share(cold)
        if roughness.elastic and contact.sliding:
            loses = search.loses_by_load(cold, share, boundary_friction)
            if loses > tolerance:
                warnings.warn(_FALLS.format(share=share, loses=loses), RangeWarning, stacklevel=2)
    cost = replace(search.cost + cold.cost, seconds=watch.seconds)
    solved = math.isfinite(share)
    return MixedThermalFilm(
        contact,
        roughness,
        search.film,
        cost,
        solved,
        reason,
        share,
        isothermal=cold,
        boundary_friction=boundary_friction,
    )


class _Search:
    """Films with heat at trial shares, each started from the last."""

    def __init__(
        self,
        contact: LineContact,
        roughness: Roughness,
        solved_at: Callable[..., ThermalFilm],
        tolerance: float,
        supply: Supply | None,
        film: ThermalFilm,
    ) -> None:
        self.contact, self.roughness, self.solved_at = contact, roughness, solved_at
        self.tolerance, self.supply, self.film, self.cost = tolerance, supply, film, film.cost

    def share(self, cold: MixedFilm) -> tuple[float, str]:
        """Share of the asperities, NaN where none is found, and why."""
        gap = self.film.central_thickness
        grows = usual_growth(self.contact, share_of(-odds_of(cold.asperity_share)), self.supply)
        if excess(self.contact, self.roughness, gap, NOTHING).value <= 0.0:
            return 0.0, "converged"
        known = KnownGap(gap, -math.inf, grows)
        odds = foreseen(self.contact, self.roughness, known)
        before, slope = None, self.slope(known.at(odds), grows, odds)
        for _ in range(_TRIES):
            share = share_of(odds)
            more = self.excess(odds)
            if not self.film.converged:
                return math.nan, self.film.message
            if before is not None and odds != before[0]:
                slope = min((more - before[1]) / (odds - before[0]), -0.05)
            step = max(-_REACH, min(_REACH, -more / slope))
            if abs(step) < self.tolerance:
                return share, "converged"
            if odds + step < NOTHING:
                return 0.0, "converged"
            before, odds = (odds, more), odds + step
        return (
            math.nan,
            "no share of the load on which film and asperities agree was found: raise the tolerance",
        )

    def slope(self, gap: float, grows: float, odds: float) -> float:
        """Derivative of the excess by the odds where the film grows with what is left."""
        at = excess(self.contact, self.roughness, gap, odds)
        return min(-at.by_gap * gap * grows * share_of(odds) + at.by_odds, -0.05)

    def loses_by_load(self, cold: MixedFilm, share: float, friction: float) -> float:
        """Part of its friction that a contact loses by the share of its asperities as the load doubles; < 0: gains."""
        if not 0.0 < share < 1.0:
            return 0.0
        gap, odds = self.film.central_thickness, odds_of(share)
        grows = usual_growth(self.contact, 1.0 - share, self.supply)
        at = excess(self.contact, self.roughness, gap, odds)
        by_load = cold.film.contact.load * cold.film.central_slope / cold.film.central_thickness
        follow = -(at.by_load + at.by_gap * gap * by_load) / self.slope(gap, grows, odds)
        film = abs(self.film.traction_coefficient)
        rubbed = (friction - film) * share * (1.0 - share) * follow
        return -math.log(2.0) * rubbed / ((1.0 - share) * film + share * friction)

    def excess(self, odds: float) -> float:
        """By how much the asperities carry more than their share asks for."""
        contact = eased(self.contact, share_of(-odds))
        self.film = self.solved_at(contact, start=self.film)
        self.cost += replace(self.film.cost, counts={**self.film.cost.counts, "films": 1})
        if not self.film.converged:
            return math.nan
        return excess(self.contact, self.roughness, self.film.central_thickness, odds).value
