"""Mean losses over a base pitch, from friction and rolling at places of the path."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

import gears
from base import Array
from flankfilm.coupling.losses.heated_films import HeatedFilms, thinned
from flankfilm.coupling.mesh.mesh_curves import MeshCycle


@dataclass(frozen=True)
class Borne:
    """What contacts, or cells of them, bear over a cycle.

    Attributes
    ----------
    rho1 : ndarray, shape (n,)
        Places [m].
    force : ndarray, shape (n,)
        [N]
    width : float or ndarray, shape (n,)
        Length of face, or of a line of contact, that each has [m].
    friction, rolling, first_part : ndarray, shape (n,)
        As of `Carried`.
    """

    rho1: Array
    force: Array
    width: float | Array
    friction: Array
    rolling: Array
    first_part: Array


class Known(Protocol):
    """Films that say what contacts of a cycle lose."""

    def borne(self, cycle: MeshCycle, face_width: float) -> Borne:
        """What the contacts of a cycle bear, with friction and rolling."""


@dataclass(frozen=True)
class Carried:
    """What films at places of the path give to the contacts between them, linear in the place.

    Attributes
    ----------
    rho1 : ndarray, shape (n,)
        Places [m], growing.
    friction : ndarray, shape (n,)
        Coefficient of friction.
    rolling : ndarray, shape (n,)
        Power lost by the oil's flow under its pressure [W/m].
    first_part : ndarray, shape (n,)
        Part of the heat that the pinion takes up.
    """

    rho1: Array
    friction: Array
    rolling: Array
    first_part: Array

    @classmethod
    def of(cls, films: HeatedFilms, ratios: Carried | None = None) -> Carried:
        """Read films, times ratios at other places."""
        carried = cls(films.rho1, films.friction, films.rolling, films.first_part)
        if ratios is None:
            return carried
        by = ratios.at(films.rho1)
        return replace(carried, friction=carried.friction * by.friction, rolling=carried.rolling * by.rolling)

    @classmethod
    def ones(cls, rho1: Array) -> Carried:
        """Ratios that change nothing."""
        unity = np.ones(rho1.size)
        return cls(rho1, unity, unity, unity)

    def over(self, other: Carried) -> Carried:
        """Ratios to what other films at the same places give; 1 where these give nothing."""

        def ratio(a: Array, b: Array) -> Array:
            return np.where(b == 0.0, 1.0, a / np.where(b == 0.0, 1.0, b))

        return replace(
            self,
            friction=ratio(self.friction, other.friction),
            rolling=ratio(self.rolling, other.rolling),
            first_part=np.ones(self.rho1.size),
        )

    def thinned_to(self, most: int) -> Carried:
        """Give so many places at most, the first and the last as well."""
        kept = thinned(self.rho1.size, most)
        return Carried(self.rho1[kept], self.friction[kept], self.rolling[kept], self.first_part[kept])

    def at(self, rho1: Array) -> Carried:
        """Carry to other places."""
        values = (
            np.interp(rho1, self.rho1, figure) for figure in (self.friction, self.rolling, self.first_part)
        )
        return Carried(rho1, *values)

    def borne(self, cycle: MeshCycle, face_width: float) -> Borne:
        """What the contacts of a cycle bear, whose load is even along the face."""
        touching = np.isfinite(cycle.rho1) & (cycle.forces > 0.0)
        here = self.at(cycle.rho1[touching])
        return Borne(
            here.rho1, cycle.forces[touching], face_width, here.friction, here.rolling, here.first_part
        )


@dataclass(frozen=True)
class Means:
    """Means over one base pitch [W], and what follows from them."""

    friction: float
    sliding_loss: float
    rolling_loss: float
    edge_loss: float
    loss_factor: float
    heat: Array

    @property
    def mesh_loss(self) -> float:
        """Power lost in all ways [W]."""
        return self.sliding_loss + self.rolling_loss + self.edge_loss

    def off(self, other: Means) -> float:
        """Relative difference of the power lost from that of others; zero where these lose none."""
        return abs(self.mesh_loss / other.mesh_loss - 1.0) if other.mesh_loss else 0.0


def means_of(pair: gears.GearPair, cycle: MeshCycle, speed: float, power: float, known: Known) -> Means:
    """Average over the positions of a cycle.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
        Forces at places of the path; tip edges as well where it has them.
    speed : float
        Of the pinion [rad/s].
    power : float
        Put in [W].
    known : Known
        Friction and rolling.
    """
    positions, here = cycle.position.size, known.borne(cycle, pair.face_width)
    slid = here.force * np.abs(pair.path_at(here.rho1).sliding(speed))
    lost = here.friction * slid
    rolled = here.width * here.rolling
    total_slid = float(slid.sum())
    friction = float(lost.sum()) / total_slid if total_slid else 0.0
    edges = _edges(cycle, speed)
    first = float(np.sum(here.first_part * (lost + rolled)) / positions)
    on_path = float(np.sum(lost + rolled) / positions)
    first += 0.5 * friction * edges
    return Means(
        friction=friction,
        sliding_loss=float(lost.sum()) / positions,
        rolling_loss=float(rolled.sum()) / positions,
        edge_loss=friction * edges,
        loss_factor=(total_slid / positions + edges) / power,
        heat=np.array([first, on_path + friction * edges - first]),
    )


def _edges(cycle: MeshCycle, speed: float) -> float:
    """Mean force times sliding speed of tip edges outside the path [W]."""
    contact = cycle.contact
    if contact is None:
        return 0.0
    if contact.lines is not None:
        return float(np.mean(contact.edge_sliding(speed)))
    pressed = contact.edge & (contact.forces > 0.0)
    slips = np.abs(contact.sliding(speed))
    return float(np.sum(np.where(pressed, contact.forces * slips, 0.0))) / cycle.position.size
