"""Keys of the pair's torsional vibration."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from base import Limit
from dynamics.limits import OSCILLATOR as LIMITS
from flankfilm.scene.key import key
from flankfilm.scene.section import Limits, Section, refused

Positive = Annotated[float, Field(gt=0)]
TwoNumbers = Annotated[tuple[float, float], Field(strict=False)]
Several = Annotated[tuple[Positive, ...], Field(strict=False)]

FASTEST = 1e7
"""Upper end of a range of speeds [rpm], or of frequencies."""

DIMENSIONLESS = ("mean_force", "error_amplitude", "half_backlash")
PHYSICAL = ("error_amplitude_um", "length_scale_um")
"""Keys of which those of one kind alone are given."""

OSCILLATOR = ("damping_ratio", "error_phase_deg", "one_sided", *DIMENSIONLESS, *PHYSICAL)
"""Keys that the oscillator takes as they are, in SI."""

_NUMBER = Limit(0.0, 1e6)
"""Of a dimensionless quantity, to catch a number with a unit."""

_INERTIA = Limit(0.0, 1e9, "kg m2")


class ExtraInertia(Section):
    """Moments of inertia that turn with the gears."""

    ground: ClassVar[Limits] = {"pinion": _INERTIA, "wheel": _INERTIA}

    pinion: float = key("of what turns with the pinion, in kg m2", 0.0, shown=True)
    wheel: float = key("of what turns with the wheel, in kg m2", 0.0, shown=True)

    @property
    def each(self) -> tuple[float, float]:
        """Of pinion and wheel."""
        return self.pinion, self.wheel


class SpeedRange(Section):
    """Range of pinion speed, or of the dimensionless mesh frequency."""

    speed_rpm: TwoNumbers | None = key("from and to, speed of the pinion", None, such_as=(500, 30000))
    frequency: TwoNumbers | None = key(
        "from and to, mesh frequency over the natural one, instead of the speed", None, such_as=(0.1, 2.1)
    )

    @model_validator(mode="after")
    def _one_range(self) -> SpeedRange:
        if len(self.given("speed_rpm", "frequency")) != 1:
            raise refused("must have either speed_rpm = [from, to] or frequency = [from, to]")
        low, high = self.ends
        if not 0 < low < high <= FASTEST:
            raise refused(f"must rise from above 0, to at most {FASTEST:g}", value=f"[{low:g}, {high:g}]")
        return self

    @property
    def ends(self) -> tuple[float, float]:
        """From and to, of the one that was given."""
        return self.speed_rpm or self.frequency or (0.0, 0.0)


class SweepSection(SpeedRange):
    """Sweep up and down."""

    points: int = key("speeds or frequencies of the sweep", 400, limit=Limit(2, 100_000, whole=True))


class DiagramSection(SpeedRange):
    """Bifurcation diagram: every branch of periodic motions, stable or not."""

    max_period: int = key("longest period of a motion, in mesh periods", 8, limit=Limit(1, 64, whole=True))
    searches: int = key(
        "places in the range from which branches are looked for", 9, limit=Limit(1, 1000, whole=True)
    )


class DynamicsSection(Section):
    """Torsional vibration of the pair; physical keys, or the dimensionless ones of the oscillator."""

    ground: ClassVar[Limits] = {
        "damping_ratio": replace(LIMITS["damping_ratio"], high=5.0),
        "error_phase": Limit(-2.0 * math.pi, 2.0 * math.pi, "rad"),
        "length_scale": Limit.above(0.0, 1.0, "m"),
        "mean_force": _NUMBER,
        "error_amplitude": _NUMBER,
        "half_backlash": _NUMBER,
    }

    fourier_order: Annotated[int, Field(ge=1, le=50)] | Literal["auto"] = key(
        'harmonics of the mesh stiffness, or "auto": as few as the tolerance allows', 1, example="auto"
    )
    stiffness: Literal["secant", "tangent"] = key(
        "force over deflection, or the slope for small vibration", "secant", shown=True
    )
    stiffness_reference: Literal["body", "bore", "teeth"] | None = key(
        "what the deflection by finite elements is measured against: the turn of the bodies, whose inertia "
        "balances the torque, of the bores, or of the root circles; body if left out",
        None,
        such_as="bore",
    )
    damping_ratio: float = key("damping of the mesh over the critical one", 0.05, shown=True)
    error_amplitude_um: float | None = key(
        "unloaded transmission error; the deflection is in the stiffness; 0 if left out",
        None,
        of="error_amplitude",
        limit=Limit(0.0, 0.01, "m"),
        example=10,
    )
    error_phase_deg: float = key("phase of this error when a pair is at A", 0.0, example=0)
    extra_inertia_kg_m2: ExtraInertia = key(
        "moments of inertia that turn with the gears, on their bores",
        ExtraInertia(),
        example={"pinion": 0.0, "wheel": 0.0},
    )
    length_scale_um: float | None = key(
        "length of the dimensionless form; if left out such that the mean force is 0.1", None, such_as=200
    )
    mean_force: float | None = key(
        "dimensionless, with the next two instead of the physical keys", None, such_as=0.1
    )
    error_amplitude: float | None = key(
        "dimensionless amplitude of the transmission error", None, such_as=0.2
    )
    half_backlash: float | None = key("dimensionless half of the backlash", None, such_as=0.2)
    one_sided: bool = key("whether there is no second flank, as with much backlash", False, shown=True)
    sweep: SweepSection | None = key(
        "range of the wanted sweep up and down", None, example={"speed_rpm": (500, 30000), "points": 400}
    )
    diagram: DiagramSection | None = key(
        "range of the wanted diagram of every branch, stable or not",
        None,
        example={"speed_rpm": (500, 30000), "max_period": 4, "searches": 9},
    )
    portraits_rpm: Several = key(
        "speeds of phase portraits; chosen from the sweep if left out", (), such_as=(9000,), max_length=12
    )
    portraits_frequency: Several = key(
        "mesh frequencies of phase portraits, of the dimensionless form", (), such_as=(0.6,), max_length=12
    )

    @property
    def dimensionless(self) -> bool:
        """Whether force, error and backlash are given in the oscillator's own units."""
        return self.mean_force is not None

    @model_validator(mode="after")
    def _one_set_of_units(self) -> DynamicsSection:
        own = self.given(*DIMENSIONLESS)
        if not own:
            return self
        if missing := [name for name in DIMENSIONLESS if name not in own]:
            raise refused(f"must have {', '.join(missing)} too in the dimensionless form")
        if physical := self.given(*PHYSICAL):
            raise refused(f"must not have {', '.join(physical)} beside the dimensionless {', '.join(own)}")
        for name, ranged in (("sweep", self.sweep), ("diagram", self.diagram)):
            if ranged is not None and ranged.speed_rpm is not None:
                raise refused(
                    f"must have {name} = {{ frequency = [from, to] }} in the dimensionless form, not speed_rpm"
                )
        if self.portraits_rpm:
            raise refused("must have portraits_frequency in the dimensionless form, not portraits_rpm")
        return self
