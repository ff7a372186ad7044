"""Mesh cycles beyond the scene's own: over torques, and tooth by tooth over a revolution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from base import SolverError
from flankfilm.build import pinion_torque
from flankfilm.stages.teeth import flanks

if TYPE_CHECKING:
    from fem import MeshCycle
    from flankfilm.stages.engine import Engine

Array = NDArray[np.float64]

REVOLUTION_POSITIONS = 40


@dataclass(frozen=True)
class TorqueStage:
    """Mesh stiffness and transmission error over torque, dry.

    Attributes
    ----------
    torque : ndarray, shape (k,)
        Of the pinion [N m].
    secant, tangent : ndarray, shape (k,)
        Means over the mesh cycle [N/m].
    transmission_error : ndarray, shape (k,)
        Peak to peak [m].
    harmonic : ndarray, shape (k,)
        First harmonic of the secant stiffness over its mean [-].
    message : str
        Why torques are missing; empty where none is.
    """

    torque: Array
    secant: Array
    tangent: Array
    transmission_error: Array
    harmonic: Array
    message: str


def torques(engine: Engine) -> TorqueStage:
    """Mesh cycles at the scene's torques from one compliance."""
    import fem

    scene = engine.scene
    assert scene.operating is not None
    wanted = sorted({*scene.operating.torques_Nm, pinion_torque(scene)})
    cycles = fem.mesh_cycle(
        engine["pair"],
        wanted,
        positions=engine["dry cycle"].phase.size,
        compliance=engine["compliance"],
        beyond_path=scene.stiffness.contact_beyond_path,
        **flanks(engine),
    )
    good = [cycle for cycle in cycles if cycle.converged]
    if not good:
        raise SolverError(f"mesh cycles over torque: {cycles[0].message}")
    refused = [cycle for cycle in cycles if not cycle.converged]
    spectra = [np.abs(np.fft.rfft(cycle.secant_stiffness)) for cycle in good]
    return TorqueStage(
        torque=np.array([cycle.torque for cycle in good]),
        secant=np.array([cycle.secant_stiffness.mean() for cycle in good]),
        tangent=np.array([cycle.stiffness.mean() for cycle in good]),
        transmission_error=np.array([np.ptp(cycle.transmission_error) for cycle in good]),
        harmonic=np.array([2 * s[1] / s[0] for s in spectra]),
        message="; ".join(f"{cycle.torque:g} N m: {cycle.message}" for cycle in refused),
    )


def revolution(engine: Engine) -> MeshCycle:
    """Mesh cycle tooth by tooth, with pitch deviations, over a revolution of the pinion unless told otherwise."""
    import fem

    scene, pair = engine.scene, engine["pair"]
    assert scene.operating is not None
    cycle = fem.mesh_cycle(
        pair,
        pinion_torque(scene),
        positions=REVOLUTION_POSITIONS,
        compliance=engine["compliance"],
        beyond_path=scene.stiffness.contact_beyond_path,
        pitches=scene.operating.pitches or pair.pinion.teeth,
        first_teeth=scene.operating.first_teeth,
        **flanks(engine, pitch=True),
    )
    if not cycle.converged:
        raise SolverError(f"revolution: {cycle.message}")
    return cycle
