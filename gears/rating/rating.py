"""The whole rating of a pair: from a grade and steels to load factors, safeties and damage."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from typing import Any, TypeVar

from base import Fault, Faults, RangeWarning, described, part, quantity, record
from base.results import EXACT
from gears.closed_form.record import STANDARD
from gears.pair.gear_pair import GearPair
from gears.rating.bending import BendingSafety, bending_safety, check_roots
from gears.rating.friction import check_oil
from gears.rating.grades import Tolerances, tolerances
from gears.rating.load_factors import LoadFactors, load_factors
from gears.rating.misalignment import Misalignment, misalignment
from gears.rating.pitting import PittingSafety, check_flanks, pitting_safety
from gears.rating.rating_data import RatingData, Required
from gears.rating.running_in import run_in, run_in_relief
from gears.rating.scuffing import ScuffingSafety, scuffing_safety
from gears.rating.spectrum import check_spectrum
from gears.rating.spectrum_rating import SpectrumRating, rate_spectrum
from gears.rating.steels import check_steels
from gears.tooth.errors import GeometryError

T = TypeVar("T")


@record
class Rating:
    """Rating of a pair at one torque and speed, with every factor in its parts."""

    torque: float = quantity("N m", "torque of the pinion, whose modulus is rated", no_error=EXACT)
    speed: float = quantity("rad/s", "speed of the pinion", shown="rpm", no_error=EXACT)
    life: float = quantity("s", "time under load", shown="h", no_error=EXACT)
    relief: float = quantity("m", "tip relief C_a, of the gears or by running in", shown="um")
    tolerances: Tolerances = part("of the accuracy grade, or what the gears have of them")
    misalignment: Misalignment | None = part("by method C; None where K_Hbeta is given")
    factors: LoadFactors = part("load factors")
    pitting: PittingSafety = part("safety against pitting")
    bending: BendingSafety | None = part("safety against breakage; None where ISO 6336-3 has no answer")
    scuffing: ScuffingSafety | None = part(
        "safety against scuffing; None where it is not asked for, or refused"
    )
    spectrum: SpectrumRating | None = part("damage of the load spectrum; None without one")
    required: Required = part("safeties that the pair must have")
    bending_fault: str = quantity("", "why ISO 6336-3 has no answer", default="")
    scuffing_fault: str = quantity("", "why scuffing has no answer", default="")

    no_error = STANDARD
    headline = ("S_H", "S_F", "S_S")

    @described("1", "gear")
    def S_H(self) -> tuple[float, float]:
        """Safety against pitting."""
        return self.pitting.S_H

    @described("1", "gear")
    def S_F(self) -> tuple[float, float] | None:
        """Safety against breakage; None where ISO 6336-3 has no answer."""
        return None if self.bending is None else self.bending.S_F

    @described("1")
    def S_S(self) -> float | None:
        """Safety against scuffing; None where it is not rated."""
        return None if self.scuffing is None else self.scuffing.S_intS

    @described("1", no_error=EXACT)
    def enough(self) -> bool:
        """Whether every safety is at least the one required, and no damage of a spectrum exceeds 1."""
        asked = self.required
        safe = [min(self.S_H) >= asked.S_H]
        safe += [] if self.S_F is None else [min(self.S_F) >= asked.S_F]
        safe += [] if self.S_S is None else [self.S_S >= asked.S_S]
        if self.spectrum is not None:
            safe.append(max(*self.spectrum.damage_H, *(self.spectrum.damage_F or ())) <= 1.0)
        return all(safe)

    @described("1", no_error=EXACT)
    def required_S_H(self) -> float:
        """Safety against pitting that is required."""
        return self.required.S_H

    @described("1", no_error=EXACT)
    def required_S_F(self) -> float:
        """Safety against breakage that is required."""
        return self.required.S_F

    @described("1", no_error=EXACT)
    def required_S_S(self) -> float:
        """Safety against scuffing that is required."""
        return self.required.S_S

    @property
    def error(self) -> None:
        """Model error, which a standard cannot know: None is unknown, never zero."""
        return


def rate(pair: GearPair, torque: float, speed: float, data: RatingData) -> Rating:
    """Rate a spur or helical pair by ISO 6336 and the integral temperature of scuffing.

    The order is that of the standard: tolerances of the grade, running in, K_v, the misalignment by method C on the
    load with K_A and K_v unless K_Hbeta is given, the other load factors, safeties, and Miner's sum of a spectrum.

    Parameters
    ----------
    pair : GearPair
    torque : float
        Of the pinion [N m]. Where it is negative the back flanks bear, which are rated as the front ones are; scuffing,
        whose formulas are of a driving pinion, is left out.
    speed : float
        Of the pinion [rad/s].
    data : RatingData

    Returns
    -------
    Rating

    Raises
    ------
    GeometryError
        With every fault that grade, steels, oil, spectrum and required safeties have, together.

    Warns
    -----
    RangeWarning
        At resonance, for a helix above 30 degrees, and what the parts of the standard warn of, each once.

    References
    ----------
    ISO 6336-1, -2, -3, -6:2006; ISO/TR 13989-2:2000.

    Examples
    --------
    >>> from gears import Gear
    >>> from gears.rating import RatedSteel
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> data = RatingData(6, (RatedSteel("Eh", 1500e6, 430e6),) * 2, 3.6e7, 220e-6, 4.8e-6, (20e-6, 20e-6))
    >>> found = rate(pair, 300.0, 209.44, data)
    >>> round(min(found.S_H), 2), round(min(found.S_F), 2), found.enough
    (1.07, 1.76, True)
    """
    deviations = _checked(pair, data)
    load, heard = abs(torque), list[str]()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        relief = run_in_relief(data.steels) if data.relief is None else data.relief
        factors, lead = factors_at(pair, load, speed, data, deviations, relief)
        pitting = pitting_safety(pair, load, speed, factors, data.steels, **pitting_arguments(data))
        bending, bending_fault = _or_fault(
            lambda: bending_safety(
                pair,
                load,
                speed,
                factors,
                data.steels,
                root_roughness=data.root_roughness,
                life=data.life,
            )
        )
        scuffing, scuffing_fault = _or_fault(lambda: _scuffing(pair, torque, speed, factors, data, relief))
        spectrum = None
        if data.spectrum:
            spectrum = rate_spectrum(
                pair,
                data,
                lambda step: factors_at(pair, step.torque, step.speed, data, deviations, relief)[0],
            )
        heard = list(dict.fromkeys(str(warning.message) for warning in caught))
    for text in heard:
        warnings.warn(text, RangeWarning, stacklevel=2)
    return Rating(
        torque,
        speed,
        data.life,
        relief,
        deviations,
        lead,
        factors,
        pitting,
        bending,
        scuffing,
        spectrum,
        data.required,
        bending_fault,
        scuffing_fault,
    )


def factors_at(
    pair: GearPair, torque: float, speed: float, data: RatingData, deviations: Tolerances, relief: float
) -> tuple[LoadFactors, Misalignment | None]:
    """Load factors at a torque [N m] and speed [rad/s], and the misalignment that K_Hbeta follows from."""
    common: dict[str, Any] = {
        "application_factor": data.application_factor,
        "effective": run_in(pair, data.steels, speed, deviations),
        "relief": relief,
        "mass": data.mass,
    }
    face = data.face
    if face.face_load_factor is not None:
        return load_factors(pair, torque, speed, face_load_factor=face.face_load_factor, **common), None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the factors below warn of the same
        dynamic = load_factors(pair, torque, speed, face_load_factor=1.0, **common).K_v
    lead = misalignment(
        pair,
        data.application_factor * dynamic * torque,
        speed,
        data.steels,
        deviations,
        shaft=face.shaft,
        B_1=face.B_1,
        B_2=face.B_2,
    )
    return load_factors(pair, torque, speed, misalignment=lead.F_by, **common), lead


def pitting_arguments(data: RatingData) -> dict[str, Any]:
    """Arguments that `pitting_safety` takes of the data."""
    return {
        "viscosity_40": data.viscosity_40,
        "roughness": data.flank_roughness,
        "life": data.life,
        "Z_W": data.Z_W,
        "Z_X": data.Z_X,
        "pitting_permitted": data.pitting_permitted,
    }


def _checked(pair: GearPair, data: RatingData) -> Tolerances:
    """Tolerances of the grade, after everything that can be wrong beside it was looked at."""
    faults, graded = list[Fault](), list[Tolerances]()
    checks: list[Callable[[], object]] = [
        lambda: graded.append(data.shares.of(tolerances(pair, data.grade))),
        lambda: _check_given(pair, data),
    ]
    if data.scuffing is not None:
        oil = data.scuffing.oil
        checks.append(lambda: check_oil(oil))
    if data.spectrum:
        checks.append(lambda: check_spectrum(data.spectrum))
    for check in checks:
        try:
            check()
        except GeometryError as error:
            faults += error.faults
    if faults:
        raise GeometryError(faults)
    return graded[0]


def _check_given(pair: GearPair, data: RatingData) -> None:
    with Faults(GeometryError) as faults:
        check_steels(faults, pair, data.steels)
        check_flanks(faults, data.viscosity_40, data.flank_roughness, data.life, data.Z_W, data.Z_X)
        check_roots(faults, data.steels, data.root_roughness)
        data.required.check(faults)
        data.shares.check(faults)


def _scuffing(
    pair: GearPair, torque: float, speed: float, factors: LoadFactors, data: RatingData, relief: float
) -> ScuffingSafety | None:
    """Safety against scuffing; None where it is not asked for."""
    test = data.scuffing
    if test is None:
        return None
    if not math.copysign(1.0, torque) > 0.0:
        raise GeometryError.at(
            "torque",
            f"{torque:g}",
            "must be positive for scuffing, of a driving pinion",
            "turn the pair round",
        )
    return scuffing_safety(
        pair,
        speed,
        factors,
        test.oil,
        roughness=test.roughness,
        relief=relief,
        test_torque=test.test_torque,
        structure=test.structure,
        supply=test.supply,
    )


def _or_fault(work: Callable[[], T]) -> tuple[T | None, str]:
    """What work gives, or None and why not."""
    try:
        return work(), ""
    except GeometryError as error:
        return None, "; ".join(map(str, error.faults))
