"""What finite elements take into account of the flanks beside the pair's geometry."""

from __future__ import annotations

from dataclasses import dataclass

import gears
from fem.pair.face_setting import FREE_ENDS


@dataclass(frozen=True)
class Flanks:
    """What finite elements take into account beside the pair's geometry, as `fem.mesh_cycle` does.

    Attributes
    ----------
    beyond_path : bool
        Whether tip edges may touch outside A to E.
    deviations : tuple, optional
        Deviations of pinion and wheel, either may be None.
    tip_rounding : (float, float)
        Radii of the tip edges of pinion and wheel [m].
    friction : float
        Coefficient of friction by which the forces are tilted.
    base_pitch_difference : float
        Base pitch of the pinion less that of the wheel, by unequal temperatures [m].
    moving_contact : bool, optional
        Whether contacts on the path move under load; unless given those of plastics do, as of `fem.mesh_cycle`.
    alignment : gears.Alignment, optional
        How the axes are out of parallel.
    cells : int, optional
        Cells of the face; the load is even along it without them, an alignment and leads.
    face_model : str
        What couples the cells, as of `fem.mesh_cycle`.
    shafts : (gears.Shaft or None, gears.Shaft or None), optional
        Shafts under the face, which bend and twist under the loads on the cells; straight and rigid without them.
    """

    beyond_path: bool = True
    deviations: tuple[gears.GearDeviations | None, gears.GearDeviations | None] | None = None
    tip_rounding: tuple[float, float] = (0.0, 0.0)
    friction: float = 0.0
    moving_contact: bool | None = None
    base_pitch_difference: float = 0.0
    alignment: gears.Alignment | None = None
    cells: int | None = None
    face_model: str = FREE_ENDS
    shafts: tuple[gears.Shaft | None, gears.Shaft | None] | None = None


PLAIN_FLANKS = Flanks()
"""Sharp edges without deviations or friction; they may touch outside the path."""
