"""Compliance of both gears of a pair to a tolerance: choice of the mesh, estimate of its error.

The displacement at a load along the load is an energy, so its error is the square of the energy norm of the
finite elements' error: it falls nearly with the fourth power of the edge length (curved second-order elements;
see ``fem.line_load``), always has the same sign, and hardly depends on the load's place. Two nested meshes show
it: with the order p, the finer one's error is their difference over 2^p - 1.
"""

from __future__ import annotations

from math import ceil, floor, log2
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Cost, Faults, Limit, Stopwatch, record
from fem.bodies import Compliance
from fem.elasticity import PlaneElasticity, check_plane
from fem.flamant import hertz_indentation
from fem.gear_compliance import FlankSamples, GearCompliance, gear_compliance, sample_places, sampled
from fem.ring import Ring, ring_of
from fem.support import Support, held_profiles, on_both
from fem.tip_strips import tip_strips

if TYPE_CHECKING:
    from gears import GearPair, ToothProfile
    from meshes import Sizes

__all__ = ["Compliance", "compliance"]

ORDER = 3.0
"""Order of convergence of the displacement at a load: 4 in the limit, 3 to 3.7 on meshes in use, least at the tip."""

FINEST = 4
"""Most refinements that a tolerance may ask for."""

TOLERANCE = Limit(2e-6, remedy="0.001 is 0.1 %")
"""The least one can be met with those refinements."""

REFINEMENTS = Limit(1, FINEST + 1, remedy="leave it out", whole=True)

SAMPLES = (20, 32, 48, 64)
"""Loads along a flank: more of them where the fit leaves too much."""


@record
class _Gear:
    """One gear on one mesh: fitted compliance, change of the samples from the coarser mesh."""

    ring: Ring
    fine: GearCompliance
    samples: FlankSamples
    coarse: FlankSamples
    cost: Cost

    def change(self, rho: Array) -> Array:
        """By how much ``own`` grew from the coarser mesh at rho (n,) [m] [m per N/m]."""
        return np.interp(rho, self.samples.rho, self.samples.own - self.coarse.own)

    @property
    def cross_change(self) -> float:
        """Largest change of a cross term [m per N/m]."""
        return float(np.max(np.abs(self.samples.cross - self.coarse.cross), initial=0.0))


def compliance(
    pair: GearPair,
    tolerance: float = 0.001,
    plane: str = "strain",
    sizes: Sizes | None = None,
    refinements: int | None = None,
    supports: Support | tuple[Support, Support] | None = None,
) -> Compliance:
    """Compliance of both gears, on the coarsest mesh that meets a tolerance.

    Two nested meshes are solved and the finer one is used. Its error is taken from the difference of the two
    with the order of convergence 3, plus what the fit along the flank leaves out. Where that is above the
    tolerance, edge lengths and number of loads follow from it for the next attempt.

    Parameters
    ----------
    pair : gears.GearPair
    tolerance : float
        Relative, on the deflection of a pair anywhere on the path; at least 2e-6.
    plane : {"strain", "stress"}
        Plane strain for gears wider than a few modules.
    sizes : meshes.Sizes, optional
        Of the mesh to begin with, before it is refined.
    refinements : int, optional
        Fixes the mesh instead of the tolerance: 1 to 5.
    supports : Support or (Support, Support), optional
        Rigid hubs of both gears, or of pinion and wheel; held on the bores unless given.

    Returns
    -------
    Compliance

    Raises
    ------
    base.InputError
        Tolerance or plane that make no sense, a hub that does not fit.

    Examples
    --------
    >>> from fem import compliance
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> bodies = compliance(pair, tolerance=0.05)
    >>> bodies.converged and bodies.error < 0.05
    True
    """
    from meshes import Sizes

    found = Faults()
    found.number("tolerance", tolerance, TOLERANCE)
    check_plane(found, plane)
    if refinements is not None:
        found.number("refinements", refinements, REFINEMENTS)
    found.raise_if_any()
    watch = Stopwatch()
    held = on_both(supports)
    profiles = held_profiles(pair, held)
    # every tooth that may touch together with another one, tip edges outside the path at both ends included
    reach = ceil(pair.contact_ratio) + 1
    sizes, level = sizes or Sizes(), refinements or 1
    cost = Cost(0.0)
    while True:
        gears = [
            _solved(pair, gear, profiles[gear], plane, sizes, level, tolerance, reach) for gear in (0, 1)
        ]
        cost = sum((gear.cost for gear in gears), cost)
        mesh_error, fit_error = _errors(pair, (gears[0], gears[1]))
        error = mesh_error + fit_error
        finer = _finer(sizes, level, mesh_error, tolerance - min(fit_error, 0.5 * tolerance))
        if refinements is not None or error <= tolerance or finer is None:
            break
        sizes, level = finer
    converged = bool(error <= tolerance) or refinements is not None
    message = f"mesh refined {level} times, error {error:.1e}"
    if not converged:
        message = (
            f"error {error:.1e} above the tolerance {tolerance:.1e} on the finest mesh allowed; ask for less"
        )
    rings = gears[0].ring, gears[1].ring
    started = watch.seconds
    first, second = (tip_strips(*both) for both in zip(rings, profiles, strict=True))
    cost = Cost(
        watch.seconds,
        sum(len(ring.inner) + len(ring.cut) for ring in rings),
        parts={**cost.parts, "tips": watch.seconds - started},
        counts={"annulus_unknowns": sum(ring.unknowns for ring in rings)},
    )
    return Compliance(
        pair,
        plane,
        gears[0].fine,
        gears[1].fine,
        (first, second),
        level,
        sizes,
        reach,
        error,
        cost,
        converged,
        message,
        supports=held,
        kept_rings=rings,
    )


def _solved(
    pair: GearPair,
    gear: int,
    profile: ToothProfile,
    plane: str,
    sizes: Sizes,
    level: int,
    tolerance: float,
    reach: int,
) -> _Gear:
    """Solve one gear on two nested meshes."""
    from meshes import mesh_sector

    watch = Stopwatch()
    mesh = mesh_sector(profile, sizes, level)
    meshed = watch.seconds
    assert mesh.coarser is not None
    law = PlaneElasticity.of(pair.materials[gear], plane)
    rings = [ring_of(one, law) for one in (mesh.coarser, mesh)]
    started = watch.seconds
    # tip edges touch the flanks inside A..E too (fem.tip_contact): no flank is loaded below these ends
    low = (pair.points.A, pair.line_of_action - pair.points.E)[gear]
    local = float(hertz_indentation(0.1 * pair.module, law, pair.module))
    for count in SAMPLES:
        samples = sampled(rings[1], sample_places(profile, low, count), reach)
        fine = gear_compliance(rings[1], profile, samples)
        if fine.fit_error <= 0.1 * tolerance * (local + float(np.min(samples.own))):
            break
    coarse = sampled(rings[0], samples.rho, reach)
    own = Cost(watch.seconds, parts={"mesh": meshed, "solve": watch.seconds - started})
    return _Gear(rings[1], fine, samples, coarse, sum((ring.cost for ring in rings), own))


def _errors(pair: GearPair, gears: tuple[_Gear, _Gear]) -> tuple[float, float]:
    """Errors by the mesh and by the fit, relative to the deflection of a pair, largest along the path."""
    rho1 = np.linspace(pair.points.A, pair.points.E, 60)
    own, change = np.zeros_like(rho1), np.zeros_like(rho1)
    for gear, rho in zip(gears, (rho1, pair.line_of_action - rho1), strict=True):
        own += gear.fine.own(rho) + hertz_indentation(0.1 * pair.module, gear.fine.law, pair.module)
        change += gear.change(rho)
    crossed = sum(gear.cross_change for gear in gears) / float(np.min(own))
    fit = sum(gear.fine.fit_error for gear in gears) / float(np.min(own))
    return max(float(np.max(np.abs(change / own))), crossed) / (2**ORDER - 1), fit


def _finer(sizes: Sizes, level: int, error: float, tolerance: float) -> tuple[Sizes, int] | None:
    """Edge lengths and refinements that should bring an error below a tolerance; None beyond the finest."""
    if error <= tolerance:  # it is the fit that errs, or nothing
        return None
    factor = (0.6 * tolerance / error) ** (1 / ORDER) if np.isfinite(error) else 0.5
    halvings = max(0, floor(-log2(factor) + 0.3))
    if level + halvings > FINEST:
        return None
    return sizes.scaled(min(factor * 2**halvings, 1.0)), level + halvings
