"""Plans: for which film, on which domain and around which spike the nodes of a grid are laid."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from base import Array
from ehl.discrete.contact import LineContact
from ehl.discrete.equations import Grid, make_grid
from ehl.discrete.grid import clusters, default_domain, graded_nodes, upstream_share
from ehl.discrete.regressions import moes_central
from ehl.discrete.supply import Meniscus, OilLayer, Supply, inlet_of_layer, starved_film

_REUSE = 1.5  # a start's grid serves until H_c differs by this factor
_NEAREST_INLET = 1e-6  # b ahead of the dry contact


def expected_film(contact: LineContact) -> float:
    """Return the flooded h R/b^2 by Moes' formula."""
    return contact.film_parameter(moes_central(contact))


@dataclass(frozen=True)
class Plan:
    """How grids are laid."""

    kind: str  # "graded" or "uniform"
    H_c: float  # expected h R/b^2
    domain: tuple[float, float]  # [half-widths]
    fixed: (
        bool  # the inlet has p = 0 there: a given domain or a meniscus; otherwise oil fills all ahead of it
    )
    spike: tuple[float, float] | None = None  # position and width of the spike [half-widths]

    @classmethod
    def of(cls, contact: LineContact, kind: str, domain: tuple[float, float] | None, reach: float) -> Plan:
        """Lay the plan of a flooded or given inlet by Moes' film."""
        H_c = expected_film(contact)
        if domain is None:
            return cls(kind, H_c, default_domain(H_c, reach), fixed=False)
        left, right = float(domain[0]), float(domain[1])
        return cls(kind, starved_film(H_c, -1.0 - left), (left, right), fixed=True)

    @classmethod
    def fed(cls, contact: LineContact, kind: str, supply: Supply, flooded: float) -> Plan:
        """Lay the plan of a starved contact, whose flooded film would be about ``flooded`` [m]."""
        H_flooded = contact.film_parameter(flooded)
        if isinstance(supply, OilLayer):
            H_c = contact.film_parameter(supply.thickness)
            distance = inlet_of_layer(H_flooded, H_c)
        else:
            distance = -1.0 - supply.position / contact.half_width
            H_c = starved_film(H_flooded, max(distance, _NEAREST_INLET))
        return cls(kind, H_c, (-1.0 - distance, default_domain(H_c)[1]), fixed=True)

    @property
    def inlet_error(self) -> float:
        """Share of the film lost to the finite inlet; 0 where the domain was given."""
        return 0.0 if self.fixed else (math.sqrt(self.H_c) / (-1.0 - self.domain[0])) ** 3

    def serves(self, other: Plan, supply: Supply | None = None) -> bool:
        """Whether grids of this plan are good enough for the other; the meniscus of a layer is sought in any case."""
        if self.kind != other.kind or self.fixed != other.fixed:
            return False
        if not 1.0 / _REUSE < self.H_c / other.H_c < _REUSE:
            return False
        if self.fixed and supply is not None:
            return isinstance(supply, OilLayer) or self.domain[0] == other.domain[0]
        reach = self.domain[0] / other.domain[0]
        return 1.0 / _REUSE < reach < _REUSE and not (self.fixed and self.domain != other.domain)

    def alike(self, other: Plan) -> bool:
        """Whether the other is the same but for its inlet."""
        return self.with_inlet(other.domain[0]) == other

    def nodes(self, n: int, start: Array | None = None) -> Array:
        """Return n nodes [half-widths]; ``start`` are nodes close to them."""
        if self.kind == "uniform":
            return np.linspace(*self.domain, n)
        return graded_nodes(self.H_c, n, self.domain, self.spike, start)

    def grid(self, n: int) -> Grid:
        """Return the grid of n nodes."""
        return self.over(self.nodes(n), math.sqrt(max(1.0, self.H_c)))

    def over(self, nodes: Array, ratio: float) -> Grid:
        """Return the grid over given nodes [half-widths], scaled by a/b."""
        share = upstream_share(nodes, self.H_c)
        return make_grid(nodes, ratio, share, open_inlet=not self.fixed)

    def with_inlet(self, inlet: float) -> Plan:
        """Return the plan with another inlet [half-widths]."""
        return replace(self, domain=(inlet, self.domain[1]))

    def moved(self, growth: float) -> Plan:
        """Return the plan for a film parameter that has grown by a factor; a given inlet stays at its x/b."""
        H_c, spike = growth * self.H_c, self.spike
        if spike is not None:
            widening = clusters(H_c)[0] / clusters(self.H_c)[0]
            spike = (1.0 + widening * (spike[0] - 1.0), widening * spike[1])
        if self.fixed:
            return replace(self, H_c=H_c, spike=spike)
        left, right = self.domain
        root = math.sqrt(growth)
        domain = (-1.0 + root * (left + 1.0), 1.0 + root * (right - 1.0))
        return replace(self, H_c=H_c, domain=domain, spike=spike)

    def moved_to(self, growth: float, wider: float, supply: Supply | None) -> Plan:
        """Return the plan for a film grown and a dry contact widened by a factor each, on the same supply."""
        moved = self.moved(growth)
        if isinstance(supply, Meniscus):
            return moved.with_inlet(self.domain[0] / wider)
        return moved
