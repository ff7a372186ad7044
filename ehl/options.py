"""What a caller asks of a solution, checked before anything is computed."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace

import numpy as np

from ehl.contact import LineContact
from ehl.errors import EhlInputError, EhlWarning, Fault, number_fault
from ehl.regressions import moes_central
from ehl.supply import Meniscus, OilLayer, Supply

__all__ = ["ARTICLE_DOMAIN", "ARTICLE_NODES", "GRIDS", "Options", "warn_of_range"]

GRIDS = ("graded", "uniform", "article")

ARTICLE_NODES = 130
ARTICLE_DOMAIN = (-4.0, 1.2)
"""The grid of a published study of spur gears: 130 equal nodes, criterion 1e-6 on the pressure."""

_SHARP_TOLERANCE = 1e-3  # below this the film feels a spike that falls between the nodes


@dataclass(frozen=True)
class Options:
    """Arguments of :func:`ehl.solve` apart from contact and start."""

    tolerance: float = 0.005
    nodes: int | None = None
    domain: tuple[float, float] | None = None
    grid: str = "graded"
    supply: Supply | None = None
    spike: float | None = None

    def checked(self, contact: object) -> Options:
        """Raise every fault at once; otherwise return the options with the article's grid spelt out."""
        faults = self._faults(contact)
        if faults:
            raise EhlInputError(faults)
        if self.grid == "article":
            return replace(self, grid="uniform", nodes=ARTICLE_NODES, domain=ARTICLE_DOMAIN)
        return self

    @property
    def sharp(self) -> bool:
        """Whether the grid is to be laid around the spike."""
        fine = self.nodes is None and self.tolerance < _SHARP_TOLERANCE
        return self.grid == "graded" and (self.spike is not None or fine)

    def _faults(self, contact: object) -> list[Fault]:
        faults: list[Fault] = []
        if not isinstance(contact, LineContact):
            faults.append(Fault("contact", repr(contact), "a LineContact", "build one with ehl.LineContact"))
        faults += number_fault(
            "tolerance", self.tolerance, low=0.0, high=0.2, remedy="0.005 is half a per cent"
        )
        if self.nodes is not None:
            faults += self._node_faults()
        if self.grid not in GRIDS:
            remedy = "'graded' resolves inlet and pressure spike"
            faults.append(Fault("grid", repr(self.grid), "one of " + ", ".join(GRIDS), remedy))
        if self.grid == "article" and not (self.nodes is None and self.domain is None):
            remedy = "it has 130 nodes on [-4, 1.2]; take grid='uniform' for others"
            faults.append(Fault("grid", "'article'", "given without nodes and domain", remedy))
        if self.domain is not None:
            faults += _domain_faults(self.domain)
        if self.supply is not None:
            faults += self._supply_faults(contact)
        if self.spike is not None:
            faults += number_fault("spike", self.spike, low=0.0, high=0.2, remedy="0.01 is one per cent")
            if self.grid != "graded":
                remedy = "only a graded grid follows the spike"
                faults.append(Fault("spike", repr(self.spike), "absent on uniform grids", remedy))
        return faults

    def _node_faults(self) -> list[Fault]:
        if isinstance(self.nodes, bool) or not isinstance(self.nodes, int | np.integer):
            return [
                Fault("nodes", repr(self.nodes), "a whole number", "give none to let the tolerance decide")
            ]
        return number_fault("nodes", self.nodes, low=32, high=4097, remedy="129 is usual", open_low=False)

    def _supply_faults(self, contact: object) -> list[Fault]:
        if not isinstance(self.supply, Meniscus | OilLayer):
            allowed = "None (flooded), ehl.Meniscus or ehl.OilLayer"
            return [Fault("supply", repr(self.supply), allowed, "say what is held constant")]
        if self.domain is not None or self.grid == "article":
            return [
                Fault("supply", repr(self.supply), "given without domain", "the supply decides the inlet")
            ]
        if isinstance(self.supply, Meniscus) and isinstance(contact, LineContact):
            edge = contact.half_width
            if self.supply.position > -edge:
                allowed = f"at most {-edge:.6g} m, the edge of the dry contact at this load"
                remedy = "nearer in no film forms: move the meniscus out, or take the contact as dry (prop 0)"
                return [Fault("supply.position", repr(self.supply.position), allowed, remedy)]
        return []


def _domain_faults(domain: object) -> list[Fault]:
    try:
        left, right = (float(v) for v in domain)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        left = right = math.nan
    if -1e9 <= left <= -1.0 and 0.0 < right <= 1e9:
        return []
    allowed = "(inlet <= -1, outlet > 0) in half-widths"
    return [Fault("domain", repr(domain), allowed, "(-15, 2.5) is usual")]


def warn_of_range(contact: LineContact) -> None:
    """Warn where the model leaves its range."""
    limit = contact.lubricant.law.reliable_below
    if contact.peak_pressure > limit:
        warnings.warn(
            f"Hertz pressure {contact.peak_pressure / 1e9:.2f} GPa: above about {limit / 1e9:g} GPa the "
            "viscosity law is an extrapolation; film thickness, decided in the inlet, suffers little",
            EhlWarning,
            stacklevel=4,
        )
    if moes_central(contact) > 1e-3 * contact.radius:
        warnings.warn(
            f"film of about {moes_central(contact):.2g} m at a radius of {contact.radius:.2g} m: the "
            "parabola that stands for the cylinders no longer holds over the whole inlet",
            EhlWarning,
            stacklevel=4,
        )
