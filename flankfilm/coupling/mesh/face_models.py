"""The load over the face by other models beside the one that counts: walls, slices, ISO 6336-1 method C."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import fem
import gears
from base import Array, Cost, InputError, Stopwatch, described, part, quantity, record
from base.results import EXACT, ITSELF
from fem.pair.face_setting import FREE_ENDS, SLICES, WALLS
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.coupling.mesh.require_converged import believed
from gears.tooth.errors import GeometryError

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth

__all__ = ["FaceLoadModels", "face_load_models", "left_out_by_iso"]

LABELS = {FREE_ENDS: "free ends", WALLS: "between walls", SLICES: "independent slices"}
ISO = "ISO 6336-1, method C"

UNKNOWN = "unknown of slices and of ISO 6336-1; face_load_factor_error is numerical"


@record
class FaceLoadModels:
    """Load over the face by several models of what couples its cells, the one that counts first.

    ISO 6336-1 has one pair under the whole torque, and a line load that is linear over the face: its mean here is that
    of the pair at the pitch point. It counts slopes and alignment in the plane of action alone; the standard's factors
    for modified leads (B_1, B_2, guide values of crowning and end relief in Annex B) are for amounts that follow
    from tolerances, not for given ones. What of a pair it so leaves out is named.
    """

    no_error = UNKNOWN
    headline = ("face_load_factor",)

    model: tuple[str, ...] = quantity("", "model of what couples the cells of the face", "model")
    face_load_factor: Array = quantity(
        "1", "face-load factor, maximum over the mesh cycle", "model", error="face_load_factor_error"
    )
    face_load_factor_error: Array = quantity(
        "1",
        "estimated relative numerical error of the maximum face-load factor; nan of ISO 6336-1",
        "model",
        no_error=ITSELF,
    )
    pitch_point_factor: Array = quantity(
        "1", "face-load factor with a pair at the pitch point", "model", error="face_load_factor_error"
    )
    greatest_line_load: Array = quantity(
        "N/m", "maximum line load over the mesh cycle; nan of ISO 6336-1", "model", shown="N/mm"
    )
    line_load_difference: Array = quantity(
        "1",
        "root mean square over the face of what the line load at the pitch point differs by from the first model, over "
        "the mean",
        "model",
        shown="%",
    )
    face_position: Array = quantity(
        "m", "middles of the cells, 0 at mid-face", "cell", shown="mm", no_error=EXACT
    )
    line_load: Array = quantity("N/m", "line load of the pair at the pitch point", "model cell", shown="N/mm")
    misalignment: float = quantity(
        "m",
        "slopes of leads and alignment in the plane of action together, over the face",
        shown="um",
        no_error=EXACT,
    )
    iso_fault: str = part("why ISO 6336-1 has no answer; empty where it has one")
    iso_left_out: str = quantity(
        "", "what varies the load along this face and is not in the factor by ISO 6336-1"
    )
    cost: Cost

    @described("1", "model", shown="%")
    def factor_difference(self) -> Array:
        """Face-load factor at the pitch point over that by the first model, less one."""
        return np.asarray(self.pitch_point_factor / self.pitch_point_factor[0] - 1.0)


def face_load_models(teeth: LoadedTeeth, cycle: MeshCycle) -> FaceLoadModels:
    """Compare the load over the face with that by walls, slices and ISO 6336-1.

    Parameters
    ----------
    teeth : LoadedTeeth
        With a lead, an alignment or cells.
    cycle : MeshCycle
        Of these, by finite elements.

    Raises
    ------
    InputError
        For a cycle without cells of the face.

    Examples
    --------
    >>> import fem, gears
    >>> from flankfilm.coupling import Flanks, LoadedTeeth, face_load_models
    >>> pair = gears.GearPair(gears.Gear(20), gears.Gear(30), module=2e-3, face_width=20e-3)
    >>> flanks = Flanks(alignment=gears.Alignment(30e-6), cells=8, face_model="walls")
    >>> teeth = LoadedTeeth(pair, 50.0, compliance=fem.compliance(pair, tolerance=0.05), flanks=flanks)
    >>> found = face_load_models(teeth, teeth.cycle(8))
    >>> found.model
    ('between walls', 'independent slices', 'ISO 6336-1, method C')
    >>> walls, slices = found.pitch_point_factor[:2]
    >>> bool(slices < walls)
    True
    """
    watch, own = Stopwatch(), None if cycle.contact is None else cycle.contact.face
    if cycle.contact is None or own is None:
        remedy = "give an alignment, cells, or gears with a lead"
        raise InputError.at("cycle", cycle.label, "must have cells of the face", remedy)
    named = list(dict.fromkeys((own.setting.model, WALLS, SLICES)))
    others = [_by(teeth, model, len(cycle.position)) for model in named[1:]]
    faces = [own, *(other.face for other in others if other.face is not None)]
    at = _at_pitch_point(cycle.contact)
    loads = [face.line_load[at] for face in faces]
    slope = own.setting.slope
    factor, fault = _iso(teeth, abs(slope))
    loads.append(_linear(loads[0].mean(), factor, -np.sign(slope), own.face_position / teeth.pair.face_width))
    first = loads[0]
    return FaceLoadModels(
        model=(*(LABELS[name] for name in named), ISO),
        face_load_factor=np.array(
            [*(distribution.greatest_face_load_factor for distribution in faces), factor]
        ),
        face_load_factor_error=np.array([*(distribution.error for distribution in faces), np.nan]),
        pitch_point_factor=np.array([*(load.max() / load.mean() for load in loads[:-1]), factor]),
        greatest_line_load=np.array([*(distribution.greatest_line_load for distribution in faces), np.nan]),
        line_load_difference=np.array(
            [float(np.sqrt(np.mean((load - first) ** 2)) / first.mean()) for load in loads]
        ),
        face_position=own.face_position,
        line_load=np.array(loads),
        misalignment=float(slope),
        iso_fault=fault,
        iso_left_out=left_out_by_iso(own, teeth.pair),
        cost=Cost(watch.seconds),
    )


def _by(teeth: LoadedTeeth, model: str, positions: int) -> fem.MeshCycle:
    """Loaded contact with another coupling of the cells."""
    other = replace(teeth, flanks=replace(teeth.flanks, face_model=model))
    cycle = fem.mesh_cycle(other.pair, other.torque, positions=positions, **other.setting)
    return believed(cycle, f"loaded tooth contact, {LABELS[model]}")


def _at_pitch_point(contact: fem.MeshCycle) -> tuple[int, int]:
    """Position and pair whose contact is the nearest to the pitch point, of those that bear."""
    away = np.where(contact.forces > 0.0, np.abs(contact.rho1 - contact.pair.points.C), np.inf)
    position, pair = np.unravel_index(np.nanargmin(away), away.shape)
    return int(position), int(pair)


def _iso(teeth: LoadedTeeth, misalignment: float) -> tuple[float, str]:
    """Factor by ISO 6336-1, and why it has none."""
    try:
        factors = gears.closed_form.iso6336_face_load(teeth.pair, abs(teeth.torque), misalignment)
    except GeometryError as error:
        return float("nan"), str(error)
    return factors.K_Hbeta, ""


def left_out_by_iso(face: fem.FaceLoads, pair: gears.GearPair) -> str:
    """What varies the load along a face and is not in the factors by ISO 6336-1, by name.

    Parameters
    ----------
    face : fem.FaceLoads
    pair : gears.GearPair
    """
    return ", ".join(_left_out(face, pair))


def _left_out(face: fem.FaceLoads, pair: gears.GearPair) -> Iterator[str]:
    """What of a face no slope shows, by name."""
    setting = face.setting
    for name, lead in zip(("pinion", "wheel"), setting.leads, strict=True):
        if lead.crowning:
            yield f"crowning of the {name}"
        if lead.end_relief:
            yield f"end relief of the {name}"
        if lead.trace is not None:
            yield f"measured lead of the {name}"
        if lead.twist:
            yield f"flank twist of the {name}"
        if lead.topography is not None:
            yield f"topography of the {name}"
    if setting.alignment.out_of_plane:
        yield "alignment across the plane of action"
    if any(shaft is not None for shaft in setting.shafts):
        yield "bending and twist of the shafts under the load"
    if pair.face_widths != (pair.face_width, pair.face_width):
        yield "what overhangs bear"
    yield "free ends of the face"
    yield "running in"


def _linear(mean: float, factor: float, side: float, x: Array) -> Array:
    """Line load as ISO 6336-1 has it over x = z/b, -1/2 to 1/2: linear, over a part of the face above a factor of 2."""
    if not factor > 1.0:
        return np.full_like(x, mean * factor)
    from_end = 0.5 - side * x  # 0 where most load is
    slope = 2.0 * (factor - 1.0) if factor <= 2.0 else 0.5 * factor**2
    return np.asarray(mean * np.maximum(factor - slope * from_end, 0.0))
