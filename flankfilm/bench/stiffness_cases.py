"""Cases of the finite elements: compliance, loaded contact, root stress."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.bench.case import (
    Answer,
    Case,
    Levels,
    PeerWork,
    Series,
    answer,
    case,
    level,
    over,
    percent,
    value,
)
from flankfilm.bench.examples import TORQUE, example_pair
from flankfilm.bench.gear_cases import FORMS, independent_pairs
from flankfilm.bench.work_cases import anew, work_contact

if TYPE_CHECKING:
    from base import Array
    from fem import Fillets, MeshCycle, PairCompliance, RootStress
    from gears import GearPair
    from gears.sharing.events import Division


POSITIONS, HELIX = 40, 20.0
MEAN, SPREAD, SINGLE = "mean mesh stiffness", "transmission error, peak to peak", "one pair, 39 places"


def compliances(quick: bool) -> tuple[Case, ...]:
    """Compliance of the usual pair, and where the geometry is harder: at the limit of undercut, and a large wheel."""
    others = () if quick else (compliance_of(17, 43), compliance_of(20, 1000))
    return compliance(quick), *others


def _single(pair: GearPair, bodies: PairCompliance) -> Array:
    """Stiffness of one pair at 39 places inside the path of contact."""
    import fem

    rho1 = np.linspace(pair.points.A, pair.points.E, 41)[1:-1]
    return fem.single_pair_stiffness(pair, pair.normal_force(0.5 * TORQUE), rho1, bodies)


@case("Compliance of both gears", "unknowns of both sectors")
def compliance(quick: bool) -> Levels:
    """Both gears' compliance and the mesh cycle held to the path, by edge length and by tolerance.

    Pair 36/40 at {TORQUE:g} N m, from nothing: two nested meshes of both gears, all flank loads, and the mesh cycle at
    {POSITIONS} positions with contact held to the path of contact. The estimate is the largest along the path, cross
    terms of neighbouring teeth included. The closed forms leave out the bodies that pairs share.
    """
    import fem
    from meshes import Sizes

    pair = example_pair()

    def cycle(**how: Any) -> tuple[PairCompliance, MeshCycle]:
        bodies = anew(pair, **how)
        return bodies, fem.mesh_cycle(pair, TORQUE, POSITIONS, bodies, beyond_path=False)

    def mean_and_single(solution: tuple[PairCompliance, MeshCycle]) -> Answer:
        bodies, held = solution
        values = {
            MEAN: value(held.secant_stiffness.mean(), held.error),
            SINGLE: value(_single(pair, bodies), bodies.error),
        }
        return answer(bodies.cost.unknowns, values, bodies)

    def edges(factor: float, refinements: int = 1, **how: Any) -> tuple[PairCompliance, MeshCycle]:
        return cycle(sizes=Sizes().scaled(factor), refinements=refinements, **how)

    factors = (2.0, 1.4, 1.0) if quick else (2.0, 1.4, 1.0, 0.7, 0.5)
    tolerances = (1e-3,) if quick else (1e-3, 1e-4, 2e-5)
    finest = ("edges x 0.6", 0.6, 1) if quick else ("refined 3 times", 1.0, 3)
    series = (
        over(factors, "edges x {:g}".format, edges, mean_and_single, name="edge lengths"),
        over(tolerances, percent, lambda t: cycle(tolerance=t), mean_and_single, name="tolerances"),
        *_forms(pair),
    )
    peers = (PeerWork("ross_stiffness", _inputs(pair), MEAN),)
    best = level(finest[0], lambda *size: edges(*size, tolerance=1e-5), mean_and_single, *finest[1:])
    return Levels(series, best, dict.fromkeys((MEAN, SINGLE), 2.0), peers)


@case("Compliance of both gears, {z1}/{z2}", "unknowns of both sectors", "compliance_{z1}_{z2}")
def compliance_of(z1: int, z2: int) -> Levels:
    """Compliance of a pair by tolerance.

    Pair {z1}/{z2}, module 2 mm, face 40 mm, bores of half the root radii: from nothing, to a tolerance.
    """
    import fem
    from gears import Gear, GearPair

    pair = GearPair(Gear(z1), Gear(z2), 2e-3, 0.04)

    def single_and_spread(bodies: PairCompliance) -> Answer:
        held = fem.mesh_cycle(pair, 0.5 * TORQUE, POSITIONS, bodies, beyond_path=False)
        values = {
            SINGLE: value(_single(pair, bodies), bodies.error),
            SPREAD: value(np.ptp(held.transmission_error), bodies.error),
        }
        return answer(bodies.cost.unknowns, values, bodies)

    series = over((1e-3, 1e-4, 2e-5), percent, anew, single_and_spread, pair, name="tolerances")
    return Levels(
        (series,), level("refined 3 times", lambda: anew(pair, 1e-5, refinements=3), single_and_spread)
    )


def _forms(pair: GearPair) -> tuple[Series, ...]:
    """Closed forms on the same positions: their distance from the finite elements has no estimate."""

    def mean(curve: Any) -> Answer:
        return Answer(float("nan"), {MEAN: value(curve.mean())})

    return tuple(
        Series(title, (level("pairs added", independent_pairs, mean, pair, form, POSITIONS),))
        for form, title in FORMS.items()
    )


def _inputs(pair: GearPair) -> dict[str, Any]:
    material = pair.materials[0]
    return {
        "module": pair.module,
        "width": pair.face_width,
        "teeth": [profile.teeth for profile in pair.teeth_profiles],
        "bores": [profile.bore_radius for profile in pair.teeth_profiles],
        "youngs_modulus": material.youngs_modulus,
        "poisson_ratio": material.poisson_ratio,
        "density": material.density,
        "positions": POSITIONS,
    }


def contacts(quick: bool) -> tuple[Case, ...]:
    """Loaded contact held to the path and beyond it, and work with a compliance at hand."""
    held = contact("held", "held to the path", False, quick)
    free = contact("free", "tip edges free to touch", True, quick)
    return (held, free) if quick else (held, free, lines_of_contact(), work_contact())


@case("Loaded contact, {words}", "positions", "contact_{short}")
def contact(short: str, words: str, beyond: bool, quick: bool) -> Levels:
    """Loaded contact with a compliance at hand, by the number of positions at which it is solved.

    Pair 36/40 at {TORQUE:g} N m, compliance at hand: mean stiffness and peak-to-peak transmission error by midpoints of
    equal intervals of one base pitch, and by smooth arcs between the events at which contacts begin and end, to a
    tolerance. Errors from sampling alone: where a pair comes in and leaves, the stiffness jumps or has a corner.
    """
    import fem

    pair = example_pair()
    bodies = fem.compliance(pair)

    def cycle(positions: int) -> MeshCycle:
        return fem.mesh_cycle(pair, TORQUE, positions, bodies, beyond_path=beyond)

    def sampled(mesh_cycle: MeshCycle) -> Answer:
        curve, moved = mesh_cycle.secant_stiffness, mesh_cycle.transmission_error
        return answer(curve.size, {MEAN: value(curve.mean()), SPREAD: value(np.ptp(moved))}, mesh_cycle)

    def arcs(tolerance: float) -> Division:
        problem = fem.mesh_cycle(pair, TORQUE, 1, bodies, beyond_path=beyond, tolerance=tolerance).problem
        assert problem is not None
        return problem.divided()

    def between(division: Division) -> Answer:
        mean, off = division.arcs.mean("secant_stiffness")
        (least, low), (most, high) = division.arcs.extremes("transmission_error")
        values = {
            MEAN: value(mean, off / mean),
            SPREAD: value(most - least, (low + high) / (most - least)),
        }
        return answer(division.samples, values)

    counts = (12, 48, 192) if quick else (12, 24, 48, 96, 192, 384)
    tolerances = (1e-2, 1e-4) if quick else (1e-1, 1e-2, 1e-3, 1e-4)
    series = (
        over(counts, "{} positions".format, cycle, sampled, name="equal intervals"),
        over(tolerances, percent, arcs, between, name="arcs between events"),
    )
    return Levels(series, level(percent(1e-6), arcs, between, 1e-6))


@case("Loaded contact, lines of contact", "cells")
def lines_of_contact() -> Levels:
    """Loaded contact of a helical pair, both gears at hand, by the number of cells over the face.

    Pair 36/40 of {HELIX:g} degrees at {TORQUE:g} N m and {POSITIONS} positions: mean stiffness, peak-to-peak
    transmission error and the largest line-load factor. The estimate of the factor is all that half as many cells
    change. The first solution at a number of cells puts the compliance between them together; later ones have it, as
    further loads do.
    """
    import fem

    pair = replace(example_pair(), helix_angle=np.radians(HELIX).item())
    bodies = fem.compliance(pair)
    factor = "line-load factor"

    def cycle(cells: int) -> MeshCycle:
        return fem.mesh_cycle(pair, TORQUE, POSITIONS, bodies, cells=cells)

    def of_lines(held: MeshCycle) -> Answer:
        assert held.lines is not None  # of a helical pair
        values = {
            MEAN: value(held.secant_stiffness.mean()),
            SPREAD: value(np.ptp(held.transmission_error)),
            factor: value(held.lines.greatest_line_load_factor, held.lines.error),
        }
        return answer(held.lines.z.shape[-1], values, held)

    cycle(8)  # solves both gears
    series = over((16, 32, 64), "{} cells".format, cycle, of_lines, name="cells of the face")
    return Levels((series,), level("128 cells", cycle, of_lines, 128))


@case("Root stress", "edges per module on the fillets")
def root_stress(quick: bool) -> Levels:
    """Maximum root stress by the edge length on the fillets and by tolerance.

    Pair 36/40 at {TORQUE:g} N m, mesh cycle at hand: influence of flank loads on all fillets, from nothing, and the
    maximum tension over {POSITIONS} positions.
    """
    import fem

    pair = example_pair()
    cycle = fem.mesh_cycle(pair, TORQUE, POSITIONS)
    quantity = "maximum tension, both gears"

    def stress(**how: Any) -> tuple[Fillets, RootStress]:
        fillets = fem.fillets(pair, **how)
        return fillets, fem.root_stress(pair, cycle, fillets)

    def greatest(solution: tuple[Fillets, RootStress]) -> Answer:
        roots, stresses = solution
        tension = [gear.greatest_tension.stress_Pa for gear in (stresses.pinion, stresses.wheel)]
        return answer(1.0 / roots.fillet_edge, {quantity: value(tension, roots.error)}, roots)

    def edges(length: float) -> tuple[Fillets, RootStress]:
        return stress(fillet_edge=length)

    def modules(length: float) -> str:
        return f"{length / 2:g} modules"

    lengths = (0.32, 0.16) if quick else (0.32, 0.16, 0.08, 0.04)
    tolerances = (0.02,) if quick else (0.02, 0.005, 0.001)
    least = 0.08 if quick else 0.02
    series = (
        over(lengths, modules, edges, greatest, name="edge lengths"),
        over(tolerances, percent, lambda t: stress(tolerance=t), greatest, name="tolerances"),
    )
    return Levels(series, level(modules(least), edges, greatest, least), {quantity: 2.0})
