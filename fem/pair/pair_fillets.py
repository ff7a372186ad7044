"""Influence functions of the fillets of both gears, on meshes that the tolerance on the root stress asks for."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import partial
from math import floor
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Cost, Faults, Limit, RangeWarning, Stopwatch, described, part, quantity, record
from base.results import ITSELF, WORST
from fem.elasticity.plane_elasticity import PlaneElasticity, check_plane
from fem.elasticity.ring import ring_of
from fem.influence.fillet_influence import FilletInfluence, fillet_influence
from fem.influence.gear_shape import GearShape, shapes
from fem.influence.gear_store import GearStore, ResultStore
from gears.closed_form.root_stress import THIN_RIM, rim_factor
from gears.pair.spur_only import check_spur

if TYPE_CHECKING:
    from gears import GearPair
    from meshes import SectorMesh, Sizes

__all__ = ["Fillets", "LoadedShape", "SolvedFillets", "fillet_sizes", "fillets"]

COARSEST, HALVINGS = 0.16, 3
"""Edge length on the fillets of the first mesh in modules (before its refinement), and how often a tolerance
may halve it."""

START = 0.05
"""Steps [modules] of the minimum curvature radius of loads, so that mates of nearly equal reach share a solution.
Nearer to the fillet no short series follows the stress, and that of undercut teeth is the worst case."""

TOLERANCE = Limit(0.0, low_open=True, remedy="0.005 is 0.5 %")
FILLET_EDGE = Limit(0.002, 1.0, "modules", "leave it out")


@record
class Fillets:
    """Influence of loads on the fillets of both gears, and how exact it is."""

    no_error = ITSELF

    headline = ("plane", "fillet_edge")

    pair: GearPair = part("the gears")
    plane: str = part('"strain" or "stress"')
    pinion: FilletInfluence = part("influence on the fillets of the pinion")
    wheel: FilletInfluence = part("influence on the fillets of the wheel")
    fillet_edge: float = quantity("1", "edge length on the fillets of the mesh in use, in modules")
    errors: Array = quantity(
        "1",
        "estimated relative error of the maximum stress on a gear's fillet, from two nested meshes",
        "gear",
    )
    shapes: tuple[LoadedShape, LoadedShape] = part("pinion and wheel as they were solved, in modules")
    cost: Cost
    converged: bool
    message: str

    @described("1")
    def error(self) -> float:
        """Larger of both gears' estimated errors."""
        return float(self.errors.max())


@record
class SolvedFillets:
    """Influence of one gear in modules, with its error and the size of what was solved.

    Attributes
    ----------
    influence : FilletInfluence
    error : float
    unknowns, annulus_unknowns : int
    """

    influence: FilletInfluence
    error: float
    unknowns: int
    annulus_unknowns: int


@dataclass(frozen=True)
class LoadedShape:
    """A gear's shape, and the minimum curvature radius of loads on it.

    Attributes
    ----------
    shape : GearShape
    low : float
        [modules]
    """

    shape: GearShape
    low: float

    def solved(self, gears: GearStore, edge: float = COARSEST) -> SolvedFillets:
        """Influence on a mesh with edges on the fillets, and on its refinement, solved where it is kept nowhere."""
        key = (self.shape, edge, self.low)
        influence: SolvedFillets = gears.record(
            "fillets", key, partial(_two_meshes, gears, self.shape, edge, self.low)
        )
        return influence

    def mesh(self, edge: float = COARSEST) -> SectorMesh:
        """Finer one of the two meshes."""
        from meshes import mesh_sector, refined

        return refined(mesh_sector(self.shape.profile, fillet_sizes(edge)))


def fillets(
    pair: GearPair,
    tolerance: float = 0.005,
    plane: str = "strain",
    fillet_edge: float | None = None,
    *,
    kept: ResultStore | None = None,
) -> Fillets:
    """Influence functions of both gears on a mesh whose fillets are as fine as the tolerance asks for.

    Each mesh is solved with its own refinement (every triangle in four). The error is taken as half of the
    largest difference of the maximum stress, over loads along the flank and both fillets (the observed order
    of a maximum that hops between elements is 1.5 to 2.5), plus what the Chebyshev fit leaves over. At the ends
    of a fillet, where its curvature jumps, the stress itself is several times less exact than its maximum.

    Parameters
    ----------
    pair : gears.GearPair
    tolerance : float
        Relative, on the maximum stress along a fillet.
    plane : {"strain", "stress"}
    fillet_edge : float, optional
        Edge length on the fillets before the refinement, in modules; fixes the mesh instead of the tolerance.
    kept : callable, optional
        Where solved gears are kept beyond the process, as of `compliance`, which see: gears are used again here too.

    Raises
    ------
    base.InputError
        Tolerance, plane or edge length that make no sense.

    Warns
    -----
    base.RangeWarning
        For a disc whose bore leaves a rim below 1.2 tooth depths. Held all round on its inside such a rim cannot bend,
        and its root stress falls with its thickness, while that of a rim on a web rises.

    Examples
    --------
    >>> from fem import fillets
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> bodies = fillets(pair, tolerance=0.1)
    >>> bodies.error < 0.1
    True
    """
    faults = Faults()
    check_spur(faults, pair, "root stress")
    faults.number("tolerance", tolerance, TOLERANCE)
    check_plane(faults, plane)
    if fillet_edge is not None:
        faults.number("fillet_edge", fillet_edge, FILLET_EDGE)
    faults.raise_if_any()
    _warn_of_held_rims(pair)
    watch = Stopwatch()
    edge = COARSEST if fillet_edge is None else fillet_edge
    smallest = edge if fillet_edge is not None else COARSEST / 2**HALVINGS
    gears, results = GearStore(kept), []
    profiles = pair.teeth_profiles
    starts = pair.points.A, pair.line_of_action - pair.points.E
    first, second = (
        LoadedShape(shape, START * floor(start / (START * pair.module)))
        for shape, start in zip(shapes(pair, profiles, plane), starts, strict=True)
    )
    for loaded in (first, second):
        gear_edge = edge
        while True:
            solved = loaded.solved(gears, gear_edge)
            if solved.error <= tolerance or gear_edge <= smallest:
                break
            gear_edge *= 0.5
        results.append((solved, gear_edge))
    errors = np.array([solved.error for solved, _ in results])
    error = float(errors.max())
    finest = min(gear_edge for _, gear_edge in results)
    message = f"edges of {0.5 * finest:.3g} modules on the fillets, error {error:.1e}"
    if error > tolerance and fillet_edge is None:
        message += f", above the tolerance {tolerance:.1e}: the mesh is the finest allowed"
    pinion, wheel = (
        solved.influence.scaled(profile, PlaneElasticity.of(material, plane))
        for (solved, _), profile, material in zip(results, profiles, pair.materials, strict=True)
    )
    cost = Cost(
        watch.seconds,
        sum(solved.unknowns for solved, _ in results),
        parts=sum(gears.costs, Cost(0.0)).parts,
        counts={"annulus_unknowns": sum(solved.annulus_unknowns for solved, _ in results)},
    )
    settled = error < WORST or fillet_edge is not None
    if not settled:
        message += f"; from {WORST:.0%} on no figure is believed: lower the tolerance, or give the edge"
    return Fillets(pair, plane, pinion, wheel, 0.5 * finest, errors, (first, second), cost, settled, message)


def _warn_of_held_rims(pair: GearPair) -> None:
    """Warn of discs whose bore leaves so little that ISO 6336-3 raises the root stress for the rim's own bending."""
    for name, profile in zip(("pinion", "wheel"), pair.teeth_profiles, strict=True):
        if profile.steps or profile.rim_ratio >= THIN_RIM:
            continue
        message = (
            f"root stress of the {name}: its rim of {profile.rim_ratio:.3g} tooth depths is held at the bore, where it "
            "cannot bend, and its stress comes out too low (unsafe) unless a stiff shaft fills the bore"
        )
        if profile.rim_ratio > 0.5:
            message += f"; ISO 6336-3 raises it by Y_B = {rim_factor(profile.rim_ratio):.3g}"
        warnings.warn(f"{message}. Give the gear its rim and web (blank)", RangeWarning, stacklevel=3)


def _two_meshes(gears: GearStore, shape: GearShape, edge: float, low: float) -> SolvedFillets:
    """Influence of loads from a curvature radius on, on a refined mesh, and its error against the mesh it refines."""
    from meshes import mesh_sector, refined

    profile, law = shape.profile, shape.law
    coarse_mesh = mesh_sector(profile, fillet_sizes(edge))
    coarse = fillet_influence(ring_of(coarse_mesh, law), profile, 0, low)
    ring = ring_of(refined(coarse_mesh), law)
    fine = fillet_influence(ring, profile, shape.reach + 1, low)
    rho = np.linspace(*fine.rho_range, 15)
    greatest, other = (np.max(np.abs(influence.stress(0, rho)), axis=2) for influence in (fine, coarse))
    error = 0.5 * float(np.max(np.abs(other / greatest - 1))) + fine.noise / float(np.max(greatest))
    gears.costs.append(ring.cost)
    return SolvedFillets(fine, error, ring.cost.unknowns, ring.unknowns)


def fillet_sizes(edge: float) -> Sizes:
    """Fine on the fillets alone; a load near the tip needs no fine corner for what the root feels."""
    from meshes import Sizes

    return Sizes(fillet=edge, root=edge, flank=0.25, corner=0.1)
