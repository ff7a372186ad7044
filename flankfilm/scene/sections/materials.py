"""Keys of the gears' materials."""

from __future__ import annotations

from dataclasses import replace

from pydantic import model_validator

from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.section import Section, refused
from gears.tooth.material import LIMITS as MATERIAL
from gears.tooth.material import Material
from gears.tooth.named_materials import MATERIALS, named_material


class ElasticSection(Section):
    """Elastic constants and density of one material, by its name or each by itself."""

    ground = MATERIAL

    name: str | None = key(
        "name in the list of materials; the other keys change single constants",
        None,
        of=None,
        such_as="steel",
    )
    youngs_modulus_GPa: float | None = key("Young's modulus", None, example=206)
    poisson_ratio: float | None = key("Poisson's ratio", None, example=0.3)
    density_kg_per_m3: float | None = key(
        "density, for the moments of inertia; 7850 if left out without a name", None, example=7850
    )
    thermal_expansion_per_K: float | None = key(
        "coefficient of linear expansion by heat; 11.5e-6 of steel if left out without a name",
        None,
        such_as=11.5e-6,
    )
    conductivity_W_per_m_K: float | None = key(
        "thermal conductivity, of films with heat; 46 of steel if left out without a name", None, such_as=46
    )
    heat_capacity_J_per_kg_K: float | None = key(
        "heat capacity, of films with heat; 470 of steel if left out without a name", None, such_as=470
    )

    @model_validator(mode="after")
    def _by_name_or_by_constants(self) -> ElasticSection:
        _refuse_unknown(self.name)
        if self.name is None and len(self.given_keys("youngs_modulus_GPa", "poisson_ratio")) < 2:
            raise refused("must have youngs_modulus_GPa and poisson_ratio, or a name")
        return self

    def material(self) -> Material:
        """Material in SI."""
        if self.name is not None:
            return replace(named_material(self.name), **self.si())
        return Material(**{"density": 7850.0, **self.si()})


def _refuse_unknown(name: str | None) -> None:
    """Refuse a name that is not in the list of materials."""
    if name is not None and name not in MATERIALS:
        listed = ", ".join(MATERIALS)
        raise refused(
            "must be a name of the list of materials", f"One of {listed}", key="name", value=repr(name)
        )


class MaterialSection(Section):
    """One material for both gears, or one each in `pinion` and `wheel`."""

    ground = MATERIAL

    name: str | None = key(
        "name of both gears' material in the list of materials; the next keys change single constants",
        None,
        of=None,
        such_as="steel 16MnCr5",
    )
    youngs_modulus_GPa: float | None = key("Young's modulus of both gears", None, example=206)
    poisson_ratio: float | None = key("Poisson's ratio of both gears", None, example=0.3)
    density_kg_per_m3: float | None = key("density of both gears; 7850 if left out", None, example=7850)
    thermal_expansion_per_K: float | None = key(
        "coefficient of linear expansion of both gears; 11.5e-6 of steel if left out", None, such_as=11.5e-6
    )
    conductivity_W_per_m_K: float | None = key(
        "thermal conductivity of both gears, of films with heat; 46 of steel if left out", None, such_as=46
    )
    heat_capacity_J_per_kg_K: float | None = key(
        "heat capacity of both gears, of films with heat; 470 of steel if left out", None, such_as=470
    )
    pinion: ElasticSection | None = key("material of the pinion alone, instead of the keys above", None)
    wheel: ElasticSection | None = key("material of the wheel alone, beside that of the pinion", None)

    @model_validator(mode="after")
    def _one_material_or_two(self) -> MaterialSection:
        _refuse_unknown(self.name)
        common = self.name is not None or len(self.given_keys("youngs_modulus_GPa", "poisson_ratio")) == 2
        if not common and len(self.given_keys("pinion", "wheel")) < 2:
            raise refused(
                "must have a name, or youngs_modulus_GPa and poisson_ratio, for both gears, "
                "or both [material.pinion] and [material.wheel]"
            )
        if (self.si() or self.name) and self.given_keys("pinion", "wheel"):
            raise refused(
                "must be one material for both gears or one each, not both at once", "Leave one out"
            )
        return self

    @property
    def each(self) -> tuple[ElasticSection, ElasticSection]:
        """Materials of pinion and wheel."""
        if self.pinion is not None and self.wheel is not None:
            return self.pinion, self.wheel
        common = ElasticSection.model_validate(self.model_dump(exclude_none=True))
        return common, common
