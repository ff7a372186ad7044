"""Keys of load and speed, and of where the mesh stiffness comes from."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, model_validator

from base import Limit
from base.units import factor
from flankfilm.scene.sections.key import BY_ELEMENTS, key, within
from flankfilm.scene.sections.section import Limits, Section, refused

TORQUE = Limit(-1e9, 1e9, "N m")

POWER = Limit(-1e9, 1e9, "W")

SAME = 1e-9
"""Relative difference of a given torque from that of the power which is rounding."""

LEAST = 1e-9
"""Minimum torque of either sign [N m]."""

AMPLITUDE = Limit(-1000.0, 1000.0)
"""Of a given stiffness over its mean: no mesh has 1, and no motion is followed with a million."""

GIVEN = ("mean_N_per_m", "amplitudes", "phases_deg")
"""Keys of a given stiffness."""


def _number(value: object) -> float:
    """Finite number of a key that is not checked yet; nan for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return math.nan
    return float(value)


def _torque(power_kW: float, speed_rpm: float) -> float:
    """Torque [N m] of a power at a speed."""
    return power_kW * factor("kW") / (speed_rpm * factor("rpm"))


class OperatingSection(Section):
    """Load and speed; the pinion turns anticlockwise."""

    ground: ClassVar[Limits] = {
        "pinion_torque": TORQUE,
        "pinion_speed": Limit(1e-6 * factor("rpm"), 1e6 * factor("rpm"), "rad/s"),
        "friction": Limit(0.0, 0.5),
        "pitches": Limit(1, 100_000, whole=True),
    }

    pinion_torque_Nm: float = key(
        "torque on the pinion, which turns anticlockwise; negative where the wheel drives, on the back flanks",
        example=600,
    )
    pinion_speed_rpm: float | None = key("speed of the pinion, which the film needs", None, example=2000)
    power_kW: float | None = key(
        "power into the pinion, in place of pinion_torque_Nm, which then follows from pinion_speed_rpm; negative "
        "where the wheel drives",
        None,
        of=None,
        limit=POWER,
        such_as=125,
    )
    friction: float = key(
        "coefficient of friction, which tilts the forces against the sliding; wanted losses compute their friction"
        " separately",
        0.0,
        such_as=0.05,
        traits=BY_ELEMENTS,
    )
    torques_Nm: Annotated[tuple[Annotated[float, within(TORQUE)], ...], Field(strict=False)] = key(
        "torques on the pinion, of the wanted torques, of either sign; none if left out",
        (),
        such_as=(100, 300, 600),
        max_length=1000,
    )
    pitches: int | None = key(
        "base pitches of the wanted revolution; one turn of the pinion if left out", None, such_as=36
    )
    first_teeth: Annotated[tuple[int, int], Field(strict=False)] = key(
        "numbers of the teeth of pinion and wheel that meet at A first", (0, 0)
    )

    @model_validator(mode="before")
    @classmethod
    def _torque_of_power(cls, raw: Any) -> Any:
        """Fill in the torque that follows from power and speed."""
        if not isinstance(raw, dict) or raw.get("power_kW") is None or "pinion_torque_Nm" in raw:
            return raw
        power, speed = _number(raw["power_kW"]), _number(raw.get("pinion_speed_rpm"))
        # where they are faulty the scene is refused for them, and not for a torque that nobody gave
        return {
            **raw,
            "pinion_torque_Nm": _torque(power, speed) if speed > 0.0 and math.isfinite(power) else 1.0,
        }

    @model_validator(mode="after")
    def _power_over_speed(self) -> OperatingSection:
        if self.power_kW is None:
            return self
        if self.pinion_speed_rpm is None:
            raise refused("is required by power_kW", "Give the pinion's speed", key="pinion_speed_rpm")
        follows, value = _torque(self.power_kW, self.pinion_speed_rpm), self.pinion_torque_Nm
        if not math.isclose(value, follows, rel_tol=SAME):
            allowed = f"must be {follows:.6g} by power_kW and pinion_speed_rpm"
            raise refused(allowed, "Give torque or power", key="pinion_torque_Nm", value=f"{value:g}")
        return self

    @model_validator(mode="after")
    def _some_torque(self) -> OperatingSection:
        for path, value in (
            ("pinion_torque_Nm", self.pinion_torque_Nm),
            *((f"torques_Nm[{k}]", torque) for k, torque in enumerate(self.torques_Nm)),
        ):
            if abs(value) < LEAST:
                allowed = f"must be at least {LEAST:g} N m, or at most {-LEAST:g} N m where the wheel drives"
                remedy = "Without torque no flank bears but those of pressed teeth: fem.mesh_cycle(pair, 0.0)"
                raise refused(allowed, remedy, key=path, value=f"{value:g}")
        return self


class StiffnessSection(Section):
    """Where the mesh stiffness comes from."""

    model: Literal["fem", "ishikawa", "weber-banaschek", "potential-energy", "given", "auto"] = key(
        "finite elements, a closed form, a given series, or the cheapest within the tolerance",
        "fem",
        shown=True,
    )
    pairs: Literal["coupled", "independent"] = key(
        "pairs of teeth that share their bodies, or stiffnesses of single pairs added", "coupled", shown=True
    )
    plane: Literal["strain", "stress"] = key(
        "plane strain or plane stress of the finite elements", "strain", shown=True
    )
    contact_beyond_path: bool | None = key(
        "whether loaded teeth may touch outside A..E with their tip edges; those of spur pairs if left out",
        None,
        such_as=True,
    )
    moving_contact: bool | None = key(
        "whether the deflection shifts the contacts of coupled finite elements along the flanks; plastics if left out",
        None,
        such_as=True,
        traits=BY_ELEMENTS,
    )
    reference: Literal["body", "bore", "teeth"] | None = key(
        "what every deflection and stiffness by finite elements is measured against: the rotation of the bodies, whose "
        "inertia balances the torque, of the bores, or of the root circles; body if left out",
        None,
        such_as="bore",
        traits=BY_ELEMENTS,
    )
    mean_N_per_m: float | None = key(
        "mean of a given stiffness; 1 if left out", None, limit=Limit(1.0, 1e15, "N/m"), such_as=7.6e8
    )
    amplitudes: Annotated[tuple[Annotated[float, within(AMPLITUDE)], ...], Field(strict=False)] | None = key(
        "harmonics of a given stiffness, each over the mean", None, such_as=(0.18,), max_length=50
    )
    phases_deg: Annotated[tuple[float, ...], Field(strict=False)] | None = key(
        "phases of these harmonics when a pair is at A; 0 if left out", None, such_as=(0.0,), max_length=50
    )

    @model_validator(mode="after")
    def _numbers_of_a_given_stiffness(self) -> StiffnessSection:
        if self.model != "given" and (listed := self.given_keys(*GIVEN)):
            raise refused(f'must not have {", ".join(listed)}, of model = "given" alone; leave them out')
        if self.model == "given":
            if self.amplitudes is None:
                raise refused(
                    'must have amplitudes with model = "given"', "Each over the mean, such as [0.18]"
                )
            if self.phases_deg is not None and len(self.phases_deg) != len(self.amplitudes):
                counts = f"{len(self.amplitudes)} and {len(self.phases_deg)}"
                raise refused(f"must have as many amplitudes as phases_deg, not {counts}")
        return self
