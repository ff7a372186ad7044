"""Answers of the loaded contact: curves over the mesh cycle at once, then means and extremes with their errors."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import fem
from base.results import figures
from fem.influence.memo import Memo
from flankfilm import coupling
from flankfilm.app.answers import GEARS, Answer, answers_of
from flankfilm.coupling.mesh.resolution import POSITIONS
from flankfilm.products import root_stress
from flankfilm.report import stiffness_parts
from flankfilm.report.text import percent
from flankfilm.scene import Scene
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import COMPLIANCE, FACE_GEARS, PAIR, PLAN, along_the_face, loaded_teeth

__all__ = [
    "Curve",
    "KnownGears",
    "answerable",
    "curves",
    "figures_of",
    "has_roots",
    "roots",
    "solve_gears",
    "solved",
]

PAIRS = 4
"""Pairs whose compliance is kept."""

UNKNOWN = "error unknown"


@dataclass(frozen=True)
class Curve:
    """A curve over the mesh cycle.

    Attributes
    ----------
    name, label, unit : str
    lines : tuple of tuple of float or None
        One for the mesh, or one for each pair; None where a pair does not touch.
    error : str
        How far values may be off.
    of : tuple of str
        Names of the lines, where they are not pairs of teeth.
    """

    name: str
    label: str
    unit: str
    lines: tuple[tuple[float | None, ...], ...]
    error: str
    of: tuple[str, ...] = ()


def answerable(scene: Scene) -> str:
    """Why a scene has no loaded contact; empty where it has one.

    Examples
    --------
    >>> from flankfilm.scene import parse_scene, template
    >>> answerable(parse_scene(template()))
    ''
    """
    if scene.pair is None:
        return "The scene has no pair."
    if scene.operating is None:
        return "The scene has no load: give [operating]."
    if scene.stiffness.model == "given":
        return "The stiffness is given: there is no contact to solve."
    if not scene.operating.pinion_torque_Nm:
        return "The torque is 0."
    return ""


def solve_gears(engine: Engine) -> None:
    """Have the gears solved, in the process and the cache, as contacts need them.

    Parameters
    ----------
    engine : Engine
        Of a scene that has a loaded contact.
    """
    if engine[PLAN].stiffness.choice == "fem":
        _ = engine[COMPLIANCE]
        if along_the_face(engine.scene):
            _ = engine[FACE_GEARS]


class KnownGears:
    """Compliances of the last pairs, each as the very record with which laws of tip corners are kept."""

    def __init__(self) -> None:
        self._kept: Memo[fem.PairCompliance] = Memo(PAIRS)

    def teeth(self, engine: Engine) -> coupling.LoadedTeeth:
        """Pair under the scene's torque; its compliance is that of an earlier scene with the same gears."""
        teeth = loaded_teeth(engine)
        if (compliance := teeth.compliance) is None:
            return teeth
        key = json.dumps(engine.inputs(COMPLIANCE), sort_keys=True)
        return replace(teeth, compliance=self._kept.obtain(key, lambda: compliance))


def solved(engine: Engine, known: KnownGears) -> coupling.MeshCycle:
    """Dry mesh cycle at the positions of a run, without the events between them, which take four times as long.

    Parameters
    ----------
    engine : Engine
        Of a scene that has a loaded contact.
    known : KnownGears
        Gears that were solved before; changed.

    Raises
    ------
    SolverError
        Where the contact has no solution.
    """
    asked = engine[PLAN].resolution
    return known.teeth(engine).cycle(POSITIONS, tolerance=min(asked.sampling, asked.transmission_error))


def curves(cycle: coupling.MeshCycle, face_width: float) -> tuple[Curve, ...]:
    """Transmission error, stiffness, load share and pressure over one base pitch: numbers of a run's curves.

    Parameters
    ----------
    cycle : coupling.MeshCycle
    face_width : float
        [m].
    """
    return tuple(_curves(cycle, face_width))


def figures_of(cycle: coupling.MeshCycle, face_width: float, tolerance: float) -> tuple[Answer, ...]:
    """Means and extremes of a mesh cycle, each with its error; events between the positions are located for them.

    Parameters
    ----------
    cycle : coupling.MeshCycle
    face_width : float
        [m].
    tolerance : float
        Relative, by which figures are marked that miss it.

    Raises
    ------
    SolverError
        Where the contact has no solution between the positions.
    """
    shown = stiffness_parts.headlines(cycle, face_width)
    if cycle.contact is not None:
        shown += stiffness_parts.pressure_headlines(cycle.contact, None)
    against = [headline.against(tolerance) for headline in shown]
    return tuple(answers_of("Loaded contact, without film", against))


def has_roots(engine: Engine) -> bool:
    """Whether the stress at the roots follows in parts of a second: of spur gears by finite elements, loaded evenly.

    Parameters
    ----------
    engine : Engine
        Of a scene that has a loaded contact.
    """
    pair = engine.scene.pair
    helical = pair is not None and pair.helical
    return engine[PLAN].stiffness.choice == "fem" and not helical and not along_the_face(engine.scene)


def roots(engine: Engine, cycle: coupling.MeshCycle) -> tuple[Curve, tuple[Answer, ...]]:
    """Largest principal stress in the fillets of both gears over one base pitch, and its maxima with their errors.

    Parameters
    ----------
    engine : Engine
        That `has_roots`.
    cycle : coupling.MeshCycle
        Of `solved`.

    Raises
    ------
    SolverError
        Where the contact has no solution between the positions.
    """
    assert cycle.contact is not None
    stresses = coupling.root_stresses(engine[PAIR], cycle.contact, engine[root_stress.FILLETS])
    largest = (stresses.stress.pinion, stresses.stress.wheel)
    lines = tuple(_lines(1e-6 * np.max(gear.tension_Pa, axis=1))[0] for gear in largest)
    error = f"± {percent(stresses.error)}"
    curve = Curve("root_tension", "maximum root tension, of all teeth", "MPa", lines, error, GEARS)
    tolerance = engine.scene.tolerance
    headlines = [headline.against(tolerance) for headline in root_stress.headlines(stresses)]
    return curve, tuple(answers_of("Root stress, without film", headlines))


def _curves(cycle: coupling.MeshCycle, face_width: float) -> Iterator[Curve]:
    """Curves of a dry mesh cycle in the units that people read."""
    error = UNKNOWN if cycle.error is None else f"± {percent(cycle.error)}"
    lag = figures(type(cycle))["transmission_error"]
    lines = _lines(lag.in_shown(cycle.transmission_error))
    yield Curve("transmission_error", "transmission error", lag.read_in, lines, error)
    per_face = 1e-9 / face_width
    for name, kind in (("stiffness", "tangent"), ("secant_stiffness", "secant")):
        values = per_face * getattr(cycle, name)
        yield Curve(name, f"mesh stiffness ({kind})", "N/(mm um)", _lines(values), error)
    share = np.where(cycle.forces > 0.0, cycle.load_share, math.nan)
    yield Curve("load_share", "load share of each pair", "", _lines(share), error)
    if cycle.contact is not None:
        pressure = np.where(cycle.contact.hertz_pressure > 0.0, cycle.contact.hertz_pressure, math.nan)
        yield Curve("hertz_pressure", "Hertz pressure of each pair", "MPa", _lines(1e-6 * pressure), UNKNOWN)
        factors = getattr(cycle.contact, "face_load_factor", None)
        if factors is not None:
            yield Curve("face_load_factor", "face load factor", "", _lines(np.asarray(factors)), UNKNOWN)


def _lines(values: Any) -> tuple[tuple[float | None, ...], ...]:
    """Lines of an array over positions, and pairs where it has them; those without any value are left out."""
    columns = np.atleast_2d(np.asarray(values, dtype=float).T)
    lines = (tuple(float(v) if math.isfinite(v) else None for v in column) for column in columns)
    return tuple(line for line in lines if any(v is not None for v in line))
