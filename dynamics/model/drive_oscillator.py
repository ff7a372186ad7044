"""The oscillator of several freedoms: a drive train with one mesh, and the checks of its parameters."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from base import Array, Faults, InputError
from dynamics.model.drive_checks import MATRICES, checked_array, refuse_unbalanced, symmetric
from dynamics.model.drive_coordinates import Coordinates, coordinates_of
from dynamics.model.excitation import (
    ERROR,
    FORCE,
    Harmonics,
    as_series,
    checked_series,
    harmonic_names,
    highest_harmonic,
    largest,
)
from dynamics.model.limits import OSCILLATOR
from dynamics.model.naming import natural_size, series_names
from dynamics.model.protocol import PeriodicOscillator
from dynamics.model.stiffness import FourierStiffness, check_stiffness

MAX_ENTRIES = 20_000_000  # of the tables: 160 MB


@dataclass(frozen=True, eq=False)
class DriveOscillator(PeriodicOscillator):
    r"""Drive train of n freedoms with one mesh that has periodic stiffness and backlash.

    .. math::

        M \ddot q + C \dot q + K q + g \, [c \, \dot y + k(t) f(y)] = F + h \, p(t), \qquad y = g \cdot q - e(t),

        e = \sum_j \varepsilon_j \cos(j \omega t + \varphi_{e,j}), \qquad
        p = \sum_j p_j \cos(j \omega t + \varphi_{p,j}),

    with the dead zone :math:`f(y) = y - D, \; 0, \; y + D` for :math:`y > D, \; |y| \le D, \; y < -D`, in any units
    that fit together. States are :math:`(q, \dot q)`, 2n numbers; what `GearOscillator` calls X is y. A rotation of
    the whole train that meets neither stiffness nor damping nor mesh is taken out: states are without it, and its
    multipliers count as 0.

    Parameters
    ----------
    mass : array_like, shape (n, n)
        M, symmetric and positive definite.
    damping, stiffness : array_like, shape (n, n)
        C and K, of everything but the mesh; they need not be symmetric (cross-coupled bearings).
    direction : array_like, shape (n,)
        g: how much each freedom closes the mesh.
    mesh_stiffness : FourierStiffness
        k(t), of the angle :math:`\omega t`.
    mesh_damping : float
        c, at least 0.
    mean_force : array_like, shape (n,)
        F.
    error_amplitude : float or sequence of float
        :math:`\varepsilon_j` of the harmonics j = 1, 2, ...; a number is the first harmonic alone.
    frequency : float
        :math:`\omega > 0`, mesh frequency.
    half_backlash : float
        D, at least 0.
    error_phase : float or sequence of float
        :math:`\varphi_{e,j}` [rad], one for each amplitude, or 0 for all of them.
    one_sided : bool
        No second flank: f(y) = 0 for all y <= D.
    free_mesh_damping : float, optional
        c in the dead zone, where it is another one than in contact.
    force_direction : array_like, shape (n,), optional
        h, along which a periodic force acts; none if left out.
    force_amplitude, force_phase : float or sequence of float
        :math:`p_j` and :math:`\varphi_{p,j}` [rad], as those of the error.

    Raises
    ------
    InputError
        With every fault found; also if a free rotation is loaded, or the tables of a period would be too large.

    Examples
    --------
    >>> from dynamics import DriveOscillator, FourierStiffness, find_orbit
    >>> drive = DriveOscillator(
    ...     mass=[[1.0, 0.0], [0.0, 1.0]], damping=[[0.1, 0.0], [0.0, 0.1]], stiffness=[[0.5, 0.0], [0.0, 0.5]],
    ...     direction=[1.0, 1.0], mesh_stiffness=FourierStiffness(1.0, (0.2,), (0.0,)), mesh_damping=0.05,
    ...     mean_force=[0.2, 0.2], error_amplitude=0.1, frequency=0.7, half_backlash=0.2,
    ... )
    >>> orbit = find_orbit(drive, drive.rest_state())
    >>> orbit.label, orbit.multipliers.shape
    ('1-0-0', (4,))
    """

    has_steps: ClassVar = False
    stiffness_name: ClassVar = "mesh_stiffness"

    mass: npt.ArrayLike
    damping: npt.ArrayLike
    stiffness: npt.ArrayLike
    direction: npt.ArrayLike
    mesh_stiffness: FourierStiffness
    mesh_damping: float
    mean_force: npt.ArrayLike
    error_amplitude: Harmonics
    frequency: float
    half_backlash: float
    error_phase: Harmonics = 0.0
    one_sided: bool = False
    free_mesh_damping: float | None = None
    force_direction: npt.ArrayLike | None = None
    force_amplitude: Harmonics = 0.0
    force_phase: Harmonics = 0.0

    def __post_init__(self) -> None:
        """Check and convert; every fault is listed."""
        values: dict[str, Any] = {}
        with Faults() as faults:
            values["direction"] = checked_array(faults, "direction", self.direction, None)
            n = len(values["direction"])
            for name in MATRICES:
                values[name] = checked_array(faults, name, getattr(self, name), (n, n))
            for name in ("mean_force", *(() if self.force_direction is None else ("force_direction",))):
                values[name] = checked_array(faults, name, getattr(self, name), (n,))
            values["mass"] = symmetric(faults, values["mass"])
            check_stiffness(faults, self.mesh_stiffness, "mesh_stiffness")
            for name in ("frequency", "half_backlash"):
                values[name] = faults.number(name, getattr(self, name), OSCILLATOR[name])
            for name in ("mesh_damping", "free_mesh_damping"):
                if (ratio := getattr(self, name)) is not None:
                    values[name] = faults.number(name, ratio, OSCILLATOR["damping_ratio"])
            for names in (ERROR, FORCE):
                amplitude, phase = (getattr(self, name) for name in names)
                values |= dict(zip(names, checked_series(faults, amplitude, phase, names), strict=True))
            if self.force_direction is None and np.any(values["force_amplitude"]):
                allowed = "must be given beside force_amplitude"
                faults.add("force_direction", "none", allowed, "one number for each freedom")
            faults.choice("one_sided", self.one_sided, (True, False), "True leaves the second flank out")
        for name, value in values.items():
            object.__setattr__(self, name, value)
        for name in (name for name in ("mean_force", "force_direction") if name in values):
            refuse_unbalanced(self.coordinates, name, values[name])
        entries = 4.0 * self.cells * self.coordinates.down.shape[0] * (self.dimension + 2)
        if not entries <= MAX_ENTRIES:
            allowed = f"must give tables of at most {MAX_ENTRIES} numbers (these have {entries:.3g})"
            raise InputError.at(
                "frequency", self.frequency, allowed, "raise it, or lower the maximum stiffness"
            )

    @property
    def dimension(self) -> int:
        """Length of a state, 2 n."""
        return 2 * len(np.asarray(self.direction))

    @cached_property
    def coordinates(self) -> Coordinates:
        """What the flow moves in."""
        return coordinates_of(*(np.asarray(getattr(self, name)) for name in (*MATRICES, "direction")))

    @cached_property
    def load(self) -> Array:
        """Mean force in the coordinates of the flow."""
        return np.asarray(self.coordinates.push @ np.asarray(self.mean_force))

    @property
    def force_series(self) -> Array:
        """Amplitudes and phases [rad] of the harmonics of the periodic force, shape (2, harmonics)."""
        return as_series(self.force_amplitude, self.force_phase)

    @cached_property
    def moving_loads(self) -> Array:
        """Direction of the periodic force in the coordinates of the flow, shape (1, m); none where none acts."""
        if self.force_direction is None or not self.force_series[0].any():
            return np.zeros((0, len(self.load)))
        return np.asarray(self.coordinates.push @ np.asarray(self.force_direction))[None]

    def moving_force(self, tau: Array) -> Array:
        """Periodic force p along its direction at some times."""
        return self._series_motion(self.force_series, tau)[0]

    @property
    def dampings(self) -> tuple[float, float]:
        """Damping of the mesh in contact and in the dead zone."""
        free = self.mesh_damping if self.free_mesh_damping is None else self.free_mesh_damping
        return self.mesh_damping, free

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of parameters: ``frequency``, ..., ``mean_force[0]``, ..., ``mesh_stiffness.mean``, ..."""
        amplitudes, phases = harmonic_names(self.error_series.shape[1])
        forces = tuple(f"mean_force[{i}]" for i in range(self.dimension // 2))
        own = ("frequency", *amplitudes, *phases, *forces, "mesh_damping", "half_backlash")
        free = () if self.free_mesh_damping is None else ("free_mesh_damping",)
        moving = () if self.force_direction is None else harmonic_names(self.force_series.shape[1], FORCE)
        pushes = (name for names in moving for name in names)
        return (*own, *free, *pushes, *(f"mesh_{name}" for name in series_names(self.mesh_stiffness.order)))

    @property
    def floor(self) -> float:
        """Half the backlash."""
        return max(self.half_backlash, 1e-300)

    @property
    def natural_size(self) -> float:
        """Largest displacement at rest, or by the periodic force at rest, or the error."""
        rest = float(np.max(np.abs(self.rest_state())))
        return natural_size(self.floor, rest, self._moved_size, largest(self.error_series))

    @property
    def driven_size(self) -> float:
        """Largest displacement at rest without backlash, or by the periodic force at rest, or the error."""
        rest = replace(self, half_backlash=0.0).rest_state()
        return natural_size(float(np.max(np.abs(rest))), self._moved_size, largest(self.error_series))

    @property
    def _moved_size(self) -> float:
        """Largest displacement by the periodic force at rest, in contact with the mean stiffness."""
        at, stiff = self.coordinates, self.coordinates.stiffness.copy()
        stiff[0, 0] += at.gain * self.mesh_stiffness.mean
        moved = at.up @ np.linalg.lstsq(stiff, self.moving_loads.T, rcond=None)[0]
        return largest(self.force_series) * float(np.max(np.abs(moved), initial=0.0))

    @cached_property
    def cells(self) -> float:
        """Cells of a period, before rounding up: a radian of every time scale, half a one of every harmonic."""
        mesh = self.mesh_stiffness
        stiff = abs(mesh.mean) + math.fsum(map(abs, mesh.amplitudes))
        fastest = self.coordinates.fastest(stiff, max(self.dampings))
        highest = highest_harmonic(mesh.order, self.error_series[0, 1:])
        highest = highest_harmonic(highest, self.force_series[0, 1:])
        return max(self.period * fastest, 4.0 * math.pi * highest)

    @cached_property
    def decay(self) -> float:
        """Rate at which a disturbance dies out that dies out most slowly, in contact with the mean stiffness."""
        at = self.coordinates
        m = len(self.load)
        stiff, drag = at.stiffness.copy(), at.damping.copy()
        stiff[0, 0] += at.gain * self.mesh_stiffness.mean
        drag[0, 0] += at.gain * self.mesh_damping
        system = np.block([[np.zeros((m, m)), np.eye(m)], [-stiff, -drag]])
        values = np.linalg.eigvals(system)
        slowest = -float(np.max(values.real))
        return slowest if slowest > 1e-12 * float(np.max(np.abs(values))) else 0.0

    @property
    def directions(self) -> int:
        """Directions of a disturbance, without free rotations."""
        return 2 * len(self.load)

    def rest_state(self) -> Array:
        """State at tau = 0 with y at rest under the mean force: on the flanks that it presses together, or between."""
        return np.asarray(self.balanced(np.zeros(1))[0])

    def balanced(self, tau: Array) -> Array:
        """States with y at rest at some times, shape (k, 2 n)."""
        at = self.coordinates
        for side in (1.0, -1.0, 0.0):
            stiff, force = at.stiffness.copy(), self.load.copy()
            if side != 0.0:
                push = at.gain * self.mesh_stiffness.mean
                stiff[0, 0] += push
                force[0] += push * side * self.half_backlash
            w = np.linalg.lstsq(stiff, force, rcond=None)[0]
            if side * (w[0] - side * self.half_backlash) > 0.0 and not (side < 0.0 and self.one_sided):
                break
        return self.lifted(np.tile(np.concatenate([w, np.zeros(len(w))]), (len(tau), 1)), tau)

    def in_contact(self, side: int) -> tuple[DriveOscillator, Array]:
        r"""Without backlash, about a displacement a with :math:`g^T a = \pm D`, which K answers with the force -K a."""
        g = np.asarray(self.direction)
        shift = side * self.half_backlash / float(g @ g) * g
        force = np.asarray(self.mean_force) - np.asarray(self.stiffness) @ shift
        linear = replace(self, mean_force=force, half_backlash=0.0, one_sided=False)
        return linear, np.concatenate([shift, np.zeros_like(shift)])

    def turning_acceleration(self, state: Array) -> float:
        """Y'' at tau = 0 where the rate of y is zero."""
        at, m = self.coordinates, len(self.load)
        moved = self.lowered(state[None], np.zeros(1))[0]
        w, speed = moved[:m].copy(), moved[m:].copy()
        push = at.gain * float(self.contact_force(np.zeros(1), moved[:1])[0])
        error, rate = self.error_motion(np.zeros(1))
        w[0] += error[0]
        speed[0] = rate[0]
        bend = self.load[0] - at.stiffness[0] @ w - at.damping[0] @ speed - push
        bend += self.moving_force(np.zeros(1))[0] * float(np.sum(self.moving_loads[:, 0]))
        j = self.frequency * np.arange(1, self.error_series.shape[1] + 1)
        amplitudes, phases = self.error_series
        return float(bend + np.sum(j**2 * amplitudes * np.cos(phases)))

    def start_plane(self) -> tuple[Array, Array]:
        """Directions in which y and its rate move alone, by one each, and the state at rest."""
        along, none = self.coordinates.up[:, 0], np.zeros(self.dimension // 2)
        return np.stack([np.append(along, none), np.append(none, along)]), self.rest_state()

    def error_motion(self, tau: Array) -> tuple[Array, Array]:
        """Error e and its rate at some times."""
        return self._series_motion(self.error_series, tau)

    def _series_motion(self, series: Array, tau: Array) -> tuple[Array, Array]:
        """Sum of the harmonics of a series and its rate at some times."""
        tau = np.asarray(tau)
        total, rate = np.zeros(tau.shape), np.zeros(tau.shape)
        for j, (amplitude, phase) in enumerate(series.T.tolist(), start=1):
            angle = j * self.frequency * tau + phase
            total = total + amplitude * np.cos(angle)
            rate = rate - j * self.frequency * amplitude * np.sin(angle)
        return total, rate

    def lowered(self, states: Array, tau: Array) -> Array:
        """Coordinates of the flow, shape (k, 2 m), of states at some times."""
        n, down = self.dimension // 2, self.coordinates.down
        w, speed = states[:, :n] @ down.T, states[:, n:] @ down.T
        error, rate = self.error_motion(tau)
        w[:, 0] -= error
        speed[:, 0] -= rate
        return np.hstack([w, speed])

    def lifted(self, moved: Array, tau: Array) -> Array:
        """States, shape (k, 2 n), of coordinates of the flow at some times."""
        m, up = moved.shape[1] // 2, self.coordinates.up
        w, speed = moved[:, :m].copy(), moved[:, m:].copy()
        error, rate = self.error_motion(tau)
        w[:, 0] += error
        speed[:, 0] += rate
        return np.hstack([w @ up.T, speed @ up.T])

    def deflection(self, y: npt.ArrayLike) -> Array:
        """Deflection f(y) past the backlash, shape of `y`."""
        at = np.asarray(y, dtype=np.float64)
        lower = -np.inf if self.one_sided else -self.half_backlash
        return np.asarray(at - np.clip(at, lower, self.half_backlash))

    def contact_motion(self, tau: Array, states: Array) -> tuple[Array, Array]:
        """Contact coordinate y and its rate."""
        n, g = self.dimension // 2, np.asarray(self.direction)
        error, rate = self.error_motion(tau)
        return np.asarray(states[:, :n] @ g - error), np.asarray(states[:, n:] @ g - rate)
