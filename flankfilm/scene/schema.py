"""The scene file: sections and keys with their units, ranges and defaults.

A key carries its unit (`module_mm`); values become SI in `flankfilm.build`. Ranges are wide
enough for every gear that is made and narrow enough to catch a wrong unit.
"""

from __future__ import annotations

import itertools
from typing import Annotated, Literal

from pydantic import Field, model_validator

from flankfilm.scene.film_schema import FilmSection, LubricantSection, RoughnessSection
from flankfilm.scene.section import Section

Want = Literal[
    "geometry",
    "closed-forms",
    "stiffness",
    "torques",
    "revolution",
    "root-stress",
    "film",
    "fourier",
    "sweep",
    "diagram",
    "vtk",
    "report",
]
Positive = Annotated[float, Field(gt=0)]
TwoNumbers = Annotated[tuple[float, float], Field(strict=False)]


class RackSection(Section):
    """Basic rack in modules, for racks outside ISO 53."""

    h_aP: float = Field(gt=0, le=3, description="addendum, times the module")
    h_fP: float = Field(gt=0, le=3, description="dedendum, times the module")
    rho_fP: float = Field(gt=0, le=3, description="tip radius of the rack, times the module")
    alpha_deg: float = Field(default=20.0, ge=10, le=35, description="pressure angle")


class ReliefSection(Section):
    """Tip relief: material removed normal to the flank."""

    amount_um: float = Field(ge=0, le=5000, description="at the tip")
    length_mm: float = Field(gt=0, le=500, description="along the path of contact, from the tip")
    form: Literal["linear", "parabolic"] = "linear"


class ProfileSection(Section):
    """Deviation of all flanks of a gear from the involute, a smooth curve through points."""

    roll_deg: Annotated[tuple[float, ...], Field(strict=False, min_length=2, max_length=10_000)]
    material_um: Annotated[tuple[float, ...], Field(strict=False, min_length=2, max_length=10_000)]

    @model_validator(mode="after")
    def _pairs_that_rise(self) -> ProfileSection:
        if len(self.roll_deg) != len(self.material_um):
            raise ValueError(
                f"{len(self.roll_deg)} roll_deg but {len(self.material_um)} material_um; give as many of each"
            )
        if any(b <= a for a, b in itertools.pairwise(self.roll_deg)):
            raise ValueError("roll_deg must rise from point to point")
        return self


class DeviationsSection(Section):
    """Deviations of one gear's flanks: a profile for all, and the pitches of its teeth (ISO 1328)."""

    profile: ProfileSection | None = None
    single_pitch_um: Annotated[tuple[float, ...], Field(strict=False)] | None = None
    cumulative_pitch_um: Annotated[tuple[float, ...], Field(strict=False)] | None = None

    @model_validator(mode="after")
    def _one_kind_of_pitch(self) -> DeviationsSection:
        if self.single_pitch_um is not None and self.cumulative_pitch_um is not None:
            raise ValueError("give single_pitch_um or cumulative_pitch_um, not both")
        return self


class HubSection(Section):
    """Rigid hub of a gear on its shaft, bearings and shaft yielding under it."""

    radial_stiffness_N_per_m: float | None = Field(default=None, gt=0, le=1e15)
    torsional_stiffness_Nm_per_rad: float | None = Field(default=None, gt=0, le=1e15)
    hub_mm: float | None = Field(default=None, gt=0, le=1e6, description="diameter held; the bore's")


class GearSection(Section):
    """One gear."""

    teeth: int = Field(ge=5, le=10_000)
    profile_shift: float = Field(default=0.0, ge=-0.8, le=1.5, description="times the module")
    bore_mm: float | None = Field(default=None, gt=0, le=1e6, description="diameter; half the root diameter")
    tip_alteration: float = Field(default=0.0, ge=-1, le=1, description="times the module")
    thickness_allowance_um: float = Field(default=0.0, ge=0, le=50_000, description="thins the tooth")
    tip_relief: ReliefSection | None = None
    tip_chamfer_mm: float = Field(default=0.0, ge=0, le=100)
    tip_rounding_um: float = Field(default=0.0, ge=0, le=50_000, description="radius of the tip's edges")
    deviations: DeviationsSection | None = None
    hub: HubSection | None = None

    @model_validator(mode="after")
    def _a_pitch_for_each_tooth(self) -> GearSection:
        some = self.deviations
        for name in ("single_pitch_um", "cumulative_pitch_um"):
            values = None if some is None else getattr(some, name)
            if values is not None and len(values) != self.teeth:
                raise ValueError(f"deviations.{name} has {len(values)} values for {self.teeth} teeth")
        return self


class PairSection(Section):
    """Geometry of the pair."""

    module_mm: float = Field(ge=0.01, le=100)
    face_width_mm: float = Field(ge=0.01, le=10_000)
    rack: Literal["ISO 53 A", "ISO 53 B", "ISO 53 C", "ISO 53 D"] | RackSection = "ISO 53 A"
    pinion: GearSection
    wheel: GearSection
    centre_distance_mm: float | None = Field(default=None, gt=0, le=1e6)
    backlash_um: float | None = Field(default=None, ge=0, le=50_000, description="normal backlash")


class ElasticSection(Section):
    """Elastic constants and density of one material."""

    youngs_modulus_GPa: float = Field(ge=0.01, le=2000)
    poisson_ratio: float = Field(ge=0, lt=0.5)
    density_kg_per_m3: float = Field(default=7850.0, ge=100, le=30_000)


class MaterialSection(Section):
    """One material for both gears, or one each in `pinion` and `wheel`."""

    youngs_modulus_GPa: float | None = Field(default=None, ge=0.01, le=2000)
    poisson_ratio: float | None = Field(default=None, ge=0, lt=0.5)
    density_kg_per_m3: float | None = Field(default=None, ge=100, le=30_000)
    pinion: ElasticSection | None = None
    wheel: ElasticSection | None = None

    @model_validator(mode="after")
    def _one_way_of_saying_it(self) -> MaterialSection:
        common = self.youngs_modulus_GPa is not None and self.poisson_ratio is not None
        partly = any(
            v is not None for v in (self.youngs_modulus_GPa, self.poisson_ratio, self.density_kg_per_m3)
        )
        each = self.pinion is not None and self.wheel is not None
        if not common and not each:
            raise ValueError(
                "give youngs_modulus_GPa and poisson_ratio for both gears, "
                "or both [material.pinion] and [material.wheel]"
            )
        if partly and (self.pinion is not None or self.wheel is not None):
            raise ValueError("give one material for both gears or one each, not both ways at once")
        return self


class OperatingSection(Section):
    """Load and speed; the pinion drives, anticlockwise."""

    pinion_torque_Nm: float = Field(ge=1e-9, le=1e9)
    pinion_speed_rpm: float | None = Field(default=None, ge=1e-6, le=1e6)
    friction: float = Field(default=0.0, ge=0, le=0.5, description="coefficient; tilts the forces")
    torques_Nm: Annotated[
        tuple[Annotated[float, Field(ge=1e-9, le=1e9)], ...], Field(strict=False, max_length=1000)
    ] = ()
    pitches: int | None = Field(default=None, ge=1, le=100_000, description="of a revolution; pinion's teeth")
    first_teeth: Annotated[tuple[int, int], Field(strict=False)] = (0, 0)


class StiffnessSection(Section):
    """Where the mesh stiffness comes from."""

    model: Literal["fem", "ishikawa", "weber-banaschek", "potential-energy", "given", "auto"] = "fem"
    pairs: Literal["coupled", "independent"] = "coupled"
    plane: Literal["strain", "stress"] = "strain"
    contact_beyond_path: bool = True
    mean_N_per_m: float | None = Field(default=None, ge=1.0, le=1e15)
    amplitudes: Annotated[tuple[float, ...], Field(strict=False, max_length=50)] | None = None
    phases_deg: Annotated[tuple[float, ...], Field(strict=False, max_length=50)] | None = None

    @model_validator(mode="after")
    def _given_means_given(self) -> StiffnessSection:
        listed = [n for n in ("mean_N_per_m", "amplitudes", "phases_deg") if getattr(self, n) is not None]
        if self.model != "given" and listed:
            raise ValueError(f'{", ".join(listed)} belong to model = "given" alone; leave them out')
        if self.model == "given":
            if self.amplitudes is None:
                raise ValueError('model = "given" needs amplitudes, each over the mean, such as [0.18]')
            if self.phases_deg is not None and len(self.phases_deg) != len(self.amplitudes):
                raise ValueError(
                    f"{len(self.amplitudes)} amplitudes but {len(self.phases_deg)} phases_deg; give as many of each"
                )
        return self


class ExtraInertia(Section):
    """Moments of inertia that turn with the gears."""

    pinion: float = Field(default=0.0, ge=0, le=1e9)
    wheel: float = Field(default=0.0, ge=0, le=1e9)


class SpeedRange(Section):
    """Range of pinion speed, or of the dimensionless mesh frequency."""

    speed_rpm: TwoNumbers | None = None
    frequency: TwoNumbers | None = None

    @model_validator(mode="after")
    def _one_range(self) -> SpeedRange:
        given = [r for r in (self.speed_rpm, self.frequency) if r is not None]
        if len(given) != 1:
            raise ValueError("give either speed_rpm = [from, to] or frequency = [from, to]")
        low, high = given[0]
        if not 0 < low < high <= 1e7:
            raise ValueError(f"the range [{low:g}, {high:g}] must rise from above 0, to at most 1e7")
        return self


class SweepSection(SpeedRange):
    """Sweep up and down."""

    points: int = Field(default=400, ge=2, le=100_000)


class DiagramSection(SpeedRange):
    """Bifurcation diagram: every branch of periodic motions, stable or not."""

    max_period: int = Field(default=8, ge=1, le=64)
    searches: int = Field(default=9, ge=1, le=1000)


class DynamicsSection(Section):
    """Torsional vibration of the pair; physical keys, or the dimensionless ones of the oscillator."""

    fourier_order: Annotated[int, Field(ge=1, le=50)] | Literal["auto"] = 1
    damping_ratio: float = Field(default=0.05, ge=0, le=5)
    stiffness: Literal["secant", "tangent"] = "secant"
    error_amplitude_um: float | None = Field(default=None, ge=0, le=10_000)
    error_phase_deg: float = Field(default=0.0, ge=-360, le=360)
    extra_inertia_kg_m2: ExtraInertia = ExtraInertia()
    length_scale_um: float | None = Field(default=None, gt=0, le=1e6)
    mean_force: float | None = Field(default=None, ge=0, le=1e6)
    error_amplitude: float | None = Field(default=None, ge=0, le=1e6)
    half_backlash: float | None = Field(default=None, ge=0, le=1e6)
    one_sided: bool = False
    sweep: SweepSection | None = None
    diagram: DiagramSection | None = None
    portraits_rpm: Annotated[tuple[Positive, ...], Field(strict=False, max_length=12)] = ()
    portraits_frequency: Annotated[tuple[Positive, ...], Field(strict=False, max_length=12)] = ()

    @property
    def dimensionless(self) -> bool:
        """Whether force, error and backlash are given in the oscillator's own units."""
        return self.mean_force is not None

    @model_validator(mode="after")
    def _one_set_of_units(self) -> DynamicsSection:
        own = {n: getattr(self, n) for n in ("mean_force", "error_amplitude", "half_backlash")}
        missing = [n for n, v in own.items() if v is None]
        if len(missing) not in (0, len(own)):
            raise ValueError(f"the dimensionless form also needs {', '.join(missing)}")
        physical = [n for n in ("error_amplitude_um", "length_scale_um") if getattr(self, n) is not None]
        if physical and not missing:
            raise ValueError(
                f"{', '.join(physical)} and the dimensionless {', '.join(own)} exclude each other"
            )
        for name, ranged in (("sweep", self.sweep), ("diagram", self.diagram)):
            if not missing and ranged is not None and ranged.speed_rpm is not None:
                raise ValueError(
                    f"the dimensionless form needs {name} = {{ frequency = [from, to] }}, not speed_rpm"
                )
        if not missing and self.portraits_rpm:
            raise ValueError("the dimensionless form needs portraits_frequency, not portraits_rpm")
        return self


class Scene(Section):
    """A whole scene file."""

    title: str = Field(default="", max_length=200)
    wants: Annotated[tuple[Want, ...], Field(strict=False, min_length=1, max_length=20)]
    tolerance: float = Field(default=0.005, ge=1e-5, le=0.4)
    pair: PairSection | None = None
    material: MaterialSection | None = None
    operating: OperatingSection | None = None
    lubricant: LubricantSection | None = None
    roughness: RoughnessSection | None = None
    stiffness: StiffnessSection = StiffnessSection()
    film: FilmSection = FilmSection(model="none")
    dynamics: DynamicsSection | None = None
