r"""What free ends add to the stress along the fillets of a helical gear without ends.

As for displacements (``fem.influence.helix_ends``) the body with a free end is held against the same body lengthened
beyond it, on the same section and with the same polynomials along the axis, so that both lack the same and the rest is
smooth. Stress is by the values of those polynomials and by their slopes (``fem.elasticity.helix_fillet``). One end is
looked at with the other far away, then what both ends do together beyond each alone. A half turn about the middle of a
tooth exchanges the ends, both flanks and both fillets, and turns the sign of the shear; a mirror across the axis
exchanges the ends and the hands.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, cached_property, partial

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, record
from fem.elasticity.fillet import fillet_line, local_cubic
from fem.elasticity.flank_samples import sample_places
from fem.elasticity.free_ends import ORDER, HalfFace, pieces_between
from fem.elasticity.helix_fillet import helix_fillets
from fem.elasticity.lengthened import FacePieces
from fem.elasticity.line_load import flank_points, joined
from fem.elasticity.prism import prism
from fem.influence.flank_variable import FlankVariable
from fem.influence.gear_face import section_of
from fem.influence.gear_shape import MeshedShape, rounded
from fem.influence.gear_store import GearStore
from fem.influence.helix_ends import (
    ACROSS,
    BODY_INWARDS,
    BODY_OUTWARDS,
    FURTHER,
    INWARDS,
    OUTWARDS,
    WIDE,
    depth_of,
    lengths,
)
from fem.influence.helix_fillet_waves import Z_REVERSED, CellLoad
from meshes.outline import Sizes

__all__ = ["HelixFilletEnds", "helix_fillet_ends"]

PLACES, SAMPLES = 5, 21
"""Places of loads on the flank, and samples of a fillet."""

TEETH = (-1, 0, 1)
"""Teeth that are looked at, counted anticlockwise from the loaded one; farther ones hardly feel where a face ends."""

SECTION = Sizes(flank=0.45, fillet=0.3, root=0.6, corner=0.45, top=1.5, growth=1.0, rim=2.0, layer_growth=2.0)
"""Of one end."""

COARSE_SECTION = Sizes(
    flank=0.9, fillet=0.45, root=0.9, corner=0.9, top=2.0, growth=1.0, rim=2.0, layer_growth=2.5
)
"""Of what one end does to the effect of the other."""


@record
class _Effect:
    """Stress by functions along the face.

    Attributes
    ----------
    start : float
        Where the pieces begin on the axis [modules].
    sense : int
        Whether they go on along the axis, 1, or against it, -1.
    pieces : FacePieces
        From 0.
    place : FlankVariable
        Of loads.
    tables : mapping of int to (places, functions, 2, functions, 3, 2, samples) array
        By tooth, anticlockwise from the loaded one: of a load's Chebyshev polynomial in rho and function of z, the
        stresses by values (0) and by slopes (1) of the functions that are seen.
    """

    start: float
    sense: int
    pieces: FacePieces
    place: FlankVariable
    tables: Mapping[int, Array]

    @cached_property
    def _functions(self) -> HalfFace:
        return pieces_between(self.pieces.ends)

    def felt(self, load: CellLoad) -> Array:
        """What all teeth feel of the forces on the cells of a line (places functions,)."""
        along = self.pieces.means(self.sense * (load.z - self.start), load.length)
        by_place = self.place.basis(load.rho, PLACES - 1)
        return np.asarray(np.einsum("c,ca,cp->ap", load.force, by_place, along, optimize=True)).ravel()

    def on(self, tooth: int, felt: Array, places: Array) -> Array:
        """Stress sigma_t, sigma_b and tau (places, 3, 2, samples) on a tooth."""
        functions, seen = self._functions, self.sense * (places - self.start)
        within = (seen >= -1e-9) & (seen <= self.pieces.ends[-1])
        inside = np.clip(seen, self.pieces.ends[0], self.pieces.ends[-1])
        along = np.stack([functions.values(inside), functions.slopes(inside)]) * within
        table = self.tables[tooth]
        by_function = np.tensordot(felt, table.reshape(len(felt), *table.shape[2:]), 1)
        stress = np.tensordot(along, by_function, ((0, 1), (0, 1)))
        return np.asarray(stress * (Z_REVERSED if self.sense < 0 else np.ones(3))[:, None, None])


@record
class HelixFilletEnds:
    """What free ends add to the stress along the fillets of a helical gear, in modules.

    Attributes
    ----------
    effects : tuple of _Effect
        Of the lower end, of the upper end, and of both together.
    """

    effects: tuple[_Effect, ...]

    def felt(self, load: CellLoad) -> tuple[Array, ...]:
        """What all teeth feel of the forces on the cells of a line, as ``on`` asks for it."""
        return tuple(effect.felt(load) for effect in self.effects)

    def on(self, tooth: int, felt: tuple[Array, ...], places: Array, samples: int) -> Array:
        """Stress sigma_t, sigma_b and tau (places, 3, 2, samples).

        Parameters
        ----------
        tooth : int
            Anticlockwise from the loaded one; one that is too far to feel an end has none.
        felt : tuple of arrays
        places : (places,) array
            Along the axis, 0 at the middle of the gear's own face [modules].
        samples : int
            Of a fillet.
        """
        if tooth not in TEETH:
            return np.zeros((len(places), 3, 2, samples))
        each = zip(self.effects, felt, strict=True)
        total = np.asarray(sum(effect.on(tooth, here, places) for effect, here in each))
        return np.asarray(total @ _finer(samples).T)


@cache
def _finer(samples: int) -> Array:
    """Weights of the samples that are solved in more of them (samples, SAMPLES)."""
    return local_cubic(np.linspace(0.0, 1.0, SAMPLES), np.linspace(0.0, 1.0, samples), 4)


def helix_fillet_ends(
    meshed: MeshedShape, twist: float, face_width: float, gears: GearStore | None = None
) -> HelixFilletEnds:
    """Solve a gear of module 1 with free ends.

    Parameters
    ----------
    meshed : MeshedShape
        Of the transverse section.
    twist : float
        [rad/module], positive for a right hand.
    face_width : float
        In modules: the face is z in [-face_width/2, face_width/2].
    gears : GearStore, optional
        Where solved gears are kept.
    """
    size, half, gears = rounded(abs(twist)), 0.5 * face_width, gears or GearStore()
    pieces, place, lower, upper = gears.record(
        "helix fillet ends", (meshed, size), partial(_single_ends, meshed, size)
    )
    if twist < 0.0:
        lower, upper = upper, lower
    ends = [(-half, 1, pieces, lower), (half, -1, pieces, upper)]
    if face_width < WIDE * depth_of(meshed):
        wide = rounded(face_width)
        between, tables = gears.record(
            "helix fillet ends together", (meshed, size, wide), partial(_both_ends, meshed, size, wide)
        )
        ends.append((-half, 1, between, tables) if twist >= 0.0 else (half, -1, between, tables))
    return HelixFilletEnds(
        tuple(_Effect(start, sense, over, place, tables) for start, sense, over, tables in ends)
    )


def _single_ends(
    meshed: MeshedShape, twist: float
) -> tuple[FacePieces, FlankVariable, Mapping[int, Array], Mapping[int, Array]]:
    """What either end of a right hand does, from the end inwards: pieces, places, the lower and the upper end."""
    depth = depth_of(meshed)
    inwards = np.concatenate([[0.0], np.cumsum(lengths(INWARDS, BODY_INWARDS, depth))])
    pieces = FacePieces(inwards)
    longer = pieces.lengthened(lengths(OUTWARDS, BODY_OUTWARDS, depth), np.zeros(0))
    solve = _Solver(meshed, twist, SECTION)
    lower, upper = (
        free - whole for free, whole in zip(solve(pieces, pieces), solve(longer, pieces), strict=True)
    )
    # a half turn: neighbours and fillets the other way round
    upper = upper[::-1, ..., ::-1, :]
    return pieces, solve.place, solve.tables(lower), solve.tables(upper)


def _both_ends(
    meshed: MeshedShape, twist: float, face_width: float
) -> tuple[FacePieces, Mapping[int, Array]]:
    """What both ends of a right hand do beyond each alone, from the lower end on: pieces and tables."""
    pieces = FacePieces(face_width * np.concatenate([[0.0], np.cumsum(ACROSS)]))
    beyond, none = lengths(FURTHER, BODY_OUTWARDS, depth_of(meshed)), np.zeros(0)
    solve = _Solver(meshed, twist, COARSE_SECTION)
    free, above, below, without = (
        solve(pieces.lengthened(low, high), pieces)[0] for low in (none, beyond) for high in (none, beyond)
    )
    return pieces, solve.tables(free - above - below + without)


class _Solver:
    """Stress along the fillets of one section by loads on both flanks, at the same places.

    Parameters
    ----------
    meshed : MeshedShape
    twist : float
    sizes : Sizes
    """

    def __init__(self, meshed: MeshedShape, twist: float, sizes: Sizes) -> None:
        profile = meshed.shape.profile
        self.over = section_of(meshed, sizes, 0, twist)
        self.rho = sample_places(profile, PLACES)
        self.at = joined(*(flank_points(self.over.mesh, self.rho, flank) for flank in ("left", "right")))
        self.place = FlankVariable((float(self.rho[0]), float(self.rho[-1])))
        line = fillet_line(profile, SAMPLES)
        self.fillets = helix_fillets(self.over.mesh, profile, line, self.over.law, twist)

    def __call__(self, body: FacePieces, seen: FacePieces) -> tuple[Array, Array]:
        """Stress by loads on the left and on the right flank (teeth, loads, psi, 2, psi, 3, 2, samples)."""
        first = ORDER * int(np.searchsorted(body.ends, seen.ends[0]))
        part, count = slice(first, first + seen.functions), seen.functions
        solved = prism(self.over, body.face())
        moved = solved.displacements(self.at, TEETH)
        nodes = moved.shape[1]
        moved = moved.reshape(len(TEETH), nodes, -1, 2 * PLACES, solved.psi)[..., part]
        moved = moved.reshape(len(TEETH), nodes, 3 * solved.psi, -1)
        in_section = moved[:, :, : 2 * solved.psi].reshape(len(TEETH), nodes, solved.psi, 2, -1)[:, :, part]
        along_axis = moved[:, :, 2 * solved.psi :][:, :, part, None]
        functions = np.concatenate([in_section, along_axis], axis=3)  # (teeth, nodes, psi, 3, loads psi)
        stress = np.empty((len(TEETH), 2, 2, 3, SAMPLES, count, 2, PLACES, count))
        for tooth, by_function in enumerate(functions):
            columns = by_function.swapaxes(1, 2).reshape(3 * nodes, -1)
            for side, fillet in enumerate(self.fillets):
                for kind, matrix in enumerate((fillet.still, fillet.sloped)):
                    stress[tooth, kind, side] = (matrix @ columns).reshape(stress.shape[3:])
        # tooth, kind, side, component, sample, seen, flank, load, psi: the flank first, then as the tables have it
        left, right = np.moveaxis(stress, (6, 0, 7, 8, 1, 5, 3, 2, 4), range(9))
        return left, right

    def tables(self, samples: Array) -> Mapping[int, Array]:
        """Coefficients of each tooth from samples at the places."""
        by_place = np.linalg.inv(chebyshev.chebvander(self.place.unit(self.rho, hold=False), PLACES - 1))
        return {
            tooth: np.tensordot(by_place, of_tooth, 1) for tooth, of_tooth in zip(TEETH, samples, strict=True)
        }
