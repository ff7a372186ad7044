r"""What free ends add to the answer of a helical gear without ends, between cells of its lines of contact.

The sum of both is the gear with free ends. E = C(free) - C(lengthened) (``fem.elasticity.lengthened``) is solved for
one end at a time, of a body whose other end is far away:

.. math:: E = E_- + E_+ + X, \qquad X = C_{ff} + C_{\ell\ell} - C_{f\ell} - C_{\ell f} ,

with f a free end and l a lengthened one, lower end first. E- and E+ know no face width. X is what each end does to the
effect of the other: smooth, even where a load is close to one of them, so that a coarser section and few pieces show
it, and nothing where the face is wider than some lengths over which the gear's body feels a load.

A half turn about the middle of a tooth exchanges the ends and both flanks, and leaves the hand. So one solution has
both ends: what the upper end does on the left flank is what the lower end does on the right flank, with neighbours
the other way round. A mirror across the axis exchanges the ends and the hands and leaves the flank: the other hand has
E- and E+ exchanged.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, record
from fem.elasticity.flank_samples import sample_places
from fem.elasticity.lengthened import FacePieces, answers
from fem.elasticity.line_load import flank_points, joined
from fem.influence.flank_variable import FlankVariable
from fem.influence.gear_face import section_of
from fem.influence.gear_shape import MeshedShape, rounded
from fem.influence.gear_store import GearStore
from fem.influence.helix_lines import ContactLine
from meshes.outline import Sizes

__all__ = ["BETWEEN", "FEWER", "OF_ENDS", "HelixEnds", "depth_of", "helix_ends", "lengths"]

BETWEEN, FEWER = "between places", "fewer places"
"""What is doubtful: how answers go on between the places of loads, and the highest order along the flank."""

OF_ENDS = (BETWEEN, FEWER)
"""Doubts of free ends (`HelixEnds.off_by`)."""

OFF_BY = 0.25
"""Part of a doubt by which gears are off: answers change in proportion, and a whole one may leave no solution."""

PLACES = 5
"""Places of loads. More of them follow the nodes of the section, where a load is within an edge of the end."""

SECTION = Sizes(flank=0.45, fillet=0.5, root=0.9, corner=0.45, top=1.5, growth=1.0, rim=2.0, layer_growth=2.0)
"""Of one end."""

COARSE_SECTION = Sizes(
    flank=0.9, fillet=0.45, root=1.2, corner=0.9, top=2.0, growth=1.0, rim=2.0, layer_growth=2.5
)
"""Of what one end does to the effect of the other."""

INWARDS, BODY_INWARDS = (0.4, 1.3, 3.5), (1.3, 2.4)
"""Lengths of pieces from an end inwards: in modules, then over the depth of the body."""

OUTWARDS, BODY_OUTWARDS = (0.6, 2.5), (3.0,)
"""Lengths of pieces beyond a lengthened end, the same way."""

FURTHER = (3.0,)
"""Those before the body's where one end's effect on the other is looked at [modules]."""

ACROSS = (0.25, 0.5, 0.25)
"""Lengths of its pieces over the face width."""

LEAST_DEPTH = 4.0
"""Depth of the body that counts where it is less [modules]: teeth feel a load as far."""

WIDE = 4.0
"""Face width over the depth of the body from which one end does nothing to the effect of the other."""


@record
class _Effect:
    """Answers between places and functions along the face.

    Attributes
    ----------
    start : float
        Where the pieces begin on the axis [modules].
    sense : int
        Whether they go on along the axis, 1, or against it, -1.
    pieces : FacePieces
        From 0.
    place : FlankVariable
    tables : mapping of int to (places functions, places functions) array
        By the k-th tooth on the side of growing rho: Chebyshev coefficients of the load's place times functions of its
        z, and the point's, in modules and E*.
    """

    start: float
    sense: int
    pieces: FacePieces
    place: FlankVariable
    tables: Mapping[int, Array]

    def between(self, load: Array, point: Array, tooth: int) -> Array:
        """Means over cells by unit line loads on cells, over their length (loads, points).

        Parameters
        ----------
        load, point : (cells, places functions) arrays
            As of ``on``.
        tooth : int
            Observed one, counted from the loaded one.
        """
        table = self.tables.get(abs(tooth))
        if table is None:  # too far away to feel an end
            return np.zeros((len(load), len(point)))
        return np.asarray(load @ ((table.T if tooth < 0 else table) @ point.T))

    def on(self, line: ContactLine, rho: Array | None = None, doubt: str = "") -> Array:
        """Means of all functions over cells (cells, places functions), off by a doubt; `rho` as of `HelixEnds`."""
        along = self.pieces.means(self.sense * (line.z - self.start), line.length)
        places = self.place.basis(line.rho, PLACES - 1)
        if doubt == BETWEEN and rho is not None:
            known = self.place.basis(rho, PLACES - 1)
            places = np.stack([np.interp(line.rho, rho, column) for column in known.T], axis=-1)
        elif doubt == FEWER:
            places[:, -1] = 0.0
        return np.asarray((places[:, :, None] * along[:, None, :]).reshape(len(line.z), -1))


@record
class HelixEnds:
    """What free ends add to the answer of a helical gear without ends, in modules and E*.

    Attributes
    ----------
    effects : tuple of _Effect
        Of the lower end, of the upper end, and of one on the other's.
    rho : (places,) array, optional
        Curvature radii of the places of loads, growing.
    doubt : str
        What they are off by: `OF_ENDS`; empty where they are as solved.
    """

    effects: tuple[_Effect, ...]
    rho: Array | None = None
    doubt: str = ""

    def off_by(self, doubt: str) -> HelixEnds:
        """The same, off by a doubt: what answers are compared with.

        A load near an end moves what is close to it most, closer than places are to one another. What a polynomial
        through the answers at the places leaves out there is about what it differs by from straight lines through them
        ("between places"). These lie on one side of a curve that bends one way, a polynomial on both: in the mean it
        leaves out less than a polynomial of one order less does ("fewer places").
        """
        return replace(self, doubt=doubt)

    def on(self, line: ContactLine) -> tuple[Array, ...]:
        """Means over cells of a line of what every effect is known by, as `joining` asks for them."""
        return tuple(effect.on(line, self.rho, self.doubt) for effect in self.effects)

    def joining(self, load: tuple[Array, ...], point: tuple[Array, ...], tooth: int) -> Array:
        """Mean displacements by unit forces on cells (loads, points), in modules and E*.

        Parameters
        ----------
        load, point : tuples of arrays
            As of `on`: of the loaded and of the observed line.
        tooth : int
            Observed one, counted from the loaded one to the side of growing rho.
        """
        each = zip(self.effects, load, point, strict=True)
        return np.asarray(sum(effect.between(here, there, tooth) for effect, here, there in each))

    def between(self, load: ContactLine, point: ContactLine) -> Array:
        """Mean displacements of cells of a line by unit line loads on cells of one (loads, points).

        What ``along_line`` lacks where both are the same line, else what ``between_lines`` lacks
        (``fem.influence.helix_lines``).

        Parameters
        ----------
        load, point : ContactLine
            Of cells within the face, z from its middle.
        """
        return load.length * self.joining(self.on(load), self.on(point), point.tooth - load.tooth)


def helix_ends(
    meshed: MeshedShape, twist: float, face_width: float, gears: GearStore | None = None
) -> HelixEnds:
    """Solve a gear of module 1 and E* = 1 with free ends.

    Parameters
    ----------
    meshed : MeshedShape
        Of the transverse section.
    twist : float
        tan(beta_b)/r_b, positive for a right hand [rad/module].
    face_width : float
        In modules: the face is z in [-face_width/2, face_width/2].
    gears : GearStore, optional
        Where solved gears are kept.
    """
    size, half, gears = rounded(abs(twist)), 0.5 * face_width, gears or GearStore()
    pieces, place, lower, upper = gears.record(
        "helix ends", (meshed, size), partial(_single_ends, meshed, size)
    )
    ends = [(-half, 1, pieces, lower), (half, -1, pieces, upper)]
    if twist < 0.0:
        ends = [(-half, 1, pieces, upper), (half, -1, pieces, lower)]
    if face_width < WIDE * depth_of(meshed):
        wide = rounded(face_width)
        between, tables = gears.record(
            "helix ends together", (meshed, size, wide), partial(_both_ends, meshed, size, wide)
        )
        ends.append((-half, 1, between, tables) if twist >= 0.0 else (half, -1, between, tables))
    effects = tuple(_Effect(start, sense, over, place, tables) for start, sense, over, tables in ends)
    return HelixEnds(effects, sample_places(meshed.shape.profile, PLACES))


def depth_of(meshed: MeshedShape) -> float:
    """Depth of the body under the teeth [modules]."""
    profile = meshed.shape.profile
    return max(profile.root_radius - profile.bore_radius, LEAST_DEPTH)


def lengths(short: Sequence[float], long: Sequence[float], depth: float) -> Array:
    """Lengths of pieces [modules], of which the last are in depths of the body."""
    return np.array([*short, *(depth * each for each in long)])


def _single_ends(
    meshed: MeshedShape, twist: float
) -> tuple[FacePieces, FlankVariable, Mapping[int, Array], Mapping[int, Array]]:
    """What either end of a right hand does, from the end inwards: pieces, places, the lower and the upper end."""
    depth = depth_of(meshed)
    inwards = np.concatenate([[0.0], np.cumsum(lengths(INWARDS, BODY_INWARDS, depth))])
    pieces = FacePieces(inwards)
    longer = pieces.lengthened(lengths(OUTWARDS, BODY_OUTWARDS, depth), np.zeros(0))
    solve = _Solver(meshed, twist, SECTION)
    free, without = solve(pieces, pieces), solve(longer, pieces)
    lower, upper = (end - whole for end, whole in zip(free, without, strict=True))
    return pieces, solve.place, solve.tables(lower), solve.tables(np.moveaxis(upper, (1, 2), (3, 4)))


def _both_ends(
    meshed: MeshedShape, twist: float, face_width: float
) -> tuple[FacePieces, Mapping[int, Array]]:
    """What one end of a right hand does to the effect of the other, from the lower end on: pieces and tables."""
    pieces = FacePieces(face_width * np.concatenate([[0.0], np.cumsum(ACROSS)]))
    beyond, none = lengths(FURTHER, BODY_OUTWARDS, depth_of(meshed)), np.zeros(0)
    solve = _Solver(meshed, twist, COARSE_SECTION)
    bodies = (pieces, pieces.lengthened(none, beyond), pieces.lengthened(beyond, beyond))
    free, above, without = (solve(body, pieces) for body in bodies)
    lower, other = (end - whole for end, whole in zip(above, without, strict=True))
    # the upper end: right flank, neighbours the other way round, pieces from there on
    upper = np.moveaxis(other, (1, 2), (3, 4))[:, :, ::-1, :, ::-1]
    return pieces, solve.tables(free[0] - without[0] - lower - upper)


class _Solver:
    """Answers of one section on both flanks, at the same places.

    Parameters
    ----------
    meshed : MeshedShape
    twist : float
    sizes : Sizes
    """

    def __init__(self, meshed: MeshedShape, twist: float, sizes: Sizes) -> None:
        self.over = section_of(meshed, sizes, 0, twist)
        self.rho = sample_places(meshed.shape.profile, PLACES)
        self.at = joined(*(flank_points(self.over.mesh, self.rho, flank) for flank in ("left", "right")))
        self.teeth = np.arange(meshed.shape.reach + 1)
        self.place = FlankVariable((float(self.rho[0]), float(self.rho[-1])))

    def __call__(self, body: FacePieces, seen: FacePieces) -> tuple[Array, Array]:
        """Answers on the left and on the right flank (teeth, loads, psi, points, psi)."""
        on_flanks = answers(self.over, body, seen, self.at, self.teeth)
        left, right = slice(0, PLACES), slice(PLACES, None)
        return on_flanks[:, left, :, left], on_flanks[:, right, :, right]

    def tables(self, samples: Array) -> Mapping[int, Array]:
        """Coefficients of each tooth (places functions, places functions) from samples at the places."""
        by_place = np.linalg.inv(chebyshev.chebvander(self.place.unit(self.rho, hold=False), PLACES - 1))
        fitted = np.einsum("ai,bj,tipjq->tapbq", by_place, by_place, samples, optimize=True)
        size = fitted.shape[1] * fitted.shape[2]
        return dict(zip(self.teeth.tolist(), fitted.reshape(-1, size, size), strict=True))
