"""Keys of the film, and what it holds at the inlet."""

from __future__ import annotations

import itertools
from typing import ClassVar, Literal

from pydantic import model_validator

import ehl
from base import Limit
from flankfilm import coupling
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.section import Limits, Section, refused

SUPPLIES = {"meniscus": ("meniscus_mm", "meniscus_half_widths"), "oil-layer": ("oil_layer_um",)}
"""Keys of which one gives the value of a supply."""


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

    def inlet(self) -> ehl.Meniscus | ehl.OilLayer | coupling.PlacedMeniscus | None:
        """Supply that is held at the inlet, in SI; None for flooded contacts."""
        if self.oil_layer_um is not None:
            return ehl.OilLayer(**self.si("oil_layer_um"))
        if self.meniscus_half_widths is not None:
            return coupling.PlacedMeniscus(self.meniscus_half_widths)
        return None if self.meniscus_mm is None else ehl.Meniscus(-self.value("meniscus_mm"))
