"""The discrete line contact: grid, dimensionless groups, gap, flux and residual.

Lengths are in a (X = x/a, H = h R/a^2) and pressures in p_a = 2w/(pi a); a is the half-width of the dry
contact b, or b sqrt(H_c) where the film is thicker than the contact's sagitta, so that both limits, the dry
contact and the rigid cylinder, keep unknowns of order one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from base import Array
from ehl.discrete.contact import LineContact
from ehl.discrete.grid import face_weights, hat_weights, middle_weights
from ehl.oil.lubricant import Lubricant

LOAD = 0.5 * math.pi  # integral of P dX
_GAUSS = np.polynomial.legendre.leggauss(8)


@dataclass(frozen=True)
class Grid:
    """Nodes and everything that depends on nothing else."""

    nodes: Array  # X = x/a (n,)
    ratio: float  # a/b
    potential: Array  # (n, n): integral of phi_j ln|X_i - t|
    centre: Array  # (n,): the same at X = 0
    weights: Array  # (n,): integral of phi_j
    quick: Array  # (n-1, 3): third-order weights of each face
    upstream: Array  # (n-1,): share of each cell's wedge term that comes from upstream
    tail: Array  # (n,): integral of |t|^-3 ln|X_i - t| ahead of the first node; zeros for a bounded inlet
    tail_centre: float  # the same at X = 0
    open: bool  # oil fills the inlet beyond the first node


def make_grid(half_widths: Array, ratio: float, upstream: Array, *, open_inlet: bool) -> Grid:
    """Return the grid of the given nodes [half-widths], scaled by a/b, with its influence matrix.

    ``upstream`` is the share of each cell's wedge term that comes from upstream.
    """
    from ehl.kernels.film_kernels import log_potential

    nodes = half_widths / ratio
    potential = log_potential(nodes, nodes)
    tail = _tail_potential(-float(nodes[0]), nodes) if open_inlet else np.zeros(nodes.size)
    middle = middle_weights(nodes)
    return Grid(
        nodes=nodes,
        ratio=ratio,
        potential=potential,
        centre=middle @ potential,
        weights=hat_weights(nodes),
        quick=face_weights(nodes),
        upstream=upstream,
        tail=tail,
        tail_centre=float(middle @ tail),
        open=open_inlet,
    )


def _tail_potential(far: float, points: Array) -> Array:
    """Integral of t^-3 ln(X + t) over t > far, by Gauss's rule in s = far/t."""
    s = 0.5 * (_GAUSS[0] + 1.0)
    out: Array = np.log(points[:, None] + far / s) @ (0.5 * _GAUSS[1] * s) / far**2
    return out


@dataclass(frozen=True)
class Groups:
    """The numbers that decide the dimensionless film, and the scales that take it back."""

    length: float  # a [m]
    pressure: float  # p_a [Pa]
    gap: float  # a^2/R [m]
    compliance: float  # (b/a)^2/pi, the weight of the elastic term
    lam: float  # 12 eta0 u R^2/(a^3 p_a)
    lubricant: Lubricant

    @classmethod
    def on(cls, contact: LineContact, grid: Grid) -> Groups:
        """Scale the contact as a grid wants it."""
        return cls.of(contact, contact.half_width * grid.ratio)

    def tail(self, grid: Grid) -> float:
        """Factor A of the pressure A |X|^-3 ahead of the first node, 4 lambda/3; 0 for a bounded inlet.

        Far ahead the gap is X^2/2 and the pressure small, so that P' = lambda/H^2.
        """
        return 4.0 / 3.0 * self.lam if grid.open else 0.0

    @classmethod
    def of(cls, contact: LineContact, length: float) -> Groups:
        """Scale the contact by a length [m]."""
        pressure = 2.0 * contact.load / (math.pi * length)
        oil = contact.lubricant
        lam = 12.0 * oil.viscosity * contact.entrainment * contact.radius**2 / (length**3 * pressure)
        return cls(
            length=length,
            pressure=pressure,
            gap=length**2 / contact.radius,
            compliance=(contact.half_width / length) ** 2 / math.pi,
            lam=lam,
            lubricant=oil,
        )


def film_gap(grid: Grid, groups: Groups, P: Array, H0: float) -> Array:
    """Gap H = H0 + X^2/2 - compliance int P ln|X - t| dt, at the nodes."""
    elastic = grid.potential @ P + groups.tail(grid) * grid.tail
    gap: Array = H0 + 0.5 * grid.nodes**2 - groups.compliance * elastic
    return gap


def centre_gap(grid: Grid, groups: Groups, P: Array, H0: float) -> float:
    """Gap at X = 0."""
    elastic = float(grid.centre @ P) + groups.tail(grid) * grid.tail_centre
    return H0 - groups.compliance * elastic


def inlet_pressure(grid: Grid, groups: Groups) -> float:
    """Pressure of the first node: that of the oil ahead of it, or zero."""
    return groups.tail(grid) / abs(float(grid.nodes[0])) ** 3


def load_inside(grid: Grid, groups: Groups) -> float:
    """Integral of P dX that the nodes have to carry: the load less what the oil ahead of them carries."""
    return LOAD - 0.5 * groups.tail(grid) / float(grid.nodes[0]) ** 2


class Fluid(NamedTuple):
    """What the flux needs of the oil at every node, all (n,) and by the dimensionless pressure."""

    ln_viscosity: Array  # ln(eta/eta0) of the viscosity that the pressure flow feels
    viscosity_slope: Array
    density: Array  # rho/rho0
    density_slope: Array
    shear: Array = np.empty((0, 5))  # (n-1, 5), of oil that thins: see ehl.kernels.film_kernels.reynolds
    swelling: Array | None = (
        None  # (n, n): change of H by P that has the effect of what heat does to the density
    )


class Oil(Protocol):
    """Oil whose state depends on more than the pressure."""

    unsettled: float  # by how much of itself its own state has still to change

    def at(self, P: Array, H: Array) -> Fluid:
        """State under pressures and gaps."""


def plain_oil(groups: Groups, P: Array) -> Fluid:
    """Isothermal, Newtonian oil under pressures."""
    ln_viscosity, viscosity_slope = groups.lubricant.log_viscosity(groups.pressure * P)
    density, density_slope = groups.lubricant.density_ratio(groups.pressure * P)
    return Fluid(ln_viscosity, viscosity_slope * groups.pressure, density, density_slope * groups.pressure)


def fluxes(
    grid: Grid, groups: Groups, P: Array, H: Array, faces: Array, fluid: Fluid | None = None
) -> tuple[Array, Array]:
    """Flux through each cell and its derivatives, see :func:`ehl.kernels.film_kernels.reynolds`."""
    from ehl.kernels.film_kernels import reynolds

    state = plain_oil(groups, P) if fluid is None else fluid
    flux_and_slopes: tuple[Array, Array] = reynolds(
        grid.nodes, P, H, faces, *state[:5], groups.lam, grid.upstream
    )
    return flux_and_slopes


class Residual(NamedTuple):
    """What given pressures and a rigid separation leave unbalanced, and the gap that they make."""

    flux: Array  # through each cell (n-1,); its differences are the net fluxes
    slopes: Array  # of the flux (n-1, 6)
    short: float  # load that is missing
    centre: float  # gap at x = 0 [m]

    @classmethod
    def of(cls, grid: Grid, groups: Groups, P: Array, H0: float, oil: Oil | None = None) -> Residual:
        """Compute all; the first node's pressure is taken from the inlet, whatever ``P`` says."""
        P = P.copy()
        P[0] = inlet_pressure(grid, groups)
        H = film_gap(grid, groups, P, H0)
        flux, slopes = fluxes(grid, groups, P, H, grid.quick, None if oil is None else oil.at(P, H))
        short = load_inside(grid, groups) - float(grid.weights @ P)
        return cls(flux, slopes, short, centre_gap(grid, groups, P, H0) * groups.gap)
