"""Compiled Taylor tables of the linear motions in each cell of the excitation period."""

import math
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
import numpy.typing as npt
from numba import njit

FloatArray = npt.NDArray[np.float64]
F = TypeVar("F", bound=Callable[..., Any])
MEAN, ZETA, FORCE, ERROR, FREQUENCY, PHASE, HALF_BACKLASH = range(7)


def kernel(function: F) -> F:
    """Compile when first called, keep the result on disk, keep the type signature."""
    return cast(F, njit(cache=True, error_model="numpy", nogil=True)(function))


@kernel
def tabulate(
    par: FloatArray, amplitudes: FloatArray, phases: FloatArray, cells: int, degree: int
) -> tuple[FloatArray, FloatArray]:
    """Taylor tables `coef` and cell maps `edge` of one period."""
    coef = np.zeros((2, cells, 3, degree + 1))
    edge = np.zeros((2, cells, 9))
    h = 2.0 * math.pi / par[FREQUENCY] / cells
    turn = 2.0 * math.pi / cells
    drag = 2.0 * par[ZETA] * h
    for cell in range(cells):
        spring = np.zeros(degree + 1)
        push = np.zeros(degree + 1)
        spring[0] = par[MEAN] * h * h
        push[0] = par[FORCE] * h * h
        for j in range(len(amplitudes)):
            add_cosine(spring, amplitudes[j] * h * h, (j + 1) * turn * cell + phases[j], (j + 1) * turn)
        add_cosine(push, par[ERROR] * turn * turn, turn * cell + par[PHASE], turn)
        for kind in range(2):
            e = edge[kind, cell]
            for which in range(3):
                u = coef[kind, cell, which]
                if which == 0:
                    u[0] = 1.0
                elif which == 1:
                    u[1] = h
                for k in range(degree - 1):
                    total = -drag * (k + 1) * u[k + 1]
                    if which == 2:
                        total += push[k]
                    if kind == 0:
                        for i in range(k + 1):
                            total -= spring[i] * u[k - i]
                    u[k + 2] = total / ((k + 2) * (k + 1))
                f = df = bend = 0.0
                for k in range(degree, -1, -1):
                    f += u[k]
                    df += k * u[k]
                    bend += k * (k - 1) * abs(u[k])
                e[which if which < 2 else 4] = f
                e[which + 2 if which < 2 else 5] = df / h
                e[6 + which] = 0.12501 * bend  # sup of |d2u/dsigma2| / 8; the last digit covers rounding
    return coef, edge


@kernel
def add_cosine(series: FloatArray, amplitude: float, angle: float, rate: float) -> None:
    """Add the Taylor coefficients of amplitude cos(angle + rate t)."""
    factor = amplitude
    even = math.cos(angle)
    odd = -math.sin(angle)
    for k in range(len(series)):
        series[k] += factor * (even if k % 2 == 0 else odd) * (1.0 if k % 4 < 2 else -1.0)
        factor *= rate / (k + 1)
