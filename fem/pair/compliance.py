"""Compliance of both gears of a pair to a tolerance: choice of the mesh, estimate of its error.

The displacement at a load along the load is an energy, so its error is the square of the energy norm of the
finite elements' error: it falls nearly with the fourth power of the edge length (curved second-order elements;
see ``fem.elasticity.line_load``), always has the same sign, and hardly depends on the load's place. Two nested meshes
(``fem.influence.gear_shape.MeshLevel``) show it: with the order p, the finer one's error is their difference over
2^p - 1.
"""

from __future__ import annotations

from dataclasses import replace
from math import ceil, floor, log2
from typing import TYPE_CHECKING

import numpy as np

from base import Cost, Faults, Limit, Stopwatch
from base.results import WORST
from fem.elasticity.flamant import hertz_indentation
from fem.elasticity.plane_elasticity import PlaneElasticity, check_plane
from fem.elasticity.support import Support, held_profiles, on_both
from fem.influence.gear_shape import COARSE, FINE, MeshedShape, shapes
from fem.influence.gear_store import GearStore, ResultStore, SolvedFlanks, sized
from fem.influence.tip_strips import gain_beside
from fem.pair.checked import check_pair
from fem.pair.options import USUAL_OPTIONS, Options
from fem.pair.pair_compliance import PairCompliance

if TYPE_CHECKING:
    from gears import GearPair
    from meshes import Sizes

__all__ = ["PairCompliance", "compliance"]

TOLERANCE = Limit(2e-6, remedy="0.001 is 0.1 %")
"""The smallest one can be met with four refinements."""

REFINEMENTS = Limit(1, 5, remedy="leave it out", whole=True)

SAMPLES = (32, 48, 64)
"""Loads along a flank, more of them where the fit leaves too much of the tolerance."""

STEPS = 4
"""Of the edge length when it is halved for a tolerance: so few meshes are tried that pairs share their gears'."""


def compliance(
    pair: GearPair,
    tolerance: float = 0.001,
    plane: str = "strain",
    sizes: Sizes | None = None,
    refinements: int | None = None,
    supports: Support | tuple[Support, Support] | None = None,
    *,
    tip_edges: bool = False,
    motion: bool = False,
    kept: ResultStore | None = None,
    options: Options = USUAL_OPTIONS,
) -> PairCompliance:
    """Compliance of both gears, on the coarsest mesh that meets a tolerance.

    Two nested meshes are solved and the finer one is used. Its error is taken from the difference of the two
    with the order of convergence 3, plus what the fit along the flank leaves out. Where that is above the
    tolerance, edge lengths and number of loads follow from it for the next attempt.

    Each gear is solved in modules and E*, by itself. The process keeps what it has solved: a gear of the same shape,
    held at the same radius and with the same Poisson's ratio is used again, to the last bit, in any pair, of any size,
    modulus, face width and mate (`fem.forget_gears` forgets them).

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
    tip_edges : bool
        Solve the tip edges now. Contact outside the path needs them; they are solved when it first does.
    motion : bool
        Solve the flanks' motion now. Contacts that move need it; it is solved when they first do.
    kept : callable, optional
        Where solved gears are kept beyond the process: called with a name, with plain inputs, and with what computes
        the record where it has none.
    options : fem.Options
        How fine the mesh may get, and how its error is estimated.

    Returns
    -------
    PairCompliance
        Converged where its error is below 20 % (`base.results.WORST`), be it above the tolerance, or where
        `refinements` are given; errors above the tolerance are in its message.

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

    faults = Faults()
    check_pair(faults, pair)
    faults.number("tolerance", tolerance, TOLERANCE)
    check_plane(faults, plane)
    if refinements is not None:
        faults.number("refinements", refinements, REFINEMENTS)
    if faults.instance("options", options, Options, "as of fem.Options"):
        options.check(faults)
    faults.raise_if_any()
    watch = Stopwatch()
    held = on_both(supports)
    profiles = held_profiles(pair, held)
    gear_shapes = shapes(pair, profiles, plane)
    laws = [PlaneElasticity.of(material, plane) for material in pair.materials]
    sizes, times = sizes or Sizes(), refinements or 1
    gears = GearStore(kept)
    while True:
        first, second = (
            sized(_fitted(gears, MeshedShape(shape, sizes, times), options.fit * tolerance), pair.module, law)
            for shape, law in zip(gear_shapes, laws, strict=True)
        )
        mesh_error, fit_error = _errors(pair, (first, second), sizes.corner * 0.5**times, options.gain)
        error = mesh_error + fit_error
        finer = _finer(sizes, times, mesh_error, tolerance - min(fit_error, 0.5 * tolerance), options)
        if refinements is not None or error <= tolerance or finer is None:
            break
        sizes, times = finer
    message = f"mesh refined {times} time{'' if times == 1 else 's'}, error {error:.1e}"
    if error > tolerance and refinements is None:
        message = f"error {error:.1e} above the tolerance {tolerance:.1e}: the mesh is the finest allowed"
    settled = error < WORST or refinements is not None
    if not settled:
        message += (
            f"; from {WORST:.0%} on no figure is believed: lower the tolerance, or give the refinements"
        )
    bodies = PairCompliance(
        pair,
        plane,
        first.fine,
        second.fine,
        times,
        sizes,
        # every tooth that may touch together with another one, tip edges outside the path at both ends included
        min(ceil(pair.contact_ratio) + 1, *(len(solved.fine.cross_series) for solved in (first, second))),
        (first.coarse, second.coarse),
        (first.coarse_backs, second.coarse_backs),
        error,
        Cost(0.0),
        settled,
        message,
        supports=held,
        fit_error=fit_error,
        gain=options.gain,
    )
    tips, coarse_tips = (bodies.tips_of(gears, level) if tip_edges else None for level in (FINE, COARSE))
    motions = bodies.motions_of(gears) if motion else None
    parts = sum(gears.costs, Cost(0.0)).parts
    counts = {"annulus_unknowns": first.annulus_unknowns + second.annulus_unknowns}
    cost = Cost(watch.seconds, first.unknowns + second.unknowns, parts=parts, counts=counts)
    return replace(bodies, tip_strips=tips, coarse_tip_strips=coarse_tips, flank_motions=motions, cost=cost)


def _fitted(gears: GearStore, meshed: MeshedShape, most: float) -> SolvedFlanks:
    """Solve one gear in modules and E*, with as many loads as the fit needs to leave at most a relative error."""
    local = float(hertz_indentation(0.1, meshed.shape.law, 1.0))
    for count in SAMPLES:
        flanks = gears.flanks(meshed, count)
        least = local + float(np.min(flanks.fine.own(flanks.rho)))
        if flanks.fine.fit_error <= most * least:
            break
    return flanks


def _errors(
    pair: GearPair, gears: tuple[SolvedFlanks, SolvedFlanks], edge: float, gain: float
) -> tuple[float, float]:
    """Errors by the mesh and by the fit, relative to the deflection of a pair, largest along the path.

    The element at the corner has a length ``edge`` [modules]; beside it a refinement gains less.
    """
    rho1 = np.linspace(pair.points.A, pair.points.E, 60)
    own, change = np.zeros_like(rho1), np.zeros_like(rho1)
    for gear, rho in zip(gears, (rho1, pair.line_of_action - rho1), strict=True):
        flexible = gear.fine
        own += flexible.own(rho) + hertz_indentation(0.1 * pair.module, flexible.law, pair.module)
        away = (flexible.rho_end**2 - np.clip(rho, *flexible.rho_range) ** 2) / (2 * flexible.base_radius)
        change += gear.change_at(rho) / gain_beside(away / (edge * pair.module), gain)
    crossed = sum(gear.cross_change for gear in gears) / float(np.min(own))
    fit = sum(gear.fine.fit_error for gear in gears) / float(np.min(own))
    return max(float(np.max(np.abs(change / own))), crossed / gain), fit


def _finer(
    sizes: Sizes, times: int, error: float, tolerance: float, options: Options
) -> tuple[Sizes, int] | None:
    """Edge lengths and refinements that should bring an error below a tolerance; None beyond the finest."""
    if error <= tolerance:  # it is the fit that errs, or nothing
        return None
    factor = (0.6 * tolerance / error) ** (1 / options.order) if np.isfinite(error) else 0.5
    halvings = max(0, floor(-log2(factor) + 0.3))
    factor = 2 ** (floor(STEPS * log2(factor)) / STEPS)
    if times + halvings > options.finest:
        return None
    return sizes.scaled(min(factor * 2**halvings, 1.0)), times + halvings
