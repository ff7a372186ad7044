r"""Drive train reduced to the modes that the harmonics of its mesh reach, and the static deflection of all others.

Shapes are the free rotation, modes of the whole train in contact, and what these leave of the static deflections under
the mesh force, under its moment where the load travels over the face, and under motor and load (MacNeal, Computers &
Structures 1, 1971, 581, doi:10.1016/0045-7949(71)90031-9). Every static answer is kept, in contact and out of it;
frequencies err upwards. Modes are taken until no force that the linear response has within the speeds changes by more
than a tolerance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.linalg import eigh

from base import Array
from flankfilm.coupling.drive.train import ShaftDamping, Train, lowest_modes

Complexes = npt.NDArray[np.complex128]
Chosen = npt.NDArray[np.bool_] | npt.NDArray[np.intp]

SPEEDS = 200
"""Speeds over the range, besides those at which a harmonic meets a mode, at which forces are compared."""

FLOOR = 0.1
"""Forces are compared with their swing at each speed, or with this part of the largest where that is more."""

BEYOND = 3.0
"""Frequencies that are looked at, over the highest that harmonics reach."""

FADED = 0.05
"""Harmonics whose force is less than this part of the tolerance, over the largest, count as none."""

MOST_MODES = 150


@dataclass(frozen=True, eq=False)
class MeshExcitation:
    """Amplitudes of what drives the train at its mesh, in contact and linear.

    Attributes
    ----------
    force : ndarray, shape (harmonics,)
        Of the stiffness' harmonics under the mean deflection [N].
    error : ndarray, shape (harmonics,)
        Of the transmission error's harmonics [m].
    stiffness, damping : float
        Mean ones of the mesh [N/m], [N s/m].
    moment : ndarray, shape (1 + any,)
        Mean and harmonics of the load that travels over the face [N m]; 0 where it stays where slopes place it.
    """

    force: Array
    error: Array
    stiffness: float
    damping: float
    moment: Array

    def amplitudes(self, frequencies: Array) -> Array:
        """Force [N] by mesh frequency [rad/s] and harmonic; that of stiffness and error added up."""
        orders = np.arange(1, len(self.force) + 1)
        nu = np.multiply.outer(frequencies, orders)
        return np.asarray(self.force + np.abs(self.stiffness + 1j * self.damping * nu) * self.error)

    def reaching(self, frequency: float, tolerance: float) -> MeshExcitation:
        """Harmonics up to the last that counts at a mesh frequency [rad/s]."""
        last = _last(self.amplitudes(np.array([frequency]))[0], tolerance)
        moment = self.moment[: 1 + _last(self.moment[1:], tolerance)]
        return MeshExcitation(self.force[:last], self.error[:last], self.stiffness, self.damping, moment)

    def sources(self, train: Train, frequencies: Array) -> list[tuple[Array, Array]]:
        """Directions (n,) and amplitudes (frequencies, harmonics) of the force and of the moment, if there is one.

        A moment that stands still swings nothing, but its direction is that of a static deflection.
        """
        force = self.amplitudes(frequencies)
        moment = np.tile(self.moment[1:], (len(frequencies), 1))
        count = max(force.shape[1], moment.shape[1])
        of_force, of_moment = (np.pad(each, ((0, 0), (0, count - each.shape[1]))) for each in (force, moment))
        return [(train.direction, of_force), (train.tilt, of_moment)][: 2 if self.moment.any() else 1]


def _last(amplitudes: Array, tolerance: float) -> int:
    """Number of harmonics up to the last that counts."""
    counts = np.flatnonzero(amplitudes >= FADED * tolerance * amplitudes.max(initial=0.0))
    return int(counts[-1]) + 1 if counts.size else 0


class Reduction(NamedTuple):
    """Shapes of the reduced train, and what they leave out.

    Attributes
    ----------
    shapes : ndarray, shape (n, r)
        Free rotation, modes, rest of static deflections.
    squares : ndarray, shape (m,)
        Of the natural frequencies of the unreduced train in contact [rad2/s2], rising, without the free rotation.
    modes : ndarray, shape (n, m)
        Of a mass of one.
    retained : ndarray of bool, shape (m,)
        Whether a mode is among the shapes.
    error : float
        Largest change of a force's swing from what is left out, within the speeds.
    valid_to : float
        Mesh frequency up to which this is within the tolerance [rad/s]; infinite where nothing is left out.
    """

    shapes: Array
    squares: Array
    modes: Array
    retained: npt.NDArray[np.bool_]
    error: float
    valid_to: float


def reduced_train(
    train: Train,
    damping: ShaftDamping,
    excitation: MeshExcitation,
    frequencies: tuple[float, float],
    tolerance: float,
) -> Reduction:
    """Choose the modes that move.

    Parameters
    ----------
    train : Train
    damping : ShaftDamping
    excitation : MeshExcitation
    frequencies : (float, float)
        Lowest and highest mesh frequency [rad/s].
    tolerance : float
        Of the swing of forces; see `FLOOR`.
    """
    excitation = excitation.reaching(frequencies[1], tolerance)
    squares, modes = lowest_modes(
        train.in_contact, train.mass, min(MOST_MODES, len(train.rotation)), frequencies[1] ** 2
    )
    squares, modes = squares[1:], modes[:, 1:]  # one rotation of the whole train is free
    if all(side.shaft is None for side in train.sides):
        kept = np.ones(len(squares), dtype=np.bool_)
        return Reduction(np.eye(len(train.rotation)), squares, modes, kept, 0.0, np.inf)
    whole = _Forced(train, damping, excitation, squares, modes, frequencies)
    order = np.argsort(-whole.importance, kind="stable")
    few, many = 0, len(order)
    while many - few > 1:  # the fewest that suffice
        at = (few + many) // 2
        few, many = (few, at) if whole.changes(order[:at])[0] <= tolerance else (at, many)
    kept = np.isin(np.arange(len(squares)), order[:many])
    change, over = whole.changes(order[:many])
    late = np.flatnonzero(over > tolerance)
    valid = whole.frequencies[late[0] - 1 if late[0] else 0] if late.size else whole.frequencies[-1]
    return Reduction(
        np.column_stack([whole.rotation, modes[:, kept], whole.rest(kept)[0]]), squares, modes, kept,
        change, float(valid),
    )  # fmt: skip


class _Forced:
    """Linear response of the unreduced train over the mesh frequency, mode by mode."""

    def __init__(
        self,
        train: Train,
        damping: ShaftDamping,
        excitation: MeshExcitation,
        squares: Array,
        modes: Array,
        ends: tuple[float, float],
    ) -> None:
        self.train, self.damping, self.squares, self.modes = train, damping, squares, modes
        rotation = train.rotation
        self.rotation = rotation / np.sqrt(rotation @ (train.mass @ rotation))
        self.factors = train.held()
        self.mesh_damping = excitation.damping
        orders = np.arange(1, max(len(excitation.force), len(excitation.moment) - 1) + 1)
        met = np.sqrt(squares)[:, None] / orders
        grid = np.geomspace(ends[0], BEYOND * ends[1], SPEEDS)
        self.frequencies = np.unique(
            np.concatenate([grid, ends, met[(met > ends[0]) & (met < BEYOND * ends[1])]])
        )
        self.within = self.frequencies <= ends[1]
        sources = excitation.sources(train, self.frequencies)
        self.directions, self.forces = zip(*sources, strict=True)
        self.nu = self.frequencies[:, None] * orders
        firm = excitation.stiffness * train.direction
        self.push = np.array([*(output.displacement for output in train.outputs), firm])
        self.drag = np.array([*(output.speed for output in train.outputs), np.zeros_like(firm)])
        self.rates = self._rates(modes)
        self.answer = self._answer(squares, self.rates)
        self.driven = [modes.T @ direction for direction in self.directions]
        self.whole = self._outputs(modes, self.answer, self.driven)
        ones = np.ones((1, *self.nu.shape), dtype=np.complex128)
        self.whole += np.concatenate(
            [
                self._under(
                    self.factors.solve(direction - train.mass @ (modes @ driven))[:, None], ones, forces
                )
                for direction, driven, forces in zip(self.directions, self.driven, self.forces, strict=True)
            ],
            axis=-1,
        )
        swing = self._swing(self.whole)
        self.scale = np.maximum(swing, FLOOR * swing[:, self.within].max(axis=1, keepdims=True))
        self.scale = np.maximum(self.scale, 1e-300)

    @property
    def importance(self) -> Array:
        """Maximum force of what a mode adds to its static deflection, over the force's scale, within the speeds."""
        more = self.answer - 1.0 / self.squares[:, None, None]
        peaks = []
        for mode in range(len(self.squares)):
            driven = [each[[mode]] for each in self.driven]
            contribution = self._outputs(self.modes[:, [mode]], more[[mode]], driven)
            peaks.append(np.max((self._swing(contribution) / self.scale)[:, self.within], initial=0.0))
        return np.array(peaks)

    def rest(self, kept: Chosen) -> tuple[Array, Array]:
        """What chosen modes leave of the static deflections, as shapes of a mass of one, and squares of frequencies."""
        mass, taken = self.train.mass, np.column_stack([self.rotation, self.modes[:, kept]])
        loads = np.column_stack([*self.directions, self.train.load])
        residual = self.factors.solve(loads - mass @ (taken @ (taken.T @ loads)))
        for _ in range(2):
            residual = residual / np.sqrt(np.sum(residual * (mass @ residual), axis=0))
            residual = residual - taken @ (taken.T @ (mass @ residual))
        sizes, turn = np.linalg.eigh(residual.T @ (mass @ residual))
        independent = sizes > 1e-12 * sizes[-1]
        residual = residual @ (turn[:, independent] / np.sqrt(sizes[independent]))
        squares, turn = eigh(residual.T @ (self.train.in_contact @ residual))
        return residual @ turn, squares

    def changes(self, kept: Chosen) -> tuple[float, Array]:
        """Largest change of a force with these modes alone within the speeds, and the largest at each."""
        rest, squares = self.rest(kept)
        shapes = np.column_stack([self.modes[:, kept], rest])
        answer = np.concatenate([self.answer[kept], self._answer(squares, self._rates(rest))])
        outputs = self._outputs(shapes, answer, [shapes.T @ direction for direction in self.directions])
        over = np.max(self._swing(outputs - self.whole) / self.scale, axis=0)
        return float(np.max(over[self.within])), over

    def _rates(self, shapes: Array) -> Array:
        """Twice ratio times frequency of shapes, their coupling by damping left out."""
        own = np.diag(self.damping.of(shapes)).copy()
        return np.asarray(own + self.mesh_damping * (shapes.T @ self.train.direction) ** 2)

    def _answer(self, squares: Array, rates: Array) -> Complexes:
        """Amplitude of modes under a force of one, (modes, frequencies, harmonics)."""
        nu = self.nu
        return np.asarray(1.0 / (squares[:, None, None] - nu**2 + 1j * rates[:, None, None] * nu))

    def _outputs(self, shapes: Array, answer: Complexes, driven: Sequence[Array]) -> Complexes:
        """Forces of parts and of the mesh, (outputs, frequencies, harmonics), each source along shapes."""
        each = [
            self._under(shapes, answer * along[:, None, None], forces)
            for along, forces in zip(driven, self.forces, strict=True)
        ]
        return np.concatenate(each, axis=-1)

    def _under(self, shapes: Array, amplitudes: Complexes, forces: Array) -> Complexes:
        """Forces of parts and of the mesh, (outputs, frequencies, harmonics), under one source."""
        flat = amplitudes.reshape(len(amplitudes), -1)
        push, drag = ((rows @ shapes @ flat).reshape(-1, *self.nu.shape) for rows in (self.push, self.drag))
        return np.asarray((push + 1j * self.nu * drag) * forces)

    def _swing(self, forces: Complexes) -> Array:
        """Root mean square over a period, (outputs, frequencies)."""
        return np.asarray(np.sqrt(0.5 * np.sum(np.abs(forces) ** 2, axis=-1)))
