r"""The load that travels over the face: places of the mesh force over the mesh cycle, and the moment they make.

A force F whose place is at :math:`z_F(t)` has the moment :math:`F (z_F - z)` about the place z at which a train has it,
that of slopes. It tilts both gears against each other and drives their bearings, even where stiffness and transmission
error stand still. The force of this moment is the mean one: what the place times the swing of the force adds is left
out, and so is that no moment acts while contact is lost.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from base import Array, Faults
from flankfilm.coupling.drive.train import Train
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.vibration.excitation import peak_to_peak
from flankfilm.coupling.vibration.series import least_order, left_out

__all__ = ["LoadTravel", "load_travel"]


@dataclass(frozen=True, eq=False)
class LoadTravel:
    """Place of the mesh force over the mesh cycle, about its mean.

    Parameters
    ----------
    harmonics : array_like of complex, shape (n,)
        Along the face [m]: Re(sum of c_j exp(i j theta)), j = 1, 2, ..., theta the mesh's angle, 0 with a pair at A, as
        of the stiffness' series.
    error : float, optional
        Estimated error of the place, root mean square over the cycle [m]; None where it is unknown.
    mean : float, optional
        Mean place from mid-face [m]; that of the train if left out.

    Raises
    ------
    InputError
        Of harmonics that are no finite numbers in one dimension.

    Examples
    --------
    >>> travel = LoadTravel([1e-3])
    >>> travel.range
    0.002
    """

    harmonics: npt.ArrayLike
    error: float | None = None
    mean: float | None = None

    def __post_init__(self) -> None:
        """Check and convert."""
        values = np.asarray(self.harmonics, dtype=np.complex128)
        with Faults() as faults:
            if values.ndim != 1 or not np.all(np.isfinite(values)):
                allowed = "must be finite numbers in one dimension"
                faults.add("harmonics", f"shape {values.shape}", allowed, "give one for each harmonic")
        object.__setattr__(self, "harmonics", values)

    @property
    def range(self) -> float:
        """Travel along the face, largest less smallest place [m]."""
        values = np.asarray(self.harmonics)
        return peak_to_peak(np.abs(values), np.angle(values)) if values.any() else 0.0

    @property
    def range_error(self) -> float | None:
        """Estimated relative error of this travel, as of a harmonic whose root mean square is that of the error."""
        if self.error is None:
            return None
        return 2.0 * math.sqrt(2.0) * self.error / self.range if self.range else 0.0

    def kept(
        self, face_width: float, share: float, bounds: tuple[float, float], damping_ratio: float
    ) -> LoadTravel:
        """As few harmonics as leave out no more than a share of half the face, as of the stiffness' series.

        Parameters
        ----------
        face_width : float
            [m]
        share : float
            Of the place at rest and in a resonance of the damping ratio.
        bounds : (float, float)
            Range of the mesh frequency over the natural one.
        damping_ratio : float
            Of the mesh.
        """
        values = np.asarray(self.harmonics)
        if not values.any():
            return replace(self, harmonics=values[:0])
        with np.errstate(divide="ignore"):  # without damping
            rest = left_out(2.0 * np.abs(values) / face_width, bounds, damping_ratio)
        order = least_order(rest, share)
        beyond = 0.5 * face_width * float(rest.curve[order])
        error = None if self.error is None else math.hypot(self.error, beyond)
        return replace(self, harmonics=values[:order], error=error)


def driving_moments(train: Train, force: float, travel: LoadTravel, centre: float) -> Array:
    r"""Mean and complex harmonics of the moment on the tilt of a train [N m]; all 0 where nothing tilts.

    The mean :math:`m_0` and what :math:`k_\psi` resists of the train's static tilt are together
    :math:`F (\bar z_F - z)`.

    Parameters
    ----------
    train : Train
    force : float
        Mean one of the mesh [N].
    travel : LoadTravel
    centre : float
        Place z of the mesh force of the train from mid-face [m].
    """
    values = np.asarray(travel.harmonics)
    if not train.tilt.any():
        return np.zeros(1)
    mean = 0.0
    if travel.mean is not None:
        tilted = float(train.tilt @ train.held().solve(train.load))
        mean = travel.mean - centre - train.tilt_stiffness * tilted
    return force * train.tilting_gain * np.append(mean, values)


def load_travel(cycle: MeshCycle) -> LoadTravel | None:
    r"""Place of the mesh force over a cycle with cells over the face or along lines; None of any other.

    It is the centre of the forces F_c of all cells, of :math:`z_c` over the face, and along lines of
    :math:`\zeta_c = z_c + (\rho_{1c} - \rho_{1C}) \tan\beta_b`.
    """
    if cycle.lines is not None:
        lines = cycle.lines
        # forces at tip edges and on relief along the line of action, as large as the torque about the pinion makes them
        force = lines.force * np.nan_to_num(lines.levers[0])
        place = np.nan_to_num(lines.z + (lines.rho[0] - lines.pair.points.C) * lines.slope)
        return _travel(cycle.position, _centre(force, place), lines.centre_error)
    if cycle.face is not None:
        return _travel(cycle.position, _centre(cycle.face.line_load, cycle.face.face_position), None)
    return None


def _travel(position: Array, centre: Array, error: float | None) -> LoadTravel:
    return LoadTravel(_harmonics(position, centre), error, float(centre.mean()))


def _centre(force: Array, place: Array) -> Array:
    """Centre of forces (positions, pairs, cells) at each position."""
    return np.asarray((force * place).sum(axis=(1, 2)) / force.sum(axis=(1, 2)))


def _harmonics(position: Array, values: Array) -> Array:
    """All harmonics that samples at equal distances over one base pitch or several resolve, of the real part."""
    in_one = int(np.sum(position < position[0] + 1.0 - 0.5 * (position[1] - position[0])))
    orders = np.arange(1, (in_one - 1) // 2 + 1)
    return np.asarray(2.0 * np.exp(-2j * np.pi * np.outer(orders, position)) @ values / len(values))
