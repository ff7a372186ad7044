"""Root stress of both gears along the mesh cycle.

Forces of a loaded mesh cycle times the influence functions of the fillets (``fem.influence.fillet_influence``), all
loaded teeth together: a tooth's root also feels the loads of its neighbours. Maximum stresses are those on the cycle's
arcs between events, where forces have corners and steps, whatever the cycle's positions. The fillet is a free edge, so
the stress there is uniaxial along it: sigma_t is a principal stress, the one across is zero, and in plane strain the
third is nu sigma_t.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Cost, Faults, InputError, Integers, Stopwatch, described, part, quantity, record
from fem.cycle.mesh_cycle import MeshCycle
from fem.influence.fillet_influence import FilletInfluence
from fem.laws.mesh_setup import MeshSetup
from fem.pair.pair_fillets import Fillets
from fem.pair.pair_fillets import fillets as _fillets
from fem.stress.face_fillets import face_fillets, over_face
from fem.stress.face_root import RootOnArcs, root_over_face
from fem.stress.gear_root import GearRootStress
from fem.stress.root_peaks import LOADED, OTHER, RootNodes, peak_of
from fem.stress.stress_over_face import StressOverFace
from gears.sharing.arcs import FORCE, Arcs
from gears.sharing.mesh_figures import MeshArcs

if TYPE_CHECKING:
    from fem.cycle.face_loads import FaceLoads
    from fem.influence.fillet_face import FilletFace
    from gears import GearPair

__all__ = ["RootStress", "root_stress"]


@record
class RootStress:
    """Root stress of both gears along a mesh cycle."""

    headline = ("pinion_tension_Pa", "wheel_tension_Pa")

    pinion: GearRootStress = part("of the pinion")
    wheel: GearRootStress = part("of the wheel")
    error: float = quantity(
        "1",
        "largest estimated relative numerical error of the maximum stresses: of the fillets' mesh, of the forces, and "
        "of what lies between the instants",
    )
    cost: Cost
    converged: bool
    message: str

    @property
    def errors(self) -> Mapping[str, float]:
        """Estimated relative errors of the maximum tensions by their names."""
        gears = {"pinion_tension_Pa": self.pinion, "wheel_tension_Pa": self.wheel}
        return {name: gear.errors["greatest_tension_Pa"] for name, gear in gears.items()}

    @described("Pa", shown="MPa", error="errors")
    def pinion_tension_Pa(self) -> float:
        """Maximum tension on the pinion's fillets."""
        return self.pinion.greatest_tension_Pa

    @described("Pa", shown="MPa", error="errors")
    def wheel_tension_Pa(self) -> float:
        """Maximum tension on the wheel's fillets."""
        return self.wheel.greatest_tension_Pa


def root_stress(
    pair: GearPair, cycle: MeshCycle, fillets: Fillets | None = None, tolerance: float = 0.005
) -> RootStress:
    """Stress along the fillets of every loaded tooth and its neighbours.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
        Of this pair; its normal forces are used, friction is left out. A tip edge is taken to press along the
        normal of the edge's flank at the end of the involute.
    fillets : Fillets, optional
        Of this pair in the cycle's plane, to be used again for other torques or positions; computed to
        ``tolerance`` unless given.
    tolerance : float
        Relative, on the maximum stress.

    Returns
    -------
    RootStress
        With cells of the face also over the face; what else is given for all teeth and samples is then at the place of
        the maximum tension along the face.

    Raises
    ------
    base.InputError
        Fillets of another pair or plane, or a cycle without forces or without arcs.
    base.SolverError
        The contact has no solution between the cycle's positions.

    Examples
    --------
    >>> from fem import compliance, mesh_cycle, root_stress
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> cycle = mesh_cycle(pair, 600.0, positions=8, compliance=compliance(pair, tolerance=0.05))
    >>> found = root_stress(pair, cycle, tolerance=0.1)
    >>> round(found.pinion_tension_Pa / 1e6, -1)
    470.0
    """
    faults = Faults()
    if fillets is not None and fillets.pair != pair:
        faults.add("fillets", "of another pair", "must be of this pair", "compute them anew")
    if fillets is not None and fillets.plane != cycle.plane:
        faults.add("fillets", f"plane {fillets.plane}", f"must be of plane {cycle.plane}", "use one plane")
    if not np.all(np.isfinite(cycle.forces)):
        faults.add("cycle", "not converged", "must have finite forces", cycle.message)
    elif cycle.opposite is not None:
        allowed = "must have flanks that bear on one side of the teeth"
        faults.add("cycle", "flanks that bear on both sides", allowed, "give more backlash")
    faults.raise_if_any()
    arcs = cycle.arcs
    if arcs is None:
        raise InputError.at(
            "cycle", "curves alone", "must have arcs between events", "take it from mesh_cycle"
        )
    watch = Stopwatch()
    roots = fillets if fillets is not None else _fillets(pair, tolerance, cycle.plane)
    ready = watch.seconds
    if cycle.face is None:
        pinion, wheel = (_gear_stress(pair, cycle, arcs, roots, gear) for gear in (0, 1))
    else:
        pinion, wheel = _over_face(pair, cycle, cycle.face, arcs, roots)
    parts = {**({} if fillets is not None else roots.cost.parts), "superpose": watch.seconds - ready}
    cost = Cost(watch.seconds, roots.cost.unknowns, parts=parts, counts=roots.cost.counts)
    return RootStress(
        pinion,
        wheel,
        max(max(stress.errors.values()) for stress in (pinion, wheel)),
        cost,
        roots.converged and cycle.converged,
        roots.message,
    )


def _gear_stress(
    pair: GearPair, cycle: MeshCycle, mesh_arcs: MeshArcs, roots: Fillets, gear: int
) -> GearRootStress:
    """Stress at the cycle's positions, and the largest on its arcs."""
    influence, fillets_error = (roots.pinion, roots.wheel)[gear], float(roots.errors[gear])
    offsets = cycle.pair_offset
    teeth = np.arange(offsets.min() - 1, offsets.max() + 2)
    forces = _Forces(offsets, teeth, pair.face_width, gear)
    total = forces.stress(influence, cycle.forces, cycle.flank_rho[gear])
    nodes, before = (
        None if arcs is None else RootNodes(arcs, _positions(cycle, arcs), forces.at_nodes(influence, arcs))
        for arcs in (mesh_arcs.arcs, mesh_arcs.before)
    )
    assert nodes is not None
    low, high = nodes.stress.min(axis=(0, 1)), nodes.stress.max(axis=(0, 1))
    tension, compression = (
        peak_of(nodes, before, mesh_arcs.gain, teeth, influence, side) for side in (LOADED, OTHER)
    )
    return GearRootStress(
        influence.line,
        influence.law,
        cycle.loaded_position,
        teeth,
        total,
        tension,
        compression,
        np.stack([low, high]),
        fillets_error,
        webbed=(pair.pinion, pair.wheel)[gear].blank is not None,
    )


def _over_face(
    pair: GearPair, cycle: MeshCycle, face: FaceLoads, mesh_arcs: MeshArcs, roots: Fillets
) -> tuple[GearRootStress, GearRootStress]:
    """Stress of both gears under loads on cells of the face."""
    solved = face_fillets(roots, pair, face.setting.model)
    offsets = cycle.pair_offset
    teeth = np.arange(offsets.min() - 1, offsets.max() + 2)

    def of(gear: int, fillets: FilletFace) -> GearRootStress:
        stress = StressOverFace(fillets, offsets, teeth, 1 if gear == 0 else -1, pair.face_offsets[gear])
        on_arcs = RootOnArcs(stress, mesh_arcs, partial(_positions, cycle), gear, solved.mesh_errors[gear])
        over = root_over_face(on_arcs, face, cycle.flank_rho[gear], cycle.loaded_position)
        return GearRootStress(
            fillets.influence.line,
            fillets.influence.law,
            cycle.loaded_position,
            teeth,
            over.tangential,
            over.tension,
            over.compression,
            over.passage,
            float(roots.errors[gear]),
            over.face,
            webbed=(pair.pinion, pair.wheel)[gear].blank is not None,
        )

    pinion, wheel = over_face(roots, solved, pair, face.setting)
    return of(0, pinion), of(1, wheel)


@record
class _Forces:
    """Forces on the teeth of one gear: columns are pairs, each so many base pitches ahead."""

    offsets: Integers
    teeth: Integers
    width: float
    gear: int

    def stress(self, influence: FilletInfluence, forces: Array, rho: Array) -> Array:
        """Stress (n, teeth, 2, samples) by forces on the pairs at curvature radii, both (n, pairs)."""
        # the pair ahead is the next tooth anticlockwise on the pinion, clockwise on the wheel
        turn = 1 if self.gear == 0 else -1
        total = np.zeros((len(forces), len(self.teeth), 2, len(influence.line.arc)))
        for column, offset in enumerate(self.offsets):
            rows = np.flatnonzero(forces[:, column] > 0)
            line_load = forces[rows, column, None, None] / self.width
            for i, tooth in enumerate(self.teeth):
                total[rows, i] += line_load * influence.stress(turn * int(tooth - offset), rho[rows, column])
        return total

    def at_nodes(self, influence: FilletInfluence, arcs: Arcs) -> Array:
        """Stress at all nodes of arcs, one after the other."""
        nodes = [arc.pairs for arc in arcs.arcs if arc.pairs is not None]
        assert len(nodes) == len(arcs.arcs)  # of finite elements
        pairs = np.concatenate(nodes)
        return self.stress(influence, pairs[..., FORCE], pairs[..., FORCE + 1 + self.gear])


def _positions(cycle: MeshCycle, arcs: Arcs) -> Array:
    """Positions of the loaded flanks at all nodes of the arcs, as `MeshCycle.loaded_position`."""
    if cycle.flank == "front":
        return np.concatenate([arc.position for arc in arcs.arcs])
    positions = []
    for arc in arcs.arcs:
        middle = arc.low + 0.5 * arc.width  # ends of arcs may be where the path starts anew
        positions.append((MeshSetup(cycle.pair).mirror - middle) % 1.0 + middle - arc.position)
    return np.concatenate(positions)
