"""The stages of a rating: by standards, and by our own factors where the run has what they need."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

import gears.rating
from flankfilm import coupling
from flankfilm.building.pair import pinion_speed, pinion_torque
from flankfilm.building.rating import mean_roughness, rating_data, under_rating
from flankfilm.scene import Scene
from flankfilm.scene.wants import BY_FINITE_ELEMENTS, FILMS, MESHED, MOTIONS
from flankfilm.stages.drives import DRIVE, moving
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.losses import LOSSES
from flankfilm.stages.mesh import (
    COMPLIANCE,
    DRY_CYCLE,
    FACE_GEARS,
    FILM,
    PAIR,
    PLAN,
    TEETH,
    TEETH_DECIDED,
    loaded_teeth,
    measured,
)
from flankfilm.stages.motion import SCALING

LOADED = MESHED | BY_FINITE_ELEMENTS | {*FILMS}
"""Wants whose runs have the loaded contact."""


FLANKS = frozenset({"film", "losses"})
"""Wants whose runs have our own films."""


@stage("rating", "rating by ISO 6336", "operating rating lubricant roughness", PAIR)
def RATING(run: Engine) -> gears.rating.Rating:
    """Safeties by standards, with every factor."""
    scene, pair = run.scene, run[PAIR]
    data = rating_data(scene, pair)
    with under_rating(scene):
        return gears.rating.rate(pair, pinion_torque(scene), pinion_speed(scene), data)


@stage(
    "unequal pitches",
    "loaded contact with base pitches that differ",
    f"{TEETH} stiffness.contact_beyond_path",
    PAIR,
    RATING,
    COMPLIANCE,
    FACE_GEARS,
    DRY_CYCLE,
    settings=TEETH_DECIDED,
)
def UNEQUAL_PITCHES(run: Engine) -> coupling.UnequalPitches:
    """Mesh cycles without film, of base pitches that differ by the deviation of the rating, both ways.

    Lines of contact of helical pairs go on over tip edges here unless the scene holds them to the path: held to it, as
    the rest of a run does where nothing is said, a line begins with its whole approach in a corner of the face, and
    carries what no tooth does.
    """
    deviation, teeth, even = run[RATING].factors.effective.f_pb_eff, loaded_teeth(run), run[DRY_CYCLE]
    if run[PAIR].helix_angle != 0.0 and run.scene.stiffness.contact_beyond_path is None:
        teeth = replace(teeth, flanks=replace(teeth.flanks, beyond_path=True))
        even = teeth.cycle(even.position.size)
    return coupling.unequal_pitches(teeth, measured(run, even), deviation)


@stage(
    "laws of the contact",
    "forces of the loaded contact over position and deflection",
    TEETH,
    RATING,
    COMPLIANCE,
    FACE_GEARS,
    DRY_CYCLE,
    settings=TEETH_DECIDED,
)
def CONTACT_LAWS(run: Engine) -> coupling.ContactLaws:
    """Laws of the contact without film, of equal base pitches and of those that differ both ways."""
    deviation = run[RATING].factors.effective.f_pb_eff
    return coupling.contact_laws(loaded_teeth(run), measured(run, run[DRY_CYCLE]), deviation)


@stage(
    "motion factor",
    "dynamic factor of the motion",
    "operating dynamics wants",
    RATING,
    SCALING,
    DRIVE,
    CONTACT_LAWS,
    kept="gears meshes fem dynamics flankfilm",
)
def MOTION_FACTOR(run: Engine) -> coupling.MotionFactor:
    """Dynamic factor of the motion with the base pitch deviation of the rating; also over a wanted sweep."""
    section, motion = run.scene.dynamics, moving(run)
    deviation = run[RATING].factors.effective.f_pb_eff
    speeds = None
    if section is not None and section.sweep is not None and "sweep" in run.scene.wants:
        asked = section.sweep
        values = np.linspace(*asked.ends, asked.points)
        assert motion.scales is not None
        by_frequency = asked.frequency is not None
        unit = motion.scales.speed(1.0) if by_frequency else math.pi / 30.0
        speeds = unit * values
    laws = run[CONTACT_LAWS] if has_contact(run) else None
    return coupling.motion_factor(motion, pinion_speed(run.scene), deviation, speeds, laws)


@stage("loaded factors", "load factors of the loaded contact", "", PAIR, DRY_CYCLE, UNEQUAL_PITCHES)
def LOADED_FACTORS(run: Engine) -> coupling.LoadedFactors:
    """Face-load and transverse load factors of the mesh cycles without film, with the base pitch deviation."""
    pitches = run[UNEQUAL_PITCHES]
    return coupling.loaded_factors(pitches.even if run[PAIR].helix_angle != 0.0 else run[DRY_CYCLE], pitches)


@stage(
    "own contact",
    "temperature and film of the flanks beside the standard's",
    "rating roughness wants",
    RATING,
    LOSSES,
    FILM,
)
def OWN_CONTACT(run: Engine) -> coupling.OwnContact:
    """Flanks by the films that are wanted."""
    scene = run.scene
    losses = run[LOSSES] if "losses" in scene.wants else None
    film = run[FILM] if losses is None else None
    return coupling.own_contact(
        run[RATING], mean_roughness(rating_data(scene, run[PAIR])), losses=losses, film=film
    )


def has_motion(scene: Scene) -> bool:
    """Whether a run of a scene has a motion in physical units, of a driving pinion."""
    moves = (
        bool({*MOTIONS} & {*scene.wants}) and scene.dynamics is not None and not scene.dynamics.dimensionless
    )
    return moves and scene.operating is not None and scene.operating.pinion_torque_Nm > 0.0


def has_contact(run: Engine) -> bool:
    """Whether a run has the loaded contact of coupled finite elements."""
    scene = run.scene
    if (
        LOADED.isdisjoint(scene.wants)
        or scene.stiffness.model == "given"
        or scene.stiffness.pairs != "coupled"
    ):
        return False
    return run[PLAN].stiffness.choice == "fem"


def own_factors(run: Engine) -> dict[str, Any]:
    """Factors that the run has, as arguments of `coupling.own_rating`; none where it has none."""
    factors: dict[str, Any] = {}
    if has_motion(run.scene):
        factors["motion"] = run[MOTION_FACTOR]
    if has_contact(run):
        factors["loaded"] = run[LOADED_FACTORS]
    if not FLANKS.isdisjoint(run.scene.wants):
        factors["flanks"] = run[OWN_CONTACT]
    return factors
