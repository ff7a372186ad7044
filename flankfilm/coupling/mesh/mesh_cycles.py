"""Mesh cycles of a dry pair by any stiffness model."""

from __future__ import annotations

from typing import Unpack

import gears
from base import Faults, Limit
from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth, TeethOptions
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.mesh.resolution import Resolution, resolution_of


def mesh_cycle(
    pair: gears.GearPair,
    torque: float,
    *,
    tolerance: float = 0.005,
    positions: int | None = None,
    **teeth: Unpack[TeethOptions],
) -> MeshCycle:
    """Mesh stiffness, load share and transmission error of a dry pair over one base pitch, by any model.

    Parameters
    ----------
    pair : gears.GearPair
    torque : float
        Of the pinion [N m].
    tolerance : float
        Relative, of the mean stiffness; it is split between meshes and arcs.
    positions : int, optional
        Equal intervals of the base pitch for the curves; 120 unless given.
    **teeth
        ``model``, ``pairs``, ``compliance``, ``flanks``, ``reference`` and ``bore_inertia``, as of `LoadedTeeth`; the
        compliance is computed where it is needed and not given.

    Raises
    ------
    InputError
        With every fault of the arguments.
    SolverError
        Where no result within the tolerance was found.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> cycle = mesh_cycle(pair, torque=600.0, model="potential-energy", pairs="independent")
    >>> cycle.secant_stiffness.shape, round(cycle.mean_secant_stiffness / 40e6, 1)  # N/(mm um)
    ((120,), 20.3)
    """
    with Faults() as faults:
        if positions is not None:
            faults.whole("positions", positions, 1, 10**6, "120 is usual")
    loaded, asked = resolved(LoadedTeeth(pair, torque, **teeth), tolerance)
    return (
        loaded.sampled(asked.sampling, tolerance)
        if positions is None
        else loaded.cycle(positions, None, tolerance)
    )


def resolved(
    teeth: LoadedTeeth, tolerance: float, film: str = "none", **positive: float
) -> tuple[LoadedTeeth, Resolution]:
    """Split a tolerance for a pair and the model of its film; give the pair with its compliance, and the split.

    Raises
    ------
    InputError
        With every fault of the tolerance, the torque and further numbers that must be more than zero.
    SolverError
        Where no resolution meets the tolerance, or the compliance misses its share.
    """
    with Faults() as faults:
        faults.number("tolerance", tolerance, Limit.above(0.0, 0.4, remedy="such as 0.005"))
        for name, value in {"torque": abs(teeth.torque), **positive}.items():
            faults.number(name, value, Limit.above(0.0))
    asked = resolution_of(tolerance, teeth.model, teeth.pairs, film)
    return teeth.meshed(asked.compliance), asked
