"""Keys of the oil, and the oil that they make."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal

from pydantic import model_validator

import ehl
from base import Limit
from ehl.oil.lubricant import LIMITS as OIL
from ehl.oil.lubricant import STRESS_LIMITS
from ehl.oil.oil_grades import LIMITS as GRADE
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.section import Section, refused

BY_NUMBERS = ("viscosity_Pa_s", "pressure_viscosity_per_GPa", "density_kg_per_m3", "roelands_z")
BY_GRADE = ("iso_vg", "viscosity_index", "base", "density_15_kg_per_m3")

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

    def lubricant(self, at: float | None = None) -> ehl.Lubricant:
        """Oil in SI.

        Parameters
        ----------
        at : float or None
            Temperature of the flanks [K]; None where they have the oil's.

        Raises
        ------
        InputError
            With every fault that only the oil's laws find.
        """
        if self.graded:
            known = self.si(*BY_GRADE, "temperature_C", "compressible")
            further = {name: value for name, value in self.si().items() if name not in known}
            graded = known if at is None else known | {"temperature": at}
            return replace(ehl.Lubricant.from_iso_vg(**graded), **self._law, **further)
        oil = ehl.Lubricant(**self.si() | self._law)
        if at is None:
            return oil
        return replace(oil, temperature=at) if self.temperature_C is None else oil.at_temperature(at)

    @property
    def _law(self) -> dict[str, Any]:
        """Numbers by which a law of viscosity is meant."""
        law: dict[str, Any] = {}
        if self.constant_viscosity:
            law["pressure_viscosity"] = 0.0
        if self.viscosity_law == "barus":
            law["roelands_z"] = 1.0  # Roelands' law of this index is Barus' law
        return law
