"""Keys of oil, roughness and film."""

from __future__ import annotations

import itertools
from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from base import Limit
from ehl.discrete.asperities import LIMITS as ROUGHNESS
from ehl.discrete.regimes import BOUNDARY, BOUNDARY_FRICTION
from ehl.oil.lubricant import LIMITS as OIL
from ehl.oil.lubricant import STRESS_LIMITS
from ehl.oil.oil_grades import LIMITS as GRADE
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.section import Limits, Section, refused

BY_NUMBERS = ("viscosity_Pa_s", "pressure_viscosity_per_GPa", "density_kg_per_m3", "roelands_z")
BY_GRADE = ("iso_vg", "viscosity_index", "base", "density_15_kg_per_m3")
SHEAR_AND_HEAT = (
    "viscosity_slope_per_K",
    "conductivity_W_per_m_K",
    "heat_capacity_J_per_kg_K",
    "thermal_expansion_per_K",
    "eyring_stress_MPa",
    "limiting_shear_ratio",
)
"""Keys of films with heat, of oils given either way."""

SUPPLIES = {"meniscus": ("meniscus_mm", "meniscus_half_widths"), "oil-layer": ("oil_layer_um",)}
"""Keys of which one gives the value of a supply."""

# the solver takes more, for contacts given by Moes' numbers and films that go to zero; what is made lies within these
_OIL = {
    "viscosity": Limit(1e-5, 1e3, "Pa s"),
    "pressure_viscosity": Limit(0.0, 1e-7, "1/Pa"),
    "density": Limit(100.0, 5000.0, "kg/m3"),
    "conductivity": Limit(1e-3, 10.0, "W/(m K)"),
    "heat_capacity": Limit(10.0, 1e5, "J/(kg K)"),
    "eyring_stress": Limit(1e4, 1e9, "Pa"),
    "limiting_shear_ratio": Limit(1e-3, 1.0),
}
_DRAWN = Limit(1e-9, 1e-4, "m")
_ROUGHNESS = {
    "deviation": Limit(1e-10, 1e-4, "m"),
    "mean": _DRAWN,
    "peaks": _DRAWN,
    "density": Limit(1e6, 1e15, "1/m2"),
    "tip_radius": Limit(1e-9, 0.1, "m"),
    "boundary_friction": BOUNDARY,
}
_Two = Annotated[tuple[float, float], Field(strict=False)]


class LubricantSection(Section):
    """Oil by its numbers at one temperature, or by its ISO grade and temperature."""

    ground = OIL | STRESS_LIMITS | GRADE | _OIL

    viscosity_Pa_s: float | None = key(
        "viscosity at temperature_C and ambient pressure; without that key, at the temperature of the flanks",
        None,
        example=0.075,
    )
    pressure_viscosity_per_GPa: float | None = key(
        "pressure-viscosity coefficient at ambient pressure", None, example=19.6
    )
    density_kg_per_m3: float | None = key("density at ambient pressure; 870 if left out", None, example=910)
    roelands_z: float | None = key(
        "Roelands' index; follows from the two numbers above if left out", None, such_as=0.54
    )
    viscosity_law: Literal["roelands", "barus", "constant"] = key(
        "growth of the viscosity with pressure", "roelands", of=None
    )
    compressible: bool = key("whether the density grows with pressure (Dowson and Higginson)", True)
    iso_vg: float | None = key(
        "grade instead of the numbers above: viscosity at 40 degC in mm2/s", None, of="vg", such_as=100
    )
    temperature_C: float | None = key(
        "temperature of the oil, required of a graded one; also of the flanks unless [heat] gives the gears' "
        "temperatures",
        None,
        celsius="temperature",
        such_as=60,
    )
    viscosity_index: float | None = key(
        "viscosity index of a graded oil, 140 to 250 of synthetic ones; 95 if left out", None, such_as=95
    )
    base: Literal["mineral", "pao", "ester", "pag"] | None = key(
        "kind of a graded oil, for density and pressure-viscosity; mineral if left out",
        None,
        such_as="mineral",
    )
    density_15_kg_per_m3: float | None = key(
        "density of a graded oil at 15 degC; typical of the base if left out", None, such_as=880
    )
    viscosity_slope_per_K: float | None = key(
        "decrease of the logarithm of viscosity per kelvin; if left out 0.04, or by ASTM D341 of a graded oil",
        None,
        such_as=0.04,
    )
    conductivity_W_per_m_K: float | None = key(
        "thermal conductivity; if left out 0.14, or typical of the base of a graded oil", None, such_as=0.14
    )
    heat_capacity_J_per_kg_K: float | None = key(
        "heat capacity; if left out 2000, or typical of the base of a graded oil", None, such_as=2000
    )
    thermal_expansion_per_K: float | None = key(
        "thermal expansion by volume; if left out 6.5e-4, or typical of the base of a graded oil",
        None,
        of="expansion",
        such_as=6.5e-4,
    )
    eyring_stress_MPa: float | None = key(
        "shear stress from which the oil thins, in films with heat; if left out 5, beside losses with 10",
        None,
        such_as=5,
    )
    limiting_shear_ratio: float | None = key(
        "maximum mean shear stress over the pressure, in films with heat; if left out typical of the base of a graded "
        "oil, else none",
        None,
        such_as=0.047,
    )

    @property
    def graded(self) -> bool:
        """Whether the oil is given by grade and temperature."""
        return self.iso_vg is not None

    @property
    def constant_viscosity(self) -> bool:
        """Whether pressure leaves the viscosity as it is."""
        return self.viscosity_law == "constant" or self.pressure_viscosity_per_GPa == 0.0

    @model_validator(mode="after")
    def _by_numbers_or_by_grade(self) -> LubricantSection:
        numbers, grade = self.given_keys(*BY_NUMBERS), self.given_keys(*BY_GRADE)
        if numbers and grade:
            raise refused(
                f"must be given by numbers ({', '.join(numbers)}) or by its grade ({', '.join(grade)}), "
                "not both ways at once"
            )
        if grade and len(self.given_keys("iso_vg", "temperature_C")) < 2:
            raise refused("must have iso_vg and temperature_C for an oil by its grade")
        known = self.pressure_viscosity_per_GPa is not None or self.viscosity_law == "constant"
        if not grade and (self.viscosity_Pa_s is None or not known):
            raise refused(
                "must have viscosity_Pa_s and pressure_viscosity_per_GPa, or iso_vg and temperature_C"
            )
        return self

    @model_validator(mode="after")
    def _a_law_with_its_numbers(self) -> LubricantSection:
        law = f'viscosity_law = "{self.viscosity_law}"'
        if self.viscosity_law != "roelands" and self.roelands_z is not None:
            raise refused(f"must not have roelands_z with {law}; leave it out")
        if self.viscosity_law == "constant" and self.pressure_viscosity_per_GPa:
            raise refused(f"must have pressure_viscosity_per_GPa = 0, or none, with {law}; leave it out")
        return self


class RoughnessSection(Section):
    """Roughness of the flanks, as drawings have it or as a standard deviation: makes the film mixed."""

    ground = ROUGHNESS | _ROUGHNESS

    Ra_um: float | None = key(
        "mean roughness Ra of each flank; of the pinion's alone beside wheel_Ra_um",
        None,
        of="mean",
        example=0.4,
    )
    wheel_Ra_um: float | None = key(
        "mean roughness Ra of the wheel's flanks, if different", None, of="mean", such_as=0.8
    )
    Rz_um: float | None = key(
        "mean peak-to-valley height Rz of each flank, instead of Ra; of the pinion's alone beside wheel_Rz_um",
        None,
        of="peaks",
        such_as=2.4,
    )
    wheel_Rz_um: float | None = key(
        "the same of the wheel's flanks, if different", None, of="peaks", such_as=4.8
    )
    sigma_um: float | None = key(
        "standard deviation of heights, both flanks together, instead of Ra and Rz",
        None,
        of="deviation",
        such_as=0.7,
    )
    density_per_mm2: float | None = key(
        "asperities per area; if left out such that density, tip radius and sigma multiply to 0.04",
        None,
        such_as=80,
    )
    tip_radius_um: float | None = key(
        "radius of the asperities' tips; a thousand times sigma if left out", None, such_as=700
    )
    law: Literal["greenwood-tripp", "greenwood-williamson", "zhou-hoeprich"] | None = key(
        "rule that shares the load: elastic asperities of two rough flanks or of one, or the film ratio; "
        "zhou-hoeprich unless given, greenwood-tripp beside density_per_mm2 or tip_radius_um",
        None,
        such_as="greenwood-tripp",
    )
    mean_plane_offset: float = key(
        "from the mean plane of heights to that of the asperities, times sigma", 1.15, of="offset"
    )
    boundary_friction: float = key(
        "coefficient of friction of what the asperities carry: 0.08 to 0.12 is usual of steel in oils for gears, and "
        "measured values are better; losses and friction of rough flanks hang on it",
        BOUNDARY_FRICTION,
        shown=True,
    )
    boundary_friction_band: _Two | None = key(
        "lowest and highest that it may be, whose effect is in the model error of friction and losses; if left out a "
        "fifth below and above",
        None,
        of=None,
        such_as=(0.08, 0.12),
    )

    @model_validator(mode="after")
    def _friction_within_its_band(self) -> RoughnessSection:
        if self.boundary_friction_band is None:
            return self
        low, high = self.boundary_friction_band
        if not (BOUNDARY.holds(low) and BOUNDARY.holds(high) and low <= self.boundary_friction <= high):
            allowed = (
                f"must be two numbers from {BOUNDARY.low:g} to {BOUNDARY.high:g}, the lower first, that have "
                f"boundary_friction = {self.boundary_friction:g} between them"
            )
            band = f"[{low:g}, {high:g}]"
            raise refused(allowed, "[0.08, 0.12] is usual", key="boundary_friction_band", value=band)
        return self

    @model_validator(mode="after")
    def _one_measure_of_height(self) -> RoughnessSection:
        measures = self.given_keys("Ra_um", "Rz_um", "sigma_um")
        if len(measures) != 1:
            raise refused(
                f"must have one of Ra_um, Rz_um and sigma_um, not {' and '.join(measures) or 'none'}"
            )
        for name in ("Ra_um", "Rz_um"):
            if self.given_keys(f"wheel_{name}") and not self.given_keys(name):
                raise refused(f"must have {name} of the pinion beside wheel_{name}")
        return self


class FilmSection(Section):
    """The oil film."""

    ground: ClassVar[Limits] = {
        "meniscus": Limit.above(0.0, 1.0, "m"),
        "meniscus_half_widths": Limit(1.00001, 1e6),
        "thickness": Limit(1e-10, 0.01, "m"),
    }

    model: Literal["ehl", "dowson", "none", "auto"] = key(
        "solved, by formulas, left out, or left out where it changes less than the tolerance",
        "auto",
        example="ehl",
    )
    heat: Literal["on", "off", "auto"] | None = key(
        "whether the wanted film is that with heat and shear thinning: with auto where they change it by more than the "
        'tolerance; if left out auto beside model = "auto", else off',
        None,
        such_as="auto",
    )
    stiffness: Literal["approach", "tangent", "nodal-sum", "dowson-central", "dowson-minimum"] | None = key(
        "definition of the film's stiffness; if left out approach, or dowson-central with formulas",
        None,
        example="approach",
    )
    supply: Literal["flooded", "meniscus", "oil-layer"] = key(
        "oil at the inlet: the quantity that is constant when the load changes", "flooded", shown=True
    )
    meniscus_mm: float | None = key(
        "where the gap fills, ahead of the contact's middle, for a supply by meniscus", None, such_as=0.3
    )
    meniscus_half_widths: float | None = key(
        "the same in half-widths of each contact at its load", None, such_as=1.5
    )
    oil_layer_um: float | None = key(
        "thickness on both flanks together, for a supply by oil layer", None, of="thickness", such_as=0.4
    )
    grid: Literal["graded", "article"] = key(
        "grid of the solver; article: 130 equal nodes on [-4, 1.2] half-widths", "graded"
    )

    @property
    def starved(self) -> bool:
        """Whether a supply is held."""
        return self.supply != "flooded"

    @property
    def asked_heat(self) -> str:
        """What the scene asks of heat in the film, by itself or by its model: on, off or auto."""
        return self.heat or ("auto" if self.model == "auto" else "off")

    @model_validator(mode="after")
    def _what_formulas_give(self) -> FilmSection:
        by_formula = (self.stiffness or "").startswith("dowson")
        if self.model == "dowson" and self.stiffness is not None and not by_formula:
            raise refused(
                'must have stiffness = "dowson-central" or "dowson-minimum" with model = "dowson", '
                f'not "{self.stiffness}"'
            )
        if self.starved and (by_formula or self.model == "dowson"):
            raise refused(
                f'must have model = "ehl" and its stiffness with supply = "{self.supply}": '
                "Dowson's formulas are of flooded contacts"
            )
        if self.heat == "on" and (self.model in ("dowson", "none") or self.grid != "graded"):
            raise refused(
                'must have heat = "off", or a film with model = "ehl" or "auto" and grid = "graded": '
                "heat is in such films alone"
            )
        if self.grid == "article" and (self.starved or self.model == "dowson"):
            raise refused('must have grid = "graded": "article" is of flooded films solved by model = "ehl"')
        return self

    @model_validator(mode="after")
    def _a_supply_with_its_value(self) -> FilmSection:
        supply_keys, wanted = (
            self.given_keys(*itertools.chain(*SUPPLIES.values())),
            SUPPLIES.get(self.supply, ()),
        )
        if astray := [name for name in supply_keys if name not in wanted]:
            raise refused(f'supply = "{self.supply}" has no {" or ".join(astray)}; leave it out')
        if wanted and len(supply_keys) != 1:
            raise refused(f'supply = "{self.supply}" needs {" or ".join(wanted)}, one of them')
        return self
