"""The numbers of the method that decide an answer: one record, the same for all films."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Method:
    """What a tolerance leaves open, and where a film counts as not solved.

    Tolerances of single calls choose between ``first_nodes`` and the most of each kind of film. Half or twice any
    of these moves answers within their reported errors, or refuses other contacts: docs/theory/ehl.md has the table.
    """

    first_nodes: int = 65
    """Nodes of the first grid that a tolerance asks for."""

    most_nodes: int = 2049
    """Of the last one, without heat."""

    most_nodes_with_heat: int = 513
    """Likewise, with heat."""

    first_nodes_in_time: int = 129
    """Of the first grid under a load that changes."""

    most_nodes_in_time: int = 513
    """Of the last one, likewise."""

    newton_steps: int = 1200
    """Newton steps of one call, on 257 nodes each, after which no new start is tried."""

    newton_done: float = 1e-6
    """Last step of the pressure over its scale: Newton's method converges quadratically."""

    newton_done_with_heat: float = 0.05
    """Likewise over the tolerance, where the oil follows: steps shrink by three and more each."""

    inlet_reach: float = 40.0
    """Length of a flooded inlet in sqrt(h R)."""

    heat_reach: float = 30.0
    """Gap over the central film ahead of which heat stays with the oil that turns back there."""

    points_across: int = 11
    """Points across the film: flows of Sig = 6 hold to 5e-10."""

    heat_balance: float = 0.1
    """Heat that is lost or found over what is made or goes through, beyond which there is no solution."""

    hottest: float = 1000.0
    """Temperature of an oil beyond which there is no solution [K]."""

    dry: float = 1e-5
    """h R/b^2 below which a contact that is not solved is as good as dry."""

    layer_flow: float = 1e-10
    """Relative difference of a film's flow and its layer."""

    layer_flow_with_heat: float = 0.02
    """Likewise over the tolerance, with heat."""

    asperity_balance: float = 1e-7
    """Relative difference of what asperities carry and are asked for."""

    grid_factor: float = 0.4
    """Error of N nodes over its difference from (N+1)/2: 1/3 at second order, with a margin."""


METHOD = Method()
"""The numbers in use."""
