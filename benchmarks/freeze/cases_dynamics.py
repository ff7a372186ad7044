"""Oscillators, trains and smooth laws: flow, orbits, branches, sweeps, basins, exponents, global structure."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

import dynamics
from dynamics import FourierStiffness, GearOscillator

from .case import Cases, take

case = Cases("dynamics")
OSC = GearOscillator(
    stiffness=FourierStiffness(mean=1.0, amplitudes=(0.18,), phases=(0.0,)), damping_ratio=0.05, mean_force=0.1,
    error_amplitude=0.2, frequency=0.6, half_backlash=0.2,
)  # fmt: skip
RICH = replace(
    OSC,
    stiffness=FourierStiffness(1.0, (0.18, 0.05), (0.3, 1.0)),
    error_amplitude=(0.2, 0.03),
    error_phase=(0.4, 1.0),
)
BOX = ((-1.0, 1.0), (-1.0, 1.0))
MAP = "states jacobian log_determinant counts"
ORBIT = "state multipliers stable label counts jacobian residual nodes error converged message"
BRANCH = "periods values states multipliers stable labels ended error converged message"
POINT = "kind parameter state multipliers label error periods boundary tau acceleration"


def train() -> Any:
    """Motor, pinion, wheel and load: four freedoms along the line of action, soft shafts, all of it held."""
    mass, stiff = np.diag([2.0, 0.9, 1.3, 3.0]), np.diag([0.05, 0.0, 0.0, 0.1])
    for i, j, k in ((0, 1, 0.8), (2, 3, 0.6)):
        row = np.zeros(4)
        row[i], row[j] = 1.0, -1.0
        stiff += k * np.outer(row, row)
    return dynamics.DriveOscillator(
        mass=mass, damping=0.02 * mass + 0.03 * stiff, stiffness=stiff, direction=[0.0, 1.0, 1.0, 0.0],
        mesh_stiffness=RICH.stiffness, mesh_damping=0.03, mean_force=[0.1, 0.0, 0.0, 0.12],
        error_amplitude=(0.1, 0.02), error_phase=(0.4, 1.0), frequency=0.9, half_backlash=0.15,
    )  # fmt: skip


def smooth(**changes: Any) -> Any:
    """Oscillator with a nonlinear contact and a squeeze film."""
    law = dynamics.PowerContact(stiffness=OSC.stiffness, half_backlash=0.2, exponent=1.1, **changes)
    return dynamics.SmoothOscillator(law, 0.05, 0.1, 0.2, 0.55)


def branch_figures(branch: Any) -> dict[str, Any]:
    """Values along a branch and its special points."""
    return {**take(branch, BRANCH), "points": [take(point, POINT) for point in branch.points]}


@case(quick=True)
def flow() -> dict[str, Any]:
    """Exact flow: states, Jacobians, trajectories, of one freedom in every form and of a train."""
    flows: dict[str, Any] = {}
    forms = {
        "one harmonic": OSC,
        "two harmonics": RICH,
        "one side": replace(OSC, one_sided=True),
        "free damping": replace(OSC, free_damping_ratio=0.3),
        "no backlash": replace(OSC, half_backlash=0.0),
    }
    for name, osc in forms.items():
        starts = (0.3, 0.0), (0.0, 0.9), (-0.7, -0.4)
        images = [take(dynamics.period_map(osc, start, 5), MAP) for start in starts]
        path = dynamics.trajectory(osc, (0.3, 0.1), 3, 50)
        flows[name] = {
            "map": images,
            "path": take(path, "tau x v events extrema"),
        }
    drive = train()
    state = np.array([0.3, -0.4, 0.1, 0.2, 0.5, -0.6, 0.2, 0.1])
    image, path = dynamics.period_map(drive, state, 4), dynamics.trajectory(drive, state, 2, 50)
    flows["train"] = {
        "map": take(image, MAP), "path": take(path, "tau states events"),
    }  # fmt: skip
    ours = dynamics.period_map(smooth(), (0.3, 0.0), 3)
    return {**flows, "smooth": take(ours, "states jacobian counts")}


@case(quick=True)
def orbits() -> dict[str, Any]:
    """Periodic motions of one freedom, trains and smooth laws, found and searched for."""
    motions: dict[str, Any] = {
        "found": take(dynamics.find_orbit(OSC, (0.5, 0.2)), ORBIT),
        "rich": take(dynamics.find_orbit(RICH, (0.5, 0.2), transient=100), ORBIT),
        "train": take(dynamics.find_orbit(train(), np.zeros(8), transient=300), ORBIT),
        "smooth": take(dynamics.find_orbit(smooth(), (0.4, 0.0)), ORBIT),
        "filmed": take(dynamics.find_orbit(smooth(film=dynamics.SqueezeFilm(0.02, 0.05)), (0.4, 0.0)), ORBIT),
    }
    searched = dynamics.find_orbits(OSC, (1, 2, 3)).orbits
    return {**motions, "searched": [take(orbit, ORBIT) for orbit in searched]}


@case(quick=True)
def branches() -> dict[str, Any]:
    """Branches in frequency and error with their special points, the doubled motion, sensitivities, a train."""
    orbit = dynamics.find_orbit(OSC, (0.5, 0.2))
    branch = dynamics.continue_branch(orbit, "frequency", (0.5, 1.2))
    error = dynamics.continue_branch(orbit, "error_amplitude", (0.05, 0.5))
    doubling = branch.special("period-doubling")[0]
    doubled = dynamics.doubled_orbit(OSC, "frequency", doubling, (0.5, 1.2))
    figures: dict[str, Any] = {"frequency": branch_figures(branch), "error": branch_figures(error)}
    figures["doubled"] = None if doubled is None else take(doubled, ORBIT)
    fold = branch.special("saddle-node")[0]
    figures["sensitivities"] = dynamics.special_sensitivities(OSC, "frequency", fold)
    start = dynamics.find_orbit(train(), np.zeros(8), transient=300)
    figures["train"] = branch_figures(dynamics.continue_branch(start, "frequency", (0.85, 0.95)))
    return figures


@case()
def loci_and_diagram() -> dict[str, Any]:
    """Loci of a fold, a doubling and a grazing in two parameters; a diagram."""
    branch = dynamics.continue_branch(dynamics.find_orbit(OSC, (0.5, 0.2)), "frequency", (0.5, 1.2))
    figures: dict[str, Any] = {}
    for kind in ("saddle-node", "period-doubling", "grazing"):
        for k, point in enumerate(branch.special(kind)[:2]):
            locus = dynamics.continue_locus(
                OSC, point, ("frequency", "mean_force"), ((0.5, 1.1), (0.05, 0.2))
            )
            special = [take(special_point, "kind values state") for special_point in locus.points]
            figures[f"{kind} {k}"] = {
                **take(locus, "values states multipliers labels ended error"),
                "points": special,
            }
    drawn = dynamics.diagram(OSC, "frequency", (0.6, 0.9), periods=(1, 2), searches=3, swept=20, max_period=2)
    figures["diagram"] = [branch_figures(drawn_branch) for drawn_branch in drawn.branches]
    graze = dynamics.contact_grazing(OSC, "frequency", (0.3, 1.2))
    return {**figures, "clearance": take(graze, "values clearance error")}


@case()
def smooth_branch() -> dict[str, Any]:
    """A branch of a smooth law."""
    orbit = dynamics.find_orbit(smooth(), (0.4, 0.0))
    return {"branch": branch_figures(dynamics.continue_branch(orbit, "frequency", (0.5, 0.62)))}


@case(quick=True)
def sweeps() -> dict[str, Any]:
    """Sweeps up and down, of several motions, run-ups, spectra; of one freedom and of a train."""
    values, figures = np.linspace(0.3, 1.2, 60), "values states labels periods impacts error message"
    swept: dict[str, Any] = {
        way: take(dynamics.sweep(OSC, "frequency", values, way), figures) for way in ("up", "down")
    }
    swept["error"] = take(
        dynamics.sweep(RICH, "error_amplitude[0]", np.linspace(0.05, 0.5, 30), "up"), figures
    )
    swept["train"] = take(dynamics.sweep(train(), "frequency", np.linspace(0.8, 1.0, 10), "up"), figures)
    several = dynamics.multi_sweep(OSC, "frequency", np.linspace(0.6, 0.9, 8), seeds=3, starts=3)
    swept["several"] = [
        [take(motion, "label state|states share|periods") for motion in here] for here in several.motions
    ]
    for name, osc in (("run-up", OSC), ("run-up of a train", train())):
        figures_of_run = "frequency tau rms peak force_rms force_peak separated order force_order state"
        swept[name] = take(dynamics.run_up(osc, (0.4, 1.0), 1500), figures_of_run)
    orbit = dynamics.find_orbit(OSC, (0.5, 0.2))
    return {
        **swept,
        "spectrum": take(dynamics.motion_spectrum(OSC, orbit.state), "order displacement force rms"),
    }


@case(quick=True)
def basins_and_exponents() -> dict[str, Any]:
    """Small basins of one freedom and of a train; exponents of regular and chaotic motion."""
    exponents = "exponents standard_errors state error message"
    figures: dict[str, Any] = {}
    for name, osc in (("at 0.6", OSC), ("at 0.83", replace(OSC, frequency=0.83))):
        pool = dynamics.basins(osc, (-1.0, 1.0, 40), (-1.0, 1.0, 40))
        figures[name] = {**take(pool, "x v labels error"), "attractors": [take(a, "label state|states share|cells")
                                                                        for a in pool.attractors]}  # fmt: skip
    plane = np.zeros((2, 8))
    plane[0, 1], plane[1, 5] = 1.0, 1.0
    figures["train"] = take(
        dynamics.basins(train(), (-0.5, 0.5, 6), (-0.5, 0.5, 6), plane=plane), "x v labels"
    )
    for name, osc in (("regular", OSC), ("chaotic", replace(OSC, frequency=1.13)), ("train", train())):
        periods = 300 if name == "train" else 2000
        figures[f"exponents, {name}"] = take(dynamics.lyapunov_exponents(osc, periods), exponents)
    scan = dynamics.lyapunov_scan(OSC, "frequency", np.linspace(0.6, 1.2, 12), 500)
    return {**figures, "scan": np.asarray(scan.exponents)}


@case()
def structure() -> dict[str, Any]:
    """Manifolds, the boundary of basins, saddles on it, a crisis."""
    osc = replace(OSC, frequency=1.13)
    saddle = next(orbit for orbit in dynamics.find_orbits(osc, (3,)).orbits if orbit.label == "U3-3-1")
    crisis = dynamics.boundary_crisis(saddle, "frequency", (1.116, 1.13), points=300, periods=60)
    curves = dynamics.manifold(saddle, "stable", BOX, length=8.0)
    pool = dynamics.basins(OSC, (-1.0, 1.0, 24), (-1.0, 1.0, 24))
    figures: dict[str, Any] = {
        "crisis": take(crisis, "parameter side overshoot before after error"),
        "manifold": take(curves, "curves rounds error"),
    }
    if len(pool.attractors) > 1:
        edge = dynamics.basin_boundary(OSC, pool.attractors, BOX, levels=4)
        saddles = dynamics.edge_saddles(OSC, pool.attractors[0], rays=4)
        figures["boundary"] = take(edge, "points cell counts dimension shares")
        figures["saddles"] = [take(orbit, ORBIT) for orbit in saddles]
    return figures


@case(quick=True)
def series() -> dict[str, Any]:
    """Fourier series of samples, scales, damping matrices."""
    samples = 1.0 + 0.2 * np.cos(np.linspace(0, 2 * np.pi, 50, endpoint=False)) ** 3
    fit = dynamics.fit_fourier(samples, order=4)
    mass, stiff = np.diag([1.0, 2.0]), np.array([[2.0, -1.0], [-1.0, 1.5]])
    angle = np.linspace(0, 6, 13)
    return {
        "fit": take(fit, "remainder_rms remainder_max harmonics condition"),
        "stiffness": take(fit.stiffness, "mean amplitudes phases"),
        "values": fit.stiffness(angle),
        "modal": dynamics.modal_damping(mass, stiff, [0.01, 0.02]),
        "rayleigh": dynamics.rayleigh_damping(mass, stiff, 0.1, 0.02),
        "restoring": dynamics.restoring_force(smooth(), angle, np.linspace(-0.5, 0.6, 13)),
    }
