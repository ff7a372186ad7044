"""Fillets of both gears of a helical pair, solved for forces on cells of its lines of contact."""

from __future__ import annotations

from functools import partial
from math import ceil, floor
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Cost, Faults, Stopwatch, described, part, quantity, record
from base.results import ITSELF, WORST
from fem.elasticity.fillet import FilletLine, fillet_line
from fem.elasticity.helix_fillet import principal
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.influence.gear_face import solved_waves
from fem.influence.gear_shape import GearShape, MeshedShape, rounded, shapes
from fem.influence.gear_store import GearStore, ResultStore
from fem.influence.helix_fillet_ends import HelixFilletEnds, helix_fillet_ends
from fem.influence.helix_fillet_waves import (
    NEAR_LOAD,
    CellLoad,
    HelixFilletWaves,
    away_from,
    helix_fillet_waves,
)
from fem.pair.pair_fillets import COARSEST, FILLET_EDGE, HALVINGS, START, TOLERANCE, fillet_sizes
from meshes.outline import Sizes

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["FilletsOfLines", "LineFillets", "line_fillets"]

LONG_WAVES = 2.0
"""Largest wave number [1/module] of those by which two meshes are held against each other."""

OF_A_NODE = 6
"""Unknowns of a node in a wave: cosine and sine of u, v and w."""

COMPARED = 15
"""Places along the flank at which they are."""


@record
class FilletsOfLines:
    """One gear of a helical pair as forces on its lines of contact stress its fillets.

    Attributes
    ----------
    waves : HelixFilletWaves
        In modules.
    ends : HelixFilletEnds
        What free ends add, in modules.
    line : FilletLine
        [m]
    law : PlaneElasticity
    module, width : float
        Normal module and the gear's own face [m].
    side : int
        1 of the pinion, -1 of the wheel, whose teeth ahead have smaller curvature radii.
    offset : float
        Middle of the gear's own face [m].
    """

    waves: HelixFilletWaves
    ends: HelixFilletEnds
    line: FilletLine
    law: PlaneElasticity
    module: float
    width: float
    side: int
    offset: float

    def stress(self, load: CellLoad, away: list[int], places: Array) -> tuple[Array, Array]:
        """Stress sigma_t, sigma_b and tau, and what of it free ends add (teeth, places, 3, 2, samples) [Pa].

        Parameters
        ----------
        load : CellLoad
            In metres and newtons, z from mid-face.
        away : list of int
            Teeth ahead of the loaded one.
        places : (places,) array
            Along the face, from mid-face [m].
        """
        m, samples = self.module, len(self.line.arc)
        here = CellLoad(load.rho / m, (load.z - self.offset) / m, load.length / m, load.force / m**2)
        at = (places - self.offset) / m
        by_waves, by_ends = self.waves.felt(here, at), self.ends.felt(here)
        added = [self.ends.on(self.side * tooth, by_ends, at, samples) for tooth in away]
        waves = [self.waves.on(self.side * tooth, by_waves) for tooth in away]
        return np.asarray(waves) + np.asarray(added), np.asarray(added)


@record
class LineFillets:
    """Fillets of both gears of a helical pair, and how exact they are."""

    no_error = ITSELF

    headline = ("fillet_edge",)

    pair: GearPair = part("the gears")
    pinion: FilletsOfLines = part("fillets of the pinion")
    wheel: FilletsOfLines = part("fillets of the wheel")
    fillet_edge: float = quantity("1", "edge length on the fillets of the mesh in use, in modules")
    errors: Array = quantity(
        "1",
        "estimated relative error of the maximum stress on a gear's fillet, from two nested meshes",
        "gear",
    )
    cost: Cost
    converged: bool
    message: str

    @described("1")
    def error(self) -> float:
        """Larger of both gears' estimated errors."""
        return float(self.errors.max())


def line_fillets(
    pair: GearPair,
    tolerance: float = 0.005,
    fillet_edge: float | None = None,
    *,
    kept: ResultStore | None = None,
) -> LineFillets:
    """Fillets of both gears of a helical pair on meshes as fine as the tolerance asks for.

    Parameters
    ----------
    pair : gears.GearPair
        Helical.
    tolerance : float
        Relative, on the maximum stress by long waves along a fillet.
    fillet_edge : float, optional
        Edge length on the fillets before the refinement, in modules; fixes the mesh instead of the tolerance.
    kept : callable, optional
        Where solved gears are kept beyond the process, as of `compliance`.

    Raises
    ------
    base.InputError
        A spur pair, whose fillets are those of `fillets`; a tolerance or edge length that makes no sense.

    Examples
    --------
    >>> from fem import line_fillets
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3, helix_angle=0.35)
    >>> bodies = line_fillets(pair, tolerance=0.05)  # doctest: +SKIP
    """
    faults = Faults()
    if pair.helix_angle == 0.0:
        faults.add("pair", "spur", "must be helical for lines across the face", "take fillets of a spur pair")
    faults.number("tolerance", tolerance, TOLERANCE)
    if fillet_edge is not None:
        faults.number("fillet_edge", fillet_edge, FILLET_EDGE)
    faults.raise_if_any()
    watch, gears, solved = Stopwatch(), GearStore(kept), []
    starts = pair.points.A, pair.line_of_action - pair.points.E
    reach = ceil(pair.total_contact_ratio)
    profiles = pair.teeth_profiles
    for gear, (shape, side) in enumerate(zip(shapes(pair, profiles, "strain"), (1, -1), strict=True)):
        low = START * floor(starts[gear] / (START * pair.module))
        twist = side * pair.helix.base_tangent * pair.module / pair.base_radii[gear]
        waves, error, unknowns, edge = _meshed(
            gears, (shape, abs(rounded(twist)), reach, low), tolerance, fillet_edge
        )
        width = rounded(pair.face_widths[gear] / pair.module)
        solved.append(
            (
                FilletsOfLines(
                    waves if twist >= 0.0 else waves.mirrored,
                    helix_fillet_ends(MeshedShape(shape, Sizes(), 0), twist, width, gears),
                    fillet_line(profiles[gear]),
                    PlaneElasticity.of(pair.materials[gear], "strain"),
                    pair.module,
                    pair.face_widths[gear],
                    side,
                    pair.face_offsets[gear],
                ),
                error,
                edge,
                unknowns,
            )
        )
    (pinion, *_), (wheel, *_) = solved
    errors, edge = np.array([error for _, error, *_ in solved]), min(edge for *_, edge, _ in solved)
    worst = float(errors.max())
    message = f"edges of {0.5 * edge:.3g} modules on the fillets, error {worst:.1e}"
    if worst > tolerance and fillet_edge is None:
        message += f", above the tolerance {tolerance:.1e}: the mesh is the finest allowed"
    settled = worst < WORST or fillet_edge is not None
    cost = Cost(
        watch.seconds, sum(unknowns for *_, unknowns in solved), parts=sum(gears.costs, Cost(0.0)).parts
    )
    return LineFillets(pair, pinion, wheel, 0.5 * edge, errors, cost, settled, message)


def _meshed(
    gears: GearStore, key: tuple[GearShape, float, int, float], tolerance: float, fillet_edge: float | None
) -> tuple[HelixFilletWaves, float, int, float]:
    """Waves of the right hand, their error, unknowns, and the edge on the fillets before the refinement [modules]."""
    edge = 2.0 * COARSEST if fillet_edge is None else fillet_edge
    smallest = edge if fillet_edge is not None else COARSEST / 2**HALVINGS
    while True:
        waves, error, unknowns = gears.record("helix fillets", (*key, edge), partial(_two_meshes, *key, edge))
        if error <= tolerance or edge <= smallest:
            return waves, error, unknowns, edge
        edge *= 0.5


def _two_meshes(
    shape: GearShape, twist: float, reach: int, low: float, edge: float
) -> tuple[HelixFilletWaves, float, int]:
    """Waves on a refined mesh, their error against the mesh that it refines, and unknowns of a wave."""
    from meshes import mesh_sector, refined

    coarse_mesh = mesh_sector(shape.profile, fillet_sizes(edge))
    mesh = refined(coarse_mesh)
    coarse, fine = (
        helix_fillet_waves(of, shape.profile, twist, shape.poisson, teeth, low)
        for of, teeth in ((coarse_mesh, 0), (mesh, reach))
    )
    return fine, _change(fine, coarse), OF_A_NODE * len(mesh.points)


def _change(fine: HelixFilletWaves, coarse: HelixFilletWaves) -> float:
    """Relative error of the maximum stress by long waves: half of what the refinement changes, and the fit's noise.

    Over the largest stress of an even load at the same place. What a load does to its own surroundings is no such.
    """
    _, wavenumber = solved_waves()
    long = wavenumber <= LONG_WAVES
    rho = np.linspace(*fine.series[0].variable.span, COMPARED)
    apart = away_from(fine.profile, fine.line, rho) >= NEAR_LOAD
    largest = []
    for waves in (fine, coarse):
        stress = principal(*np.moveaxis(waves.beyond(0, rho)[:, :, long], 3, 0))
        sizes = np.where(apart[:, None, None, None], np.maximum(*np.abs(stress)), 0.0)
        largest.append(sizes.max(axis=-1))  # (loads, 2, waves, 2)
    here, before = largest
    even = here[:, :1, -1:]
    return 0.5 * float(np.max(np.abs(before - here) / even)) + fine.noise / float(even.max())
