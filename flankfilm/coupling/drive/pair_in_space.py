r"""Bearing forces of a pair whose gears have six freedoms each: linear about the loaded state, periodic in the mesh.

With cells' forces :math:`F_c(t)` and the turn :math:`q_s(t)` under the static load, and slopes :math:`k_c(t)`,

.. math:: M\ddot q + C\dot q + K_b q + \sum_c g_c [F_c(t) + k_c(t)\, g_c^T (q - q_s(t))] = Q .

The torques Q balance the forces in the turn. What remains drives even a mesh of constant turn: the centre of the load
travels over the face, and with it the moment that tilts both gears. The periodic motion is found by harmonic balance
(Hill), in which :math:`k_c(t)` couples the harmonics; nothing is neglected but harmonics above the highest.

Bodies are rigid, gyroscopic moments are left out, and all cells that bear keep bearing: contact that is lost as a whole
is refused.
"""

from __future__ import annotations

import math

import numpy as np

from base import Array, Cost, Faults, Limit, SolverError, Stopwatch, record
from flankfilm.coupling.drive.drive_reduced import gear_masses
from flankfilm.coupling.drive.mesh_in_space import SpatialMesh

__all__ = ["BearingForces", "SpatialPair", "spatial_pair"]

RATIO = Limit(0.0, 1.0, "", "0.05 for a mesh")
SPEED = Limit.above(0.0, 1e6, "rad/s", "give the pinion's speed")


@record
class BearingForces:
    """What the bearings of both gears carry in a periodic motion, by harmonics of the mesh.

    Attributes
    ----------
    speed : float
        Of the pinion [rad/s].
    harmonics : (n + 1, 2, 6) complex array
        Forces along x, y, z [N] and moments about them at mid-face [N m] on the bearings of pinion and wheel:
        Re(sum of c_j exp(i j theta)), theta the mesh's angle, 0 with a pair at A at mid-face; j = 0 is the mean.
    motion : (n + 1, 12) complex array
        Displacements [m] and turns [rad] likewise, from the unloaded state.
    mesh_force : (positions,) array
        Force along the transverse line of action [N].
    error : float
        Change of the largest harmonic, mean left out, by half as many harmonics; over it.
    cost : Cost
    """

    speed: float
    harmonics: Array
    motion: Array
    mesh_force: Array
    error: float
    cost: Cost

    @property
    def amplitude(self) -> Array:
        """Amplitudes of the harmonics from the first on (n, 2, 6)."""
        return np.abs(self.harmonics[1:])


@record
class SpatialPair:
    """Two gears in space, joined by their mesh and held by bearings.

    Attributes
    ----------
    mesh : SpatialMesh
    mass, bearings, damping : (12, 12) arrays
        Damping is that of bearings and mesh.
    bearing_damping : (12, 12) array
        Of that what bearings have.
    """

    mesh: SpatialMesh
    mass: Array
    bearings: Array
    damping: Array
    bearing_damping: Array

    @property
    def in_contact(self) -> Array:
        """Stiffness with the mean of the mesh (12, 12)."""
        return np.asarray(self.bearings + self.mesh.stiffness.mean(axis=0))

    @property
    def natural_frequencies(self) -> Array:
        """Natural frequencies in contact with the mean mesh (12,) [Hz], rising; 0 of what nothing holds."""
        from scipy.linalg import eigh  # loads half of scipy

        squares = eigh(self.in_contact, self.mass, eigvals_only=True)
        return np.asarray(np.sqrt(np.maximum(squares, 0.0)) / (2.0 * math.pi))

    def bearing_forces(self, speed: float, harmonics: int = 5, error: Array | None = None) -> BearingForces:
        """Periodic motion at a speed of the pinion [rad/s], and what it brings to the bearings.

        Parameters
        ----------
        speed : float
        harmonics : int
            Highest harmonic of the mesh; below a quarter of the positions.
        error : (positions,) array, optional
            Unloaded transmission error that the loaded contact has not, alike over the face [m].

        Raises
        ------
        InputError
            With every fault of the arguments.
        SolverError
            Where the mesh would pull: contact is lost, for which there is one coordinate, in the pair that turns alone.
        """
        watch = Stopwatch()
        positions = len(self.mesh.turn)
        with Faults() as faults:
            faults.number("speed", speed, SPEED)
            order = faults.whole("harmonics", harmonics, 2, (positions - 1) // 4, "give more positions")
        turn = self.mesh.turn if error is None else self.mesh.turn + error
        motion = self._motion(speed, order, turn)
        fewer = self._motion(speed, order // 2, turn)
        wrench, before = (self._carried(speed, each) for each in (motion, fewer))
        force = self._mesh_force(motion, turn)
        if force.min() < 0.0:
            raise SolverError(
                f"the mesh would pull with up to {-force.min():.4g} N at {speed:g} rad/s: contact is lost, "
                "which bodies with six freedoms do not know; take `pair_oscillator`, more damping or another speed"
            )
        kept = slice(1, len(fewer))
        most = float(np.max(np.abs(wrench[1:, :, :3]), initial=0.0))
        off = float(np.max(np.abs(wrench[kept, :, :3] - before[kept, :, :3]), initial=0.0))
        return BearingForces(
            speed, wrench, motion, force, off / most if most > 0.0 else 0.0, Cost(watch.seconds)
        )

    def _motion(self, speed: float, order: int, turn: Array) -> Array:
        """Harmonics 0 to n of the displacements (n + 1, 12), of the real part."""
        mesh, numbers = self.mesh, np.arange(-order, order + 1)
        stiff = _harmonics(mesh.stiffness, 2 * order)
        driven = mesh.torsion * turn[:, None]
        driving = np.einsum("pij,pj->pi", mesh.stiffness, driven) - mesh.load
        driving[:, 5] += mesh.torque
        driving[:, 11] += mesh.torque * mesh.pair.base_radii[1] / mesh.pair.base_radii[0]
        sides = _harmonics(driving, order)
        size, omega = 12 * len(numbers), speed * mesh.pair.pinion.teeth
        whole = np.zeros((len(numbers), 12, len(numbers), 12), dtype=np.complex128)
        for i, n in enumerate(numbers):
            for j, m in enumerate(numbers):
                whole[i, :, j] = stiff[n - m + 2 * order]
            whole[i, :, i] += self.bearings + 1j * n * omega * self.damping - (n * omega) ** 2 * self.mass
        rolls = self.mass @ mesh.free_turn
        scale = np.trace(self.in_contact) / np.trace(self.mass) / (rolls @ mesh.free_turn)
        whole[order, :, order] += scale * np.outer(rolls, rolls)  # holds the rotation that nothing else does
        moved = np.linalg.solve(whole.reshape(size, size), sides.reshape(size)).reshape(-1, 12)[order:]
        moved[1:] *= 2.0  # of the real part
        return np.asarray(moved)

    def _carried(self, speed: float, motion: Array) -> Array:
        """Wrenches on the bearings by harmonic (n + 1, 2, 6)."""
        rate = 1j * speed * self.mesh.pair.pinion.teeth * np.arange(len(motion))
        carried = motion @ self.bearings.T + (rate[:, None] * motion) @ self.bearing_damping.T
        return np.asarray(carried.reshape(-1, 2, 6))

    def _mesh_force(self, motion: Array, turn: Array) -> Array:
        """Elastic force along the transverse line of action over the cycle (positions,) [N]."""
        mesh, positions = self.mesh, len(self.mesh.turn)
        angle = 2j * math.pi * (np.arange(positions) + 0.5) / positions
        waves = np.exp(np.outer(angle, np.arange(len(motion))))
        moved = np.real(waves @ motion) - mesh.torsion * turn[:, None]
        return np.asarray(
            mesh.load @ mesh.torsion + np.einsum("i,pij,pj->p", mesh.torsion, mesh.stiffness, moved)
        )


def spatial_pair(
    mesh: SpatialMesh,
    bearings: tuple[Array, Array],
    *,
    damping_ratio: float = 0.05,
    bearing_damping: tuple[Array, Array] | None = None,
    extra_mass: tuple[float, float] = (0.0, 0.0),
    extra_inertia: tuple[float, float] = (0.0, 0.0),
) -> SpatialPair:
    """Pair in space, of rigid gears as discs from the bore to the reference circle.

    Parameters
    ----------
    mesh : SpatialMesh
    bearings : (array, array)
        Stiffness under pinion and wheel (6, 6) each, as of `bearing_stiffness`, or that of a shaft.
    damping_ratio : float
        Of the mesh, as of `pair_oscillator`: of the pair that turns alone, spread as the mean stiffness is.
    bearing_damping : (array, array), optional
        Damping under both (6, 6) [N s/m, N s, N m s]; none if left out.
    extra_mass, extra_inertia : (float, float)
        What moves with the gears [kg], and turns about their axes [kg m2].

    Raises
    ------
    InputError
        With every fault of the arguments.

    Examples
    --------
    >>> from flankfilm.coupling import bearing_stiffness, spatial_mesh, spatial_pair
    >>> held = bearing_stiffness([(-0.05, 2e8, 1e8), (0.05, 2e8, 0.0)])
    >>> pair = spatial_pair(spatial_mesh(cycle), (held, held))  # doctest: +SKIP
    >>> pair.natural_frequencies  # doctest: +SKIP
    """
    pair = mesh.pair
    with Faults() as faults:
        faults.number("damping_ratio", damping_ratio, RATIO)
        for name, each in (("bearings", bearings), ("bearing_damping", bearing_damping or ())):
            for i, matrix in enumerate(each):
                _check(faults, f"{name}[{i}]", np.asarray(matrix, dtype=np.float64))
    mass, polar = np.zeros((12, 12)), np.array(pair.moments_of_inertia) + extra_inertia
    for i, (own, width) in enumerate(zip(gear_masses(pair), pair.face_widths, strict=True)):
        heavy = own + extra_mass[i]
        tilting = 0.5 * polar[i] + own * width**2 / 12.0
        at = np.arange(6 * i, 6 * i + 6)
        mass[at, at] = [heavy, heavy, heavy, tilting, tilting, polar[i]]
    first, second = pair.base_radii
    equivalent = 1.0 / (first**2 / polar[0] + second**2 / polar[1])
    mean, stiffness = float(mesh.torsional_stiffness.mean()), mesh.stiffness.mean(axis=0)
    of_bearings = _of_both(bearing_damping or (np.zeros((6, 6)),) * 2)
    rate = 2.0 * damping_ratio * math.sqrt(equivalent / mean)
    return SpatialPair(mesh, mass, _of_both(bearings), of_bearings + rate * stiffness, of_bearings)


def _check(faults: Faults, name: str, matrix: Array) -> None:
    """Note what is no stiffness or damping of a body."""
    if matrix.shape != (6, 6) or not np.all(np.isfinite(matrix)):
        faults.add(name, f"shape {matrix.shape}", "must be (6, 6) finite numbers", "take `bearing_stiffness`")
        return
    size = np.abs(matrix).max(initial=0.0)
    if not np.allclose(matrix, matrix.T, rtol=0.0, atol=1e-9 * size):
        faults.add(name, "", "must be symmetric", "take the mean of it and its transpose")
    elif np.linalg.eigvalsh(matrix)[0] < -1e-9 * size:
        faults.add(name, "", "must not be negative in any direction", "give what holds the body")


def _of_both(each: tuple[Array, Array]) -> Array:
    """(12, 12) of two (6, 6)."""
    whole = np.zeros((12, 12))
    whole[:6, :6], whole[6:, 6:] = each
    return whole


def _harmonics(values: Array, order: int) -> Array:
    """Complex harmonics -order .. order of values at midpoints of equal intervals (positions, ...)."""
    count = len(values)
    angle = 2.0 * math.pi * (np.arange(count) + 0.5) / count
    waves = np.exp(-1j * np.outer(np.arange(-order, order + 1), angle)) / count
    return np.tensordot(waves, values, axes=(1, 0))
