"""Keys of a rating by standards: grade, steels, oil, how K_Hbeta is found, and the load spectrum."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal

from pydantic import Field, field_validator, model_validator

from base import Limit
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.section import Limits, Section, refused
from gears.rating.bending import ROUGHNESS
from gears.rating.friction import LIMITS as OIL
from gears.rating.grades import GRADES
from gears.rating.load_factors import LIMITS as LOADS
from gears.rating.misalignment import LIMITS as FACE
from gears.rating.pitting import FACTOR
from gears.rating.pitting import LIMITS as FLANKS
from gears.rating.rating_data import REQUIRED, SHARE
from gears.rating.scuffing import LIMITS as SCUFFING
from gears.rating.spectrum import LIMITS as STEP
from gears.rating.steels import KINDS
from gears.rating.steels import LIMITS as STRENGTHS

MOST_STEPS = 1000
"""Steps of a load spectrum."""

GRADE = Limit(*GRADES, "", "ISO 1328-1 has grades 0 to 12; 6 is usual for ground gears", whole=True)


class RatedGearSection(Section):
    """Steel of a gear with its strengths, and its fillets."""

    ground: ClassVar[Limits] = {**STRENGTHS, "root_roughness": ROUGHNESS, "Z_W": FACTOR}

    steel: Literal["St", "V", "Eh", "IF", "NT", "NV nitr", "NV nitrocar"] = key(
        "class of the steel by ISO 6336-5: normalized, through-hardened, case-hardened, flame or induction hardened, "
        "nitriding steel nitrided, other steel nitrided, nitrocarburized; irons and plastics are not rated",
        of="kind",
        example="Eh",
    )
    sigma_Hlim_MPa: float = key(
        "allowable stress number for contact sigma_Hlim of ISO 6336-5, by hardness and quality",
        of="contact_strength",
        example=1500,
    )
    sigma_Flim_MPa: float = key(
        "nominal stress number for bending sigma_Flim of ISO 6336-5",
        of="bending_strength",
        example=430,
    )
    proof_stress_MPa: float | None = key(
        "yield strength of St, 0.2 % proof stress of V: required of these two, whose notch sensitivity it decides",
        None,
        such_as=600,
    )
    root_Rz_um: float = key("roughness Rz of the fillets", of="root_roughness", example=20.0)
    Z_W: float = key("work hardening factor; 1 unless a ground hard pinion runs with a soft wheel", 1.0)

    @field_validator("steel", mode="before")
    @classmethod
    def _a_steel(cls, symbol: object) -> object:
        if isinstance(symbol, str) and symbol not in KINDS:
            allowed = f"must be one of {', '.join(map(repr, KINDS))}"
            remedy = "These are the steels of ISO 6336-5; its irons, and plastics, are not rated"
            raise refused(allowed, remedy, value=repr(symbol))
        return symbol


class RatedOilSection(Section):
    """Oil by its data sheet, where [lubricant] has not its grade."""

    ground: ClassVar[Limits] = OIL

    nu_40_mm2_per_s: float = key("kinematic viscosity at 40 degC", of="viscosity_40", example=220)
    nu_100_mm2_per_s: float | None = key(
        "kinematic viscosity at 100 degC, which scuffing needs", None, of="viscosity_100", such_as=19
    )
    density_15_kg_per_m3: float = key("density at 15 degC", 890.0, of="density_15", shown=True)
    temperature_C: float | None = key(
        "temperature of the oil as it reaches the teeth, which scuffing needs; that of [lubricant] if left out",
        None,
        celsius="temperature",
        such_as=80,
    )


class ScuffingSection(Section):
    """Test by which scuffing is rated."""

    ground: ClassVar[Limits] = SCUFFING

    T_1T_Nm: float = key(
        "pinion torque of the load stage at which the oil scuffs in the FZG test A/8.3/90; 714.2 of stage 14",
        of="test_torque",
        example=714.2,
    )
    X_WrelT: float = key(
        "structural factor of the steel; 1 of case-hardened steel as in the test", 1.0, of="structure"
    )
    X_S: float = key("how oil reaches the teeth; 1 of gears that dip into it", 1.0, of="supply")


class SharesSection(Section):
    """What the gears have of the tolerances of their grade, to be drawn by a study."""

    ground: ClassVar[Limits] = {"f_pb": SHARE, "f_falpha": SHARE, "f_Hbeta": SHARE}

    f_pb: float = key("base pitch deviation over its tolerance", 1.0, example=0.5)
    f_falpha: float = key("profile form deviation over its tolerance", 1.0, example=0.5)
    f_Hbeta: float = key("helix slope deviation over its tolerance", 1.0, example=0.5)


class StepSection(Section):
    """Step of a load spectrum, on the rated flanks."""

    ground: ClassVar[Limits] = {**STEP, "duration": FLANKS["life"]}

    torque_Nm: float = key(
        "torque on the pinion, 0 of a step without load; reversed torques load the other flanks, and are a second "
        "rating",
        example=600,
    )
    speed_rpm: float = key("speed of the pinion", example=2000)
    duration_h: float | None = key("time of the step in the life of the gears", None, example=5000)
    cycles: float | None = key("load cycles of the pinion, instead of the time", None, such_as=6e8)

    @field_validator("torque_Nm", mode="before")
    @classmethod
    def _one_direction(cls, torque: object) -> object:
        if isinstance(torque, int | float) and torque < 0.0:
            remedy = "Reversed torques load the other flanks: rate these by a second scene with their moduli"
            raise refused("must be at least 0", remedy, value=f"{torque:g}")
        return torque

    @model_validator(mode="after")
    def _time_or_cycles(self) -> StepSection:
        if len(self.given_keys("duration_h", "cycles")) != 1:
            raise refused("must have duration_h or cycles", "Give one of them")
        return self

    @property
    def turns(self) -> float:
        """Load cycles of the pinion."""
        if self.cycles is not None:
            return self.cycles
        return float(self.value("duration_h") * self.value("speed_rpm") / (2.0 * math.pi))


Steps = Annotated[tuple[StepSection, ...], Field(strict=False)]


class RatingSection(Section):
    """Rating by ISO 6336 and by the integral temperature of scuffing."""

    ground: ClassVar[Limits] = {
        "grade": GRADE,
        "application_factor": LOADS["application_factor"],
        "face_load_factor": LOADS["face_load_factor"],
        "mass": LOADS["mass"],
        "life": FLANKS["life"],
        "flank_roughness": FLANKS["roughness"],
        "mean_roughness": SCUFFING["roughness"],
        "Z_X": FLANKS["Z_X"],
        **{name: FACE[name] for name in ("shaft", "B_1", "B_2")},
        **{f"required.{name}": REQUIRED for name in ("S_H", "S_F", "S_S")},
    }

    accuracy_grade: int = key("accuracy grade of both gears by ISO 1328-1:1995", of="grade", example=6)
    tolerance_shares: SharesSection | None = key(
        "what the gears have of the tolerances of this grade; all of each if left out, as ratings have it",
        None,
        of="shares",
        such_as={"f_pb": 0.5, "f_falpha": 0.5, "f_Hbeta": 0.5},
    )
    K_A: float = key(
        "application factor; 1 of a torque that is the maximum already", of="application_factor", example=1.25
    )
    life_h: float | None = key(
        "time under load at the torque of [operating]; that of the spectrum if left out",
        None,
        of="life",
        example=20000,
    )
    flank_Rz_um: float | None = key(
        "roughness Rz of the flanks, mean of both gears; that of [roughness] if left out, or 6 Ra",
        None,
        of="flank_roughness",
        example=4.8,
    )
    flank_Ra_um: float | None = key(
        "roughness Ra of the flanks, mean of both gears, which scuffing needs; that of [roughness] if left out, "
        "or Rz/6",
        None,
        of="mean_roughness",
        such_as=0.8,
    )
    K_Hbeta: float | None = key(
        "face-load factor where it is known; method C of ISO 6336-1 with the next three keys if left out",
        None,
        of="face_load_factor",
        such_as=1.15,
    )
    shaft_term: float = key(
        "K' l s/d_1^2 (d_1/d_sh)^4 of method C: distance l of the bearings, offset s of the pinion, diameter d_sh of "
        "its shaft; 0 of a pinion midway between its bearings",
        0.0,
        of="shaft",
    )
    B_1: float = key(
        "what modifications along the face leave of the shaft's deflection, by method C; 1 without", 1.0
    )
    B_2: float = key("what they leave of the helix slope deviations, by method C", 1.0)
    Z_X: float = key("size factor of the contact stress", 1.0)
    pitting_permitted: bool = key("whether limited pitting is permitted", False)
    reduced_mass_kg_per_m: float | None = key(
        "reduced mass m_red per length of face; by the sizes of the gears if left out",
        None,
        of="mass",
        such_as=9.7,
    )
    required_S_H: float = key(
        "safety against pitting that is required, as agreed", 1.0, of="required.S_H", shown=True
    )
    required_S_F: float = key("safety against breakage that is required", 1.4, of="required.S_F", shown=True)
    required_S_S: float = key("safety against scuffing that is required", 1.5, of="required.S_S", shown=True)
    pinion: RatedGearSection = key(
        "steel and fillets of the pinion",
        example={"steel": "Eh", "sigma_Hlim_MPa": 1500, "sigma_Flim_MPa": 430, "root_Rz_um": 20.0},
    )
    wheel: RatedGearSection | None = key(
        "the same of the wheel; as the pinion if left out",
        None,
        such_as={"steel": "Eh", "sigma_Hlim_MPa": 1500, "sigma_Flim_MPa": 430, "root_Rz_um": 20.0},
    )
    oil: RatedOilSection | None = key(
        "oil by its data sheet; that of [lubricant] if left out, which must then have a grade",
        None,
        such_as={"nu_40_mm2_per_s": 220, "nu_100_mm2_per_s": 19, "temperature_C": 80},
    )
    scuffing: ScuffingSection | None = key(
        "test by which scuffing is rated; scuffing is left out without it", None, such_as={"T_1T_Nm": 714.2}
    )
    spectrum: Steps = key(
        "steps of a load spectrum, for Miner's sum at the required safeties; none if left out",
        (),
        such_as=({"torque_Nm": 600, "speed_rpm": 2000, "duration_h": 5000},),
        max_length=MOST_STEPS,
    )

    @property
    def each(self) -> tuple[RatedGearSection, RatedGearSection]:
        """Of pinion and wheel."""
        return self.pinion, self.pinion if self.wheel is None else self.wheel

    @field_validator("accuracy_grade", mode="before")
    @classmethod
    def _a_grade(cls, grade: object) -> object:
        least, most = GRADES
        if isinstance(grade, int) and not least <= grade <= most:
            allowed = f"must be a whole number, at least {least} and at most {most}"
            raise refused(
                allowed, "ISO 1328-1:1995 has these grades; 6 is usual for ground gears", value=f"{grade}"
            )
        return grade

    @model_validator(mode="after")
    def _a_life(self) -> RatingSection:
        if self.life_h is None and not self.spectrum:
            raise refused("is required without a spectrum", "Give the time under load", key="life_h")
        if self.spectrum and not any(step.torque_Nm > 0.0 for step in self.spectrum):
            raise refused(
                "must have a step with torque", "Give torque, speed and time of each", key="spectrum"
            )
        return self
