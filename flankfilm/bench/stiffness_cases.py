"""Cases of the finite elements: compliance, loaded contact, root stress."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.bench.case import Answer, Case, PeerWork, Series, Value, level
from flankfilm.bench.examples import TORQUE, example_pair
from flankfilm.bench.gear_cases import FORMS, independent_pairs
from flankfilm.bench.work_cases import contact_work

if TYPE_CHECKING:
    from base import Array
    from fem import Compliance, Fillets, MeshCycle, RootStress
    from gears import GearPair

__all__ = ["compliance", "contact", "root_stress"]

POSITIONS = 40


def compliance(quick: bool) -> tuple[Case, ...]:
    """Both gears' compliance and the mesh cycle held to the path, by edge length and by tolerance."""
    import fem
    from meshes import Sizes

    pair = example_pair()
    rho1 = np.linspace(pair.points.A, pair.points.E, 41)[1:-1]
    mesh, single = "mean mesh stiffness", "one pair, 39 places"

    def cycle(**how: Any) -> tuple[Compliance, MeshCycle]:
        bodies = fem.compliance(pair, **how)
        return bodies, fem.mesh_cycle(pair, TORQUE, POSITIONS, bodies, beyond_path=False)

    def answer(found: tuple[Compliance, MeshCycle]) -> Answer:
        bodies, held = found
        one = fem.single_pair_stiffness(pair, pair.normal_force(0.5 * TORQUE), rho1, bodies)
        values = {
            mesh: Value(np.array([held.secant_stiffness.mean()]), held.error),
            single: Value(one, bodies.error),
        }
        return Answer(bodies.cost.unknowns, values, "" if bodies.converged else bodies.message)

    def edges(factor: float) -> tuple[Compliance, MeshCycle]:
        return cycle(sizes=Sizes().scaled(factor), refinements=1)

    def tolerance(value: float) -> tuple[Compliance, MeshCycle]:
        return cycle(tolerance=value)

    def refined(times: int, factor: float) -> tuple[Compliance, MeshCycle]:
        return cycle(tolerance=1e-5, refinements=times, sizes=Sizes().scaled(factor))

    factors = (2.0, 1.4, 1.0) if quick else (2.0, 1.4, 1.0, 0.7, 0.5)
    tolerances = (1e-3,) if quick else (1e-3, 1e-4, 2e-5)
    finest = (1, 0.6) if quick else (3, 1.0)
    label = "edges x 0.6" if quick else "refined 3 times"
    return (
        Case(
            "compliance",
            "Compliance of both gears",
            f"Pair 36/40 at {TORQUE:g} N m, from nothing: two nested meshes of both gears, all flank loads, and "
            f"the mesh cycle at {POSITIONS} positions with contact held to the path of contact. The estimate is "
            "the largest along the path, cross terms of neighbouring teeth included. The closed forms leave "
            "out the bodies that pairs share.",
            "unknowns of both sectors",
            (
                Series("edge lengths", tuple(level(f"edges x {f:g}", edges, answer, f) for f in factors)),
                Series(
                    "tolerances", tuple(level(f"{100 * t:g} %", tolerance, answer, t) for t in tolerances)
                ),
                *_forms(pair, mesh),
            ),
            level(label, refined, answer, *finest),
            {mesh: 2.0, single: 2.0},
            (PeerWork("ross_stiffness", _given(pair), mesh),),
        ),
        *(() if quick else _other_pairs()),
    )


def _other_pairs() -> Iterator[Case]:
    """Compliance by tolerance where the geometry is harder: at the limit of undercut, and a large wheel."""
    import fem
    from gears import Gear, GearPair

    single, spread = "one pair, 39 places", "transmission error, peak to peak"
    for z1, z2 in ((17, 43), (20, 1000)):
        pair = GearPair(Gear(z1), Gear(z2), 2e-3, 0.04)
        rho1 = np.linspace(pair.points.A, pair.points.E, 41)[1:-1]

        def answer(bodies: Compliance, pair: GearPair = pair, rho1: Array = rho1) -> Answer:
            k = fem.single_pair_stiffness(pair, pair.normal_force(0.5 * TORQUE), rho1, bodies)
            held = fem.mesh_cycle(pair, 0.5 * TORQUE, POSITIONS, bodies, beyond_path=False)
            values = {
                single: Value(k, bodies.error),
                spread: Value(np.array([np.ptp(held.transmission_error)]), bodies.error),
            }
            return Answer(bodies.cost.unknowns, values, "" if bodies.converged else bodies.message)

        yield Case(
            f"compliance_{z1}_{z2}",
            f"Compliance of both gears, {z1}/{z2}",
            f"Pair {z1}/{z2}, module 2 mm, face 40 mm, bores of half the root radii: from nothing, to a tolerance.",
            "unknowns of both sectors",
            (
                Series(
                    "tolerances",
                    tuple(
                        level(f"{100 * t:g} %", fem.compliance, answer, pair, t) for t in (1e-3, 1e-4, 2e-5)
                    ),
                ),
            ),
            level("refined 3 times", lambda p=pair: fem.compliance(p, 1e-5, refinements=3), answer),
        )


def _forms(pair: GearPair, quantity: str) -> tuple[Series, ...]:
    """Closed forms on the same positions: their distance from the finite elements has no estimate."""

    def answer(curve: Any) -> Answer:
        return Answer(float("nan"), {quantity: Value(np.array([curve.mean()]))})

    return tuple(
        Series(title, (level("pairs added", independent_pairs, answer, pair, form, POSITIONS),))
        for form, title in FORMS.items()
    )


def _given(pair: GearPair) -> dict[str, Any]:
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


def contact(quick: bool) -> tuple[Case, ...]:
    """Loaded contact with a compliance at hand, by the number of positions."""
    import fem
    from flankfilm.coupling.cycle import peak_to_peak_error, sampling_error

    pair = example_pair()
    bodies = fem.compliance(pair)
    mean, spread = "mean mesh stiffness", "transmission error, peak to peak"

    def cycle(beyond: bool, positions: int) -> MeshCycle:
        return fem.mesh_cycle(pair, TORQUE, positions, bodies, beyond_path=beyond)

    def answer(found: MeshCycle) -> Answer:
        curve, moved = found.secant_stiffness, found.transmission_error
        values = {
            mean: Value(np.array([curve.mean()]), sampling_error(curve)),
            spread: Value(np.array([np.ptp(moved)]), peak_to_peak_error(moved)),
        }
        return Answer(curve.size, values, "" if found.converged else found.message)

    counts = (12, 48, 192) if quick else (12, 24, 48, 96, 192, 384)
    many = 768 if quick else 3072
    cases = tuple(
        Case(
            f"contact_{key}",
            f"Loaded contact, {words}",
            f"Pair 36/40 at {TORQUE:g} N m, compliance at hand: forces, approach and stiffness at midpoints of equal "
            "intervals of one base pitch. Errors from sampling alone: where a pair comes in and leaves, the stiffness "
            "jumps or has a corner.",
            "positions",
            (Series(words, tuple(level(f"{n} positions", cycle, answer, beyond, n) for n in counts)),),
            level(f"{many} positions", cycle, answer, beyond, many),
            {mean: 1.0 if not beyond else 2.0, spread: 1.0},
        )
        for key, words, beyond in (
            ("held", "held to the path", False),
            ("free", "tip edges free to touch", True),
        )
    )
    return cases if quick else (*cases, contact_work())


def root_stress(quick: bool) -> tuple[Case, ...]:
    """Greatest root stress by the edge length on the fillets and by tolerance."""
    import fem

    pair = example_pair()
    cycle = fem.mesh_cycle(pair, TORQUE, POSITIONS)
    quantity = "greatest tension, both gears"

    def stress(**how: Any) -> tuple[Fillets, RootStress]:
        found = fem.fillets(pair, **how)
        return found, fem.root_stress(pair, cycle, found)

    def answer(found: tuple[Fillets, RootStress]) -> Answer:
        roots, both = found
        greatest = [gear.greatest_tension.stress_Pa for gear in (both.pinion, both.wheel)]
        failure = "" if roots.converged else roots.message
        return Answer(1.0 / roots.fillet_edge, {quantity: Value(np.array(greatest), roots.error)}, failure)

    def edges(length: float) -> tuple[Fillets, RootStress]:
        return stress(fillet_edge=length)

    def tolerance(value: float) -> tuple[Fillets, RootStress]:
        return stress(tolerance=value)

    lengths = (0.32, 0.16) if quick else (0.32, 0.16, 0.08, 0.04)
    tolerances = (0.02,) if quick else (0.02, 0.005, 0.001)
    least = 0.08 if quick else 0.02
    return (
        Case(
            "root_stress",
            "Root stress",
            f"Pair 36/40 at {TORQUE:g} N m, mesh cycle at hand: influence of flank loads on all fillets, from nothing, "
            f"and the greatest tension over {POSITIONS} positions.",
            "edges per module on the fillets",
            (
                Series("edge lengths", tuple(level(f"{f / 2:g} modules", edges, answer, f) for f in lengths)),
                Series(
                    "tolerances", tuple(level(f"{100 * t:g} %", tolerance, answer, t) for t in tolerances)
                ),
            ),
            level(f"{least / 2:g} modules", edges, answer, least),
            {quantity: 2.0},
        ),
    )
