"""Bearing forces, axial motion and tilt of a helical pair over the speed, by gears with six freedoms each.

Linear about the loaded state: at every speed one periodic motion (`coupling.drive.pair_in_space`). Speeds at which the
mesh would pull are left out, since contact that is lost in several coordinates is not known.
"""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import numpy as np

from base import Array, Booleans, Cost, Faults, Limit, SolverError, Stopwatch, quantity, record
from base.results import EXACT, ITSELF
from flankfilm.coupling.drive.pair_in_space import BearingForces, SpatialPair
from flankfilm.coupling.drive.spatial_bearings import SpatialBearing

__all__ = ["BearingSweep", "bearing_sweep"]

SAMPLES = 64
"""Samples of a mesh period at which forces are looked at."""

_SPEED = Limit.above(0.0, 1e6, "rad/s", "give speeds of the pinion in rad/s")

ROUNDING = 1e-6
"""Natural frequencies over the highest below which they are of what nothing holds."""

BOTH = ("pinion", "wheel")


@record
class BearingSweep:
    """What bearings carry and how gears move in periodic motions over the speed; nan where contact would be lost."""

    headline: ClassVar[tuple[str, ...]] = ("greatest_swing", "greatest_force")

    speed: Array = quantity("rad/s", "pinion speed", "speed", shown="rpm", no_error=EXACT)
    bearings: tuple[str, ...] = quantity(
        "", "bearings of both gears, in the order of their forces", "bearing"
    )
    bearing_force: Array = quantity(
        "N", "maximum force of each bearing within a mesh period", "speed bearing", error="error"
    )
    bearing_swing: Array = quantity(
        "N",
        "root mean square of the force of each bearing about its mean, all directions together",
        "speed bearing",
        error="error",
    )
    axial_force: Array = quantity(
        "N", "maximum axial force of each bearing within a mesh period", "speed bearing", error="error"
    )
    axial_motion: Array = quantity(
        "m", "axial motion of each gear, peak to peak", "speed gear", shown="um", error="error"
    )
    tilt: Array = quantity("rad", "maximum tilt of each gear about its mean one", "speed gear", error="error")
    mean_force: Array = quantity(
        "N", "force of each bearing in the mean, by the static load", "bearing", no_error=EXACT
    )
    natural_frequencies: Array = quantity(
        "Hz", "natural frequencies in contact, of the mean mesh", "mode", error="frequency_error"
    )
    mesh_share: Array = quantity(
        "1", "part of a mode's strain energy that is in the mesh", "mode", no_error="not estimated"
    )
    resonance_speeds: Array = quantity(
        "rad/s",
        "pinion speeds at which the mesh frequency is a natural one",
        "mode",
        shown="rpm",
        error="frequency_error",
    )
    greatest_force: float = quantity("N", "maximum force of a bearing over all speeds", error="error")
    greatest_swing: float = quantity(
        "N", "largest root mean square of a bearing's force about its mean over all speeds", error="error"
    )
    greatest_swing_speed: float = quantity(
        "rad/s", "pinion speed at which that is", shown="rpm", no_error="one of the speeds looked at"
    )
    greatest_axial_motion: float = quantity(
        "m", "largest axial motion of a gear over all speeds, peak to peak", shown="um", error="error"
    )
    greatest_tilt: float = quantity(
        "rad", "largest tilt of a gear about its mean one over all speeds", error="error"
    )
    frequency_error: float = quantity(
        "1", "estimated relative error of natural frequencies, the largest of all", no_error=ITSELF
    )
    error: float
    cost: Cost
    converged: bool = True
    message: str = ""


def bearing_sweep(
    pair: SpatialPair,
    bearings: tuple[tuple[SpatialBearing, ...], tuple[SpatialBearing, ...]],
    speed: Array,
    *,
    harmonics: int = 5,
    mesh_error: float = 0.0,
    transmission_error: Array | None = None,
) -> BearingSweep:
    """Bearing forces, axial motion and tilt at speeds of the pinion.

    The error is that of the largest swing: its change by half as many harmonics, by half as many cells of the lines of
    contact, and by a mesh as much stiffer as its error; each over all speeds.

    Parameters
    ----------
    pair : SpatialPair
        Held by these bearings.
    bearings : (tuple, tuple)
        Of pinion and wheel.
    speed : (n,) array
        Speeds of the pinion [rad/s].
    harmonics : int
        Highest harmonic of the mesh, as of `SpatialPair.bearing_forces`.
    mesh_error : float
        Relative error of the mesh stiffness.
    transmission_error : (positions,) array, optional
        Unloaded, that the loaded contact has not [m].

    Raises
    ------
    InputError
        With every fault of the arguments.
    SolverError
        Where contact would be lost at every speed.

    Examples
    --------
    >>> from flankfilm.coupling import SpatialBearing, bearing_sweep  # doctest: +SKIP
    >>> bearing_sweep(pair, (held, held), np.linspace(50.0, 500.0, 46))  # doctest: +SKIP
    """
    watch, at = Stopwatch(), np.atleast_1d(np.asarray(speed, dtype=np.float64))
    with Faults() as faults:
        for end in (at.min(), at.max()):
            faults.number("speed", float(end), _SPEED)
    varied = _variants(pair, mesh_error)
    swept = [_at_speeds(one, bearings, at, harmonics, transmission_error) for one in (pair, *varied)]
    own, swing = swept[0], swept[0].swing
    if np.isnan(swing).all():
        raise SolverError(
            "the mesh would pull at every speed: contact is lost, which bodies with six freedoms do not know; take the "
            'pair that turns alone (wants = ["sweep"]), more damping or other speeds'
        )
    greatest = float(np.nanmax(swing))
    off = [_largest(np.abs(other.swing - swing)) for other in swept[1:]]
    frequencies = pair.natural_frequencies
    kept = frequencies > ROUNDING * frequencies[-1]
    moved = [np.abs(one.natural_frequencies[kept] / frequencies[kept] - 1.0).max() for one in varied]
    return BearingSweep(
        speed=at,
        bearings=tuple(f"{gear} {i + 1}" for k, gear in enumerate(BOTH) for i in range(len(bearings[k]))),
        bearing_force=own.force,
        bearing_swing=swing,
        axial_force=own.axial,
        axial_motion=own.motion,
        tilt=own.tilt,
        mean_force=own.mean,
        natural_frequencies=frequencies[kept],
        mesh_share=_mesh_share(pair)[kept],
        resonance_speeds=2.0 * np.pi * frequencies[kept] / pair.mesh.pair.pinion.teeth,
        greatest_force=_largest(own.force),
        greatest_swing=greatest,
        greatest_swing_speed=float(at[np.unravel_index(int(np.nanargmax(swing)), swing.shape)[0]]),
        greatest_axial_motion=_largest(own.motion),
        greatest_tilt=_largest(own.tilt),
        frequency_error=float(sum(moved)),
        error=(own.by_harmonics + sum(off)) / greatest if greatest > 0.0 else 0.0,
        cost=Cost(watch.seconds, counts={"speeds": at.size}),
        message=_left_out(at, np.asarray(np.isnan(swing).all(axis=1))),
    )


def _largest(values: Array) -> float:
    """Largest of the values that are known; 0 of none."""
    return float(np.max(values, where=np.isfinite(values), initial=0.0))


@record
class _Swept:
    """Figures of all bearings and gears over the speeds."""

    force: Array
    swing: Array
    axial: Array
    motion: Array
    tilt: Array
    mean: Array
    by_harmonics: float


def _variants(pair: SpatialPair, mesh_error: float) -> tuple[SpatialPair, ...]:
    """The pair with a mesh stiffer by its error, and with half as many cells of its lines of contact."""
    mesh, stiffer = pair.mesh, 1.0 + mesh_error
    varied = [replace(mesh, stiffness=stiffer * mesh.stiffness, turn=mesh.turn / stiffer)]
    if mesh.coarser is not None:
        varied.append(replace(mesh, stiffness=mesh.coarser))
    return tuple(replace(pair, mesh=one) for one in varied)


def _at_speeds(
    pair: SpatialPair,
    bearings: tuple[tuple[SpatialBearing, ...], tuple[SpatialBearing, ...]],
    speed: Array,
    harmonics: int,
    transmission_error: Array | None,
) -> _Swept:
    """Periodic motions at all speeds."""
    count = len(bearings[0]) + len(bearings[1])
    rows, gears, off = np.full((3, len(speed), count), np.nan), np.full((2, len(speed), 2), np.nan), 0.0
    mean = np.full(count, np.nan)
    for i, rate in enumerate(speed.tolist()):
        try:
            moved = pair.bearing_forces(rate, harmonics, transmission_error)
        except SolverError:
            continue
        forces = _over_period(moved, bearings, rate * pair.mesh.pair.pinion.teeth)
        mean = np.linalg.norm(_mean(forces)[0], axis=-1)
        rows[0, i] = np.linalg.norm(forces, axis=-1).max(axis=0)
        rows[1, i] = np.sqrt(np.mean(np.sum((forces - _mean(forces)) ** 2, axis=-1), axis=0))
        rows[2, i] = np.abs(forces[..., 2]).max(axis=0)
        bodies = _waves(moved.motion).reshape(SAMPLES, 2, 6)
        gears[0, i] = np.ptp(bodies[..., 2], axis=0)
        tilts = bodies[..., 3:5] - _mean(bodies[..., 3:5])
        gears[1, i] = np.linalg.norm(tilts, axis=-1).max(axis=0)
        off = max(off, moved.error * float(rows[1, i].max()))
    return _Swept(rows[0], rows[1], rows[2], gears[0], gears[1], mean, off)


def _mean(values: Array) -> Array:
    """Mean over the samples of a period (1, ...)."""
    return np.asarray(values.mean(axis=0, keepdims=True))


def _waves(harmonics: Array) -> Array:
    """Samples of a period (SAMPLES, ...) of harmonics (n + 1, ...)."""
    angle = 2j * np.pi * np.outer(np.arange(SAMPLES) / SAMPLES, np.arange(len(harmonics)))
    return np.asarray(np.real(np.tensordot(np.exp(angle), harmonics, axes=(1, 0))))


def _over_period(
    moved: BearingForces,
    bearings: tuple[tuple[SpatialBearing, ...], tuple[SpatialBearing, ...]],
    omega: float,
) -> Array:
    """Forces on every bearing along the axes (SAMPLES, bearings, 3) [N], at a mesh frequency [rad/s]."""
    rate, forces = 1j * omega * np.arange(len(moved.motion))[:, None], []
    for gear, each in enumerate(bearings):
        motion = moved.motion[:, 6 * gear : 6 * gear + 6]
        forces += [(1.0 + rate * one.damping_time) * one.springs * (motion @ one.moves.T) for one in each]
    return _waves(np.stack(forces, axis=1))


def _mesh_share(pair: SpatialPair) -> Array:
    """Part of the strain energy of every mode that is in the mesh (12,)."""
    from scipy.linalg import eigh

    mesh = pair.mesh.stiffness.mean(axis=0)
    _, modes = eigh(pair.in_contact, pair.mass)
    inside, whole = (np.einsum("im,ij,jm->m", modes, matrix, modes) for matrix in (mesh, pair.in_contact))
    return np.asarray(np.clip(inside / np.maximum(whole, 1e-12 * whole.max()), 0.0, 1.0))


def _left_out(speed: Array, lost: Booleans) -> str:
    """What to say of speeds that are left out."""
    if not lost.any():
        return ""
    rpm = speed[lost] * 30.0 / np.pi
    return (
        f"contact would be lost at {int(lost.sum())} of {speed.size} speeds, from {rpm.min():.0f} to "
        f"{rpm.max():.0f} rpm: these are left out, since bodies with six freedoms are linear about the loaded state"
    )
