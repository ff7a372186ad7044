"""A restoring force that the user writes."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from base import Array, Faults, InputError
from dynamics.model.limits import NUMBER
from dynamics.model.naming import unknown

STEP = 1e-40  # imaginary, so that nothing is lost to cancellation


@dataclass(frozen=True)
class Surface:
    """A surface n_X X + n_V V = sign q, on which the force is not smooth, or crossings are counted.

    Parameters
    ----------
    normal : tuple of float
        n_X, n_V.
    parameter : str
        Name of q; empty for 0.
    sign : float
        Factor on q.
    """

    normal: tuple[float, float] = (1.0, 0.0)
    parameter: str = ""
    sign: float = 1.0


@dataclass(frozen=True)
class CompiledLaw:
    """Force given as a function, compiled with numba.

    Parameters
    ----------
    force : callable
        Either ``force(theta, x, v, region, q)`` that returns f and is written with numpy's functions, which take
        complex numbers too: derivatives are taken by an imaginary step, exact to rounding, so that within a region
        the function must be analytic (no abs, max, comparison of x), and powers must be written as products, since a
        complex power of a negative number loses the step. Both are checked against differences. Or a numba ``cfunc``
        of the type `dynamics.kernels.stepwise.compiling.LAW`, which gives its own derivatives and is faster.
    parameters : tuple of (str, float)
        Names and values of q.
    surfaces_at : tuple of Surface
        Where the force is switched; bit i of `region` is 1 where n . (X, V) is above surface i. The first counts p
        (falls), the second q of the label.
    size : float
        Natural size of a displacement.

    Raises
    ------
    InputError
        With every fault found; when first used, if derivatives by imaginary steps differ from differences.

    Notes
    -----
    Compiled anew in every process; one function makes one law however often its parameters are changed.
    """

    force: Callable[..., Any]
    parameters: tuple[tuple[str, float], ...] = ()
    surfaces_at: tuple[Surface, ...] = ()
    size: float = 1.0

    def __post_init__(self) -> None:
        """Check."""
        with Faults() as faults:
            if not callable(self.force):
                faults.add(
                    "force", self.force, "must be a function", "force(theta, x, v, region, q) that returns f"
                )
            for name, value in self.parameters:
                faults.number(f"parameters[{name!r}]", value, NUMBER)
            if len(set(self.names)) != len(self.names):
                faults.add("parameters", self.names, "must be different names", "rename one")
            for surface in self.surfaces_at:
                if surface.parameter and surface.parameter not in self.names:
                    faults.add(
                        "surfaces_at",
                        surface.parameter,
                        f"must be one of {', '.join(self.names)}",
                        "name a parameter",
                    )
            if len(self.surfaces_at) > 16:
                faults.add("surfaces_at", len(self.surfaces_at), "must be at most 16", "join some")

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters."""
        return tuple(name for name, _ in self.parameters)

    @property
    def values(self) -> Array:
        """Their values."""
        return np.array([value for _, value in self.parameters], dtype=np.float64)

    @property
    def data(self) -> Array:
        """Nothing."""
        return np.empty(0)

    @property
    def surfaces(self) -> Array:
        """Rows n_X, n_V, sign, place."""
        rows = [
            (*s.normal, s.sign, float(self.names.index(s.parameter)) if s.parameter else -1.0)
            for s in self.surfaces_at
        ]
        return np.array(rows, dtype=np.float64).reshape(-1, 4)

    @property
    def compiled(self) -> Any:
        """Function pointer."""
        return self.force if hasattr(self.force, "native_name") else _checked(self)

    def with_value(self, name: str, value: float) -> CompiledLaw:
        """Return the law with one parameter changed.

        Raises
        ------
        InputError
            If there is no such parameter.
        """
        if name not in self.names:
            raise unknown(name, self.names)
        changed = tuple((n, float(value) if n == name else v) for n, v in self.parameters)
        return dataclasses.replace(self, parameters=changed)


@lru_cache(maxsize=64)
def _compiled(force: Callable[..., Any]) -> tuple[Any, Any]:
    """Function pointer with derivatives by imaginary steps, and the function alone."""
    from numba import cfunc, njit

    from dynamics.kernels.stepwise.compiling import LAW

    inner = force if hasattr(force, "py_func") else njit(error_model="numpy")(force)

    def law(theta, x, v, region, q, data, out):  # type: ignore[no-untyped-def]
        out[0] = inner(theta, x, v, region, q)
        if len(out) > 1:
            z = q.astype(np.complex128)
            out[1] = inner(theta, complex(x, STEP), complex(v, 0.0), region, z).imag / STEP
            out[2] = inner(theta, complex(x, 0.0), complex(v, STEP), region, z).imag / STEP
            for j in range(len(q)):
                z[j] = complex(q[j], STEP)
                out[3 + j] = inner(theta, complex(x, 0.0), complex(v, 0.0), region, z).imag / STEP
                z[j] = complex(q[j], 0.0)

    return cfunc(LAW, error_model="numpy")(law), inner


@lru_cache(maxsize=1024)
def _checked(law: CompiledLaw) -> Any:
    """Function pointer, or InputError if derivatives by imaginary steps are not those of the function."""
    pointer, inner = _compiled(law.force)
    q, worst = law.values, 0.0
    for angle, x, v in ((0.4, 1.3, 0.7), (2.9, -1.3, 0.7), (4.1, 0.6, -0.9), (5.5, -0.4, -1.1)):
        x, v = x * law.size, v * law.size
        region = 0
        for i, (n_x, n_v, sign, place) in enumerate(law.surfaces):
            level = sign * q[int(place)] if place >= 0 else 0.0
            region |= int(n_x * x + n_v * v > level) << i
        h = 1e-4 * law.size
        z = q.astype(np.complex128)
        for dx, dv in ((1.0, 0.0), (0.0, 1.0)):
            there, back = (inner(angle, x + s * h * dx, v + s * h * dv, region, q) for s in (1.0, -1.0))
            imaginary = inner(angle, complex(x, STEP * dx), complex(v, STEP * dv), region, z)
            slope = complex(imaginary).imag / STEP
            size = max(abs(there), abs(back), abs(slope) * law.size, 1e-300) / law.size
            worst = max(worst, abs((there - back) / (2.0 * h) - slope) / size)
    if not worst < 1e-4:
        allowed = "must be analytic in X and V within a region"
        remedy = "write x*x*x for x**3, declare a surface where it is not smooth, use numpy's functions"
        raise InputError.at("force", f"derivatives off by {worst:.1e}", allowed, remedy)
    return pointer
