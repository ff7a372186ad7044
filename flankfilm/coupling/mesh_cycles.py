"""Mesh cycles of a dry pair by any stiffness model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from base import Faults, Limit, SolverError
from flankfilm.coupling.cycle import MeshCycle
from flankfilm.coupling.loaded_teeth import PLAIN_FLANKS, Flanks, LoadedTeeth
from flankfilm.coupling.resolution import Resolution, resolution_of

if TYPE_CHECKING:
    import fem
    from gears import GearPair


def mesh_cycle(
    pair: GearPair,
    torque: float,
    *,
    tolerance: float = 0.005,
    positions: int | None = None,
    model: str = "fem",
    pairs: str = "coupled",
    compliance: fem.Compliance | None = None,
    flanks: Flanks = PLAIN_FLANKS,
) -> MeshCycle:
    """Mesh stiffness, load share and transmission error of a dry pair over one base pitch, by any model.

    Parameters
    ----------
    pair : gears.GearPair
    torque : float
        Of the pinion [N m].
    tolerance : float
        Relative, of the mean stiffness; it is split between meshes and positions.
    positions : int, optional
        Equal intervals of the base pitch; as few of 120, 360 and 1080 as the tolerance needs unless given.
    model, pairs : str
        As of `LoadedTeeth`.
    compliance : fem.Compliance, optional
        For finite elements; computed unless given.
    flanks : Flanks
        Deviations, edges and friction, for finite elements.

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
    ((120,), 20.2)
    """
    asked = resolution_of(checked(tolerance, torque=torque), model, pairs, "none")
    teeth = loaded_teeth(pair, torque, asked, model, pairs, compliance, flanks)
    return teeth.sampled(asked.sampling, tolerance) if positions is None else teeth.cycle(positions)


def loaded_teeth(
    pair: GearPair,
    torque: float,
    resolution: Resolution,
    model: str = "fem",
    pairs: str = "coupled",
    compliance: fem.Compliance | None = None,
    flanks: Flanks = PLAIN_FLANKS,
) -> LoadedTeeth:
    """Pair under a torque with its model, the compliance computed where it is needed and not given.

    Raises
    ------
    SolverError
        Where the compliance misses its tolerance.
    """
    if model == "fem" and compliance is None:
        import fem

        compliance = fem.compliance(pair, tolerance=resolution.compliance)
        if not compliance.converged:
            raise SolverError(f"tooth compliance: {compliance.message}")
    return LoadedTeeth(pair, torque, model, pairs, compliance, flanks)


def checked(tolerance: float, **positive: float) -> float:
    """Check a tolerance, and numbers that must be more than zero.

    Raises
    ------
    InputError
        With every fault.
    """
    with Faults() as faults:
        faults.number("tolerance", tolerance, Limit.above(0.0, 0.4, remedy="such as 0.005"))
        for name, value in positive.items():
            faults.number(name, value, Limit.above(0.0))
    return tolerance
