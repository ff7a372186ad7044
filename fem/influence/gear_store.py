"""Gears that this process has solved, in modules and E*, to be used again by any pair that has one of them.

A study of N pinions and M wheels so costs N + M gears, and equal gears of a pair are solved once. What is kept is
small and refuses writing; factors are large and kept for the two gears in use alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol, TypeVar

import numpy as np

from base import Array, Cost, Stopwatch, record
from fem.elasticity.flank_samples import flank_loads, sample_places, sampled, samples_of
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.elasticity.ring import Ring, ring_of
from fem.influence.back_compliance import BackCompliance, back_by_mirror, back_compliance
from fem.influence.flank_motion import FlankMotion, flank_motion
from fem.influence.gear_compliance import GearCompliance, gear_compliance
from fem.influence.gear_shape import COARSE, FINE, MeshedShape, MeshLevel, plain
from fem.influence.memo import Memo, read_only
from fem.influence.tip_strips import TipStrips, tip_strips

__all__ = ["GearStore", "InModules", "ResultStore", "SolvedFlanks", "forget_gears", "sized"]

T = TypeVar("T")
S = TypeVar("S", covariant=True)

MOST_RECORDS, MOST_RINGS, MOST_FACES = 512, 2, 16

BACK_SAMPLES = 20
"""Loads along a flank whose answer on the other side of the teeth is looked at: there it is smooth."""

_RECORDS: Memo[Any] = Memo(MOST_RECORDS)
_SIZED: Memo[Any] = Memo(MOST_RECORDS)
_RINGS: Memo[Mapping[MeshLevel, Ring]] = Memo(MOST_RINGS)
_FACES: Memo[Any] = Memo(MOST_FACES)
_DRAWINGS: Memo[Any] = Memo(MOST_RINGS)


def forget_gears() -> None:
    """Forget all gears that this process has solved, such as before a measurement of what they cost.

    Examples
    --------
    >>> from fem import forget_gears
    >>> forget_gears()
    """
    _RECORDS.clear()
    _SIZED.clear()
    _RINGS.clear()
    _FACES.clear()
    _DRAWINGS.clear()


class ResultStore(Protocol):
    """Where a caller keeps parts of a result beyond the process, as `fem.compliance` asks for them."""

    def __call__(self, name: str, inputs: Mapping[str, Any], compute: Callable[[], T]) -> T:
        """Give what was kept under a name for these plain inputs; else compute it, and keep it."""


class InModules(Protocol[S]):
    """What was solved of a gear in modules and E*."""

    def scaled(self, module: float, law: PlaneElasticity) -> S:
        """Give it a size [m] and a modulus."""


def sized(solved: InModules[S], module: float, law: PlaneElasticity) -> S:
    """Give a record that is kept its size [m] and modulus: the very same one each time.

    What follows from a gear, such as laws beside its tip corner, so can be kept by the gear itself.
    """
    record: S = _SIZED.obtain((solved, module, law), lambda: read_only(solved.scaled(module, law)))
    return record


@record
class SolvedFlanks:
    """A gear's flanks on both of its meshes (`MeshLevel`).

    Attributes
    ----------
    fine, coarse : GearCompliance
    rho : (n,) array
        Curvature radii of the loads [m].
    change : (n,) array
        By how much ``own`` grew there from the coarser mesh [m per N/m].
    cross_change : float
        Largest change of a cross term [m per N/m].
    coarse_backs : BackCompliance
        What loads do to the other side of the teeth on the coarser mesh.
    unknowns, annulus_unknowns : int
        Of the sector, and of the annulus that it stands for.
    """

    fine: GearCompliance
    coarse: GearCompliance
    rho: Array
    change: Array
    cross_change: float
    coarse_backs: BackCompliance
    unknowns: int
    annulus_unknowns: int

    def change_at(self, rho: Array) -> Array:
        """Growth of ``own`` from the coarser mesh at rho (n,) [m] [m per N/m]."""
        return np.interp(rho, self.rho, self.change)

    def scaled(self, module: float, law: PlaneElasticity) -> SolvedFlanks:
        """Give the flanks of a gear in modules and E* their size [m] and modulus."""
        return SolvedFlanks(
            self.fine.scaled(module, law),
            self.coarse.scaled(module, law),
            self.rho * module,
            self.change / law.plane_modulus,
            self.cross_change / law.plane_modulus,
            self.coarse_backs.scaled(module, law),
            self.unknowns,
            self.annulus_unknowns,
        )


class GearStore:
    """Gives solved gears in modules and E*, and notes what those cost that it had to solve.

    Parameters
    ----------
    kept : ResultStore, optional
        Asked for records that this process does not have.

    Attributes
    ----------
    costs : list of Cost
    """

    def __init__(self, kept: ResultStore | None = None) -> None:
        self.kept = kept
        self.costs: list[Cost] = []

    def flanks(self, meshed: MeshedShape, samples: int) -> SolvedFlanks:
        """Flanks with loads at a number of places."""
        return self.record("flanks", (meshed, samples), lambda: self._flanks(meshed, samples))

    def tips(self, meshed: MeshedShape, level: MeshLevel) -> TipStrips:
        """Answer of the tip edges on one of the meshes."""
        name = "tips" if level == FINE else "coarse tips"
        return self._solved(name, "tips", meshed, level, lambda ring: tip_strips(ring, meshed.shape.profile))

    def motion(self, meshed: MeshedShape) -> FlankMotion:
        """Motion of the flank, on the coarser mesh: a correction."""
        return self._solved("motion", "motion", meshed, COARSE, flank_motion)

    def backs(self, meshed: MeshedShape) -> BackCompliance:
        """What loads on the front flanks do to the back flanks."""
        shape = meshed.shape

        def solve(ring: Ring) -> BackCompliance:
            return back_compliance(ring, sample_places(shape.profile, BACK_SAMPLES), shape.reach)

        return self._solved("back flanks", "back flanks", meshed, FINE, solve)

    def rings(self, meshed: MeshedShape) -> Mapping[MeshLevel, Ring]:
        """Factorised gears on both meshes."""
        return _RINGS.obtain(meshed, lambda: self._rings(meshed))

    def record(self, name: str, key: tuple[Any, ...], compute: Callable[[], T]) -> T:
        """Record of a name by all that decides it, solved where it is kept nowhere."""
        kept = self.kept

        def missing() -> T:
            return compute() if kept is None else kept(f"gear {name}", {"key": plain(key)}, compute)

        solved: T = _RECORDS.obtain((name, key), lambda: read_only(missing()))
        return solved

    def over_face(self, name: str, key: tuple[Any, ...], compute: Callable[[], T]) -> T:
        """Give what gears do between cells of a face: large, and kept for the few that were used last."""
        influence: T = _FACES.obtain((name, key), compute)
        return influence

    def drawing(self, key: tuple[Any, ...], compute: Callable[[], T]) -> T:
        """Give what draws a gear in its size: as large as its factors, and kept like them."""
        drawn: T = _DRAWINGS.obtain(key, compute)
        return drawn

    def _rings(self, meshed: MeshedShape) -> Mapping[MeshLevel, Ring]:
        from meshes import mesh_sector

        watch = Stopwatch()
        mesh = mesh_sector(meshed.shape.profile, meshed.sizes, meshed.refinements)
        assert mesh.coarser is not None
        own = Cost(watch.seconds, parts={"mesh": watch.seconds})
        coarse, fine = (ring_of(sector, meshed.shape.law) for sector in (mesh.coarser, mesh))
        self.costs += [own, coarse.cost, fine.cost]
        return {COARSE: coarse, FINE: fine}

    def _flanks(self, meshed: MeshedShape, samples: int) -> SolvedFlanks:
        rings = self.rings(meshed)
        coarse, fine = rings[COARSE], rings[FINE]
        watch, profile, reach = Stopwatch(), meshed.shape.profile, meshed.shape.reach
        places = sample_places(profile, samples)
        loads = flank_loads(coarse, places)
        fine_samples, coarse_samples = sampled(fine, places, reach), samples_of(loads, reach)
        flanks = SolvedFlanks(
            gear_compliance(fine, profile, fine_samples),
            gear_compliance(coarse, profile, coarse_samples),
            places,
            fine_samples.own - coarse_samples.own,
            float(np.max(np.abs(fine_samples.cross - coarse_samples.cross), initial=0.0)),
            back_by_mirror(loads.part(slice(samples)), reach),
            len(fine.inner) + len(fine.cut),
            fine.unknowns,
        )
        self.costs.append(Cost(watch.seconds, parts={"solve": watch.seconds}))
        return flanks

    def _solved(
        self, name: str, part: str, meshed: MeshedShape, level: MeshLevel, solve: Callable[[Ring], T]
    ) -> T:
        """Record that is solved on one of the meshes, at a cost that counts as a part."""

        def compute() -> T:
            ring = self.rings(meshed)[level]
            watch = Stopwatch()
            solved = solve(ring)
            self.costs.append(Cost(watch.seconds, parts={part: watch.seconds}))
            return solved

        return self.record(name, (meshed,), compute)
