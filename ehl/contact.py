"""The line contact: load, speed, shape and the groups that decide its film."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ehl.errors import EhlInputError, Fault, number_fault
from ehl.lubricant import Lubricant
from ehl.rheology import ROELANDS_LN_VISCOSITY, ROELANDS_PRESSURE

__all__ = ["LineContact"]

_SPEED_PARAMETER = 1e-11  # U2 taken by from_moes when alpha = 0 leaves it free


@dataclass(frozen=True)
class LineContact:
    """A steady line contact of two elastic cylinders; how oil comes to it is an argument of :func:`ehl.solve`.

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

    Raises
    ------
    EhlInputError
        With every fault at once. A load or an entrainment of zero is refused: without load there is no
        contact to solve (the film stiffness is zero), and without entrainment a steady film does not exist
        (the contact is dry: the film props the bodies apart by nothing).
    """

    load: float
    entrainment: float
    radius: float
    reduced_modulus: float
    lubricant: Lubricant

    def __post_init__(self) -> None:
        """Check every field."""
        faults = number_fault(
            "load",
            self.load,
            low=0.0,
            high=1e15,
            remedy="a pair without load has no film to solve: leave it out, or give its small load in N/m",
        )
        faults += number_fault(
            "entrainment",
            self.entrainment,
            low=0.0,
            high=1e9,
            remedy="without entrainment no steady film exists: take the contact as dry; "
            "if both surfaces move backwards, give the magnitude and mirror x",
        )
        faults += number_fault("radius", self.radius, low=0.0, high=1e6, remedy="give R in m")
        faults += number_fault(
            "reduced_modulus",
            self.reduced_modulus,
            low=0.0,
            high=1e14,
            remedy="give E' in Pa, 2.26e11 for steel",
        )
        if not isinstance(self.lubricant, Lubricant):
            faults.append(
                Fault("lubricant", repr(self.lubricant), "a Lubricant", "build one with ehl.Lubricant")
            )
        if faults:
            raise EhlInputError(faults)

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
        remedy = "Moes' numbers of line contacts lie between 0.01 and 5000 (M), 0 and 30 (L)"
        faults = number_fault("M", M, low=0.0, high=1e9, remedy=remedy)
        faults += number_fault("L", L, low=0.0, high=1e3, open_low=False, remedy=remedy)
        faults += number_fault(
            "roelands_z", roelands_z, low=0.1, high=2.0, open_low=False, remedy="oils lie between 0.2 and 1"
        )
        faults += number_fault(
            "pressure_viscosity",
            pressure_viscosity,
            low=0.0,
            high=1e-7,
            remedy="for a constant viscosity give L=0",
        )
        faults += number_fault("reduced_modulus", reduced_modulus, low=0.0, high=1e14, remedy="give E' in Pa")
        faults += number_fault("radius", radius, low=0.0, high=1e6, remedy="give R in m")
        if not faults and 0.0 < L < 1e-6:
            faults.append(Fault("L", repr(L), "0 or at least 1e-6", "give L=0 for a constant viscosity"))
        if faults:
            raise EhlInputError(faults)
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

    @property
    def half_width(self) -> float:
        """Half-width of the dry contact b = sqrt(8 w R/(pi E')) [m]."""
        return math.sqrt(8.0 * self.load * self.radius / (math.pi * self.reduced_modulus))

    @property
    def peak_pressure(self) -> float:
        """Hertz pressure p_H = 2w/(pi b) [Pa]."""
        return 2.0 * self.load / (math.pi * self.half_width)

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
