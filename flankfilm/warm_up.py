"""Compiled code made ready on all cores before it is needed, each part in a separate process."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from queue import SimpleQueue
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from dynamics import GearOscillator


@dataclass(frozen=True)
class Warmed:
    """A part that is ready.

    Attributes
    ----------
    name : str
        What it computes.
    compiled : int
        Functions that were compiled; 0 where all were kept by an earlier process.
    seconds : float
        Wall time.
    """

    name: str
    compiled: int
    seconds: float

    def __str__(self) -> str:
        """One line."""
        how = f"{self.compiled} functions compiled" if self.compiled else "was ready"
        return f"{self.name}: {how}, {self.seconds:.1f} s"


def warm_up(workers: int, report: Callable[[Warmed], None]) -> list[Warmed]:
    """Compile what is kept on disk, in so many processes; each part is reported when it is ready.

    Parameters
    ----------
    workers : int
        Processes.
    report : callable
        Called with each part.

    Examples
    --------
    >>> warm_up(0, print)
    []
    """
    from flankfilm.studies.executors import executor

    ready: list[Warmed] = []
    if workers == 0:
        return ready
    with executor("processes", min(workers, len(PARTS))) as pool:
        # as in the rows of a study: concurrent.futures.as_completed does not survive a signal
        done: SimpleQueue[Future[Warmed]] = SimpleQueue()
        for name in PARTS:
            pool.executor.submit(warmed, name).add_done_callback(done.put)
        for _ in PARTS:
            ready.append(done.get().result())
            report(ready[-1])
    return ready


def warmed(name: str) -> Warmed:
    """Compile a part here."""
    from base import heard_compiling, hide_compilation

    heard: list[str] = []
    began = perf_counter()
    hide_compilation()
    with heard_compiling(heard.append):
        PARTS[name]()
    return Warmed(name, len(heard), perf_counter() - began)


def _motions() -> None:
    """Sweeps, basins, orbits and trajectories of the exact flow, and motions with a gridded contact."""
    import dynamics
    from dynamics.flow.exact_flow import exact_flow
    from dynamics.motion.gridded_motion import GriddedContact, gridded_motions
    from dynamics.orbits.multiple_shooting import stretches

    pair = _pair()
    dynamics.sweep(pair, "frequency", [0.6])
    grid = np.tile([0.0, 1.0], (12, 1))
    gridded_motions(pair, GriddedContact(grid, 0.0, 1.0, np.zeros(12), 0.0), [0.6])
    dynamics.basins(pair, (-1.0, 1.0, 3), (-1.0, 1.0, 3))
    dynamics.find_orbits(pair, (1,), starts=2)
    dynamics.trajectory(pair, (0.5, 0.2), 1)
    table = exact_flow(pair)
    stretches(table, np.array([[0.5, 0.2]]), np.array([0, table.cells]))


def _branches() -> None:
    """Points of branches of the exact flow."""
    from dynamics.branches.corrector import OrbitProblem

    ends = np.array([0.5]), np.array([0.7])
    OrbitProblem(_pair(), ("frequency",), 1, *ends, 1.0).evaluate(np.array([0.5, 0.2, 0.5]))


def _smooth_motions() -> None:
    """Motions that are followed in steps, with the laws of this package."""
    import dynamics

    stiffness = dynamics.FourierStiffness(1.0, (0.1,), (0.0,))
    law = dynamics.PowerContact(stiffness=stiffness, half_backlash=0.2, exponent=1.5)
    smooth = dynamics.SmoothOscillator(law, 0.05, 0.1, 0.2, 0.6)
    dynamics.find_orbit(smooth, (0.5, 0.2))
    dynamics.lyapunov_exponents(smooth, periods=20)


def _drives() -> None:
    """Motions of drive trains."""
    import dynamics

    drive = dynamics.DriveOscillator(
        [[1.0, 0.0], [0.0, 2.0]], [[0.1, 0.0], [0.0, 0.1]], [[0.5, -0.2], [-0.2, 0.4]], [1.0, -1.0],
        dynamics.FourierStiffness(1.0, (0.1,), (0.0,)), 0.05, [0.1, -0.1], 0.2, 0.62, 0.2,
    )  # fmt: skip
    dynamics.sweep(drive, "frequency", [0.6])
    dynamics.basins(drive, (-1.0, 1.0, 2), (-1.0, 1.0, 2), limit=20)
    dynamics.trajectory(drive, drive.rest_state(), 1)


def _films() -> None:
    """Films, with heat too."""
    from ehl import LineContact, Lubricant, Solid, film_response, solve, solve_thermal

    oil = Lubricant(
        viscosity=0.05, pressure_viscosity=18e-9, density=860.0, temperature=343.15, viscosity_slope=0.04,
        conductivity=0.14, heat_capacity=2000.0, expansion=6.5e-4, eyring_stress=5e6,
    )  # fmt: skip
    contact = LineContact(
        load=1e5, entrainment=10.0, sliding=1.0, radius=0.012, reduced_modulus=2.2e11, lubricant=oil
    )
    solve(contact, nodes=65)
    steel = Solid(46.0, 7850.0, 470.0)
    warm = solve_thermal(contact, solids=(steel, steel), bulk_temperatures=(343.15, 343.15), tolerance=0.05)
    film_response(warm, 1e4)


def _pair() -> GearOscillator:
    """An oscillator with impacts."""
    import dynamics

    stiffness = dynamics.FourierStiffness(1.0, (0.18,), (0.0,))
    return dynamics.GearOscillator(stiffness, 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)


PARTS: dict[str, Callable[[], None]] = {
    "motions with backlash": _motions,
    "branches of orbits": _branches,
    "motions of drive trains": _drives,
    "motions in steps": _smooth_motions,
    "films": _films,
}
"""What is compiled, the longest first."""
