"""What a caller asks of a solution, checked before anything is computed."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace

from base import Faults, Limit, RangeWarning
from ehl.discrete.contact import LineContact
from ehl.discrete.regressions import moes_central
from ehl.discrete.supply import Meniscus, OilLayer, Supply
from ehl.oil.lubricant import Lubricant

GRIDS = ("graded", "uniform", "article")

_ARTICLE_NODES = 130
_ARTICLE_DOMAIN = (-4.0, 1.2)
"""The grid of a published study of spur gears: 130 equal nodes, criterion 1e-6 on the pressure."""

_LIMITS = {
    "tolerance": Limit.above(0.0, 0.2, remedy="0.005 is 0.5 %"),
    "spike": Limit.above(0.0, 0.2, remedy="0.01 is 1 %"),
}
_NODES = (32, 4097, "129 is usual; leave it out to let the tolerance decide")
_SHARP_TOLERANCE = 1e-3  # below this the film feels a spike that falls between the nodes


class PressureWarning(RangeWarning):
    """A Hertz pressure beyond what the viscosity law was measured at."""


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
        with Faults.of(self, _LIMITS) as faults:
            self._check(contact, faults)
        if self.grid == "article":
            return replace(self, grid="uniform", nodes=_ARTICLE_NODES, domain=_ARTICLE_DOMAIN)
        return self

    @property
    def sharp(self) -> bool:
        """Whether the grid is to be laid around the spike."""
        fine = self.nodes is None and self.tolerance < _SHARP_TOLERANCE
        return self.grid == "graded" and (self.spike is not None or fine)

    def _check(self, contact: object, faults: Faults) -> None:
        if not isinstance(contact, LineContact):
            faults.add("contact", contact, "must be a LineContact", "build one with ehl.LineContact")
        elif contact.lubricant.table is not None:
            last = contact.lubricant.table.pressure[-1]
            if contact.peak_pressure > last:
                allowed = f"must have a Hertz pressure of at most {last:g} Pa, where the oil's table ends"
                pressure = f"{contact.peak_pressure:.4g} Pa"
                faults.add("contact", pressure, allowed, "measure farther, or lower the load")
        if self.nodes is not None:
            faults.whole("nodes", self.nodes, *_NODES)
        faults.choice("grid", self.grid, GRIDS, "'graded' resolves inlet and pressure spike")
        if self.grid == "article" and not (self.nodes is None and self.domain is None):
            remedy = "it has 130 nodes on [-4, 1.2]; take grid='uniform' for others"
            faults.add("grid", repr(self.grid), "must be given without nodes and domain", remedy)
        if self.domain is not None and not _in_order(self.domain):
            allowed = "must be (inlet, outlet) in half-widths, inlet at most -1 and outlet more than 0"
            faults.add("domain", self.domain, allowed, "(-15, 2.5) is usual")
        if self.supply is not None:
            self._check_supply(contact, faults)
        if self.spike is not None and self.grid != "graded":
            remedy = "only a graded grid follows the spike"
            faults.add("spike", self.spike, "must be left out on uniform grids", remedy)

    def _check_supply(self, contact: object, faults: Faults) -> None:
        if not isinstance(self.supply, Meniscus | OilLayer):
            allowed = "must be None (flooded), ehl.Meniscus or ehl.OilLayer"
            faults.add("supply", self.supply, allowed, "say what is held constant")
        elif self.domain is not None or self.grid == "article":
            allowed = "must be given without domain"
            faults.add("supply", self.supply, allowed, "the supply decides the inlet")
        elif isinstance(self.supply, Meniscus) and isinstance(contact, LineContact):
            edge = contact.half_width
            if self.supply.position > -edge:
                allowed = f"must be at most {-edge:.6g} m, the edge of the dry contact at this load"
                remedy = "nearer in no film forms: move the meniscus out, or take the contact as dry (separation 0)"
                faults.add("supply.position", self.supply.position, allowed, remedy)


def _in_order(domain: object) -> bool:
    try:
        left, right = (float(v) for v in domain)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        return False
    return -1e9 <= left <= -1.0 and 0.0 < right <= 1e9


def warn_of_range(contact: LineContact) -> None:
    """Warn where the model leaves its range."""
    warn_of_pressure(contact.lubricant, contact.peak_pressure, stacklevel=4)
    film = moes_central(contact)
    if film > 1e-3 * contact.radius:
        message = (
            f"film of about {film:.2g} m at a radius of {contact.radius:.2g} m: the parabola that stands for "
            "the cylinders no longer holds over the whole inlet"
        )
        warnings.warn(message, RangeWarning, stacklevel=3)


def warn_of_pressure(lubricant: Lubricant, pressure: float, stacklevel: int = 2) -> None:
    """Warn where a Hertz pressure [Pa] is beyond what the viscosity law was measured at."""
    limit = lubricant.law.reliable_below
    if pressure > limit:
        message = (
            f"Hertz pressure {pressure / 1e9:.2f} GPa: above about {limit / 1e9:g} GPa the "
            "viscosity law is an extrapolation; film thickness, decided in the inlet, suffers little"
        )
        warnings.warn(message, PressureWarning, stacklevel=stacklevel)
