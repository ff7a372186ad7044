"""Film thickness by published formulas of steady, fully flooded, isothermal line contacts."""

from __future__ import annotations

import math
import warnings

from base import Cost, Faults, InputError, RangeWarning, described, part, quantity, record
from ehl.discrete.contact import LineContact

_DEFINITIONS = ("dowson-central", "dowson-minimum")


def _powers(contact: LineContact, factor: float, speed: float, material: float, load: float) -> float:
    """Film ``factor R U^speed G^material W^load`` [m], U = eta0 u/(E'R) on the mean velocity."""
    U, G, W = 0.5 * contact.U2, contact.G, contact.W
    film: float = factor * U**speed * G**material * W**load * contact.radius
    return film


def dowson_higginson_minimum(contact: LineContact) -> float:
    """Minimum film ``h_min = 2.65 R U^0.70 G^0.54 W^-0.13`` [m], U = eta0 u/(E'R) on the mean velocity.

    Range: the elastic, piezoviscous regime of steel and mineral oil (G of 2500 to 7500); at light loads,
    where the bodies stay rigid or the viscosity constant, it is wrong by any amount.

    References
    ----------
    D. Dowson, Elastohydrodynamics, Proc. Inst. Mech. Engrs 182 (1967-68), Part 3A, 151-167.

    Examples
    --------
    >>> f"{1e6 * dowson_higginson_minimum(LineContact.from_moes(M=20.0, L=10.0)):.3f} um"
    '0.245 um'
    """
    return _powers(contact, 2.65, speed=0.70, material=0.54, load=-0.13)


def dowson_toyoda_central(contact: LineContact) -> float:
    """Central film ``h_c = 3.06 R U^0.69 G^0.56 W^-0.10`` [m], U = eta0 u/(E'R) on the mean velocity.

    Range as for :func:`dowson_higginson_minimum`.

    References
    ----------
    D. Dowson and S. Toyoda, A central film thickness formula for elastohydrodynamic line contacts, Proc. 5th
    Leeds-Lyon Symposium on Tribology (1979), 60-65.

    Examples
    --------
    >>> f"{1e6 * dowson_toyoda_central(LineContact.from_moes(M=20.0, L=10.0)):.3f} um"
    '0.327 um'
    """
    return _powers(contact, 3.06, speed=0.69, material=0.56, load=-0.10)


def pan_hamrock_minimum(contact: LineContact) -> float:
    """Minimum film ``h_min = 1.714 R W^-0.128 U^0.694 G^0.568`` [m], U = eta0 u/(E'R) on the mean velocity.

    Fitted to compressible solutions for U of 1e-12 to 1e-10, W of 2e-5 to 5e-4 and G of 2500 to 15000, that is
    the elastic, piezoviscous regime.

    References
    ----------
    P. Pan and B. J. Hamrock, Simple formulas for performance parameters used in elastohydrodynamically lubricated
    line contacts, ASME Journal of Tribology 111 (1989) 246-251. The constants are quoted from memory; our
    solutions at G = 5000 lie within 10 % (minimum) and 13 % (central) of them (docs/validation/ehl.md).

    Examples
    --------
    >>> f"{1e6 * pan_hamrock_minimum(LineContact.from_moes(M=20.0, L=10.0)):.3f} um"
    '0.230 um'
    """
    return _powers(contact, 1.714, speed=0.694, material=0.568, load=-0.128)


def pan_hamrock_central(contact: LineContact) -> float:
    """Central film ``h_c = 2.922 R W^-0.166 U^0.692 G^0.470`` [m]; see :func:`pan_hamrock_minimum`.

    Examples
    --------
    >>> f"{1e6 * pan_hamrock_central(LineContact.from_moes(M=20.0, L=10.0)):.3f} um"
    '0.256 um'
    """
    return _powers(contact, 2.922, speed=0.692, material=0.470, load=-0.166)


def nijenbanning_line_central(contact: LineContact, slenderness: float = 0.01) -> float:
    """Central film [m] of a long elliptical contact with the line contact's Hertz pressure at its middle.

    Nijenbanning, Venner and Moes give the elastic and piezoviscous asymptotes of ellipses of D = Rx/Ry:
    ``h_EI = 3.18 q^(-14/25) D^(-1/15) N^(-2/15)``, ``h_EP = 1.48 q^(-7/20) D^(-1/24) N^(-1/12) L^(3/4)``,
    ``h_RP = 1.29 (1 + 0.691 D)^(-2/3) L^(2/3)`` with ``q = 1 + 0.006 ln D + 0.63 D^(4/7)`` and N the load number
    of points. An ellipse of axes b and b/k, k -> 0, has ``D = k^2 [ln(4/k) - 1]`` and, for the same Hertz
    pressure, ``N^2 D = (128/9 pi) [ln(4/k) - 1] M^3``: so its asymptotes fall with M as those of a line. They
    are put together as in :func:`moes_central`, with the line's own rigid, isoviscous film 3/M, which the ellipse
    does not tend to.

    Range: as :func:`moes_central`. The limit is logarithmic: D = 0.01 lies within 2 % of Moes' constants.

    Parameters
    ----------
    contact : LineContact
        The line contact.
    slenderness : float
        D [-], small.

    References
    ----------
    G. Nijenbanning, C. H. Venner and H. Moes, Film thickness in elastohydrodynamically lubricated elliptic
    contacts, Wear 176 (1994) 217-229.

    Examples
    --------
    >>> f"{1e6 * nijenbanning_line_central(LineContact.from_moes(M=20.0, L=10.0)):.3f} um"
    '0.327 um'
    """
    D, k = slenderness, math.sqrt(slenderness)
    for _ in range(60):
        k = math.sqrt(D / (math.log(4.0 / k) - 1.0))
    M, L = contact.moes_M, contact.moes_L
    q = 1.0 + 0.006 * math.log(D) + 0.63 * D ** (4.0 / 7.0)
    point_load = math.sqrt(128.0 / (9.0 * math.pi) * (math.log(4.0 / k) - 1.0) * M**3 / D)
    elastic = 3.18 * q ** (-14.0 / 25.0) * D ** (-1.0 / 15.0) * point_load ** (-2.0 / 15.0)
    rigid_piezo = 1.29 * (1.0 + 0.691 * D) ** (-2.0 / 3.0) * L ** (2.0 / 3.0)
    elastic_piezo = 1.48 * q ** (-7.0 / 20.0) * D ** (-1.0 / 24.0) * point_load ** (-1.0 / 12.0) * L**0.75
    return _between(3.0 / M, elastic, rigid_piezo, elastic_piezo) * contact.moes_film


def _between(rigid: float, elastic: float, rigid_piezo: float, elastic_piezo: float) -> float:
    """Moes' interpolation between the four asymptotes [-]."""
    s = (7.0 + 8.0 * math.exp(-2.0 * elastic / rigid)) / 5.0
    film = (rigid ** (7 / 3) + elastic ** (7 / 3)) ** (3 * s / 7)
    if rigid_piezo > 0.0:
        film += (rigid_piezo**-3.5 + elastic_piezo**-3.5) ** (-2 * s / 7)
    thickness: float = film ** (1 / s)
    return thickness


def moes_central(contact: LineContact) -> float:
    """Central film [m] of an incompressible lubricant, fitted between the four asymptotes of line contacts.

    In Moes units: ``h_RI = 3/M``, ``h_EI = 2.621 M^-1/5``, ``h_RP = 1.287 L^2/3``,
    ``h_EP = 1.311 M^-1/8 L^3/4``, ``s = (7 + 8 exp(-2 h_EI/h_RI))/5``,
    ``H = [(h_RI^(7/3) + h_EI^(7/3))^(3s/7) + (h_RP^(-7/2) + h_EP^(-7/2))^(-2s/7)]^(1/s)``.

    Range: any M and L. A compressible film is thinner by about the density at the Hertz pressure.

    References
    ----------
    H. Moes, Optimum similarity analysis with applications to elastohydrodynamic lubrication, Wear 159 (1992)
    57-66.

    Examples
    --------
    >>> f"{1e6 * moes_central(LineContact.from_moes(M=20.0, L=10.0)):.3f} um"
    '0.327 um'
    """
    M, L = contact.moes_M, contact.moes_L
    film = _between(3.0 / M, 2.621 * M**-0.2, 1.287 * L ** (2 / 3), 1.311 * M**-0.125 * L**0.75)
    return film * contact.moes_film


def formula_stiffness(contact: LineContact, definition: str) -> float:
    """Film stiffness [N/m per m of face] by Dowson's formulas: 10 w/h_c, or w/(0.13 h_m) for the minimum."""
    if definition == "dowson-central":
        return 10.0 * contact.load / dowson_toyoda_central(contact)
    return contact.load / (0.13 * dowson_higginson_minimum(contact))


@record
class FormulaFilm:
    """The film of one contact by Dowson's formulas, as a cheap stand-in for a solution.

    Its model error is unknown until it is compared with the solver; ``error`` says so with NaN.
    """

    no_error = "unknown: a regression"

    contact: LineContact = part("the contact that it is of")
    central_thickness: float = quantity("m", "central film by Dowson and Toyoda", shown="um")
    minimum_thickness: float = quantity("m", "minimum film by Dowson and Higginson", shown="um")
    error: float = math.nan
    cost: Cost = Cost(0.0)
    converged: bool = True
    message: str = "by formula"

    @described("m", shown="um")
    def separation(self) -> float:
        """Film separation, taken as the central film; -1/(d separation/dw) is ``stiffness()``."""
        return self.central_thickness

    def stiffness(self, definition: str = "dowson-central") -> float:
        """Film stiffness [N/m per m of face], a tangent since the formulas are powers of the load.

        ``"dowson-central"``: 10 w/h_c. ``"dowson-minimum"``: w/(0.13 h_m). Other names raise InputError.
        """
        with Faults() as faults:
            faults.choice("definition", definition, _DEFINITIONS, "solve the contact for the others")
        return formula_stiffness(self.contact, definition)


def dowson(contact: LineContact) -> FormulaFilm:
    """Return central and minimum film by Dowson's formulas.

    Raises
    ------
    InputError
        For a constant viscosity, which the formulas do not know.

    Warns
    -----
    RangeWarning
        Outside the elastic, piezoviscous regime, taken here as alpha p_H < 1, where the formulas do not hold.

    Examples
    --------
    >>> film = dowson(LineContact.from_moes(M=20.0, L=10.0))
    >>> f"{1e6 * film.central_thickness:.3f} um, {film.stiffness():.2e} N/m per m"
    '0.327 um, 8.62e+12 N/m per m'
    """
    if contact.G == 0.0:
        allowed = "must be more than 0 for Dowson's film formulas"
        raise InputError.at("pressure_viscosity", "0", allowed, "solve the contact with ehl.solve")
    if contact.lubricant.pressure_viscosity * contact.peak_pressure < 1.0:
        warnings.warn(
            f"Dowson's film formulas at alpha p_H = "
            f"{contact.lubricant.pressure_viscosity * contact.peak_pressure:.2g}: the contact is not in the "
            "elastic, piezoviscous regime; use ehl.solve",
            RangeWarning,
            stacklevel=2,
        )
    return FormulaFilm(contact, dowson_toyoda_central(contact), dowson_higginson_minimum(contact))
