"""Work whose time alone is of interest: what is built on the solvers, once their errors are known."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.bench.case import Levels, case, work
from flankfilm.bench.examples import TORQUE, contacts_along_path, example_pair, oscillator, pitch_point

if TYPE_CHECKING:
    from collections.abc import Callable

    from fem import PairCompliance
    from gears import GearPair


@case("Pair and load sharing", "positions")
def work_geometry() -> Levels:
    """Pair made, rolled, and its load shared.

    Pair 36/40 made with all its guards and rolled through a mesh cycle; load shared by three pairs whose local
    deflection is logarithmic.
    """
    from gears import check_meshing, share_load

    pair = example_pair()
    bulk, gap = 2.4e-9 * np.eye(3) + 4e-10, np.array([0.0, 5e-6, 2e-5])

    def shared(positions: int) -> Callable[[], object]:
        stacked = np.broadcast_to(bulk, (positions, 3, 3)), np.broadcast_to(gap, (positions, 3))
        return lambda: share_load(17736.3, stacked[0], _LogarithmicContact(), stacked[1])

    series = (
        work("pair made", example_pair),
        work("pair rolled", lambda: check_meshing(pair)),
        *(work(f"load shared at {n}", shared(n), n) for n in (1, 40, 400)),
    )
    return Levels(series)


@case("Ratings", "steps")
def work_rating() -> Levels:
    """Safeties by ISO 6336 and scuffing, and Miner's sum by the number of steps of a load spectrum.

    Pair 36/40 at 300 N m, grade 6, case-hardened: K_Hbeta given, and by method C; spectra with one, ten and a hundred
    steps by method C.
    """
    from gears.rating import FaceData, GearOil, LoadBin, RatedSteel, RatingData, ScuffingData, rate

    pair, steels = example_pair(), (RatedSteel("Eh", 1500e6, 430e6),) * 2
    test = ScuffingData(GearOil(220e-6, 19e-6, 890.0, 353.15), 0.8e-6, 450.1)
    data = RatingData(6, steels, 7.2e7, 220e-6, 4.8e-6, (20e-6, 20e-6), 1.25, scuffing=test)

    def rated(asked: RatingData) -> Callable[[], object]:
        return lambda: rate(pair, 300.0, 209.44, asked)

    def steps(count: int) -> RatingData:
        torques = np.linspace(200.0, 300.0, count).tolist()
        return replace(data, spectrum=tuple(LoadBin(torque, 209.44, 1e8) for torque in torques))

    series = (
        work("K_Hbeta given", rated(replace(data, face=FaceData(1.2)))),
        work("method C", rated(data)),
        *(work(f"spectrum of {count}", rated(steps(count)), count) for count in (1, 10, 100)),
    )
    return Levels(series)


class _LogarithmicContact:
    """Local law with the slope of the pair 36/40."""

    def approach(self, force: np.ndarray) -> np.ndarray:
        """Deflection [m]."""
        safe = np.where(force > 0, force, 1.0)
        return np.where(force > 0, 2.8e-11 * safe * (np.log(1e9 / safe) + 1.0), 0.0)

    def slope(self, force: np.ndarray) -> np.ndarray:
        """Derivative of the deflection by the force [m/N]."""
        safe = np.where(force > 0, force, 1.0)
        return np.where(force > 0, 2.8e-11 * np.log(1e9 / safe), np.inf)


def anew(pair: GearPair, *args: Any, **options: Any) -> PairCompliance:
    """Compliance of a pair whose gears this process has not solved."""
    import fem

    fem.forget_gears()
    return fem.compliance(pair, *args, **options)


@case("Mesh cycles and fields", "positions")
def work_contact() -> Levels:
    """Mesh cycles from nothing, of known gears and with a compliance at hand, root stress, files for ParaView.

    Pair 36/40 at 600 N m: whole mesh cycles from nothing at 0.1 and 0.5 %; the others with the compliance at hand. The
    study has 8 pinions of 18 to 25 teeth and 8 wheels of 31 to 66, 64 pairs at three torques each; its gears are known.
    """
    import fem
    from fem.fields.vtk import write_vtk_series
    from gears import Gear, GearPair

    pair = example_pair()
    bodies, fillets = fem.compliance(pair), fem.fillets(pair)
    cycle = fem.mesh_cycle(pair, TORQUE, 40, bodies)
    few = fem.mesh_cycle(pair, TORQUE, 20, bodies)
    torques = np.linspace(10.0, 900.0, 100)

    def study() -> None:
        for z1 in range(18, 26):
            for z2 in range(31, 71, 5):
                gear_pair = GearPair(Gear(z1), Gear(z2), 2e-3, 0.04)
                fem.mesh_cycle(gear_pair, (50.0, 100.0, 200.0), 40, tolerance=0.005)

    def from_nothing(tolerance: float) -> None:
        fem.mesh_cycle(pair, TORQUE, 40, anew(pair, tolerance))

    def write() -> None:
        with tempfile.TemporaryDirectory() as folder:
            write_vtk_series(Path(folder), pair, few, bodies)

    series = (
        work("from nothing", lambda: from_nothing(0.001), 40),
        work("from nothing at 0.5 %", lambda: from_nothing(0.005), 40),
        work("known gears", lambda: fem.mesh_cycle(pair, TORQUE, 40, tolerance=0.005), 40),
        work("64 pairs, 3 torques", study, 64 * 3 * 40),
        work("held to the path", lambda: fem.mesh_cycle(pair, TORQUE, 40, bodies, False), 40),
        work("with tip edges", lambda: fem.mesh_cycle(pair, TORQUE, 40, bodies), 40),
        work("rounded tips", lambda: fem.mesh_cycle(pair, TORQUE, 40, bodies, tip_rounding=5e-5), 40),
        work("100 torques", lambda: fem.mesh_cycle(pair, torques, 40, bodies), 4000),
        work("360 pitches", lambda: fem.mesh_cycle(pair, TORQUE, 40, bodies, pitches=360), 14_400),
        work("root stress", lambda: fem.root_stress(pair, cycle, fillets), 40),
        work("files for ParaView", write, 20),
    )
    return Levels(series)


@case("Films by their start", "contacts")
def work_film() -> Levels:
    """A film by the film that it starts from, and films along a path.

    Pitch point of the pair 36/40 at 0.5 %: from nothing, from its own film, and from that of another load; 101
    contacts along the path with two jumps of the load, each from its neighbour.
    """
    from ehl import solve, solve_path

    contact = pitch_point()
    film = solve(contact)
    contacts = contacts_along_path(101)

    def at(factor: float) -> Callable[[], object]:
        other = replace(contact, load=factor * contact.load)
        return lambda: solve(other, start=film)

    series = (
        work("from nothing", lambda: solve(contact), 1),
        work("same contact", at(1.0), 1),
        work("load +0.01 %", at(1.0001), 1),
        work("load +2 %", at(1.02), 1),
        work("load halved", at(0.5), 1),
        work("along the path", lambda: solve_path(contacts), 101),
    )
    return Levels(series)


@case("Sweeps, branches, diagrams, basins", "values, points or starts")
def work_motion() -> Levels:
    """Sweeps, branches, loci, diagrams and basins.

    The oscillator of the exact flow, kernels compiled: what is built on its period map.
    """
    import dynamics
    from dynamics.flow.exact_flow import exact_flow

    osc = oscillator()
    values = np.linspace(0.1, 2.1, 2000)
    start = dynamics.find_orbit(osc.with_parameter("frequency", 0.5), (0.35, 0.0))
    branch = dynamics.continue_branch(start, "frequency", (0.5, 1.2))
    plane = ("frequency", "stiffness.amplitudes[0]"), ((0.3, 1.5), (0.0, 0.6))
    locus = dynamics.continue_locus(osc, branch.points[0], *plane)

    def swept() -> None:
        for direction in ("up", "down"):
            dynamics.sweep(osc, values=values, direction=direction)

    series = (
        work("tables of the flow", lambda: exact_flow(osc)),
        work("sweep up and down", swept, 4000),
        work("branch", lambda: dynamics.continue_branch(start, "frequency", (0.5, 1.2)), len(branch.values)),
        work(
            "locus of a fold",
            lambda: dynamics.continue_locus(osc, branch.points[0], *plane),
            len(locus.values),
        ),
        work("orbits of periods 1 to 4", lambda: dynamics.find_orbits(osc, (1, 2, 3, 4))),
        work("diagram", lambda: dynamics.diagram(osc, "frequency", (0.3, 2.1))),
        work("basins", lambda: dynamics.basins(osc, x=(-1, 1, 200), v=(-1, 1, 200)), 40_000),
    )
    return Levels(series)
