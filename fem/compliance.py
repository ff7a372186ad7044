"""Everything of a pair's elasticity that does not depend on the load, with its error and cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import ceil
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fem.elasticity import PlaneElasticity
from fem.errors import Fault, FemError
from fem.flamant import hertz_half_width, hertz_indentation
from fem.flexibility import GearFlexibility, flexibility
from fem.local_law import HertzApproach
from fem.ring import Ring, ring_of
from fem.tip_contact import TipStrips, tip_strips

if TYPE_CHECKING:
    from gears import GearPair
    from meshes import Sizes

__all__ = ["Compliance", "Cost", "compliance", "mesh_and_factor", "single_pair_stiffness"]

Array = NDArray[np.float64]

FINEST = 3
"""Most refinements that a tolerance may ask for."""


@dataclass(frozen=True)
class Cost:
    """What a result cost.

    Attributes
    ----------
    seconds : float
        Wall time of the whole.
    unknowns : int
        Displacement components that were factorised: one sector of each gear, finest mesh.
    annulus_unknowns : int
        Those of the two whole annuli that the sectors stand for.
    iterations : int
        Newton iterations of the load sharing, all positions together; 0 for a compliance.
    parts : mapping of str to float
        Seconds by stage: mesh, assemble, factor, condense, solve, tips; contact for a mesh cycle.
    """

    seconds: float
    unknowns: int
    iterations: int = 0
    annulus_unknowns: int = 0
    parts: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Compliance:
    """Flexibility of both gears of a pair as functions of the contact's place.

    Attributes
    ----------
    pair : gears.GearPair
    plane : {"strain", "stress"}
    pinion, wheel : GearFlexibility
    tips : (TipStrips, TipStrips)
        Tips of pinion and wheel, for contact of their edges outside the path.
    refinements : int
        Of the mesh in use.
    sizes : meshes.Sizes
        Of the coarsest mesh.
    reach : int
        Neighbours with cross terms on either side of a tooth.
    error : float
        Estimated relative error of the single-pair deflection, from two nested meshes.
    cost : Cost
    converged : bool
        Whether ``error`` meets the tolerance asked for.
    message : str
    kept_rings : (Ring, Ring) or None
        The factorised gears where this process computed them; dropped on pickling (see ``rings``).
    """

    pair: GearPair
    plane: str
    pinion: GearFlexibility
    wheel: GearFlexibility
    tips: tuple[TipStrips, TipStrips]
    refinements: int
    sizes: Sizes
    reach: int
    error: float
    cost: Cost
    converged: bool
    message: str
    kept_rings: tuple[Ring, Ring] | None = field(default=None, repr=False)

    def __getstate__(self) -> dict[str, Any]:
        """Leave the factorised gears behind: they are large, and a factorisation cannot travel."""
        return {**self.__dict__, "kept_rings": None}

    def rings(self) -> tuple[Ring, Ring]:
        """Meshed and factorised gears: those that were kept, or computed anew from the same mesh sizes."""
        if self.kept_rings is not None:
            return self.kept_rings
        return mesh_and_factor(self.pair, self.plane, self.sizes, self.refinements)[0]

    @property
    def hub_windup(self) -> tuple[float, float]:
        """Turning of pinion's and wheel's body, along the line of action [m/N at the pair's face width]."""
        width = self.pair.face_width
        return self.pinion.hub_windup / width, self.wheel.hub_windup / width

    def own(self, rho1: Array) -> Array:
        """Deflection of a pair per force without the local indentation [m/N], at rho1 [m]."""
        rho1 = np.asarray(rho1, dtype=float)
        total = self.pinion.own(rho1) + self.wheel.own(self.pair.line_of_action - rho1)
        return np.asarray(total / self.pair.face_width)

    def bulk(self, rho1: Array, rho2: Array | None = None) -> Array:
        """Bulk flexibility of pairs in order of their rho1, one tooth apart.

        Parameters
        ----------
        rho1 : (..., n) array
            Curvature radii on the pinion [m].
        rho2 : (..., n) array, optional
            On the wheel; those of the line of action unless given.

        Returns
        -------
        (..., n, n) array
            Symmetric [m/N].
        """
        rho1 = np.asarray(rho1, dtype=float)
        rho2 = self.pair.line_of_action - rho1 if rho2 is None else rho2
        n = rho1.shape[-1]
        matrix = np.zeros((*rho1.shape, n))
        for i in range(n):
            matrix[..., i, i] = self.pinion.own(rho1[..., i]) + self.wheel.own(rho2[..., i])
            for j in range(i + 1, min(n, i + self.reach + 1)):
                matrix[..., i, j] = self.pinion.cross(j - i, rho1[..., i], rho1[..., j])
                # the pair ahead has the smaller rho2, and the cross term is symmetric (Maxwell and Betti)
                matrix[..., i, j] += self.wheel.cross(j - i, rho2[..., j], rho2[..., i])
                matrix[..., j, i] = matrix[..., i, j]
        return np.asarray(matrix / self.pair.face_width)

    def hertz(self, rho1: Array) -> HertzApproach:
        """Local indentation of pairs at rho1 [m] as a function of their forces."""
        path = self.pair.path_at(np.clip(rho1, 0.0, self.pair.line_of_action))
        width = self.pair.face_width
        first, second = self.pinion.law, self.wheel.law
        reduced = 2 / (1 / first.plane_modulus + 1 / second.plane_modulus)
        half_width = hertz_half_width(1.0 / width, path.radius, reduced)  # of 1 N
        length = self.pair.module
        constant = (
            hertz_indentation(half_width, first, length) + hertz_indentation(half_width, second, length)
        ) / width
        per_log = (1 / first.plane_modulus + 1 / second.plane_modulus) / (np.pi * width)
        return HertzApproach(constant, per_log)


def mesh_and_factor(
    pair: GearPair, plane: str, sizes: Sizes, refinements: int
) -> tuple[tuple[Ring, Ring], dict[str, float]]:
    """Mesh, assemble, factorise and condense both gears; seconds by stage."""
    from meshes import mesh_sector

    rings, seconds = [], {"mesh": 0.0}
    for profile, material in zip(pair.teeth_profiles, pair.materials, strict=True):
        began = perf_counter()
        mesh = mesh_sector(profile, sizes, refinements)
        seconds["mesh"] += perf_counter() - began
        ring = ring_of(mesh, PlaneElasticity.of(material, plane))
        for stage, duration in ring.seconds.items():
            seconds[stage] = seconds.get(stage, 0.0) + duration
        rings.append(ring)
    return (rings[0], rings[1]), seconds


def _both_flexibilities(
    pair: GearPair, rings: tuple[Ring, Ring], reach: int
) -> tuple[GearFlexibility, GearFlexibility]:
    first, second = pair.teeth_profiles
    points = pair.points
    # tip edges touch the flanks inside A..E too (fem.tip_contact): no flank is loaded below these ends
    pinion = flexibility(rings[0], first, points.A, reach)
    wheel = flexibility(rings[1], second, pair.line_of_action - points.E, reach)
    return pinion, wheel


def compliance(
    pair: GearPair,
    tolerance: float = 0.001,
    plane: str = "strain",
    sizes: Sizes | None = None,
    refinements: int | None = None,
) -> Compliance:
    """Flexibility of both gears, on the coarsest mesh that meets a tolerance.

    Two nested meshes are solved; the finer one is used, and its error is taken as a third of the difference
    (second order; the observed order is above two) plus what the fit along the flank leaves over. The mesh is
    refined until that meets the tolerance.

    Parameters
    ----------
    pair : gears.GearPair
    tolerance : float
        Relative, on the deflection of a pair.
    plane : {"strain", "stress"}
        Plane strain for gears wider than a few modules.
    sizes : meshes.Sizes, optional
        Of the coarsest mesh.
    refinements : int, optional
        Fixes the mesh instead of the tolerance; at least 1.

    Returns
    -------
    Compliance

    Raises
    ------
    FemError
        Tolerance or plane that make no sense.
    """
    from meshes import Sizes

    faults = []
    if not (np.isfinite(tolerance) and tolerance > 0):
        faults.append(Fault("tolerance", f"{tolerance!r}", "finite and > 0", "0.001 is 0.1 %"))
    if plane not in ("strain", "stress"):
        faults.append(Fault("plane", f"{plane!r}", '"strain" or "stress"', "wide gears: strain"))
    if refinements is not None and not 1 <= refinements <= FINEST + 1:
        faults.append(Fault("refinements", f"{refinements!r}", f"1 to {FINEST + 1}", "leave it out"))
    if faults:
        raise FemError(*faults)
    began = perf_counter()
    sizes = sizes or Sizes()
    # every tooth that may touch together with another one, tip edges outside the path at both ends included
    reach = ceil(pair.contact_ratio) + 1
    parts: dict[str, float] = {}
    level = 0 if refinements is None else refinements - 1
    error, coarse = np.inf, None
    while True:
        rings, seconds = mesh_and_factor(pair, plane, sizes, level)
        started = perf_counter()
        fine = _both_flexibilities(pair, rings, reach)
        seconds["solve"] = perf_counter() - started
        parts = {name: parts.get(name, 0.0) + value for name, value in seconds.items()}
        if coarse is not None:
            error = _difference(pair, coarse, fine, reach) / 3 + _ripple(pair, fine)
            if refinements is not None or error <= tolerance or level >= FINEST:
                break
        coarse, level = fine, level + 1
    converged = bool(error <= tolerance) or refinements is not None
    message = (
        f"mesh refined {level} times, error {error:.1e}"
        if converged
        else f"error {error:.1e} above the tolerance {tolerance:.1e} on the finest mesh allowed; ask for less"
    )
    unknowns = sum(len(ring.inner) + len(ring.cut) for ring in rings)
    annuli = sum(ring.unknowns for ring in rings)
    started = perf_counter()
    first, second = (tip_strips(*both) for both in zip(rings, pair.teeth_profiles, strict=True))
    parts["tips"] = perf_counter() - started
    cost = Cost(perf_counter() - began, unknowns, 0, annuli, parts)
    return Compliance(
        pair, plane, *fine, (first, second), level, sizes, reach, error, cost, converged, message, rings
    )


def _difference(
    pair: GearPair,
    coarse: tuple[GearFlexibility, GearFlexibility],
    fine: tuple[GearFlexibility, GearFlexibility],
    reach: int,
) -> float:
    """Largest difference of own and cross deflection along the path, relative to a pair's deflection."""
    points, total = pair.points, pair.line_of_action
    rho1 = np.linspace(points.A, points.E, 60)
    own, change = np.zeros_like(rho1), np.zeros_like(rho1)
    crossed = 0.0
    for one, other, rho in zip(coarse, fine, (rho1, total - rho1), strict=True):
        own += other.own(rho) + hertz_indentation(0.1 * pair.module, other.law, pair.module)
        change += other.own(rho) - one.own(rho)
        for k in range(1, reach + 1):
            grid = np.meshgrid(rho, rho)
            crossed = max(crossed, float(np.max(np.abs(other.cross(k, *grid) - one.cross(k, *grid)))))
    return max(float(np.max(np.abs(change / own))), crossed / float(np.min(own)))


def _ripple(pair: GearPair, bodies: tuple[GearFlexibility, GearFlexibility]) -> float:
    """Distance of the samples from the fitted series, relative to a pair's deflection."""
    rho1 = np.linspace(pair.points.A, pair.points.E, 60)
    own = bodies[0].own(rho1) + bodies[1].own(pair.line_of_action - rho1)
    own += sum(hertz_indentation(0.1 * pair.module, body.law, pair.module) for body in bodies)
    return (bodies[0].noise + bodies[1].noise) / float(np.min(own))


def single_pair_stiffness(
    pair: GearPair,
    force: float,
    rho1: Array,
    compliance: Compliance | None = None,
    tolerance: float = 0.001,
    plane: str = "strain",
) -> Array:
    """Secant stiffness F/deflection of one tooth pair alone, hub and bodies included [N/m].

    Parameters
    ----------
    pair : gears.GearPair
    force : float
        Normal force [N] at the pair's face width.
    rho1 : (n,) array
        Curvature radii on the pinion [m]. Within ``0.01`` modules of a tip corner, A and E included, the
        load stands at that distance: a line load on the corner itself would have no finite displacement.
    compliance : Compliance, optional
        Of this pair.

    Returns
    -------
    (n,) array

    Raises
    ------
    FemError
        Force not positive and finite, or a place off the path of contact.
    """
    bodies = compliance or _compliance(pair, tolerance, plane)
    rho1 = np.atleast_1d(np.asarray(rho1, dtype=float))
    points = pair.points
    faults = []
    if not (np.isfinite(force) and force > 0):
        faults.append(
            Fault("force", f"{force!r}", "finite and > 0 (N)", "give the force along the line of action")
        )
    slack = 1e-9 * points.E
    if not np.all((rho1 >= points.A - slack) & (rho1 <= points.E + slack)):
        allowed = f"{points.A:g} to {points.E:g} m, the path of contact"
        faults.append(Fault("rho1", f"{np.min(rho1):g} .. {np.max(rho1):g}", allowed, "stay between A and E"))
    if faults:
        raise FemError(*faults)
    approach = bodies.own(rho1) * force + bodies.hertz(rho1).approach(np.full(len(rho1), float(force)))
    stiffness: Array = force / approach
    return stiffness


_compliance = compliance  # single_pair_stiffness has an argument of that name
