"""The scene's keys for oil, roughness and film."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from flankfilm.scene.section import Section

_BY_NUMBERS = ("viscosity_Pa_s", "pressure_viscosity_per_GPa", "density_kg_per_m3", "roelands_z")
_BY_GRADE = ("iso_vg", "temperature_C", "viscosity_index", "base", "density_15_kg_per_m3")

_LAYS = {"meniscus": ("meniscus_mm", "meniscus_half_widths"), "oil-layer": ("oil_layer_um",)}
"""Keys of which one gives the value of a supply."""


class LubricantSection(Section):
    """Oil at the temperature of the contact's inlet: by its numbers, or by its ISO grade and temperature."""

    viscosity_Pa_s: float | None = Field(default=None, ge=1e-5, le=1e3)
    pressure_viscosity_per_GPa: float | None = Field(default=None, ge=0, le=100)
    density_kg_per_m3: float | None = Field(default=None, ge=100, le=5000, description="870 if left out")
    roelands_z: float | None = Field(default=None, gt=0, le=2)
    iso_vg: float | None = Field(default=None, ge=7, le=10_000, description="mm2/s at 40 degC")
    temperature_C: float | None = Field(default=None, gt=-20, le=150)
    viscosity_index: float | None = Field(default=None, ge=0, le=250, description="95 if left out")
    base: Literal["mineral", "pao", "ester", "pag"] | None = Field(default=None, description="mineral")
    density_15_kg_per_m3: float | None = Field(default=None, gt=500, le=2000, description="at 15 degC")
    viscosity_law: Literal["roelands", "barus", "constant"] = "roelands"
    compressible: bool = True

    @property
    def graded(self) -> bool:
        """Whether the oil is given by grade and temperature."""
        return self.iso_vg is not None

    @property
    def constant_viscosity(self) -> bool:
        """Whether pressure leaves the viscosity as it is."""
        return self.viscosity_law == "constant" or self.pressure_viscosity_per_GPa == 0.0

    @model_validator(mode="after")
    def _one_way_of_saying_it(self) -> LubricantSection:
        numbers, grade = ([n for n in names if getattr(self, n) is not None] for names in _WAYS)
        if numbers and grade:
            raise ValueError(
                f"give the oil by numbers ({', '.join(numbers)}) or by its grade ({', '.join(grade)}), "
                "not both ways at once"
            )
        if grade and (self.iso_vg is None or self.temperature_C is None):
            raise ValueError("an oil by its grade needs iso_vg and temperature_C")
        known = self.pressure_viscosity_per_GPa is not None or self.viscosity_law == "constant"
        if not grade and (self.viscosity_Pa_s is None or not known):
            raise ValueError(
                "give viscosity_Pa_s and pressure_viscosity_per_GPa, or iso_vg and temperature_C"
            )
        return self

    @model_validator(mode="after")
    def _a_law_with_its_numbers(self) -> LubricantSection:
        if self.viscosity_law != "roelands" and self.roelands_z is not None:
            raise ValueError(
                f'roelands_z has no place in viscosity_law = "{self.viscosity_law}"; leave it out'
            )
        if self.viscosity_law == "constant" and self.pressure_viscosity_per_GPa:
            raise ValueError(
                'viscosity_law = "constant" has pressure_viscosity_per_GPa = 0, or none; leave it out'
            )
        return self


_WAYS = (_BY_NUMBERS, _BY_GRADE)


class RoughnessSection(Section):
    """Roughness of both flanks together: makes the film mixed."""

    sigma_um: float = Field(ge=1e-4, le=100, description="standard deviation of heights")
    density_per_mm2: float = Field(ge=1, le=1e9, description="asperities per area")
    tip_radius_um: float = Field(ge=1e-3, le=1e5, description="of the asperities")
    law: Literal["greenwood-tripp", "greenwood-williamson"] = "greenwood-tripp"
    mean_plane_offset: float = Field(default=1.15, ge=0, le=3, description="times sigma")


class FilmSection(Section):
    """The oil film."""

    model: Literal["ehl", "dowson", "none", "auto"] = "auto"
    stiffness: Literal["approach", "tangent", "nodal-sum", "dowson-central", "dowson-minimum"] | None = None
    supply: Literal["flooded", "meniscus", "oil-layer"] = "flooded"
    meniscus_mm: float | None = Field(
        default=None, gt=0, le=1000, description="ahead of the contact's middle"
    )
    meniscus_half_widths: float | None = Field(
        default=None, ge=1.00001, le=1e6, description="of each contact at its load; it stays there"
    )
    oil_layer_um: float | None = Field(
        default=None, ge=1e-4, le=10_000, description="on both flanks together"
    )
    grid: Literal["graded", "article"] = "graded"

    @property
    def starved(self) -> bool:
        """Whether a supply is held."""
        return self.supply != "flooded"

    @model_validator(mode="after")
    def _formulas_know_two_definitions(self) -> FilmSection:
        by_formula = (self.stiffness or "").startswith("dowson")
        if self.model == "dowson" and self.stiffness is not None and not by_formula:
            raise ValueError(
                f'model = "dowson" has stiffness = "dowson-central" or "dowson-minimum", not "{self.stiffness}"'
            )
        if self.starved and (by_formula or self.model == "dowson"):
            raise ValueError(
                f'Dowson\'s formulas are of flooded contacts; supply = "{self.supply}" needs "ehl"'
            )
        if self.grid == "article" and (self.starved or self.model == "dowson"):
            raise ValueError('grid = "article" is of flooded films solved by model = "ehl"')
        return self

    @model_validator(mode="after")
    def _a_supply_with_its_value(self) -> FilmSection:
        given = [name for names in _LAYS.values() for name in names if getattr(self, name) is not None]
        wanted = _LAYS.get(self.supply, ())
        astray = [name for name in given if name not in wanted]
        if astray:
            raise ValueError(f'supply = "{self.supply}" has no {" or ".join(astray)}; leave it out')
        if wanted and len(given) != 1:
            raise ValueError(f'supply = "{self.supply}" needs {" or ".join(wanted)}, one of them')
        return self

    def definition(self, model: str) -> str:
        """Definition of the film stiffness for a film computed by `model`."""
        return self.stiffness or ("dowson-central" if model == "dowson" else "approach")
