"""Stress along the fillets by a line load anywhere on the flank of the same or of a neighbouring tooth.

The stress is linear in the loads. On the loaded tooth it is the sum of the half-plane's stress, in closed form
(``fem.flamant``), and of the regular part u_r of the finite elements, which varies smoothly with the load's
place and is kept as a Chebyshev series in the curvature radius rho; on the other teeth the finite elements
give all of it. With the free edge's normal stress zero, sigma_t = E* eps_t(u_r) + sigma_s,tt - nu* sigma_s,nn.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from functools import partial
from math import floor
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, Cost, Faults, Integers, Limit, RangeWarning, Stopwatch, part, quantity, record
from fem import flamant
from fem.elasticity import MIRROR, PlaneElasticity, check_plane
from fem.fillet import FilletLine, fillet_line, fillet_stress_matrix
from fem.gear_compliance import CORNER_CLEARANCE
from fem.gear_shape import GearShape, shapes
from fem.line_load import LineLoads, flank_points, line_loads
from fem.ring import Ring, ring_of
from fem.solved_gear import Gears, Kept
from gears.closed_form.root_stress import THIN_RIM, rim_factor

if TYPE_CHECKING:
    from gears import GearPair, ToothProfile
    from meshes import Sizes

__all__ = ["FilletInfluence", "Fillets", "fillet_influence", "fillets"]

LOADS, DEGREE = 24, 14

COARSEST, HALVINGS = 0.16, 3
"""Edge length on the fillets of the first mesh in modules (before its refinement), and how often a tolerance
may halve it."""

START = 0.05
"""Steps [modules] of the least curvature radius of loads, so that mates of nearly equal reach share a solution.
Nearer to the fillet no short series follows the stress, of undercut teeth least of all."""

TOLERANCE = Limit(0.0, low_open=True, remedy="0.005 is 0.5 %")
FILLET_EDGE = Limit(0.002, 1.0, "modules", "leave it out")

ON_SAMPLE = 1e-4
"""Of the samples' distance: a load nearer to a sample stands on it, where rounding would grow beyond bounds."""

SIDES = ("left", "right")


@record
class FilletInfluence:
    """Tangential stress on the fillets of one gear per unit line load on its left flank.

    Attributes
    ----------
    profile : gears.ToothProfile
    law : PlaneElasticity
    line : FilletLine
        Sample points of a fillet.
    rho_range : (float, float)
        Curvature radii of loads [m].
    series : mapping of int to (degree + 1, 2, n) array
        For each tooth, counted anticlockwise from the loaded one: Chebyshev coefficients over ``rho_range`` of
        the stress [1/m] at the samples of its left (index 0) and right fillet; without the half-plane's part
        on tooth 0.
    noise : float
        Largest distance of a sample from its fit [1/m].
    """

    profile: ToothProfile
    law: PlaneElasticity
    line: FilletLine
    rho_range: tuple[float, float]
    series: Mapping[int, Array]
    noise: float

    def scaled(self, profile: ToothProfile, law: PlaneElasticity) -> FilletInfluence:
        """Give a gear in modules its size; the stress per line load does not depend on the modulus."""
        module = profile.module
        low, high = self.rho_range
        series = {tooth: coefficients / module for tooth, coefficients in self.series.items()}
        return FilletInfluence(
            profile,
            law,
            fillet_line(profile),
            (low * module, high * module),
            series,
            self.noise / module,
        )

    def stress(self, tooth: int, rho: Array) -> Array:
        """Tangential stress (loads, 2, n) [Pa per N/m] on a tooth's left and right fillet.

        Parameters
        ----------
        tooth : int
            Anticlockwise from the loaded one.
        rho : (loads,) array
            Curvature radius at each load [m]; beyond the range it is moved to its end.
        """
        low, high = self.rho_range
        rho = np.clip(rho, low, high)
        if tooth not in self.series:
            return np.zeros((len(rho), 2, len(self.line.arc)))
        unit = (2 * rho - low - high) / (high - low)
        stress = np.moveaxis(chebyshev.chebval(unit, self.series[tooth]), -1, 0)
        return np.asarray(stress + self._half_plane(rho) if tooth == 0 else stress)

    def _half_plane(self, rho: Array) -> Array:
        """Flamant's part E* eps_t on the loaded tooth, (loads, 2, n)."""
        loads, inward = self.profile.involute(rho) * MIRROR, -self.profile.normal(rho) * MIRROR
        parts = [
            flamant_along(loads, inward, *self.line.side(side == "left"), self.law.plane_poisson)
            for side in SIDES
        ]
        return np.stack(parts, axis=1)


def flamant_along(
    loads: Array, inward: Array, points: Array, tangents: Array, normals: Array, poisson: float
) -> Array:
    """sigma_tt - nu* sigma_nn of unit line loads on half-planes at points of a curve, (loads, points) [1/m]."""
    away = points[None] - loads[:, None]
    along = np.einsum("lpa,la->lp", away, inward)
    r2 = np.sum(away**2, axis=2)
    t2 = np.einsum("lpa,pa->lp", away, tangents) ** 2
    n2 = np.einsum("lpa,pa->lp", away, normals) ** 2
    # a load on the sample itself, at the foot of an involute that begins there, acts on the flank only
    apart = r2 > (ON_SAMPLE * np.linalg.norm(points[1] - points[0])) ** 2
    safe = np.where(apart, r2, 1.0)
    return np.asarray(np.where(apart, -2 * along * (t2 - poisson * n2) / (np.pi * safe**2), 0.0))


def fillet_influence(ring: Ring, profile: ToothProfile, reach: int, rho_low: float = 0.0) -> FilletInfluence:
    """Load the left flank at Chebyshev places, all with the ring's factorisation, and fit.

    Parameters
    ----------
    ring : Ring
    profile : gears.ToothProfile
        That the ring's mesh was made of.
    reach : int
        Teeth on either side of the loaded one.
    rho_low : float
        Least curvature radius of loads [m], if the flank goes on below it.
    """
    low, high = max(rho_low, profile.flank_rho[0]), profile.flank_rho[1] - CORNER_CLEARANCE * profile.module
    unit = np.cos(np.pi * (np.arange(LOADS) + 0.5) / LOADS)
    unit /= unit[0]  # stretched to include both ends
    loads = line_loads(ring, flank_points(ring.mesh, 0.5 * (low + high) + 0.5 * (high - low) * unit))
    line = fillet_line(profile)
    recover = [fillet_stress_matrix(ring.mesh, profile, line, ring.law, side) for side in SIDES]
    touched = np.unique(np.concatenate([matrix.indices for matrix in recover]))
    fit = np.linalg.pinv(chebyshev.chebvander(unit, DEGREE))
    noise, series = 0.0, {}
    for tooth in range(-reach, reach + 1):
        moved = _displacements(ring, loads, tooth, touched)
        stress = np.stack([(matrix[:, touched] @ moved).T for matrix in recover], axis=1)
        series[tooth] = np.einsum("dl,lsn->dsn", fit, stress)
        fitted = np.moveaxis(chebyshev.chebval(unit, series[tooth]), -1, 0)
        noise = max(noise, float(np.max(np.abs(fitted - stress))))
    return FilletInfluence(profile, ring.law, line, (low, high), series, noise)


def _displacements(ring: Ring, loads: LineLoads, tooth: int, unknowns: Integers) -> Array:
    """Displacements (unknowns, loads) of a tooth's sector, without the half-plane's part on tooth 0."""
    cuts = np.asarray(ring.polar @ ring.interfaces(loads.cut_force, tooth))
    moved = np.empty((len(unknowns), cuts.shape[1]))
    place = np.full(ring.mesh.unknowns, -1)
    place[ring.inner] = np.arange(len(ring.inner))
    inside = place[unknowns] >= 0
    rows = place[unknowns[inside]]
    moved[inside] = -ring.inner_by_cut[rows] @ cuts + (loads.own_inner[rows] if tooth == 0 else 0.0)
    place[ring.cut] = np.arange(len(ring.cut))
    border = unknowns[~inside]
    moved[~inside] = cuts[place[border]]
    if tooth == 0 and len(border):
        nodes = ring.mesh.points[border // 2]
        for i, (load, inward) in enumerate(zip(loads.at.points, loads.at.inward, strict=True)):
            u = flamant.displacement(nodes, load, inward, ring.law, ring.mesh.module)
            moved[~inside, i] -= u[np.arange(len(border)), border % 2]
    return moved


@record
class Fillets:
    """Influence of loads on the fillets of both gears, and how exact it is."""

    headline = ("plane", "fillet_edge")

    pair: GearPair = part("the gears")
    plane: str = part('"strain" or "stress"')
    pinion: FilletInfluence = part("influence on the fillets of the pinion")
    wheel: FilletInfluence = part("influence on the fillets of the wheel")
    fillet_edge: float = quantity("1", "edge length on the fillets of the mesh in use, in modules")
    error: float = quantity(
        "1", "estimated relative error of the greatest stress on a fillet, from two nested meshes"
    )
    cost: Cost
    converged: bool
    message: str


@record
class _SolvedFillets:
    """Influence of one gear in modules, with its error and the size of what was solved."""

    influence: FilletInfluence
    error: float
    unknowns: int
    annulus_unknowns: int


def fillets(
    pair: GearPair,
    tolerance: float = 0.005,
    plane: str = "strain",
    fillet_edge: float | None = None,
    *,
    kept: Kept | None = None,
) -> Fillets:
    """Influence functions of both gears on a mesh whose fillets are as fine as the tolerance asks for.

    Each mesh is solved with its own refinement (every triangle in four). The error is taken as half of the
    largest difference of the greatest stress, over loads along the flank and both fillets (the observed order
    of a maximum that hops between elements is 1.5 to 2.5), plus what the Chebyshev fit leaves over. At the ends
    of a fillet, where its curvature jumps, the stress itself is several times less exact than its maximum.

    Parameters
    ----------
    pair : gears.GearPair
    tolerance : float
        Relative, on the greatest stress along a fillet.
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
    found = Faults()
    found.number("tolerance", tolerance, TOLERANCE)
    check_plane(found, plane)
    if fillet_edge is not None:
        found.number("fillet_edge", fillet_edge, FILLET_EDGE)
    found.raise_if_any()
    _warn_of_held_rims(pair)
    watch = Stopwatch()
    edge = COARSEST if fillet_edge is None else fillet_edge
    smallest = edge if fillet_edge is not None else COARSEST / 2**HALVINGS
    gears, results = Gears(kept), []
    profiles = pair.teeth_profiles
    starts = pair.points.A, pair.line_of_action - pair.points.E
    for shape, start in zip(shapes(pair, profiles, plane), starts, strict=True):
        gear_edge, low = edge, START * floor(start / (START * pair.module))
        while True:
            solved = gears.record(
                "fillets", (shape, gear_edge, low), partial(_two_meshes, gears, shape, gear_edge, low)
            )
            if solved.error <= tolerance or gear_edge <= smallest:
                break
            gear_edge *= 0.5
        results.append((solved, gear_edge))
    error = max(solved.error for solved, _ in results)
    converged = error <= tolerance or fillet_edge is not None
    finest = min(gear_edge for _, gear_edge in results)
    message = f"edges of {0.5 * finest:.3g} modules on the fillets, error {error:.1e}"
    if not converged:
        message += f", above the tolerance {tolerance:.1e} on the finest mesh allowed; ask for less"
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
    return Fillets(pair, plane, pinion, wheel, 0.5 * finest, error, cost, converged, message)


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


def _two_meshes(gears: Gears, shape: GearShape, edge: float, low: float) -> _SolvedFillets:
    """Influence of loads from a curvature radius on, on a refined mesh, and its error against the mesh it refines."""
    from meshes import mesh_sector, refined

    profile, law = shape.profile, shape.law
    coarse_mesh = mesh_sector(profile, _sizes(edge))
    coarse = fillet_influence(ring_of(coarse_mesh, law), profile, 0, low)
    ring = ring_of(refined(coarse_mesh), law)
    fine = fillet_influence(ring, profile, shape.reach + 1, low)
    rho = np.linspace(*fine.rho_range, 15)
    greatest, other = (np.max(np.abs(found.stress(0, rho)), axis=2) for found in (fine, coarse))
    error = 0.5 * float(np.max(np.abs(other / greatest - 1))) + fine.noise / float(np.max(greatest))
    gears.costs.append(ring.cost)
    return _SolvedFillets(fine, error, ring.cost.unknowns, ring.unknowns)


def _sizes(edge: float) -> Sizes:
    """Fine on the fillets alone; a load near the tip needs no fine corner for what the root feels."""
    from meshes import Sizes

    return Sizes(fillet=edge, root=edge, flank=0.25, corner=0.1)
