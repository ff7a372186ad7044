"""Root stress of both gears along the mesh cycle.

Forces of a loaded mesh cycle times the influence functions of the fillets (``fem.fillet_influence``), all
loaded teeth together: a tooth's root also feels the loads of its neighbours. The fillet is a free edge, so the
stress there is uniaxial along it: sigma_t is a principal stress, the one across is zero, and in plane strain
the third is nu sigma_t.
"""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fem.contact import MeshCycle
from fem.cost import Cost
from fem.elasticity import PlaneElasticity
from fem.errors import Fault, FemError
from fem.fillet import MIRROR, FilletLine
from fem.fillet_influence import FilletInfluence, Fillets
from fem.fillet_influence import fillets as _fillets

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["GearRootStress", "RootPeak", "RootStress", "root_stress"]

Array = NDArray[np.float64]

LOADED, OTHER = 0, 1
"""Fillet under the loaded flank, in tension when its tooth bears, and the one on the other side."""


@dataclass(frozen=True, eq=False)
class RootPeak:
    """The greatest stress of a cycle and where it acts.

    Attributes
    ----------
    stress_Pa : float
        Principal stress along the fillet, negative in compression.
    von_mises_Pa : float
    row : int
        Position of the cycle.
    tooth : int
        Base pitches that the tooth is ahead of the pair that entered last.
    way : float
        Base pitches since the tooth's pair passed A.
    arc : float
        Arc length from the middle of the gap [m].
    tangent_angle : float
        Between the fillet's tangent and the tooth's centre line [rad].
    point : (2,) array
        In the tooth's frame, centre line along +y, the loaded flank on the left [m].
    """

    stress_Pa: float
    von_mises_Pa: float
    row: int
    tooth: int
    way: float
    arc: float
    tangent_angle: float
    point: Array


@dataclass(frozen=True, eq=False)
class GearRootStress:
    """Stress along the fillets of one gear's teeth.

    Attributes
    ----------
    line : FilletLine
        Sample points.
    law : PlaneElasticity
    position : (n,) array
        As of the mesh cycle: way from A over the base pitch of the pair that entered last.
    tooth : (teeth,) array of int
        Base pitches that each tooth is ahead of that pair; beside the loaded ones one more at either end.
    tangential_Pa : (n, teeth, 2, samples) array
        Principal stress along the fillet under the loaded flank (0) and along the other one (1).
    """

    line: FilletLine
    law: PlaneElasticity
    position: Array
    tooth: NDArray[np.int64]
    tangential_Pa: Array

    @property
    def way(self) -> Array:
        """Base pitches since each tooth's pair passed A, (n, teeth)."""
        return np.asarray(self.position[:, None] + self.tooth)

    @property
    def tension_Pa(self) -> Array:
        """Greatest principal stress along the fillet under the loaded flank, (n, teeth)."""
        return _extreme(self.line.arc, self.tangential_Pa[:, :, LOADED])[0]

    @property
    def tension_arc(self) -> Array:
        """Where that acts: arc length from the middle of the gap, (n, teeth) [m]."""
        return _extreme(self.line.arc, self.tangential_Pa[:, :, LOADED])[1]

    @property
    def compression_Pa(self) -> Array:
        """Least principal stress along the other fillet, negative in compression, (n, teeth)."""
        return -_extreme(self.line.arc, -self.tangential_Pa[:, :, OTHER])[0]

    @property
    def compression_arc(self) -> Array:
        """Where that acts: arc length from the middle of the gap, (n, teeth) [m]."""
        return _extreme(self.line.arc, -self.tangential_Pa[:, :, OTHER])[1]

    def von_mises(self, principal: Array | float) -> Array:
        """Von Mises stress [Pa] of an edge under one principal stress: sqrt(1 - nu + nu^2) in plane strain."""
        nu = self.law.nu if self.law.plane == "strain" else 0.0
        return np.asarray(np.sqrt(1 - nu + nu**2) * np.abs(principal))

    @property
    def greatest_tension(self) -> RootPeak:
        """Of all teeth and positions."""
        return self._peak(self.tension_Pa, self.tension_arc, LOADED)

    @property
    def greatest_compression(self) -> RootPeak:
        """Of all teeth and positions."""
        return self._peak(self.compression_Pa, self.compression_arc, OTHER)

    def _peak(self, stress: Array, arc: Array, side: int) -> RootPeak:
        row, column = np.unravel_index(np.argmax(np.abs(stress)), stress.shape)
        value, place = float(stress[row, column]), float(arc[row, column])
        line = self.line
        point = np.array([np.interp(place, line.arc, line.points[:, axis]) for axis in (0, 1)])
        return RootPeak(
            value,
            float(self.von_mises(value)),
            int(row),
            int(self.tooth[column]),
            float(self.position[row] + self.tooth[column]),
            place,
            float(np.interp(place, line.arc, line.tangent_angle)),
            point * MIRROR if side == LOADED else point,
        )

    def passage(self) -> tuple[Array, Array]:
        """Follow one tooth through its mesh: every position and tooth is one instant of it.

        Returns
        -------
        way : (n teeth,) array
            Base pitches since its pair passed A, growing.
        tangential_Pa : (n teeth, 2, samples) array
        """
        order = np.argsort(self.way, axis=None, kind="stable")
        flat = self.tangential_Pa.reshape(-1, *self.tangential_Pa.shape[2:])
        return self.way.ravel()[order], flat[order]

    def fatigue(self) -> tuple[Array, Array]:
        """Amplitude and mean over one tooth's passage at every sample, each (2, samples) [Pa].

        A tooth's root is drawn when it bears and pressed when the tooth before it bears.
        """
        _, stress = self.passage()
        high, low = np.max(stress, axis=0), np.min(stress, axis=0)
        # far from its mesh the tooth is unloaded
        high, low = np.maximum(high, 0.0), np.minimum(low, 0.0)
        return 0.5 * (high - low), 0.5 * (high + low)


@dataclass(frozen=True, eq=False)
class RootStress:
    """Root stress of both gears along a mesh cycle.

    Attributes
    ----------
    pinion, wheel : GearRootStress
    error : float
        Estimated relative numerical error of the greatest stresses: of the fillets' mesh and of the forces.
    cost : Cost
    converged : bool
    message : str
    """

    pinion: GearRootStress
    wheel: GearRootStress
    error: float
    cost: Cost
    converged: bool
    message: str


def root_stress(
    pair: GearPair, cycle: MeshCycle, fillets: Fillets | None = None, tolerance: float = 0.005
) -> RootStress:
    """Stress along the fillets of every loaded tooth and its neighbours.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
        Of this pair; its normal forces are used, friction is left out. A tip edge is taken to press along the
        normal of its own flank at the end of the involute.
    fillets : Fillets, optional
        Of this pair in the cycle's plane, to be used again for other torques or positions; computed to
        ``tolerance`` unless given.
    tolerance : float
        Relative, on the greatest stress.

    Returns
    -------
    RootStress

    Raises
    ------
    FemError
        Fillets of another pair or plane, or a cycle without forces.
    """
    faults = []
    if fillets is not None and fillets.pair != pair:
        faults.append(Fault("fillets", "of another pair", "of this pair", "compute them anew"))
    if fillets is not None and fillets.plane != cycle.plane:
        faults.append(Fault("fillets", f"plane {fillets.plane}", f"plane {cycle.plane}", "use one plane"))
    if not np.all(np.isfinite(cycle.forces)):
        faults.append(Fault("cycle", "not converged", "with finite forces", cycle.message))
    if faults:
        raise FemError(*faults)
    began = perf_counter()
    roots = fillets if fillets is not None else _fillets(pair, tolerance, cycle.plane)
    ready = perf_counter()
    both = [
        _gear_stress(pair, cycle, influence, gear)
        for gear, influence in enumerate((roots.pinion, roots.wheel))
    ]
    parts = {**({} if fillets is not None else roots.cost.parts), "superpose": perf_counter() - ready}
    cost = Cost(perf_counter() - began, roots.cost.unknowns, 0, roots.cost.annulus_unknowns, parts)
    return RootStress(
        both[0],
        both[1],
        roots.error + cycle.error,
        cost,
        roots.converged and cycle.converged,
        roots.message,
    )


def _gear_stress(pair: GearPair, cycle: MeshCycle, influence: FilletInfluence, gear: int) -> GearRootStress:
    offsets = cycle.pair_offset
    teeth = np.arange(offsets.min() - 1, offsets.max() + 2)
    # the pair ahead is the next tooth anticlockwise on the pinion, clockwise on the wheel
    turn = 1 if gear == 0 else -1
    line = influence.line
    total = np.zeros((len(cycle.position), len(teeth), 2, len(line.arc)))
    for column, offset in enumerate(offsets):
        rows = np.flatnonzero(cycle.forces[:, column] > 0)
        line_load = cycle.forces[rows, column, None, None] / pair.face_width
        rho = cycle.flank_rho[gear][rows, column]
        for i, tooth in enumerate(teeth):
            total[rows, i] += line_load * influence.stress(turn * int(tooth - offset), rho)
    return GearRootStress(line, influence.law, cycle.position, teeth, total)


def _extreme(arc: Array, values: Array) -> tuple[Array, Array]:
    """Maximum over the last axis and its place, by the parabola through the three highest samples."""
    step = arc[1] - arc[0]
    top = np.clip(np.argmax(values, axis=-1), 1, len(arc) - 2)[..., None]
    before, here, after = (np.take_along_axis(values, top + k, axis=-1)[..., 0] for k in (-1, 0, 1))
    bend = before - 2 * here + after
    shift = np.where(bend < 0, 0.5 * (before - after) / np.where(bend < 0, bend, -1.0), 0.0)
    shift = np.clip(shift, -1.0, 1.0)
    highest = here + 0.5 * shift * (after - before) + 0.5 * bend * shift**2
    return np.asarray(highest), np.asarray(arc[top[..., 0]] + shift * step)
