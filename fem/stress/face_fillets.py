"""Fillets of both gears of a pair solved for loads along the face, before root stresses ask for them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from base import Cost, Stopwatch, record
from fem.influence.fillet_ends import FilletEnds, fillet_ends
from fem.influence.fillet_waves import FilletWaves, even_waves, fillet_waves
from fem.influence.gear_shape import rounded
from fem.influence.gear_store import GearStore, ResultStore
from fem.influence.root_influence import RootInfluence
from fem.pair.face_setting import FREE_ENDS
from fem.pair.pair_fillets import Fillets, LoadedShape

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["EVEN", "FaceFillets", "face_fillets", "root_influences"]

EVEN = "even"
"""Of loads that are even along the face, a single cell, beside the models of `FaceSetting`."""


@record
class FaceFillets:
    """Fillets of both gears as loads along the face stress them, in modules.

    Attributes
    ----------
    waves : (FilletWaves, FilletWaves)
        Of pinion and wheel.
    ends : (FilletEnds, FilletEnds) or None
        What free ends add; None between walls.
    mesh_errors : (float, float)
        Estimated relative error of the largest even stress on the mesh that the waves were solved on.
    cost : Cost
        Of what was not there already.
    """

    waves: tuple[FilletWaves, FilletWaves]
    ends: tuple[FilletEnds, FilletEnds] | None
    mesh_errors: tuple[float, float]
    cost: Cost


def face_fillets(
    fillets: Fillets, pair: GearPair, model: str = FREE_ENDS, kept: ResultStore | None = None
) -> FaceFillets:
    """Solve the fillets of both gears for loads along the face; root stresses that are asked for later find them.

    Parameters
    ----------
    fillets : Fillets
    pair : gears.GearPair
        Whose face widths are those of the gears.
    model : {"free-ends", "walls", "slices"}
        Free ends, or a face between frictionless walls, which is also what slices of load are taken to stress.
    kept : callable, optional
        As of `fem.compliance`.

    Examples
    --------
    >>> from fem import face_fillets, fillets
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=20), Gear(teeth=20), module=2e-3, face_width=20e-3)
    >>> face_fillets(fillets(pair, tolerance=0.1), pair, "walls").ends is None
    True
    """
    watch, gears = Stopwatch(), GearStore(kept)
    pinion, wheel = fillets.shapes
    ends = None
    if model == FREE_ENDS:
        first, second = (width / pair.module for width in pair.face_widths)
        ends = _ends(pinion, first, gears), _ends(wheel, second, gears)
    errors = pinion.solved(gears).error, wheel.solved(gears).error
    return FaceFillets((_waves(pinion, gears), _waves(wheel, gears)), ends, errors, Cost(watch.seconds))


def _waves(loaded: LoadedShape, gears: GearStore) -> FilletWaves:
    def solve() -> FilletWaves:
        return fillet_waves(loaded.mesh(), loaded.solved(gears).influence)

    return gears.record("fillet waves", (loaded,), solve)


def _ends(loaded: LoadedShape, width: float, gears: GearStore) -> FilletEnds:
    long = rounded(width)
    return gears.record("fillet ends", (loaded, long), partial(fillet_ends, loaded.shape, long, loaded.low))


def root_influences(fillets: Fillets, pair: GearPair, model: str) -> tuple[RootInfluence, RootInfluence]:
    """Stress of pinion's and wheel's fillets by loads on cells of the face.

    Parameters
    ----------
    fillets : Fillets
    pair : gears.GearPair
    model : {"free-ends", "walls", "slices", "even"}
        As of `face_fillets`, or loads that are even along the face, which ask for nothing beyond the fillets.
    """
    solved = _even(fillets) if model == EVEN else face_fillets(fillets, pair, model)
    pinion, wheel = (
        RootInfluence(
            (fillets.pinion, fillets.wheel)[gear],
            solved.waves[gear],
            None if solved.ends is None else solved.ends[gear],
            solved.mesh_errors[gear],
            pair.face_widths[gear],
            pair.face_width,
            pair.face_offsets[gear],
        )
        for gear in (0, 1)
    )
    return pinion, wheel


def _even(fillets: Fillets) -> FaceFillets:
    waves = even_waves(fillets.pinion), even_waves(fillets.wheel)
    return FaceFillets(waves, None, (0.0, 0.0), Cost(0.0))
