"""The maximum stress on the fillets of a cycle: between samples of a fillet and between nodes of the cycle's arcs."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, quantity, record
from base.results import ITSELF
from fem.elasticity.fillet import FilletLine
from gears.sharing.arc_series import OVERSHOOT, left_out, to_series
from gears.sharing.arcs import Arcs

__all__ = ["LOADED", "OTHER", "SIGNS", "Greatest", "RootNodes", "RootPeak", "extreme"]

LOADED, OTHER = 0, 1
"""Fillet under the loaded flank, in tension when its tooth bears, and the one on the other side."""

SIGNS = {LOADED: 1.0, OTHER: -1.0}

FINER = 4
"""Points between the nodes of an arc, of which the largest has a parabola through its neighbours."""


@record
class RootPeak:
    """The maximum stress of a cycle and where it acts."""

    no_error = "not estimated by itself; the maximum stress has an error"

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
    sampling: float = quantity(
        "1", "estimated relative error from higher values between the instants", no_error=ITSELF
    )
    forces: float = quantity(
        "1",
        "estimated relative error by the forces, from those of the mesh before the last refinement",
        no_error=ITSELF,
    )
    face_position: float = quantity(
        "m",
        "place along the face, 0 at the middle of the face in contact; nan of loads that are even along it",
        shown="mm",
        default=float("nan"),
    )


@record
class RootNodes:
    """Stress at all nodes of a cycle's arcs, one after the other (n, teeth, 2, samples), and their positions (n,)."""

    arcs: Arcs
    position: Array
    stress: Array

    def greatest(self, line: FilletLine, side: int) -> Greatest:
        """Maximum stress on one side of all teeth, on the series through the stress at every sample and arc.

        Between nodes only arcs and teeth are looked at on which it may be: by as much as the stress changes there.
        """
        ends, candidates = np.cumsum([len(piece.position) for piece in self.arcs.arcs])[:-1], []
        positions, stress = (
            np.split(self.position, ends),
            np.split(SIGNS[side] * self.stress[:, :, side], ends),
        )
        nodes = [extreme(line.arc, of_arc)[0] for of_arc in stress]
        most = max(float(of_arc.max()) for of_arc in nodes)
        for arc, position, here, values in zip(self.arcs.arcs, positions, stress, nodes, strict=True):
            for tooth in np.flatnonzero(2.0 * values.max(axis=0) - values.min(axis=0) >= most).tolist():
                value, off, unit, along = _on_arc(here[:, tooth], line.arc, arc.crowded)
                at = float(np.interp(arc.place(np.array(unit)), arc.position, position))
                candidates.append(Greatest(value, off, tooth, at, along))
        best = max(candidates, key=lambda candidate: candidate.value)
        above, below = (
            max(candidate.value + sign * candidate.off for candidate in candidates) for sign in (1.0, -1.0)
        )
        return replace(best, off=max(above - best.value, best.value - below))


@dataclass(frozen=True)
class Greatest:
    """Maximum stress, or smallest with its sign turned; its error between nodes; tooth, position and fillet there."""

    value: float
    off: float
    tooth: int
    position: float
    along: Array


def _on_arc(stress: Array, samples: Array, crowded: bool) -> tuple[float, float, float, Array]:
    """Largest on an arc of one tooth (nodes, samples): its error, the argument of the series, the stress there."""
    degree = len(stress) - 1
    angle = np.linspace(0.0, np.pi, FINER * degree + 1)
    series = to_series(degree) @ stress
    values = extreme(samples, chebyshev.chebvander(-np.cos(angle), degree) @ series)[0]
    top = int(np.argmax(values))
    if top in (0, len(values) - 1):  # ends of arcs are nodes, which are exact
        along = stress[-1 if top else 0]
        return float(extreme(samples, along)[0]), 0.0, 1.0 if top else -1.0, along
    unit = np.array([-np.cos(extreme(angle, values)[1])])
    along = (chebyshev.chebvander(unit, degree) @ series)[0]
    value, beyond = float(extreme(samples, along)[0]), float(values.max() - values[::FINER].max())
    off = np.linalg.norm(left_out(series[:, np.argmax(along)], unit, np.ones(1), crowded))
    return value, min(float(off), OVERSHOOT * max(beyond, 0.0)), float(unit[0]), along


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
