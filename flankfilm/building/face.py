"""What of a scene makes the load vary along the face, and what such a scene cannot have."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TypedDict

import gears
from base import Fault, Faults
from flankfilm.coupling.mesh.resolution import POSITIONS
from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.dynamics import BY_FILM
from flankfilm.scene.sections.gears import GEARS
from flankfilm.scene.sections.ground import in_keys
from flankfilm.scene.traits import given_keys, named

__all__ = ["even_along_face", "face", "faults_of_face", "varies_by"]


class FaceOptions(TypedDict, total=False):
    """Fields of `coupling.Flanks` that say how the face is looked at."""

    alignment: gears.Alignment | None
    cells: int | None
    face_model: str
    shafts: tuple[gears.Shaft | None, gears.Shaft | None] | None


def face(scene: Scene) -> FaceOptions:
    """How the face of a scene's pair is looked at; nothing where leads alone decide."""
    section, options = scene.alignment, FaceOptions()
    if section is not None:
        options = {
            "alignment": section.alignment(),
            "cells": section.cells,
            "face_model": section.face_model,
        }
    if (under := scene.shafts_under_face) is not None:
        options["shafts"] = under.shafts()
    return options


def even_along_face(pair: gears.GearPair) -> gears.GearPair:
    """The pair without leads and without overhangs."""
    return replace(pair, pinion=_even(pair.pinion), wheel=_even(pair.wheel))


def _even(gear: gears.Gear) -> gears.Gear:
    return replace(gear, lead=gears.Lead(), face_width=None, face_offset=0.0)


def varies_by(scene: Scene) -> list[str]:
    """Keys and sections of a scene by which the load varies along the face; empty where it is even."""
    whole = {
        f"pair.{name}.face_width_mm"
        for name in GEARS
        if scene.pair is not None and getattr(scene.pair, name).face_width_mm == scene.pair.face_width_mm
    }
    return [
        named(path)
        for path, about, value in given_keys(scene, Scene)
        if about.traits.along_face and value and path not in whole
    ]


def faults_of_face(scene: Scene, pair: gears.GearPair) -> Iterator[Fault]:
    """Faults of a face along which the load varies, and of what is not known with it."""
    by = " and ".join(varies_by(scene))
    if not by or scene.stiffness.model == "given":
        return
    yield from _of_setting(scene, pair)
    condition, drop = f"where the load varies along the face, by {by}", f"or drop {by}"
    yield from _of_films(scene, condition, drop)
    if scene.stiffness.plane != "strain":
        remedy = f'Take stiffness.plane = "strain", {drop}'
        yield Fault("stiffness.plane", f"{scene.stiffness.plane!r}", f'must be "strain" {condition}', remedy)


def _of_films(scene: Scene, condition: str, drop: str) -> Iterator[Fault]:
    """Faults of films that do not follow from place and line load alone, and of what has no films over the face."""
    if scene.film.meniscus_half_widths is not None:
        allowed = f"must be left out {condition}: every cell would hold the meniscus elsewhere"
        value = f"{scene.film.meniscus_half_widths:g}"
        yield Fault("film.meniscus_half_widths", value, allowed, f"Give meniscus_mm instead, {drop}")
    if scene.film.stiffness is not None:
        allowed = f"must be left out {condition}: films of cells have their own slope by the load"
        yield Fault("film.stiffness", f"{scene.film.stiffness!r}", allowed, f"Leave it out, {drop}")
    helical = scene.pair is not None and scene.pair.helical
    if scene.dynamics is not None and scene.dynamics.damping_ratio == BY_FILM and not helical:
        allowed = f"must be a number {condition}: the damping of films is that of even loads"
        yield Fault("dynamics.damping_ratio", "'film'", allowed, f"Give a number, {drop}")


def _of_setting(scene: Scene, pair: gears.GearPair) -> Iterator[Fault]:
    """Faults of cells, alignment and leads, each under its key."""
    from fem.pair.face_setting import FREE_ENDS, face_setting

    options, faults = face(scene), Faults()
    setting = face_setting(
        pair,
        options.get("alignment"),
        options.get("cells"),
        options.get("face_model", FREE_ENDS),
        options.get("shafts"),
    )
    if setting is not None:
        setting.check(faults, pair, POSITIONS)
    for fault in faults.found:
        if fault.where.endswith(".lead.topography"):
            at = fault.where.replace("lead.topography", "deviations.map.twist")
            remedy = 'Give "left-out", or drop [alignment] or the segments of [shafts]'
            yield replace(fault, where=f"pair.{at}", value="'kept'", remedy=remedy)
        elif fault.where in ("cells", "face_model"):
            yield in_keys(fault, scene.alignment, "alignment")
        else:
            yield in_keys(fault, scene.pair, "pair")
