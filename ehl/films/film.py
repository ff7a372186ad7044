"""The solved film: thickness, pressure, separation of the bodies and stiffness."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Cost, Faults, described, part, quantity, record
from base.results import ITSELF
from ehl.discrete.contact import LineContact
from ehl.discrete.regressions import formula_stiffness

if TYPE_CHECKING:
    from ehl.discrete.supply import Supply
    from ehl.solving.levels import State

MEANINGS = {
    "approach": "tangent, -1/(d separation/dw): the film's yielding beyond the dry contact",
    "tangent": "tangent, -dw/dh_cen",
    "nodal-sum": "secant, int p/h dx",
    "dowson-central": "tangent of a formula, 10 w/h_c",
    "dowson-minimum": "tangent of a formula, w/(0.13 h_m)",
}
"""Definitions of a film's stiffness by name: what each is."""

DEFINITIONS = tuple(MEANINGS)

unsolved = partial(quantity, default=math.nan)
"""A figure that is NaN where no solution was found."""


@record
class FilmErrors:
    """Estimated relative errors, from the grid of half as many cells and from the length of the inlet."""

    no_error = ITSELF

    film: float = quantity("1", "error of central and minimum film")
    separation: float = unsolved("1", "error of the film separation")
    approach_stiffness: float = unsolved("1", "error of the stiffness by separation")
    tangent_stiffness: float = unsolved("1", "error of the stiffness by central film")
    inlet: float = unsolved("1", "share of the film lost to the finite inlet, 0 where the domain was given")
    separation_shift: float = unsolved("1", "error of the film separation, with the sign of its last change")
    slope_shift: float = unsolved(
        "1", "error of the separation's derivative by the load, likewise, of the grid"
    )
    pressure: float = unsolved(
        "1", "mean change of the pressure between two grids and teeth before the spike, over the pressure"
    )


@record
class Spike:
    """The second pressure maximum, before the outlet."""

    no_error = "not estimated; the pressure of the tip has one"

    position: float = quantity("m", "place of the tip", shown="um")
    pressure: float = quantity("Pa", "pressure of the tip", shown="GPa", error="error")
    width: float = quantity(
        "m", "distance downstream from the tip to where the pressure has fallen by a tenth", shown="um"
    )
    error: float = quantity(
        "1", "change of the tip's pressure between two grids laid around it, NaN if none were"
    )


@record
class Film:
    """A steady line-contact film; everything is per metre of face width.

    Figures are NaN when ``converged`` is False; ``message`` then says what to do.
    ``cost.counts["restarts"]`` counts the starts that did not converge.
    """

    no_error = "not estimated in single places; the central and the minimum film have one"

    headline = ("central_thickness", "minimum_thickness", "separation")

    contact: LineContact = part("the contact that was solved")
    x: Array = quantity("m", "place, 0 on the line of centres, oil enters at the left", "node", shown="um")
    pressure: Array = quantity("Pa", "pressure", "node", shown="GPa")
    thickness: Array = quantity("m", "film thickness", "node", shown="um")
    inlet: float = quantity("m", "place where the domain begins", shown="um")
    errors: FilmErrors = part("estimated errors of its figures")
    cost: Cost
    converged: bool
    message: str
    central_thickness: float = unsolved("m", "film thickness at x = 0", shown="um", error="error")
    minimum_thickness: float = unsolved("m", "minimum film thickness", shown="um", error="error")
    minimum_position: float = unsolved("m", "place of the minimum thickness", shown="um")
    outlet: float = unsolved("m", "place where the film ends", shown="um")
    separation: float = unsolved(
        "m", "film separation: approach of the dry contact less that with the film", shown="um"
    )
    separation_slope: float = unsolved("m2/N", "derivative of the separation by the load at fixed speed")
    central_slope: float = unsolved("m2/N", "derivative of the central thickness by the load at fixed speed")
    flow: float = unsolved(
        "m", "mass flow over rho0 u: the film that leaves the contact at ambient pressure", shown="um"
    )
    flux_error: float = unsolved("1", "largest deviation of the mass flow inside the film, relative")
    load_error: float = unsolved("1", "error of the integral of the pressure, relative")
    supply: Supply | None = part("what is held at the inlet; None where it is flooded", default=None)
    spike: Spike | None = part(
        "second maximum of the pressure; None where there is no narrow one", default=None
    )
    state: State | None = part("what a next solution starts from", default=None)

    @described("1")
    def error(self) -> float:
        """Estimated relative error of central and minimum thickness, the larger."""
        return self.errors.film

    @described("1", error="error")
    def central_moes(self) -> float:
        """Central film in Moes units, h_cen/(R sqrt(U2))."""
        return self.central_thickness / self.contact.moes_film

    @described("1", error="error")
    def minimum_moes(self) -> float:
        """Minimum film in Moes units, h_min/(R sqrt(U2))."""
        return self.minimum_thickness / self.contact.moes_film

    @property
    def starved(self) -> bool:
        """Whether a supply holds the inlet; False for a layer thicker than what the inlet takes."""
        return self.supply is not None and self.errors.inlet == 0.0

    @described("1", "node")
    def fill(self) -> Array:
        """Share of the gap that oil fills, 1 - theta: 1 where p > 0, less in cavitation."""
        density = self.contact.lubricant.density_ratio(self.pressure)[0]
        full = self.pressure > 0.0
        full[0] = True
        return np.where(full, 1.0, np.minimum(1.0, self.flow / (density * self.thickness)))

    @described("m", shown="um")
    def approach(self) -> float:
        """Approach of the two bodies with the film between them, on the datum of :func:`hertz_approach`.

        It is the dry approach less ``separation``; the difference of two approaches of contacts with different
        loads means something on one common datum only, which this property takes as R.
        """
        return hertz_approach(self.contact) - self.separation

    def stiffness(self, definition: str = "approach") -> float:
        """Film stiffness per length of face [N/m per m] at fixed speed.

        Parameters
        ----------
        definition : str
            - ``"approach"``: -1/(d separation/dw), the film's extra yielding beyond the dry contact: the one to put
              in series with a tooth whose stiffness already holds the dry contact.
            - ``"tangent"``: -dw/dh_cen.
            - ``"nodal-sum"``: int p/h dx over the film, a secant.
            - ``"dowson-central"``: 10 w/h_c with the Dowson-Toyoda central film.
            - ``"dowson-minimum"``: w/(0.13 h_m) with the Dowson-Higginson minimum film.

        Returns
        -------
        float
            NaN without convergence, and for the formulas where the viscosity does not rise with pressure or
            the contact is starved.

        Raises
        ------
        InputError
            For any other name.
        """
        with Faults() as faults:
            faults.choice("definition", definition, DEFINITIONS)
        without_formula = definition.startswith("dowson") and (self.contact.G == 0.0 or self.starved)
        if not self.converged or without_formula:
            return math.nan
        if definition == "approach":
            return -1.0 / self.separation_slope
        if definition == "tangent":
            return -1.0 / self.central_slope
        if definition == "nodal-sum":
            return float(np.trapezoid(self.pressure / self.thickness, self.x))
        return formula_stiffness(self.contact, definition)


def hertz_approach(contact: LineContact, datum: float | None = None) -> float:
    """Approach of two dry cylinders, ``(b^2/2R) [ln(l/b) + 1/2 + ln 2]`` [m].

    In two dimensions displacements grow with the logarithm of the distance: here the surfaces do not move at
    the distance l (``datum``, R when not given) from the middle of the contact.

    References
    ----------
    K. L. Johnson, Contact Mechanics, Cambridge University Press (1985), section 4.2(c) and 5.6.

    Examples
    --------
    >>> f"{1e6 * hertz_approach(LineContact.from_moes(M=20.0, L=10.0)):.3f} um"
    '8.821 um'
    """
    b = contact.half_width
    length = contact.radius if datum is None else datum
    return b**2 / (2.0 * contact.radius) * (math.log(2.0 * length / b) + 0.5)
