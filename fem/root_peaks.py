"""The greatest stress on the fillets of a cycle: between samples of a fillet and between nodes of the cycle's arcs."""

from __future__ import annotations

import numpy as np

from base import Array, Integers, quantity, record
from fem.elasticity import MIRROR
from fem.fillet_influence import FilletInfluence
from gears.arcs import Arcs

__all__ = ["LOADED", "OTHER", "RootNodes", "RootPeak", "extreme", "peak_of"]

LOADED, OTHER = 0, 1
"""Fillet under the loaded flank, in tension when its tooth bears, and the one on the other side."""


@record
class RootPeak:
    """The greatest stress of a cycle and where it acts."""

    headline = ("stress_Pa", "position")

    stress_Pa: float = quantity(
        "Pa", "principal stress along the fillet, negative in compression", shown="MPa"
    )
    von_mises_Pa: float = quantity("Pa", "von Mises stress", shown="MPa")
    tooth: int = quantity("1", "base pitches that the tooth is ahead of the pair that entered last")
    position: float = quantity("1", "base pitches since the tooth's pair passed A")
    arc: float = quantity("m", "arc length from the middle of the gap between two teeth", shown="mm")
    tangent_angle: float = quantity("rad", "angle between the fillet's tangent and the tooth's centre line")
    point: Array = quantity(
        "m",
        "place in the tooth's frame, centre line along +y, the loaded flank on the left",
        "axis",
        shown="mm",
    )
    along_Pa: Array = quantity("Pa", "stress along that fillet at that instant", "sample", shown="MPa")
    sampling: float = quantity("1", "estimated relative error by what is greater between the instants")
    forces: float = quantity(
        "1", "estimated relative error by the forces, from those of the mesh before the last refinement"
    )


@record
class RootNodes:
    """Stress at all nodes of a cycle's arcs (n, teeth, 2, samples), and with the forces of the mesh before."""

    arcs: Arcs
    position: Array
    teeth: Integers
    stress: Array
    before: Array
    gain: float


def peak_of(nodes: RootNodes, influence: FilletInfluence, side: int) -> RootPeak:
    """Greatest stress on one side of all teeth, and what is missed between the nodes."""
    line, law, sign = influence.line, influence.law, 1.0 if side == LOADED else -1.0
    most, arc = extreme(line.arc, sign * nodes.stress[:, :, side])
    coarse, _ = extreme(line.arc, sign * nodes.before[:, :, side])
    ends = np.cumsum([len(one.position) for one in nodes.arcs.arcs])[:-1]
    row, column = np.unravel_index(np.argmax(most), most.shape)
    value, place = float(most[row, column]), float(arc[row, column])
    greatest, error = nodes.arcs.with_curves("tooth", np.split(most, ends)).greatest_of_all()
    nu = law.nu if law.plane == "strain" else 0.0
    point = np.array([np.interp(place, line.arc, line.points[:, axis]) for axis in (0, 1)])
    return RootPeak(
        sign * value,
        float(np.sqrt(1 - nu + nu**2)) * value,
        int(nodes.teeth[column]),
        float(nodes.position[row] + nodes.teeth[column]),
        place,
        float(np.interp(place, line.arc, line.tangent_angle)),
        point * MIRROR if side == LOADED else point,
        nodes.stress[row, column, side],
        (greatest + error) / value - 1.0,
        abs(float(coarse.max()) / value - 1.0) / nodes.gain,
    )


def extreme(arc: Array, values: Array) -> tuple[Array, Array]:
    """Maximum over the last axis and its place, by the parabola through the three highest samples."""
    step = arc[1] - arc[0]
    top = np.clip(np.argmax(values, axis=-1), 1, len(arc) - 2)[..., None]
    before, here, after = (np.take_along_axis(values, top + k, axis=-1)[..., 0] for k in (-1, 0, 1))
    bend = before - 2 * here + after
    shift = np.where(bend < 0, 0.5 * (before - after) / np.where(bend < 0, bend, -1.0), 0.0)
    shift = np.clip(shift, -1.0, 1.0)
    highest = here + 0.5 * shift * (after - before) + 0.5 * bend * shift**2
    return np.asarray(highest), np.asarray(arc[top[..., 0]] + shift * step)
