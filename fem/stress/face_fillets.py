"""Fillets of both gears of a pair solved for loads that vary along the face, before root stresses ask for them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from base import Cost, Stopwatch, record
from fem.influence.fillet_ends import FilletEnds, fillet_ends
from fem.influence.fillet_face import FilletFace
from fem.influence.fillet_waves import FilletWaves, fillet_waves
from fem.influence.gear_shape import DIGITS
from fem.influence.gear_store import GearStore, ResultStore
from fem.pair.face_setting import FREE_ENDS, FaceSetting
from fem.pair.pair_fillets import Fillets, LoadedShape

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["FaceFillets", "face_fillets", "over_face"]


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
    long = float(f"{width:.{DIGITS}g}")
    return gears.record("fillet ends", (loaded, long), partial(fillet_ends, loaded.shape, long, loaded.low))


def over_face(
    fillets: Fillets, solved: FaceFillets, pair: GearPair, setting: FaceSetting
) -> tuple[FilletFace, FilletFace]:
    """Fillets of pinion and wheel under loads on the cells of a face.

    Parameters
    ----------
    fillets : Fillets
    solved : FaceFillets
        Of these.
    pair : gears.GearPair
    setting : FaceSetting
    """
    pinion, wheel = (
        FilletFace(
            (fillets.pinion, fillets.wheel)[gear],
            solved.waves[gear],
            None if solved.ends is None else solved.ends[gear],
            pair.face_widths[gear],
            setting.edges(pair) - pair.face_offsets[gear],
        )
        for gear in range(2)
    )
    return pinion, wheel
