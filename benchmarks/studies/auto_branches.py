"""A branch of the lubricated scan by AUTO-07p, with a smoothed backlash, beside the stepwise and the exact flow.

AUTO (Doedel and others; orthogonal collocation, arclength) wants a smooth autonomous system: the backlash is

    f(X) = s [ln(1 + e^((X - D)/s)) - ln(1 + e^(-(X + D)/s))]

and two further unknowns run on the unit circle in place of the time. Folds and doublings at each width s stand beside
those of our stepwise flow under the same law; folds are taken to s = 0 by its even powers, and stand there beside those
of the exact flow. AUTO-07p and gfortran must be there (on Debian: ``apt-get install auto-07p gfortran``).
Run from the root with ``PYTHONPATH=. python benchmarks/studies/auto_branches.py`` (two minutes); it prints the
tables of docs/validation/dynamics.md, and the numbers of tests/validation/test_auto_branch.py.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from dynamics import GearOscillator, SmoothedBacklash, SmoothOscillator, continue_branch, find_orbit
from tests.validation.article_motion import lubricated

START, END = 0.5, 0.95
WIDTHS = (0.004, 0.002, 0.001, 0.0005)
"""Widths s of the corners, over the scale of length."""

MESH, STEP = 200, 0.001
"""AUTO's intervals of a period, and longest step: 0.01 misplaces the fold beside the touch of the back flank."""

EQUATIONS = """
subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  implicit none
  integer, intent(in) :: ndim, icp(*), ijac
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
  double precision :: w, s, up, down, force, r
  w = par(1); s = par(2)
  up = (u(1) - {D}d0) / s; down = -(u(1) + {D}d0) / s
  force = s * (softplus(up) - softplus(down))
  r = 1d0 - u(3)**2 - u(4)**2
  f(1) = u(2)
  f(2) = {F}d0 + {eps}d0 * w**2 * u(3) - 2d0 * {zeta}d0 * u(2) - (1d0 + {kappa}d0 * u(3)) * force
  f(3) = -w * u(4) + u(3) * r
  f(4) = w * u(3) + u(4) * r
contains
  double precision function softplus(y)
    double precision, intent(in) :: y
    softplus = max(y, 0d0) + log(1d0 + exp(-abs(y)))
  end function
end subroutine

subroutine stpnt(ndim, u, par, t)
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(inout) :: u(ndim), par(*)
  double precision, intent(in) :: t
  par(1) = {start}d0; par(2) = {s}d0; par(11) = 8d0 * atan(1d0) / par(1)
end subroutine

subroutine bcnd
end subroutine
subroutine icnd
end subroutine
subroutine fopt
end subroutine
subroutine pvls
end subroutine
"""

CODES = {"LP": "5", "PD": "7"}
"""Types of points in AUTO's file of the branch."""

CONSTANTS = """
dat = 'gear', NDIM = 4, IPS = 2, ILP = 1, ISP = 2, ICP = [1, 11], NPAR = 11, NTST = {mesh}, NCOL = 4, IAD = 1
NMX = 20000, NPR = 0, ISW = 1, IPLT = 0, NBC = 0, NINT = 0, IID = 2, ITMX = 9, ITNW = 9, NWTN = 4, MXBF = 0
RL0 = 0.45, RL1 = 1.05, A0 = -1000, A1 = 1000, UZSTOP = {{1: {end}}}
DS = 0.0005, DSMIN = 1e-9, DSMAX = {step}, IADS = 1, EPSL = 1e-10, EPSU = 1e-10, EPSS = 1e-9
"""


def start_file(osc: GearOscillator) -> str:
    """One period of the exact motion: time, X, V, cosine and sine of the phase."""
    orbit = find_orbit(osc, (0.4, 0.0))

    def rate(t, y):
        x, v = y
        turn = np.cos(osc.frequency * t)
        force = np.sign(x) * max(abs(x) - osc.half_backlash, 0.0)
        pull = (1 + osc.stiffness.amplitudes[0] * turn) * force
        return [
            v,
            osc.mean_force + osc.error_amplitude * osc.frequency**2 * turn - 2 * osc.damping_ratio * v - pull,
        ]

    times = np.linspace(0, 2 * np.pi / osc.frequency, 201)
    path = solve_ivp(rate, (0, times[-1]), orbit.state, t_eval=times, rtol=1e-10, atol=1e-12).y
    phase = osc.frequency * times
    rows = np.column_stack([times, *path, np.cos(phase), np.sin(phase)])
    return "\n".join(" ".join(f"{value:.16e}" for value in row) for row in rows)


def branch(osc: GearOscillator, width: float) -> dict[str, list[float]]:
    """Frequencies of AUTO's folds (LP) and doublings (PD) in the order of the branch."""
    values = {
        "D": osc.half_backlash, "F": osc.mean_force, "eps": osc.error_amplitude, "zeta": osc.damping_ratio,
        "kappa": osc.stiffness.amplitudes[0], "start": osc.frequency, "s": width,
    }  # fmt: skip
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "gear.f90").write_text(EQUATIONS.format(**values))
        (folder / "gear.dat").write_text(start_file(osc))
        (folder / "c.gear").write_text(CONSTANTS.format(mesh=MESH, step=STEP, end=END))
        (folder / "gear.auto").write_text("run(e='gear', c='gear', sv='gear')\n")
        done = subprocess.run(
            ["auto-07p", "gear.auto"], cwd=folder, capture_output=True, text=True, check=False
        )
        try:
            rows = [line.split() for line in (folder / "b.gear").read_text().splitlines()]
        except OSError:
            sys.exit(done.stdout + done.stderr)
    # signs tell stable points from unstable ones
    rows = [[row[0].lstrip("-"), *row[1:2], row[2].lstrip("-"), *row[3:]] for row in rows if len(row) > 4]
    return {
        kind: [float(row[4]) for row in rows if row[0] == "1" and row[2] == code]
        for kind, code in CODES.items()
    }


def ours(osc: GearOscillator, width: float = 0.0) -> dict[str, list[float]]:
    """The same by the stepwise flow with corners of a width, or by the exact flow at 0."""
    orbit = find_orbit(osc, (0.4, 0.0))
    if width > 0.0:
        law = SmoothedBacklash(stiffness=osc.stiffness, half_backlash=osc.half_backlash, width=width)
        rounded = SmoothOscillator(law, osc.damping_ratio, osc.mean_force, osc.error_amplitude, osc.frequency)
        orbit = find_orbit(rounded, orbit.state, tolerance=1e-10)
    whole = continue_branch(orbit, "frequency", (START, END))
    kinds = {"LP": "saddle-node", "PD": "period-doubling"}
    return {
        kind: [point.parameter for point in whole.points if point.kind == name]
        for kind, name in kinds.items()
    }


def limits(values: Sequence[float]) -> list[float]:
    """Values at s = 0 by more and more even powers of s, from widths each half of the one before."""
    table, power = [np.asarray(values)], 1
    while len(table[-1]) > 1:
        table.append((4**power * table[-1][1:] - table[-1][:-1]) / (4**power - 1))
        power += 1
    return [float(row[-1]) for row in table]


def main() -> None:
    """Print the tables."""
    osc = lubricated(START)
    found = {width: branch(osc, width) for width in WIDTHS}
    for width, theirs in found.items():
        stepwise = ours(osc, width)
        for kind in CODES:
            for auto, own in zip(theirs[kind], stepwise[kind], strict=True):
                print(f"s {width} {kind}  AUTO {auto:.11f}  stepwise {own:.11f}  apart {own - auto:.1e}")
    for kind, exact in ours(osc).items():
        for number, value in enumerate(exact):
            last = limits([theirs[kind][number] for theirs in found.values()])
            steps = " ".join(f"{one:.10f}" for one in last)
            print(f"s 0 {kind}  AUTO by powers {steps}  exact {value:.13f}", flush=True)


if __name__ == "__main__":
    main()
