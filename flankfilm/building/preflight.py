"""What a scene would surely fail by, found before anything is solved: its geometry, its oil, its speeds."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

import gears.rating
from base import Fault, Faults, InputError
from flankfilm.building.face import faults_of_face, varies_by
from flankfilm.building.film import lubricant, roughness
from flankfilm.building.flanks import deviations
from flankfilm.building.followed_speeds import faults_of_ranges
from flankfilm.building.pair import pinion_speed, pinion_torque, supports, tip_roundings, warm_pair
from flankfilm.building.rating import rating_data, under_rating
from flankfilm.scene import Scene
from flankfilm.scene.needs import faults_between_sections
from flankfilm.scene.needs_of_helix import wants_load
from flankfilm.scene.sections.dynamics import DynamicsSection
from flankfilm.scene.sections.gears import GEARS
from flankfilm.scene.sections.ground import in_keys, under_keys
from flankfilm.scene.sections.section import required
from flankfilm.scene.wants import MOTIONS, RATED
from gears.pair.hertz import half_width

LEAST_SHARE = 0.5
"""Load of a pair at the pitch point, over that of pairs which share equally, that no pair there falls below."""

ROUNDING = 1e-12
"""Overlap of flanks that is rounding [modules]."""


def refuse(scene: Scene) -> None:
    """Refuse a scene with every fault that shows without solving.

    Raises
    ------
    InputError
        With all of them, each under the scene's key.
    """
    if between := faults_between_sections(scene.as_given):  # of a scene that no file was read for
        raise InputError(between)
    with Faults() as faults:
        pair = None
        if scene.pair is not None:
            faults.extend(_faults(lambda: warm_pair(scene)))
            if not faults.found:
                pair = warm_pair(scene).pair
                faults.extend(_faults(lambda: deviations(scene, pair, every_tooth=True)))
                for check in (_held, _pressed, _menisci, faults_of_face, _rated):
                    faults.extend(check(scene, pair))
        if scene.lubricant is not None:
            faults.extend(_faults(lambda: lubricant(scene)))
        if scene.roughness is not None:
            faults.extend(_faults(lambda: roughness(scene)))
        if scene.dynamics is not None and "diagram" in scene.wants:
            faults.extend(_undriven(scene.dynamics))
        if {*MOTIONS} & set(scene.wants) and not faults.found:
            faults.extend(faults_of_ranges(scene, pair))


def _faults(build: Callable[[], object]) -> tuple[Fault, ...]:
    """Faults of what is built."""
    try:
        build()
    except InputError as error:
        return error.faults
    return ()


def _rated(scene: Scene, pair: gears.GearPair) -> tuple[Fault, ...]:
    """Faults of a wanted rating, which is quicker than any estimate of it."""
    if RATED.isdisjoint(scene.wants):
        return ()

    def build() -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the run says them
            data = rating_data(scene, pair)
            with under_rating(scene):
                gears.rating.rate(pair, pinion_torque(scene), pinion_speed(scene), data)

    return _faults(build)


def _pressed(scene: Scene, pair: gears.GearPair) -> Iterator[Fault]:
    """Fault of a motion of teeth that are pressed together, whose back flanks it does not know."""
    asked = " and ".join(sorted({*MOTIONS} & set(scene.wants)))
    if not asked or pair.backlash >= -ROUNDING * pair.module:
        return
    section = required(scene.pair, "[pair]")
    key = "tight" if section.centre_distance_mm is None else "centre_distance_mm"
    value = "true" if key == "tight" else f"{section.centre_distance_mm:g}"
    allowed = (
        f"leaves an overlap of {-1e6 * pair.backlash:.4g} µm; the wanted {asked}, in which back flanks also touch, "
        "requires none"
    )
    remedy = "Give more backlash"
    if scene.heat is None:
        least = math.ceil(1e7 * pair.centre_distance_of_backlash(0.0)) / 1e4
        remedy = f"Take pair.centre_distance_mm = {least:.4f} or more"
    yield Fault(f"pair.{key}", value, allowed, f"{remedy}, or leave {asked} out of wants")


def _undriven(section: DynamicsSection) -> Iterator[Fault]:
    """Fault of an oscillator that nothing drives, which rests anywhere in the backlash."""
    if section.mean_force == 0.0 and not any(section.error_amplitude or ()):
        allowed = (
            "must not be 0 where error_amplitude is 0 too: nothing drives the motions of the wanted diagram"
        )
        yield Fault("dynamics.mean_force", "0", allowed, "Give mean_force, 0.1 is usual")


def _held(scene: Scene, pair: gears.GearPair) -> tuple[Fault, ...]:
    """Faults of hubs and tip edges that do not fit the gears, where finite elements have them."""
    if scene.stiffness.model == "given" or (pair.helix_angle and not wants_load(scene.wants)):
        return ()
    from fem.elasticity.support import held_profiles
    from fem.laws.mesh_setup import MeshSetup

    hubs = supports(scene)

    def build() -> None:
        with under_keys(scene.pair, "pair"):
            if hubs is not None:
                held_profiles(pair, hubs)

    edges = Faults()
    MeshSetup(pair, beyond_path=scene.tip_edges, tip_rounding=tip_roundings(scene)).check(edges)
    keys = {f"tip_rounding[{k}]": f"{gear}.tip_rounding_um" for k, gear in enumerate(GEARS)}
    rounded = (replace(fault, where=keys.get(fault.where, fault.where)) for fault in edges.found)
    return (*_faults(build), *(in_keys(fault, scene.pair, "pair") for fault in rounded))


def _menisci(scene: Scene, pair: gears.GearPair) -> Iterator[Fault]:
    """Fault of a meniscus that stands inside every dry contact at the pitch point, however the pairs share the load."""
    held, operating = scene.film.value("meniscus_mm"), scene.operating
    if held is None or operating is None or scene.lubricant is None or scene.film.model == "none":
        return
    load = abs(pair.normal_force(pinion_torque(scene))) / pair.face_width
    at_c = float(pair.path_at(pair.points.C).radius[0])
    largest = float(np.max(pair.path_of_contact(n=33).radius))
    surely = float(half_width(LEAST_SHARE * load / pair.contact_ratio, at_c, pair.reduced_modulus))
    if held <= surely:
        safely = math.ceil(1e5 * float(half_width(load, largest, pair.reduced_modulus)) + 1) / 1e2
        least = f"{1e3 * surely:.3g} mm"
        allowed = f"must be outside the dry contact, whose half-width at the pitch point is more than {least}"
        remedy = f"Nearer in no film forms: move it out to {safely:g} mm"
        remedy += "" if varies_by(scene) else ", or give meniscus_half_widths"
        yield Fault("film.meniscus_mm", f"{scene.film.meniscus_mm:g}", allowed, remedy)
