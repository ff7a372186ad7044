"""A film under a load that changes with time: the record."""

from __future__ import annotations

from base import Array, Cost, described, part, quantity, record
from base.results import ITSELF
from ehl.discrete.contact import LineContact
from ehl.films.film import unsolved


@record
class TransientFilm:
    """A film over time, per metre of face; figures are NaN where `converged` is False."""

    headline = ("lowest", "lowest_time")

    contact: LineContact = part("the contact at the first time")
    time: Array = quantity("s", "time", "time")
    load: Array = quantity("N/m", "load", "time", shown="N/mm")
    least: Array = quantity("m", "minimum film thickness", "time", shown="um", error="error")
    central: Array = quantity("m", "film thickness at x = 0", "time", shown="um", error="error")
    separation: Array = quantity(
        "m",
        "film separation: approach of the dry contact less that with the film",
        "time",
        shown="um",
        error="error",
    )
    greatest_pressure: Array = quantity("Pa", "maximum pressure", "time", shown="GPa", error="pressure_error")
    x: Array = quantity("m", "places, which follow the contact", "time node", shown="um")
    pressure: Array = quantity("Pa", "pressure", "time node", shown="GPa")
    thickness: Array = quantity("m", "film thickness", "time node", shown="um")
    no_error = "not estimated in single places; the central and the minimum film have one"
    cost: Cost
    converged: bool
    message: str
    lowest: float = unsolved("m", "minimum film of all steps of time", shown="um", error="error")
    lowest_time: float = unsolved("s", "time of it")
    grid_error: float = unsolved(
        "1", "largest change of central and minimum film and separation between two grids", no_error=ITSELF
    )
    time_error: float = unsolved(
        "1",
        "local errors of the steps of time, added over the time that oil takes through the contact",
        no_error=ITSELF,
    )
    pressure_error: float = unsolved(
        "1",
        "change of the maximum pressure between two grids, for each halving that the spike's cells need",
        no_error=ITSELF,
    )
    balance: float = unsolved(
        "1",
        "largest net flux into a node, its change of content counted, over the flux, of all steps",
        no_error=ITSELF,
    )

    @described("1", no_error=ITSELF)
    def error(self) -> float:
        """Estimated relative error of the films, by grid and by steps of time together."""
        return self.grid_error + self.time_error
