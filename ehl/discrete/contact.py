"""The line contact: load, speed, shape and the groups that decide its film."""

from __future__ import annotations

import math
from dataclasses import dataclass

from base import Faults, Limit, described
from ehl.oil.lubricant import Lubricant
from ehl.oil.rheology import ROELANDS_LN_VISCOSITY, ROELANDS_PRESSURE

LIMITS = {
    "load": Limit.above(
        0.0,
        1e15,
        "N/m",
        "a pair without load has no film to solve: leave it out, or give its small load in N/m",
    ),
    "entrainment": Limit.above(
        0.0,
        1e9,
        "m/s",
        "without entrainment no steady film exists: take the contact as dry; "
        "if both surfaces move backwards, give the magnitude and mirror x",
    ),
    "radius": Limit.above(0.0, 1e6, "m", "give R in m"),
    "sliding": Limit(-1e9, 1e9, "m/s", "give u1 - u2 in m/s"),
    "reduced_modulus": Limit.above(0.0, 1e14, "Pa", "give E' in Pa, 2.26e11 for steel"),
}
"""What the numbers of a line contact may be."""

_MOES = "Moes' numbers of line contacts lie between 0.01 and 5000 (M), 0 and 30 (L)"
_MOES_LIMITS = {
    "M": Limit.above(0.0, 1e9, remedy=_MOES),
    "L": Limit(0.0, 1e3, remedy=_MOES),
    "roelands_z": Limit(0.1, 2.0, remedy="oils lie between 0.2 and 1"),
    "pressure_viscosity": Limit.above(0.0, 1e-7, "1/Pa", "for a constant viscosity give L = 0"),
    "reduced_modulus": LIMITS["reduced_modulus"],
    "radius": LIMITS["radius"],
}

_SPEED_PARAMETER = 1e-11  # U2 taken by from_moes when alpha = 0 leaves it free


@dataclass(frozen=True)
class LineContact:
    """A steady line contact of two elastic cylinders; how oil is supplied is an argument of :func:`ehl.solve`.

    Parameters
    ----------
    load : float
        w, force per length of face [N/m].
    entrainment : float
        u = (u1 + u2)/2, mean velocity of the two surfaces towards the outlet [m/s]. Not the sliding velocity.
    radius : float
        R = R1 R2/(R1 + R2) [m].
    reduced_modulus : float
        E' = 2/[(1 - nu1^2)/E1 + (1 - nu2^2)/E2] [Pa]; twice the E* of contact mechanics.
    lubricant : Lubricant
        The oil.
    sliding : float
        u1 - u2, velocity of one surface over the other [m/s], positive where the first is the faster.

    Raises
    ------
    InputError
        With every fault at once. A load or an entrainment of zero is refused: without load there is no
        contact to solve (the film stiffness is zero), and without entrainment a steady film does not exist
        (the contact is dry: the film separation is zero).

    Examples
    --------
    >>> oil = Lubricant(viscosity=0.06, pressure_viscosity=22.6e-9, density=910.0)
    >>> contact = LineContact(
    ...     load=1e5, entrainment=1.0, radius=0.015, reduced_modulus=2.2e11, lubricant=oil
    ... )
    >>> round(contact.moes_M, 2), round(contact.moes_L, 2), round(1e-9 * contact.peak_pressure, 3)
    (5.03, 12.21, 0.483)
    """

    no_error = "exact: Hertz's law for the load as given"

    load: float
    entrainment: float
    radius: float
    reduced_modulus: float
    lubricant: Lubricant
    sliding: float = 0.0

    def __post_init__(self) -> None:
        """Check every field."""
        with Faults.of(self, LIMITS) as faults:
            if not isinstance(self.lubricant, Lubricant):
                faults.add("lubricant", self.lubricant, "must be a Lubricant", "build one with ehl.Lubricant")

    @classmethod
    def from_moes(
        cls,
        M: float,
        L: float,
        roelands_z: float = 0.68,
        pressure_viscosity: float = 22e-9,
        compressible: bool = True,
        reduced_modulus: float = 2.2e11,
        radius: float = 0.015,
    ) -> LineContact:
        """Build the contact that has given Moes numbers.

        ``G = alpha E'``, ``U2 = (L/G)^4``, ``W = M sqrt(U2)``; eta0 follows from z and alpha. The groups fix
        alpha p_H = L sqrt(M/(2 pi)) but not the size, so E' and R may be chosen freely.

        Parameters
        ----------
        M, L : float
            Moes' load and lubricant numbers [-]. L = 0 is a constant viscosity; it leaves U2 free, which is
            then taken as 1e-11 (it matters through the compressibility alone).
        roelands_z : float
            Roelands' index [-].
        pressure_viscosity : float
            alpha [1/Pa].
        compressible : bool
            Whether the density rises with pressure.
        reduced_modulus, radius : float
            E' [Pa] and R [m].
        """
        with Faults() as faults:
            faults.numbers(_MOES_LIMITS, (M, L, roelands_z, pressure_viscosity, reduced_modulus, radius))
            if not faults.found and 0.0 < L < 1e-6:
                faults.add("L", L, "must be 0 or at least 1e-6", "give L = 0 for a constant viscosity")
        alpha = pressure_viscosity if L > 0 else 0.0
        speed = (L / (alpha * reduced_modulus)) ** 4 if L > 0 else _SPEED_PARAMETER
        viscosity = math.exp(pressure_viscosity * ROELANDS_PRESSURE / roelands_z + ROELANDS_LN_VISCOSITY)
        oil = Lubricant(viscosity, alpha, roelands_z=roelands_z, compressible=compressible)
        return cls(
            load=M * math.sqrt(speed) * reduced_modulus * radius,
            entrainment=speed * reduced_modulus * radius / (2.0 * viscosity),
            radius=radius,
            reduced_modulus=reduced_modulus,
            lubricant=oil,
        )

    @described("m", shown="um")
    def half_width(self) -> float:
        """Half-width of the dry contact, b = sqrt(8 w R/(pi E'))."""
        return math.sqrt(8.0 * self.load * self.radius / (math.pi * self.reduced_modulus))

    @property
    def peak_pressure(self) -> float:
        """Hertz pressure p_H = 2w/(pi b) [Pa]."""
        return 2.0 * self.load / (math.pi * self.half_width)

    @property
    def surface_speeds(self) -> tuple[float, float]:
        """Velocities of both surfaces towards the outlet [m/s]."""
        return self.entrainment + 0.5 * self.sliding, self.entrainment - 0.5 * self.sliding

    def film_parameter(self, film: float) -> float:
        """Film over the sagitta of the dry contact, h R/b^2 [-]."""
        return film * self.radius / self.half_width**2

    @property
    def U2(self) -> float:
        """Speed parameter eta0 (u1 + u2)/(E' R) [-], on the sum of the surface velocities."""
        return 2.0 * self.lubricant.viscosity * self.entrainment / (self.reduced_modulus * self.radius)

    @property
    def W(self) -> float:
        """Load parameter w/(E' R) [-]."""
        return self.load / (self.reduced_modulus * self.radius)

    @property
    def G(self) -> float:
        """Material parameter alpha E' [-]."""
        return self.lubricant.pressure_viscosity * self.reduced_modulus

    @property
    def moes_M(self) -> float:
        """Moes' load number M = W/sqrt(U2) [-]."""
        return self.W / math.sqrt(self.U2)

    @property
    def moes_L(self) -> float:
        """Moes' lubricant number L = G U2^(1/4) [-]."""
        return self.G * math.sqrt(math.sqrt(self.U2))

    @property
    def moes_film(self) -> float:
        """Film thickness of one Moes unit, R sqrt(U2) [m]."""
        return self.radius * math.sqrt(self.U2)
