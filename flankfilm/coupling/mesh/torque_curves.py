"""Mesh cycles beyond one torque and one base pitch: over torques, and tooth by tooth over a revolution."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

import fem
from base import Array, Cost, SolverError, quantity, record
from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth
from flankfilm.coupling.mesh.require_converged import believed

REVOLUTION_POSITIONS = 40

HARMONICS = range(1, 6)
"""Harmonics of the transmission error that are given over torque."""


OVER_TORQUE = "not estimated over torque; the dry cycle's is that of the scene's own torque"


@record
class TorqueCurves:
    """Mesh stiffness and transmission error over torque, dry; ``message`` says why torques are missing."""

    torque: Array = quantity("N m", "torque of the pinion", "torque")
    secant_stiffness: Array = quantity("N/m", "mean mesh stiffness (secant)", "torque", error="error")
    stiffness: Array = quantity(
        "N/m", "mean mesh stiffness (tangent)", "torque", error="error", called="tangent_stiffness"
    )
    transmission_error: Array = quantity(
        "m", "transmission error, peak to peak", "torque", shown="um", error="range_error"
    )
    harmonic_1: Array = quantity(
        "1", "first harmonic of the secant stiffness over its mean", "torque", no_error=OVER_TORQUE
    )
    transmission_error_harmonic: Mapping[str, Array] = quantity(
        "m",
        "amplitude of a harmonic of the transmission error",
        "torque",
        shown="um",
        error="harmonics_error",
    )
    harmonics_error: Array = quantity("m", "largest error of those harmonics", "torque", shown="um")
    range_error: float = quantity("1", "largest relative error of the peak-to-peak transmission errors")
    error: float
    cost: Cost
    converged: bool
    message: str
    reference: str = quantity("", "what the deflection is measured against", default="body")


def torque_curves(teeth: LoadedTeeth, torques: Iterable[float], positions: int) -> TorqueCurves:
    """Mesh cycles by finite elements at several torques from one compliance.

    Parameters
    ----------
    teeth : LoadedTeeth
        Its own torque is one of them.
    torques : iterable of float
        Of the pinion [N m].
    positions : int
        Of a base pitch.

    Raises
    ------
    SolverError
        Where none of them converged.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> import fem
    >>> bodies = fem.compliance(pair)
    >>> found = torque_curves(LoadedTeeth(pair, 600.0, compliance=bodies), [300.0], positions=40)
    >>> found.torque.tolist(), bool(found.secant_stiffness[0] < found.secant_stiffness[1])
    ([300.0, 600.0], True)
    """
    over_torque = fem.mesh_cycle(
        teeth.pair,
        sorted({*torques, teeth.torque}),
        positions=positions,
        **teeth.setting,
    )
    cycles = [teeth.measured(cycle) for cycle in over_torque]
    refused = {cycle.torque: why for cycle in cycles if (why := _refusal(cycle))}
    good = [cycle for cycle in cycles if cycle.torque not in refused]
    if not good:
        raise SolverError(f"mesh cycles over torque: {refused[cycles[0].torque]}")
    return TorqueCurves(
        torque=np.array([cycle.torque for cycle in good]),
        secant_stiffness=np.array([cycle.mean_secant_stiffness for cycle in good]),
        stiffness=np.array([cycle.mean_stiffness for cycle in good]),
        transmission_error=np.array([cycle.transmission_error_range for cycle in good]),
        harmonic_1=np.array([cycle.secant_stiffness_harmonics[0] for cycle in good]),
        transmission_error_harmonic={
            str(order): np.array([cycle.transmission_error_harmonics[order - 1] for cycle in good])
            for order in HARMONICS
        },
        harmonics_error=np.array([_harmonics_error(cycle) for cycle in good]),
        error=max(_error(cycle, "mean_secant_stiffness", "mean_stiffness") for cycle in good),
        range_error=max(_error(cycle, "transmission_error_range") for cycle in good),
        cost=cycles[0].cost,
        converged=not refused,
        message="; ".join(f"{torque:g} N m: {why}" for torque, why in refused.items()),
        reference=good[0].reference,
    )


def _refusal(cycle: fem.MeshCycle) -> str:
    """Why a cycle has no figures; empty where it has them."""
    if not cycle.converged:
        return cycle.message
    try:
        return "" if cycle.arcs is not None else cycle.message
    except SolverError as error:
        return str(error)


def _harmonics_error(cycle: fem.MeshCycle) -> float:
    """Largest error of the harmonics of the transmission error [m]; nan where it is not known."""
    errors = cycle.transmission_error_harmonics_error
    return float("nan") if errors is None else float(np.max(errors[: max(HARMONICS)]))


def _error(cycle: fem.MeshCycle, *names: str) -> float:
    """Largest relative error of some figures; nan where they have none."""
    errors = [cycle.errors[name] for name in names]
    return max((error for error in errors if error is not None), default=float("nan"))


def revolution(
    teeth: LoadedTeeth, pitches: int | None = None, first_teeth: tuple[int, int] = (0, 0)
) -> fem.MeshCycle:
    """Mesh cycle tooth by tooth, with deviations of each, by finite elements: curves alone, without events and arcs.

    Parameters
    ----------
    teeth : LoadedTeeth
        With the deviations of single teeth in its flanks.
    pitches : int, optional
        Base pitches; a revolution of the pinion unless given.
    first_teeth : (int, int)
        Teeth of pinion and wheel in the first pair.

    Raises
    ------
    SolverError
        Where the loaded contact did not converge.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> import fem
    >>> bodies = fem.compliance(pair)
    >>> found = revolution(LoadedTeeth(pair, 600.0, compliance=bodies), pitches=2)
    >>> found.transmission_error.shape
    (80,)
    """
    cycle = fem.mesh_cycle(
        teeth.pair,
        teeth.torque,
        positions=REVOLUTION_POSITIONS,
        pitches=pitches or teeth.pair.pinion.teeth,
        first_teeth=first_teeth,
        **teeth.setting,
    )
    # as many events as a revolution has would cost a hundred times its curves, which are what it is looked at for
    return replace(teeth.measured(believed(cycle, "revolution")), problem=None)
