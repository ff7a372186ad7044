"""Errors of figures from the smooth arcs between the events of a mesh cycle.

The error of a figure is that of its arcs' series and, by finite elements, that of the mesh and of fits along the
flanks: the figure is computed once more from gears on the mesh before the last refinement whose fits are off by as
much more, with separate events. What films may err by changes it likewise: it is computed once more with films so
changed, and with half as many cells of the face. These parts have nothing to do with each other and are added as
squares. A part of a harmonic's error is complex, with the phase of what causes it. All this is solved when an error is
first asked for: a study of figures alone does without.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from math import hypot, sqrt

import numpy as np

from base import Array, Integers, RangeWarning, SolverError, part, quantity, record
from base.later import Later, known
from gears.sharing.arcs import Arcs
from gears.sharing.events import Division
from gears.tooth.errors import LoadSharingError

__all__ = ["ALONE", "CURVES", "Compared", "Estimate", "FewerCells", "MeshArcs", "Scatter", "compared_later"]

CURVES = ("transmission_error", "stiffness", "secant_stiffness")
"""Curves of every mesh cycle on its arcs."""

STEP = 1e-3
"""Smallest relative step of the tangent stiffness that is a separate event."""

UNLIKE = 0.2
"""Part of a change across a harmonic, in the complex plane, that may lie along it.

A mesh's error falls with the order 3 to 4, by 7 to 15, not everywhere alike, and what an arc leaves out is not all at
one place.
"""


@record
class Estimate:
    """A figure with its estimated error, both in the figure's unit."""

    value: float = quantity("", "figure")
    later_error: Later[float | None] = part("its error, found when it is first asked for")

    @property
    def error(self) -> float | None:
        """Error, in the figure's unit; None where it is unknown."""
        return self.later_error.value

    @property
    def relative(self) -> float | None:
        """Relative error."""
        return None if self.error is None else self.error / abs(self.value) if self.value else self.error


@record
class Scatter:
    """What cells leave of a curve at the positions of a cycle, in the curve's unit."""

    no_error = "what the estimates of a cycle are made of: MeshFigures has the errors"

    size: float = quantity("", "root mean square over positions")
    varying: float = quantity("", "the same of what is not alike at all positions")
    of_mean: float = quantity("", "of their mean, which changes of sign leave the less of the more there are")


@record
class FewerCells:
    """A cycle with half as many cells of the face."""

    no_error = "what the estimates of a cycle are made of: MeshFigures has the errors"

    arcs: Arcs = part("curves with fewer cells")
    share: float = quantity("1", "how much of what fewer cells change is error")
    scatter: Mapping[str, Scatter] = part("that part at positions, of curves by their names")
    ends: tuple[Arcs, float] | None = part(
        "as many cells, with free ends of helical gears off by a part of what is doubtful of them, and how much of it "
        "every change stands for; None of spur gears",
        default=None,
    )
    ends_scatter: Mapping[str, Scatter] | None = part(
        "the most that free ends move extremes (`size`) and ranges (`varying`) by", default=None
    )


@record
class Compared:
    """Curves of the same cycle with parts of the model changed, for an estimate of what they leave open."""

    no_error = "what the estimates of a cycle are made of: MeshFigures has the errors"

    before: Arcs | None = part(
        "curves on the mesh before the last refinement; None where there is no mesh", default=None
    )
    varied: tuple[tuple[Arcs, float], ...] = part(
        "the same with a part of the model changed, such as its films, and how much of every change is error",
        default=(),
    )
    fewer: FewerCells | None = part(
        "the same with half as many cells of the face; None where it has none", default=None
    )


ALONE: Later[Compared | str] = known(Compared())
"""Of arcs that nothing is compared with."""


def compared_later(find: Callable[[], Compared]) -> Later[Compared | str]:
    """What arcs are compared with, found when an error is first asked for, or why that has no solution.

    Warns
    -----
    base.RangeWarning
        Where it has none.
    """

    def compared() -> Compared | str:
        try:
            return find()
        except (SolverError, LoadSharingError) as error:
            warnings.warn(f"errors of the mesh cycle are unknown: {error}", RangeWarning, stacklevel=2)
            return str(error)

    return Later(compared)


@record
class MeshArcs:
    """Curves of a mesh cycle on smooth arcs, and what they are compared with for an estimate."""

    no_error = "what the estimates of a cycle are made of: MeshFigures has the errors"

    division: Division = part("arcs and events")
    others: Later[Compared | str] = part("what they are compared with, or why that has no solution")
    gain: float = quantity("1", "by how much the last refinement reduced the error")
    other: float | None = quantity(
        "1", "further relative error of all figures; None where a model's is unknown"
    )

    @property
    def compared(self) -> Compared:
        """What the arcs are compared with, solved when it is first asked for.

        Raises
        ------
        base.SolverError
            It has no solution somewhere, so that errors are unknown.
        """
        if isinstance(self.others.value, str):
            raise SolverError(self.others.value)
        return self.others.value

    @property
    def comparable(self) -> bool:
        """Whether errors are known: those of the model, and what arcs are compared with."""
        return self.other is not None and not isinstance(self.others.value, str)

    @property
    def arcs(self) -> Arcs:
        """Curves on their arcs."""
        return self.division.arcs

    @property
    def events(self) -> Array:
        """Where contacts begin or end: where a switch turns, or the tangent stiffness steps by 0.1 % (events,)."""
        events, row = self.division.events, self.arcs.names.index("stiffness")
        ends = np.array([arc.values[row, [0, -1]] for arc in self.arcs.arcs])
        before, after = np.roll(ends[:, 1], 1), ends[:, 0]
        steps = np.append(np.abs(after / before - 1) > STEP, False)
        return np.asarray(events.position[steps | (events.switched >= 0)])

    def mean(self, name: str, between: tuple[float, float] | None = None) -> Estimate:
        """Mean of a curve, all over or between two ends of arcs in every base pitch."""
        value, error = self.arcs.mean(name, between)

        # what free ends change of means is `other`
        def bounds() -> tuple[float, float | None]:
            return self._scatter(name).of_mean, None

        return self._estimate(value, error, lambda arcs: arcs.mean(name, between)[0], bounds)

    def extreme(self, name: str, greatest: bool) -> Estimate:
        """Minimum or maximum value of a curve."""
        value, error = self.arcs.extremes(name)[greatest]

        def bounds() -> tuple[float, float | None]:
            return self._scatter(name).size, self._ends_scatter(name).size

        return self._estimate(value, error, lambda arcs: arcs.extremes(name)[greatest][0], bounds)

    def range(self, name: str) -> Estimate:
        """Maximum minus minimum value of a curve."""
        (least, off), (most, more) = self.arcs.extremes(name)

        def apart(arcs: Arcs) -> float:
            (low, _), (high, _) = arcs.extremes(name)
            return high - low

        def bounds() -> tuple[float, float | None]:
            return self._scatter(name).varying, self._ends_scatter(name).varying

        return self._estimate(most - least, hypot(off, more), apart, bounds)

    def greatest_share(self) -> Estimate:
        """Largest share of the torque that a pair takes; nan where pairs are not distinguished."""
        shares = self.arcs.shares()
        if shares is None:
            return Estimate(float("nan"), known(None))
        value, error = shares.greatest_of_all()

        def greatest(arcs: Arcs) -> float:
            others = arcs.shares()
            return value if others is None else others.greatest_of_all()[0]

        # what all pairs have alike changes no share
        return self._estimate(value, error, greatest, alike=False)

    def harmonics(self, name: str, orders: Integers) -> tuple[Array, Array | None]:
        """Complex amplitudes of harmonics of the mesh frequency, and their errors, in the curve's unit."""
        value, changes = self._harmonics(name, orders, False)
        return value, None if changes is None else np.linalg.norm(changes, axis=1)

    def over_mean(self, name: str, orders: Integers) -> tuple[Array, Array | None]:
        """Complex amplitudes of harmonics over the mean, and their errors.

        What changes the mean and all harmonics alike is no error of their ratio.
        """
        value, changes = self._harmonics(name, orders, True)
        return value, None if changes is None else np.linalg.norm(changes, axis=1)

    def amplitudes(self, name: str, orders: Integers, over_mean: bool) -> tuple[Array, Array | None]:
        """Sizes of `harmonics`, or `over_mean`, and their errors: what only turns a phase changes no size."""
        value, changes = self._harmonics(name, orders, over_mean)
        size = np.abs(value)
        if changes is None:
            return size, None
        either = np.abs(value[:, None] + np.stack([changes, -changes]))
        sizes = np.max(np.abs(either - size[:, None]), axis=0)
        across = np.abs(np.imag(changes * np.conj(_phase(value))[:, None]))
        return size, np.linalg.norm(np.hypot(sizes, UNLIKE * across), axis=1)

    def _harmonics(self, name: str, orders: Integers, over_mean: bool) -> tuple[Array, Array | None]:
        """Complex amplitudes, and what each part of their errors changes (orders, parts); None where one is unknown.

        Parts are what a much finer mesh would change, arcs leave out, and other models change. What cells and free
        ends change of a harmonic may vanish by chance: it counts at least as what cells change at positions (root
        mean square), and as a part V/(n + 1) of the range V that free ends move; a range V is that of an amplitude V/2.
        """

        def figure(arcs: Arcs) -> Array:
            return arcs.harmonics(name, orders)[0] / (arcs.mean(name)[0] if over_mean else 1.0)

        value, off = self.arcs.harmonics_and_parts(name, orders)
        parts, mean = [off], 1.0
        if over_mean:
            mean, less = self.arcs.mean(name)
            value = value / mean
            parts = [off / mean, (value * less / mean)[:, None]]
        if self.other is None or not self.comparable:
            return value, None
        parts.append(self.other * value[:, None])
        compared, fewer = self.compared, self.compared.fewer
        before = () if compared.before is None else ((compared.before, 1.0 / self.gain),)
        parts += [share * (value - figure(arcs))[:, None] for arcs, share in (*before, *compared.varied)]
        if fewer is not None:
            few = figure(fewer.arcs)
            least = np.full(len(orders), self._scatter(name).varying / mean)
            parts.append(_of_any_phase(value, np.maximum(fewer.share * np.abs(value - few), least)))
            if fewer.ends is not None:
                of_ends, share = fewer.ends
                least = self._ends_scatter(name).varying / mean / np.maximum(orders + 1.0, 3.0)
                parts.append(_of_any_phase(value, np.maximum(share * np.abs(figure(of_ends) - few), least)))
        return value, np.concatenate(parts, axis=1)

    def _scatter(self, name: str) -> Scatter:
        """What the cells leave of a curve at positions."""
        none = Scatter(0.0, 0.0, 0.0)
        fewer = self.compared.fewer
        return none if fewer is None else fewer.scatter.get(name, none)

    def _ends_scatter(self, name: str) -> Scatter:
        """The most that free ends move of a curve."""
        none = Scatter(0.0, 0.0, 0.0)
        fewer = self.compared.fewer
        moved = None if fewer is None else fewer.ends_scatter
        return none if moved is None else moved.get(name, none)

    def _estimate(
        self,
        value: float,
        sampling: float,
        figure: Callable[[Arcs], float],
        bounds: Callable[[], tuple[float, float | None]] = lambda: (0.0, 0.0),
        alike: bool = True,
    ) -> Estimate:
        """Estimate with the error of arcs, mesh, cells, free ends and other models.

        Cells and free ends change at positions the `bounds`, the second None where these are among other models.
        """

        def error() -> float | None:
            if self.other is None or not self.comparable:
                return None
            compared, fewer = self.compared, self.compared.fewer
            other = self.other * value if alike else 0.0
            mesh = 0.0 if compared.before is None else abs(value - figure(compared.before)) / self.gain
            varied = [share * abs(value - figure(arcs)) for arcs, share in compared.varied]
            if fewer is not None:
                # the change of a figure may vanish by chance where cells change much at single positions
                few, (least, ends) = figure(fewer.arcs), bounds()
                varied.append(max(fewer.share * abs(value - few), least))
                if fewer.ends is not None and ends is not None:
                    of_ends, share = fewer.ends
                    varied.append(max(share * abs(figure(of_ends) - few), ends))
            return hypot(sampling, mesh, other, *varied)

        return Estimate(value, Later(error))


def _of_any_phase(value: Array, change: Array) -> Array:
    """Change of complex amplitudes (orders, 2), whose phase is chance: half of its square along them, half across."""
    return np.asarray(_phase(value)[:, None] * change[:, None] * np.array([1.0, 1j]) / sqrt(2.0))


def _phase(value: Array) -> Array:
    """Of complex amplitudes, as numbers of size one."""
    size = np.abs(value)
    return np.asarray(np.divide(value, size, out=np.ones_like(value), where=size > 0.0))
