"""What a scene says for its rating as the data that `gears.rating` takes, with faults under the scene's keys."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from base import Fault, InputError
from ehl.oil.oil_grades import graded_oil
from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.ground import in_keys
from flankfilm.scene.sections.rating import RatingSection
from flankfilm.scene.sections.section import required
from gears import GearPair
from gears.rating import (
    DeviationShares,
    FaceData,
    GearOil,
    LoadBin,
    RatedSteel,
    RatingData,
    Required,
    ScuffingData,
)

PEAKS = 6.0
"""Rz over Ra where one of both follows from the other: ISO 6336-2 takes Ra = Rz/6."""

OF_STEEL = ("steel", "sigma_Hlim_MPa", "sigma_Flim_MPa", "proof_stress_MPa")
"""Keys of a gear's steel."""

MATERIAL = ".material."
"""What leads to a gear's material in faults of the ground."""

DENSITY_AT = 288.15
"""Temperature at which data sheets have the density [K]."""


def rating_data(scene: Scene, pair: GearPair) -> RatingData:
    """Data of a scene's rating in SI; oil and roughness from their sections where [rating] has none.

    Raises
    ------
    InputError
        With every figure that is missing, under the scene's key.
    """
    section = required(scene.rating, "[rating]", "the wanted rating")
    faults = list[Fault]()
    heights, oil = _roughness(scene, section, faults), _oil(scene, section, faults)
    if faults:
        raise InputError(faults)
    peaks, mean = heights
    steels, fillets, hardening = zip(
        *((RatedSteel(**gear.si(*OF_STEEL)), gear.value("root_Rz_um"), gear.Z_W) for gear in section.each),
        strict=True,
    )
    steps = tuple(LoadBin(step.torque_Nm, step.value("speed_rpm"), step.turns) for step in section.spectrum)
    life = section.value("life_h")
    scuffing = None
    if section.scuffing is not None:
        scuffing = ScuffingData(GearOil(**oil), mean, **section.scuffing.si())
    return RatingData(
        section.accuracy_grade,
        steels,
        sum(step.time for step in steps) if life is None else life,
        oil["viscosity_40"],
        peaks,
        fillets,
        section.K_A,
        FaceData(**section.si("K_Hbeta", "shaft_term", "B_1", "B_2")),
        hardening,
        section.Z_X,
        section.pitting_permitted,
        _relief(pair),
        section.value("reduced_mass_kg_per_m"),
        scuffing,
        steps,
        Required(**section.si_of("required")),
        DeviationShares(**({} if section.tolerance_shares is None else section.tolerance_shares.si())),
    )


def mean_roughness(data: RatingData) -> float:
    """Ra of the flanks [m], the mean of both gears: that of scuffing, or Rz/6."""
    return data.flank_roughness / PEAKS if data.scuffing is None else data.scuffing.roughness


def _relief(pair: GearPair) -> float | None:
    """Tip relief of the gear that has less; None where one has none."""
    first, second = pair.pinion.tip_relief, pair.wheel.tip_relief
    return None if first is None or second is None else min(first.amount, second.amount)


def _roughness(scene: Scene, section: RatingSection, faults: list[Fault]) -> tuple[float, float]:
    """Rz and Ra of the flanks [m], the mean of both gears."""
    peaks, mean = section.value("flank_Rz_um"), section.value("flank_Ra_um")
    if scene.roughness is not None:
        drawn = scene.roughness.means
        peaks, mean = (drawn[0] if peaks is None else peaks), (drawn[1] if mean is None else mean)
    if peaks is None and mean is None:
        allowed = "is required by the wanted rating"
        faults.append(
            Fault("rating.flank_Rz_um", "", allowed, "Give Rz or flank_Ra_um, here or in [roughness]")
        )
        return 0.0, 0.0
    return PEAKS * mean if peaks is None else peaks, peaks / PEAKS if mean is None else mean


def _oil(scene: Scene, section: RatingSection, faults: list[Fault]) -> dict[str, float]:
    """Figures of the oil's data sheet in SI; those of the grade of [lubricant] where [rating.oil] has none."""
    sheet = dict[str, float]()
    lubricant = scene.lubricant
    temperature = None if lubricant is None else lubricant.value("temperature_C")
    if lubricant is not None and lubricant.iso_vg is not None and temperature is not None:
        of_grade: dict[str, Any] = {
            "index": lubricant.viscosity_index,
            "base": lubricant.base,
            "density_15": lubricant.density_15_kg_per_m3,
        }
        known = {name: value for name, value in of_grade.items() if value is not None}
        cold = graded_oil(lubricant.iso_vg, DENSITY_AT, **known)
        sheet = {
            "viscosity_40": 1e-6 * lubricant.iso_vg,
            "viscosity_100": 1e-6 * cold.kinematic_viscosity_100,
            "density_15": cold.density,
        }
    if temperature is not None:
        sheet["temperature"] = temperature
    sheet |= {} if section.oil is None else section.oil.si()
    if section.scuffing is not None and lubricant is not None and lubricant.base not in (None, "mineral"):
        allowed = "must be mineral for scuffing, whose friction is of mineral oils: no source confirms X_L of others"
        remedy = "Leave [rating.scuffing] out, or take the temperatures of wanted losses"
        faults.append(Fault("lubricant.base", f"{lubricant.base}", allowed, remedy))
    needed = {"viscosity_40": "nu_40_mm2_per_s"}
    if section.scuffing is not None:
        needed |= {"viscosity_100": "nu_100_mm2_per_s", "temperature": "temperature_C"}
    for name, key in needed.items():
        if name not in sheet:
            by = "scuffing" if name != "viscosity_40" else "the wanted rating"
            remedy = "Give the oil's data sheet in [rating.oil], or its grade in [lubricant]"
            faults.append(Fault(f"rating.oil.{key}", "", f"is required by {by}", remedy))
    return sheet


@contextmanager
def under_rating(scene: Scene) -> Iterator[None]:
    """Give the faults of a rating under the keys of [rating], [material] and [pair]."""
    try:
        yield
    except InputError as error:
        raise InputError(dict.fromkeys(_under(fault, scene) for fault in error.faults)) from error


def _under(fault: Fault, scene: Scene) -> Fault:
    """Fault of the ground under the scene's key."""
    gear, of_material, name = fault.where.partition(MATERIAL)
    if of_material:
        section = scene.material
        whole = section is not None and section.pinion is None
        inside = section if whole or section is None else getattr(section, gear)
        return in_keys(replace(fault, where=name), inside, "material" if whole else f"material.{gear}")
    if fault.where.endswith("face_width"):
        gear = fault.where.partition(".")[0]
        wider = scene.pair is not None and getattr(scene.pair, gear).face_width_mm is not None
        return in_keys(fault if wider else replace(fault, where="face_width"), scene.pair, "pair")
    if fault.where.endswith(("module", "reference_diameter")):
        return in_keys(fault, scene.pair, "pair")
    if fault.where == "F_bx":
        allowed = (
            f"is required where method C begins with a misalignment of {fault.value}: it {fault.allowed}"
        )
        return Fault("rating.K_Hbeta", "", allowed, "Give K_Hbeta, by the loaded contact or another source")
    path = fault.where.replace(".steel.", ".")
    if scene.rating is not None and scene.rating.wheel is None and path.startswith("wheel."):
        path = path.replace("wheel.", "pinion.", 1)  # whose keys both gears have
    return in_keys(replace(fault, where=path), scene.rating, "rating")
