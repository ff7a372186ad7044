"""Keys of the shafts: steps, bearings, motor and load; one model for the motion and for slopes at the mesh."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import Field, model_validator

import gears
from base import Fault, InputError, Limit
from flankfilm.scene.sections.ground import in_keys
from flankfilm.scene.sections.key import key, within
from flankfilm.scene.sections.materials import ElasticSection
from flankfilm.scene.sections.section import Limits, Section, refused
from gears.pair.shafts import BEARING, SEGMENT

PLACE = Limit(0.0, 1e4, "m", "Count from the left end of the shaft")
MOST_STEPS = 200
MOST_BEARINGS = 20

BAND = Limit.above(0.0, 100.0, "", "0.5 and 2: half and twice the damping")
TOLERANCE = Limit.above(0.0, 1.0, "", "0.05 for forces of the linear response within 5 %")
DAMPING_BAND = (0.5, 2.0)
Factor = Annotated[float, within(BAND)]
Band = Annotated[tuple[Factor, Factor], Field(strict=False)]
ONE_RATIO = (0.01,)
RATIO = Limit(0.0, 1.0, "", "0.005 to 0.02 for shafts")


class SegmentSection(Section):
    """Step of a shaft."""

    ground = SEGMENT

    length_mm: float = key("length of the step", example=100)
    diameter_mm: float = key("outer diameter", example=40)
    bore_mm: float = key("diameter of the bore, 0 for a solid shaft", 0.0)


class BearingSection(Section):
    """Bearing: springs to the housing across and along the shaft, and a damper across it."""

    ground = BEARING

    position_mm: float = key("place, from the left end of the shaft", example=20)
    stiffness_N_per_m: float = key("radial stiffness, 1e8 to 1e9 for rolling bearings", example=4e8)
    damping_N_s_per_m: float = key("radial damping", 0.0)
    axial_stiffness_N_per_m: float = key(
        "axial stiffness, 0 for a bearing that is free to slide; for the motion of helical pairs one bearing of each "
        "shaft must have it",
        0.0,
        such_as=1e8,
    )


Segments = Annotated[tuple[SegmentSection, ...], Field(strict=False)]
Bearings = Annotated[tuple[BearingSection, ...], Field(strict=False)]


class ShaftSection(Section):
    """Shaft of a gear, with what is coupled to it; lengths count from its left end, the same side for both shafts."""

    ground: ClassVar[Limits] = {
        "gear_position": PLACE,
        "torque_position": PLACE,
        "inertia": Limit(0.0, 1e9, "kg m2"),
        "coupling_stiffness": Limit.above(0.0, 1e15, "N m/rad", "leave it out for a rigid coupling"),
    }

    segments: Segments = key(
        "steps of the shaft from the left end on; a rigid shaft in rigid bearings if left out",
        (),
        such_as=({"length_mm": 200, "diameter_mm": 40},),
        max_length=MOST_STEPS,
    )
    bearings: Bearings = key(
        "bearings of the shaft, at least two",
        (),
        such_as=(
            {"position_mm": 20, "stiffness_N_per_m": 4e8},
            {"position_mm": 180, "stiffness_N_per_m": 4e8},
        ),
        max_length=MOST_BEARINGS,
    )
    gear_position_mm: float | None = key(
        "middle of the gear's face, from the left end of the shaft; between the bearings, or beyond them where it "
        "overhangs",
        None,
        such_as=100,
    )
    torque_position_mm: float = key(
        "where motor or load is coupled, from the left end: 0 for that end, the whole length for the other",
        0.0,
    )
    material: ElasticSection | None = key(
        "material of the shaft; steel if left out", None, such_as={"name": "steel"}
    )
    inertia_kg_m2: float = key(
        "moment of inertia of motor or load; the shaft's own follows from its steps", 0.0, such_as=0.02
    )
    coupling_stiffness_Nm_per_rad: float | None = key(
        "torsional stiffness of the coupling between the shaft and this inertia; rigid if left out",
        None,
        such_as=2e4,
    )

    @property
    def rigid(self) -> bool:
        """Whether the shaft neither bends nor twists."""
        return not self.segments

    def shaft(self) -> gears.Shaft | None:
        """Shaft in SI; None for a rigid one."""
        if self.rigid or self.gear_position_mm is None:
            return None
        steel = gears.STEEL if self.material is None else self.material.material()
        return gears.Shaft(
            tuple(gears.ShaftSegment(**step.si()) for step in self.segments),
            tuple(gears.Bearing(**bearing.si()) for bearing in self.bearings),
            self.value("gear_position_mm"),
            self.value("torque_position_mm"),
            steel,
        )

    @property
    def bent(self) -> dict[str, Any]:
        """What decides how it bends and twists under a load that stands still, as plain values."""
        still = {"inertia_kg_m2": True, "coupling_stiffness_Nm_per_rad": True}
        return self.model_dump(exclude={**still, "bearings": {"__all__": {"damping_N_s_per_m"}}})

    @model_validator(mode="after")
    def _a_whole_shaft(self) -> ShaftSection:
        faults = []
        if self.coupling_stiffness_Nm_per_rad is not None and not self.inertia_kg_m2 > 0.0:
            allowed = "must be more than 0 kg m2 behind a coupling"
            remedy = "Give that of motor or load, or leave the coupling out"
            faults.append(Fault("inertia_kg_m2", f"{self.inertia_kg_m2:g}", allowed, remedy))
        if self.rigid:
            needless = [name for name in ("bearings", "material") if getattr(self, name)]
            needless += self.given_keys("gear_position_mm")
            needless += ["torque_position_mm"] if self.torque_position_mm else []
            allowed = "must have segments beside it: a rigid shaft has none"
            faults += [Fault(name, "", allowed, "Give the steps, or leave it out") for name in needless]
        elif self.gear_position_mm is None:
            remedy = "Give the middle of the gear's face, from the left end of the shaft"
            faults.append(Fault("gear_position_mm", "", "is required by the segments", remedy))
        try:
            self.shaft()
        except InputError as error:
            faults += [in_keys(fault, self, "") for fault in error.faults]
        if faults:
            raise InputError(faults)
        return self


_PER_SECOND = Limit(0.0, 1e9, "1/s", "10 to 100 damps the lowest modes")
_SECONDS = Limit(0.0, 10.0, "s", "1e-6 to 1e-5 damps the highest modes")


class RayleighSection(Section):
    """Damping in proportion to mass and stiffness of shafts and bearings."""

    ground: ClassVar[Limits] = {"of_mass": _PER_SECOND, "of_stiffness": _SECONDS}

    of_mass_per_s: float = key("factor of the mass, alpha; free rotation is not braked", 0.0, example=20.0)
    of_stiffness_s: float = key("factor of the stiffness, beta", 0.0, example=1e-6)

    @property
    def each(self) -> tuple[float, float]:
        """Of mass [1/s] and stiffness [s]."""
        return self.of_mass_per_s, self.of_stiffness_s


class ShaftsSection(Section):
    """Shafts of both gears with bearings, motor and load, which make a drive train of the pair."""

    pinion: ShaftSection | None = key(
        "shaft of the pinion; rigid in rigid bearings, with nothing coupled, if left out",
        None,
        example={
            "segments": ({"length_mm": 200, "diameter_mm": 40},),
            "bearings": (
                {"position_mm": 20, "stiffness_N_per_m": 4e8},
                {"position_mm": 180, "stiffness_N_per_m": 4e8},
            ),
            "gear_position_mm": 100,
            "torque_position_mm": 0,
            "inertia_kg_m2": 0.02,
        },
    )
    wheel: ShaftSection | None = key(
        "shaft of the wheel, with the same keys",
        None,
        such_as={"inertia_kg_m2": 0.05, "coupling_stiffness_Nm_per_rad": 2e4},
    )
    damping_ratio: Annotated[tuple[Annotated[float, within(RATIO)], ...], Field(strict=False)] = key(
        "modal damping of shafts, bearings and couplings without the mesh over the critical one: of all modes, or "
        "a list from the lowest mode on, of which the last holds for all higher modes; dampers of bearings are added",
        ONE_RATIO,
        such_as=0.01,
        min_length=1,
    )
    damping_band: Band = key(
        "likely minimum and maximum damping of shafts and bearings over the given one, for the error of peaks",
        DAMPING_BAND,
    )
    reduction_tolerance: float = key(
        "allowed change of the swing of a force by modes of shafts that are not retained, within the speeds of the"
        " scene",
        0.05,
        limit=TOLERANCE,
    )
    rayleigh: RayleighSection | None = key(
        "instead of it: damping in proportion to mass and stiffness",
        None,
        such_as={"of_mass_per_s": 20.0, "of_stiffness_s": 1e-6},
    )

    @property
    def each(self) -> tuple[ShaftSection | None, ShaftSection | None]:
        """Of pinion and wheel."""
        return self.pinion, self.wheel

    @property
    def bends(self) -> bool:
        """Whether one of the shafts has steps, which bend and twist."""
        return any(shaft is not None and not shaft.rigid for shaft in self.each)

    def shafts(self) -> tuple[gears.Shaft | None, gears.Shaft | None]:
        """Shafts of pinion and wheel in SI; None for a rigid one."""
        pinion, wheel = (None if section is None else section.shaft() for section in self.each)
        return pinion, wheel

    def drive_arguments(self) -> dict[str, Any]:
        """What `flankfilm.coupling.pair_drive` takes of the section, in SI."""
        ends = [ShaftSection() if section is None else section for section in self.each]
        damping: dict[str, Any] = {"shaft_damping_ratio": self.damping_ratio}
        if self.rayleigh is not None:
            damping = {"rayleigh": self.rayleigh.each}
        return {
            "shafts": self.shafts(),
            "end_inertias": tuple(section.inertia_kg_m2 for section in ends),
            "couplings": tuple(section.value("coupling_stiffness_Nm_per_rad") for section in ends),
            "damping_band": self.damping_band,
            "reduction_tolerance": self.reduction_tolerance,
            **damping,
        }

    @model_validator(mode="before")
    @classmethod
    def _one_ratio_as_a_list(cls, raw: object) -> object:
        if isinstance(raw, dict) and isinstance(raw.get("damping_ratio"), int | float):
            return raw | {"damping_ratio": [raw["damping_ratio"]]}
        return raw

    @model_validator(mode="after")
    def _shafts_and_one_damping(self) -> ShaftsSection:
        if self.pinion is None and self.wheel is None:
            raise refused(
                "must have [shafts.pinion] or [shafts.wheel]", "Give a shaft, or leave [shafts] out"
            )
        low, high = self.damping_band
        if not low <= 1.0 <= high:
            raise refused(
                "must hold 1, the damping that is given",
                "Give the smallest and the largest, 0.5 and 2",
                key="damping_band",
                value=f"{low:g} to {high:g}",
            )
        if self.rayleigh is not None and "damping_ratio" in self.model_fields_set:
            raise refused("must have damping_ratio or rayleigh, not both", "Leave one of them out")
        return self
