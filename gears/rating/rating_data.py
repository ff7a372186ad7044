"""What a rating takes beside the pair, its torque and its speed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from base import Faults, Limit
from gears.rating.friction import GearOil
from gears.rating.grades import Tolerances
from gears.rating.spectrum import LoadBin
from gears.rating.steels import Steels

REQUIRED = Limit.above(0.0, 100.0, remedy="1 is failure of 1 gear in 100")
"""Safeties that may be required."""


@dataclass(frozen=True)
class Required:
    """Safeties that a pair must have: the standards leave them to supplier and customer.

    Parameters
    ----------
    S_H, S_F, S_S : float
        Against pitting, breakage and scuffing.
    """

    S_H: float = 1.0
    S_F: float = 1.4
    S_S: float = 1.5

    def check(self, faults: Faults) -> None:
        """Note safeties that nobody can require."""
        for name in ("S_H", "S_F", "S_S"):
            faults.number(f"required.{name}", getattr(self, name), REQUIRED)


@dataclass(frozen=True)
class ScuffingData:
    """Oil and test by which scuffing is rated.

    Parameters
    ----------
    oil : GearOil
        By its data sheet, at its temperature.
    roughness : float
        Ra, the mean of both flanks [m].
    test_torque : float
        T_1T, pinion torque of the load stage at which the oil scuffs in the FZG test A/8.3/90 [N m].
    structure, supply : float
        X_WrelT of the steel, X_S of the way in which oil reaches the teeth.
    """

    oil: GearOil
    roughness: float  # Ra, m
    test_torque: float  # T_1T, N m
    structure: float = 1.0  # X_WrelT
    supply: float = 1.0  # X_S


@dataclass(frozen=True)
class FaceData:
    """Where K_Hbeta comes from: given, or method C by shaft, grade and modifications along the face.

    Parameters
    ----------
    face_load_factor : float or None
        K_Hbeta where it is known; method C unless given.
    shaft : float
        K' l s/d_1^2 (d_1/d_sh)^4 of `misalignment`, 0 of a pinion midway between its bearings.
    B_1, B_2 : float
        What modifications along the face leave of shaft deflection and deviations.
    """

    face_load_factor: float | None = None  # K_Hbeta
    shaft: float = 0.0
    B_1: float = 1.0
    B_2: float = 1.0


SHARE = Limit(0.0, 2.0, remedy="1 is the tolerance of the grade, 0 a gear without the deviation")
"""Parts of a tolerance that a gear has."""


@dataclass(frozen=True)
class DeviationShares:
    """What a gear has of the tolerances of its grade, 1 of each as a rating takes them; below 1 of gears as made.

    Parameters
    ----------
    f_pb, f_falpha, f_Hbeta : float
        Base pitch, profile form and helix slope deviation over their tolerances.
    """

    f_pb: float = 1.0
    f_falpha: float = 1.0
    f_Hbeta: float = 1.0

    def check(self, faults: Faults) -> None:
        """Note parts that no gear has."""
        for name in ("f_pb", "f_falpha", "f_Hbeta"):
            faults.number(f"shares.{name}", getattr(self, name), SHARE)

    def of(self, grade: Tolerances) -> Tolerances:
        """Deviations of both gears, those that a rating depends on."""

        def part(share: float, both_gears: tuple[float, float]) -> tuple[float, float]:
            return share * both_gears[0], share * both_gears[1]

        return replace(
            grade,
            f_pb=part(self.f_pb, grade.f_pb),
            f_falpha=part(self.f_falpha, grade.f_falpha),
            f_Hbeta=part(self.f_Hbeta, grade.f_Hbeta),
        )


@dataclass(frozen=True)
class RatingData:
    """What a rating takes beside the pair, its torque and its speed.

    Parameters
    ----------
    grade : int
        Accuracy grade of ISO 1328-1:1995.
    steels : tuple of RatedSteel
        Of pinion and wheel.
    life : float
        Time under load [s].
    viscosity_40 : float
        Kinematic viscosity of the oil at 40 degC [m2/s].
    flank_roughness : float
        Mean peak-to-valley height Rz, the mean of both flanks [m].
    root_roughness : tuple of float
        Rz of the fillets of both gears [m].
    application_factor : float
        K_A.
    face : FaceData
        Where K_Hbeta comes from.
    Z_W : tuple of float
        Work hardening factors of both gears.
    Z_X : float
        Size factor of the contact stress.
    pitting_permitted : bool
        Whether limited pitting is permitted.
    relief : float or None
        C_a, tip relief of the smaller one of both gears [m]; what running in makes unless given.
    mass : float or None
        m_red [kg/m]; by the sizes of the gears unless given.
    scuffing : ScuffingData or None
        None leaves scuffing out.
    spectrum : tuple of LoadBin
        Steps of a load spectrum; none leaves Miner's sum out.
    required : Required
        Safeties that the pair must have.
    shares : DeviationShares
        What the gears have of the tolerances of their grade.

    Examples
    --------
    >>> from gears.rating import RatedSteel
    >>> steels = (RatedSteel("Eh", 1500e6, 430e6),) * 2
    >>> RatingData(6, steels, 3.6e7, 220e-6, 4.8e-6, (20e-6, 20e-6)).required.S_F
    1.4
    """

    grade: int
    steels: Steels
    life: float  # s
    viscosity_40: float  # nu_40, m2/s
    flank_roughness: float  # Rz, m
    root_roughness: tuple[float, float]  # Rz, m
    application_factor: float = 1.0  # K_A
    face: FaceData = field(default_factory=FaceData)
    Z_W: tuple[float, float] = (1.0, 1.0)
    Z_X: float = 1.0
    pitting_permitted: bool = False
    relief: float | None = None  # C_a, m
    mass: float | None = None  # m_red, kg/m
    scuffing: ScuffingData | None = None
    spectrum: tuple[LoadBin, ...] = ()
    required: Required = field(default_factory=Required)
    shares: DeviationShares = field(default_factory=DeviationShares)
