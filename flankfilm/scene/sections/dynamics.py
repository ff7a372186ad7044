"""Keys of the pair's torsional vibration."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from base import Limit
from dynamics.model.limits import OSCILLATOR as LIMITS
from flankfilm.scene.sections.error_curve import AMPLITUDE_UM, PHASE_DEG, ErrorCurveSection, harmonics
from flankfilm.scene.sections.key import BY_ELEMENTS, Traits, key, within
from flankfilm.scene.sections.section import Limits, Section, refused

Positive = Annotated[float, Field(gt=0)]
TwoNumbers = Annotated[tuple[float, float], Field(strict=False)]
Several = Annotated[tuple[Positive, ...], Field(strict=False)]

FASTEST = 1e7
"""Upper end of a range of speeds [rpm], or of frequencies."""

DIMENSIONLESS = ("mean_force", "error_amplitude", "half_backlash")
PHYSICAL = ("error_amplitude_um", "error_curve", "length_scale_um")
"""Keys of which those of one kind alone are given."""

OSCILLATOR = (
    "damping_ratio",
    "free_damping_ratio",
    "error_phase_deg",
    "one_sided",
    *DIMENSIONLESS,
    "error_amplitude_um",
    "length_scale_um",
)
"""Keys that the oscillator takes unchanged, in SI; amplitudes and phases of an error are lists."""

_NUMBER = Limit(0.0, 1e6)
"""Of a dimensionless quantity, to catch a number with a unit."""

_DAMPING = replace(LIMITS["damping_ratio"], high=5.0)

BY_FILM = "film"
"""Damping ratio that is the films'."""

ON_RIGID_SHAFTS = Traits(beside_shafts="is of the pair on rigid shafts, which [shafts] excludes")

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
        if len(self.given_keys("speed_rpm", "frequency")) != 1:
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


class RunUpSection(SpeedRange):
    """Run-up, evenly in time, and coast-down."""

    seconds: float | None = key(
        "time of the run-up; of 8000 mesh periods if neither is given",
        None,
        such_as=5,
        limit=Limit.above(0.0, 1e5, "s"),
    )
    periods: int | None = key(
        "mesh periods of the run-up, instead", None, such_as=8000, limit=Limit(16, 2_000_000, whole=True)
    )

    @model_validator(mode="after")
    def _one_time(self) -> RunUpSection:
        if len(self.given_keys("seconds", "periods")) == 2:
            raise refused("must have seconds or periods, not both")
        if self.seconds is not None and self.frequency is not None:
            raise refused("must have periods with frequency = [from, to], which knows no seconds")
        return self


class BearingForcesSection(SpeedRange):
    """Bearing forces of a helical pair over the speed, by gears that move and tilt in space."""

    points: int = key("speeds or frequencies looked at", 100, limit=Limit(2, 100_000, whole=True))
    harmonics: int = key("highest harmonic of the mesh", 5, limit=Limit(2, 20, whole=True))


class DynamicsSection(Section):
    """Torsional vibration of the pair; physical keys, or the dimensionless ones of the oscillator."""

    ground: ClassVar[Limits] = {
        "free_damping_ratio": _DAMPING,
        "length_scale": Limit.above(0.0, 1.0, "m"),
        "mean_force": _NUMBER,
        "half_backlash": _NUMBER,
    }

    fourier_order: Annotated[int, Field(ge=1, le=50)] | Literal["auto"] = key(
        'harmonics of the mesh stiffness, or "auto": as few as the tolerance allows (with shafts by the pair on rigid '
        "ones)",
        "auto",
        shown=True,
    )
    stiffness: Literal["secant", "tangent"] = key(
        "force over deflection, or the slope for small vibration", "secant", shown=True
    )
    stiffness_reference: Literal["body", "bore", "teeth"] | None = key(
        "older name of stiffness.reference, which counts for all deflections of the scene",
        None,
        such_as="bore",
        traits=BY_ELEMENTS,
    )
    damping_ratio: Annotated[float, within(_DAMPING)] | Literal["film"] = key(
        'damping of the mesh over the critical one, or "film": the damping of its oil films alone',
        0.05,
        shown=True,
    )
    free_damping_ratio: float | None = key(
        "damping ratio in the backlash, where no teeth press and no film damps; as in contact if left out",
        None,
        such_as=0.005,
    )
    error_amplitude_um: Annotated[tuple[float, ...], harmonics(AMPLITUDE_UM)] | None = key(
        "unloaded transmission error, its first harmonic or a list of harmonics; the deflection is in the stiffness; 0 "
        "if left out",
        None,
        of="error_amplitude",
        example=0,
    )
    error_phase_deg: Annotated[tuple[float, ...], harmonics(PHASE_DEG)] = key(
        "phase of this error when a pair is at A, one for each harmonic",
        (0.0,),
        of="error_phase",
        example=0,
    )
    error_curve: ErrorCurveSection | Literal["unloaded"] | None = key(
        "instead of them: the error over a base pitch, in a file or by points, or unloaded: that of the scene's own "
        "reliefs and mean deviations, by the geometry",
        None,
        such_as="error.csv",
    )
    error_order: Annotated[int, Field(ge=1, le=1000)] | Literal["auto"] = key(
        'harmonics of that curve, or "auto": as few as the tolerance allows', "auto", such_as="auto"
    )
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
    error_amplitude: Annotated[tuple[float, ...], harmonics(_NUMBER)] | None = key(
        "dimensionless amplitude of the transmission error, or a list of its harmonics", None, such_as=0.2
    )
    half_backlash: float | None = key("dimensionless half of the backlash", None, such_as=0.2)
    one_sided: bool = key("whether the back flank never touches, as with large backlash", False, shown=True)
    sweep: SweepSection | None = key(
        "range of the wanted sweep up and down", None, example={"speed_rpm": (500, 30000), "points": 400}
    )
    diagram: DiagramSection | None = key(
        "range of the wanted diagram of every branch, stable or not",
        None,
        example={"speed_rpm": (500, 30000), "max_period": 4, "searches": 9},
    )
    run_up: RunUpSection | None = key(
        "range of the wanted run-up and coast-down", None, such_as={"speed_rpm": (500, 30000), "seconds": 5}
    )
    bearing_forces: BearingForcesSection | None = key(
        "range of the wanted bearing forces of a helical pair",
        None,
        such_as={"speed_rpm": (500, 6000), "points": 100, "harmonics": 5},
    )
    portraits_rpm: Several = key(
        "speeds of phase portraits; chosen from the sweep if left out",
        (),
        such_as=(9000,),
        max_length=12,
        traits=ON_RIGID_SHAFTS,
    )
    portraits_frequency: Several = key(
        "mesh frequencies of phase portraits, of the dimensionless form",
        (),
        such_as=(0.6,),
        max_length=12,
        traits=ON_RIGID_SHAFTS,
    )

    @property
    def known_damping(self) -> float:
        """Maximum damping ratio before anything is computed: 0 for films', too small to decide steps of time."""
        pressed = 0.0 if isinstance(self.damping_ratio, str) else self.damping_ratio
        return max(pressed, self.free_damping_ratio or 0.0)

    @property
    def ranges(self) -> dict[str, SpeedRange]:
        """Ranges of the speed, or of the mesh frequency, that are given, by their keys."""
        values = ((name, getattr(self, name)) for name in type(self).model_fields)
        return {name: value for name, value in values if isinstance(value, SpeedRange)}

    @property
    def dimensionless(self) -> bool:
        """Whether force, error and backlash are given in the oscillator's own units."""
        return self.mean_force is not None

    @model_validator(mode="after")
    def _one_error(self) -> DynamicsSection:
        amplitudes = self.error_amplitude or self.error_amplitude_um or (0.0,)
        if self.error_curve is not None:
            if amplitude_keys := self.given_keys("error_amplitude", "error_amplitude_um"):
                raise refused(f"must not have {amplitude_keys[0]} beside error_curve; leave one of them out")
            if any(self.error_phase_deg):
                raise refused("must not have error_phase_deg beside error_curve, which has separate phases")
        elif len(self.error_phase_deg) != len(amplitudes) and self.error_phase_deg != (0.0,):
            counts = f"{len(amplitudes)} and {len(self.error_phase_deg)}"
            raise refused(f"must have as many error_phase_deg as amplitudes of the error, not {counts}")
        return self

    @model_validator(mode="after")
    def _one_set_of_units(self) -> DynamicsSection:
        own = self.given_keys(*DIMENSIONLESS)
        if not own:
            return self
        if missing := [name for name in DIMENSIONLESS if name not in own]:
            raise refused(f"must have {', '.join(missing)} too in the dimensionless form")
        if physical := self.given_keys(*PHYSICAL):
            raise refused(f"must not have {', '.join(physical)} beside the dimensionless {', '.join(own)}")
        for name, ranged in self.ranges.items():
            if ranged.speed_rpm is not None:
                raise refused(
                    f"must have {name} = {{ frequency = [from, to] }} in the dimensionless form, not speed_rpm"
                )
        if self.portraits_rpm:
            raise refused("must have portraits_frequency in the dimensionless form, not portraits_rpm")
        return self
