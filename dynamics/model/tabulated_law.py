"""A measured law: contact force as a table over deflection and angle, and the spline through it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from base import Array, Faults, Limit
from dynamics.model.contact_laws import ContactLaw

INTERVALS = 32


@dataclass(frozen=True, eq=False, kw_only=True)
class TabulatedContact(ContactLaw):
    r"""Contact force as a function of depth and angle, from samples.

    .. math::

        f = c \sum_j \left[a_j(\delta)\cos j\theta + b_j(\delta)\sin j\theta\right]

    with splines :math:`a_j, b_j` of degree 5 in the depth :math:`\delta = X - D > 0`, on knots that lie closer towards
    :math:`\delta = 0`: four times continuously differentiable, three times where they go on as straight lines beyond
    the samples; the same, mirrored, at the back. Build one with `from_deflections` or `from_forces`.

    Parameters
    ----------
    half_backlash : float
        :math:`D \ge 0`.
    coefficients : ndarray, shape (1 + 2 J, 6 n + 2)
        Splines of the mean, the cosines and the sines.
    reach : float
        Largest depth of the samples.
    remainder : float
        Largest difference to the samples, over the mean force of the same deflection.
    factor : float
        c.
    film : SqueezeFilm
        Squeezed film, if any.
    one_sided : bool
        No second flank.

    Raises
    ------
    InputError
        With every fault found; also if the force falls anywhere while the depth grows.
    """

    coefficients: Array
    reach: float
    remainder: float = 0.0
    factor: float = 1.0

    def __post_init__(self) -> None:
        """Check."""
        faults = self._check()
        faults.number("reach", self.reach, Limit(0.0, low_open=True, remedy="give the largest depth"))
        faults.number("factor", self.factor, Limit(0.0, low_open=True, remedy="1 is the law itself"))
        shape = np.shape(self.coefficients)
        if len(shape) != 2 or shape[0] % 2 == 0 or shape[1] < 8 or shape[1] % 6 != 2:
            faults.add(
                "coefficients", shape, "must have the shape (1 + 2 J, 6 n + 2)", "use from_deflections"
            )
        faults.raise_if_any()
        steepness = self.slopes(np.linspace(0.0, 2.0 * np.pi, 128, endpoint=False))
        if not steepness.min() > 0.0:
            turn, at = np.unravel_index(int(np.argmin(steepness)), steepness.shape)
            place = f"at angle {2 * np.pi * turn / 128:.3f} and interval {at // 4} of {self.intervals}"
            faults.add(
                "samples",
                f"falling {place}",
                "must give a force that grows with the depth",
                "fewer harmonics, more samples",
            )
        faults.raise_if_any()

    @classmethod
    def from_deflections(
        cls,
        forces: npt.ArrayLike,
        deflections: npt.ArrayLike,
        *,
        half_backlash: float,
        order: int = 8,
        first_angle: float = 0.0,
        intervals: int = INTERVALS,
        **options: Any,
    ) -> TabulatedContact:
        """Law through deflections under given forces, as a sweep of loads gives them.

        Between the samples of an angle the secant stiffness is a cubic spline over the root of the deflection, below
        the smallest force it is a straight line; a least-squares Fourier series over the angle follows.

        Parameters
        ----------
        forces : array_like, shape (p,)
            Forces, rising from more than 0, at least four.
        deflections : array_like, shape (a, p)
            Deflection at each of a equally spaced angles.
        half_backlash : float
            :math:`D`.
        order : int
            Harmonics J kept, below a/2.
        first_angle : float
            Angle of the first row [rad]; half an interval for midpoints.
        intervals : int
            Intervals n of the splines.
        **options
            film, one_sided, factor.

        Raises
        ------
        InputError
            With every fault found.
        """
        from scipy.interpolate import CubicSpline

        load, table = np.asarray(forces, dtype=np.float64), np.asarray(deflections, dtype=np.float64)
        _checked_table(load, table, order, intervals)
        reach = float(table[:, -1].max())
        knots = reach * (np.arange(intervals + 1) / intervals) ** 2
        values = np.zeros((len(table), intervals + 1))
        for row, depth in zip(values, table, strict=True):
            root = np.sqrt(depth)
            secant = CubicSpline(root, load / depth)
            inside = np.clip(np.sqrt(knots), root[0], root[-1])
            row[:] = secant(inside) * knots
            below, above = knots < depth[0], knots > depth[-1]
            row[below] = knots[below] * (
                secant(root[0]) + secant(root[0], 1) * (np.sqrt(knots[below]) - root[0])
            )
            steep = secant(root[-1]) + 0.5 * root[-1] * secant(root[-1], 1)
            row[above] = load[-1] + steep * (knots[above] - depth[-1])
        return cls.from_forces(
            knots, values, half_backlash=half_backlash, order=order, first_angle=first_angle, **options
        )

    @classmethod
    def from_forces(
        cls,
        depths: npt.ArrayLike,
        forces: npt.ArrayLike,
        *,
        half_backlash: float,
        order: int = 8,
        first_angle: float = 0.0,
        **options: Any,
    ) -> TabulatedContact:
        """Law through forces at knots reach (i/n)^2, i = 0 .. n, of the depth.

        Parameters
        ----------
        depths : array_like, shape (n + 1,)
            The knots.
        forces : array_like, shape (a, n + 1)
            Force at each of a equally spaced angles, 0 at no depth.
        half_backlash, order, first_angle, **options
            As in `from_deflections`.

        Raises
        ------
        InputError
            With every fault found.
        """
        from scipy.interpolate import make_interp_spline

        knots, table = np.asarray(depths, dtype=np.float64), np.asarray(forces, dtype=np.float64)
        with Faults() as faults:
            n = len(knots) - 1
            graded = n >= 6 and np.allclose(knots, knots[-1] * (np.arange(n + 1) / n) ** 2, rtol=1e-9)
            if not graded:
                faults.add("depths", knots.tolist(), "must be reach (i/n)^2, n >= 6", "use from_deflections")
            if (
                table.shape != (table.shape[0], n + 1)
                or not np.all(np.isfinite(table))
                or np.any(table[:, 0])
            ):
                faults.add(
                    "forces",
                    table.shape,
                    f"must be finite, (angles, {n + 1}), 0 at no depth",
                    "check the table",
                )
            count = len(table)
            whole = faults.whole("order", order, 0, max((count - 1) // 2, 0), "keep it below half the angles")
        angles = first_angle + 2.0 * np.pi * np.arange(count) / count
        j = np.arange(1, whole + 1)
        waves = np.vstack([np.ones(count), np.cos(j[:, None] * angles), np.sin(j[:, None] * angles)])
        parts = waves @ table / count
        parts[1:] *= 2.0
        remainder = np.max(np.abs(waves.T @ parts - table)[:, 1:] / np.mean(table[:, 1:], axis=0))
        # the second and third knot are left out for the two conditions at the far end, where a straight line follows
        places = np.concatenate([[knots[0]] * 6, knots[3:-1], [knots[-1]] * 6])
        ends: Any = (None, [(m, np.zeros(len(parts))) for m in (2, 3)])  # scipy's stubs know no derivatives
        spline = make_interp_spline(knots, parts.T, k=5, t=places, bc_type=ends)
        terms = [spline(knots[:-1], m) / math.factorial(m) for m in range(6)]
        rows = np.stack(terms, axis=-1).transpose(1, 0, 2).reshape(len(parts), 6 * n)
        last = np.column_stack([spline(knots[-1]), spline(knots[-1], 1)])
        return cls(
            half_backlash=half_backlash,
            coefficients=np.column_stack([rows, last]),
            reach=float(knots[-1]),
            remainder=float(remainder),
            **options,
        )

    @property
    def order(self) -> int:
        """Highest harmonic."""
        return len(self.coefficients) // 2

    @property
    def intervals(self) -> int:
        """Intervals of the splines."""
        return (int(np.shape(self.coefficients)[1]) - 2) // 6

    @property
    def knots(self) -> Array:
        """Depths at which the splines' pieces meet."""
        return self.reach * (np.arange(self.intervals + 1) / self.intervals) ** 2

    def slopes(self, angles: Array) -> Array:
        """Stiffness at four places of each interval, shape (angles, 4 intervals)."""
        n = self.intervals
        share = np.arange(4) / 3.0 * np.diff(self.knots)[:, None]
        c = self.coefficients[:, : 6 * n].reshape(-1, n, 6, 1)
        slope = np.zeros((len(c), n, 4))
        for m in range(5, 0, -1):
            slope = slope * share + m * c[:, :, m]
        j = np.arange(1, self.order + 1)
        waves = np.vstack([np.ones(len(angles)), np.cos(j[:, None] * angles), np.sin(j[:, None] * angles)])
        return np.asarray(waves.T @ slope.reshape(len(slope), -1))

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters."""
        return ("half_backlash", "film.damping", "film.thickness", "factor")

    @property
    def data(self) -> Array:
        """Splines, as the kernel reads them."""
        head = [*super().data, float(self.order), float(self.intervals), self.reach]
        return np.concatenate([head, self.coefficients.ravel()])

    @property
    def compiled(self) -> Any:
        """Function pointer."""
        from dynamics.kernels.stepwise.laws import tabulated_contact

        return tabulated_contact


def _checked_table(load: Array, table: Array, order: int, intervals: int) -> None:
    """Raise InputError with every fault of the samples."""
    with Faults() as faults:
        if load.ndim != 1 or len(load) < 4 or not np.all(np.diff(load, prepend=0.0) > 0.0):
            faults.add(
                "forces",
                load.tolist(),
                "must be four or more, rising from more than 0",
                "sort them, drop zero",
            )
        if table.ndim != 2 or table.shape[1:] != load.shape or not np.all(np.isfinite(table)):
            faults.add(
                "deflections", table.shape, f"must be finite, (angles, {load.size})", "one row per angle"
            )
        elif not np.all(np.diff(table, axis=1, prepend=0.0) > 0.0):
            row = int(np.argmin(np.diff(table, axis=1, prepend=0.0).min(axis=1)))
            faults.add(
                "deflections", f"not rising in row {row}", "must be rising with the force", "check the sweep"
            )
        faults.whole("order", order, 0, max((len(table) - 1) // 2, 0), "keep it below half the angles")
        faults.whole("intervals", intervals, 6, 10_000, "32 is usual")
