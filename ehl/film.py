"""The solved film: thickness, pressure, separation of the bodies and stiffness."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Faults
from ehl.contact import LineContact
from ehl.regressions import dowson_higginson_minimum, dowson_toyoda_central

if TYPE_CHECKING:
    from ehl.levels import State
    from ehl.supply import Supply

__all__ = ["DEFINITIONS", "Cost", "Film", "FilmErrors", "Spike", "hertz_approach"]

DEFINITIONS = ("approach", "tangent", "nodal-sum", "dowson-central", "dowson-minimum")


@dataclass(frozen=True)
class Cost:
    """What a solution took."""

    seconds: float  # wall time; the first call of a process includes loading the compiled kernels
    unknowns: int  # nodal pressures and the rigid separation, on the finest grid
    iterations: int  # Newton steps on all grids
    grids: tuple[int, ...]  # nodes of every grid solved, in order
    attempts: int  # starts tried; more than 1 when the first did not converge


@dataclass(frozen=True)
class FilmErrors:
    """Estimated relative errors, from the grid of half as many cells and from the length of the inlet."""

    film: float  # of central and minimum film
    separation: float
    approach_stiffness: float
    tangent_stiffness: float
    inlet: float  # share of the film lost to the finite inlet; 0 where the caller fixed the domain


@dataclass(frozen=True)
class Spike:
    """The second pressure maximum, before the outlet."""

    position: float  # x of the tip [m]
    pressure: float  # p of the tip [Pa]
    width: float  # from the tip to where the pressure has fallen by a tenth, downstream [m]
    error: float  # change of the tip's pressure between two grids laid around it, relative; NaN if none were


@dataclass(frozen=True)
class Film:
    """A steady line-contact film.

    Figures are NaN when ``converged`` is False; ``message`` then says what to do.
    """

    contact: LineContact
    x: Array  # nodes (n,) [m], 0 on the line of centres, oil enters at the left
    pressure: Array  # p (n,) [Pa]
    thickness: Array  # h (n,) [m]
    central_thickness: float  # h at x = 0 [m]
    minimum_thickness: float  # least h inside the film [m]
    minimum_position: float  # x of the least h [m]
    inlet: float  # x where the domain begins [m]
    outlet: float  # x where the film ends [m]
    separation: float  # approach of the dry contact minus approach of the film [m]
    separation_slope: float  # d separation/d load at fixed speed [m per N/m]
    central_slope: float  # d h_cen/d load at fixed speed [m per N/m]
    flow: float  # mass flow over rho0 u [m]: the film that leaves the contact at ambient pressure
    flux_error: float  # largest deviation of the mass flow inside the film, relative
    load_error: float  # of the integral of the pressure, relative
    error: float  # estimated relative error of central and minimum thickness, the larger
    errors: FilmErrors
    cost: Cost
    converged: bool
    message: str
    supply: Supply | None = None  # what was held: None is a flooded inlet
    spike: Spike | None = None  # None where the pressure has no narrow second maximum
    state: State | None = field(repr=False, compare=False, default=None)  # what a next solution starts from

    @property
    def central_moes(self) -> float:
        """Central film in Moes units, h_cen/(R sqrt(U2)) [-]."""
        return self.central_thickness / self.contact.moes_film

    @property
    def minimum_moes(self) -> float:
        """Minimum film in Moes units, h_min/(R sqrt(U2)) [-]."""
        return self.minimum_thickness / self.contact.moes_film

    @property
    def starved(self) -> bool:
        """Whether a supply holds the inlet; False for a layer thicker than what the inlet takes."""
        return self.supply is not None and self.errors.inlet == 0.0

    @property
    def fill(self) -> Array:
        """Share of the gap that oil fills, 1 - theta, at the nodes [-]: 1 where p > 0, less in cavitation."""
        density = self.contact.lubricant.density_ratio(self.pressure)[0]
        full = self.pressure > 0.0
        full[0] = True
        return np.where(full, 1.0, np.minimum(1.0, self.flow / (density * self.thickness)))

    @property
    def approach(self) -> float:
        """Approach of the two bodies with the film between them [m], on the datum of :func:`hertz_approach`.

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
        w = self.contact.load
        found = Faults()
        found.choice("definition", definition, DEFINITIONS)
        found.raise_if_any()
        without_formula = definition.startswith("dowson") and (self.contact.G == 0.0 or self.starved)
        if not self.converged or without_formula:
            return math.nan
        if definition == "approach":
            return -1.0 / self.separation_slope
        if definition == "tangent":
            return -1.0 / self.central_slope
        if definition == "nodal-sum":
            return float(np.trapezoid(self.pressure / self.thickness, self.x))
        if definition == "dowson-central":
            return 10.0 * w / dowson_toyoda_central(self.contact)
        return w / (0.13 * dowson_higginson_minimum(self.contact))


def hertz_approach(contact: LineContact, datum: float | None = None) -> float:
    """Approach of two dry cylinders, ``(b^2/2R) [ln(l/b) + 1/2 + ln 2]`` [m].

    In two dimensions displacements grow with the logarithm of the distance: here the surfaces do not move at
    the distance l (``datum``, R when not given) from the middle of the contact.

    References
    ----------
    K. L. Johnson, Contact Mechanics, Cambridge University Press (1985), section 4.2(c) and 5.6.
    """
    b = contact.half_width
    length = contact.radius if datum is None else datum
    return b**2 / (2.0 * contact.radius) * (math.log(2.0 * length / b) + 0.5)
