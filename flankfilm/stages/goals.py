"""Which stages the wanted outputs of a scene ask for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from flankfilm.building.face import varies_by
from flankfilm.scene import Scene, needs
from flankfilm.scene.sections.dynamics import BY_FILM
from flankfilm.stages import losses, motion
from flankfilm.stages import mesh as of
from flankfilm.stages.damping import FILM_DAMPING
from flankfilm.stages.drives import DRIVE, DRIVE_SWEEP
from flankfilm.stages.engine import Stage
from flankfilm.stages.excitation import EXCITATION
from flankfilm.stages.face import FACE_MODELS
from flankfilm.stages.speeds import DIAGRAM, DYNAMIC_MAP, RUN_UP, SPECTRUM


def goals(scene: Scene) -> tuple[Stage[Any], ...]:
    """Stages that the scene's wants ask for; those that these need follow by themselves."""
    return tuple(dict.fromkeys(_goals(scene, set(scene.wants), scene.stiffness.model == "given")))


def _goals(scene: Scene, wants: set[str], given_stiffness: bool) -> Iterator[Stage[Any]]:
    if "geometry" in wants:
        yield of.PAIR
    if scene.heat is not None and scene.pair is not None:
        yield of.HEAT
    if "closed-forms" in wants or ({"report", "stiffness"} <= wants and not given_stiffness):
        yield of.CLOSED_FORMS
    if wants & {"stiffness", "film"} and not given_stiffness:
        over_face = bool(varies_by(scene))
        yield from (of.PLAN, *((of.FACE_GEARS,) if over_face else ()), of.DRY_CYCLE, of.REFERENCES)
        if over_face:
            yield FACE_MODELS
        if wants & {"closed-forms", "report"}:
            yield of.OTHER_CYCLES
        if scene.film.model != "none" or "film" in wants:
            yield of.MESH
    if "film" in wants and not given_stiffness and scene.film.asked_heat != "off":
        yield losses.HOT_FILM
    if "losses" in wants:
        yield from (of.PAIR, losses.LOSSES, losses.HOT_CONTACT)
    yield from (wanted for wanted in (of.TORQUES, of.REVOLUTION) if wanted.name in wants)
    if "root-stress" in wants:
        yield of.ROOT_STRESS
    if wants & {"fourier", *needs.MOTIONS}:
        if "report" in wants and not given_stiffness and scene.pair is not None:
            yield of.DRY_CYCLE  # a film from the cache asks for none, and stands beside it in the report
        yield motion.FOURIER
    if scene.dynamics is not None and scene.dynamics.damping_ratio == BY_FILM and wants & {*needs.MOTIONS}:
        yield FILM_DAMPING
    if scene.dynamics is not None and scene.dynamics.error_curve is not None and wants & {*needs.MOTIONS}:
        yield EXCITATION
    if scene.shafts is not None and wants & {*needs.MOTIONS}:
        yield from (motion.SCALING, DRIVE, *((DRIVE_SWEEP,) if "sweep" in wants else ()))
        wants = wants - {"sweep"}
    for wanted in (motion.SWEEP, DIAGRAM, SPECTRUM, RUN_UP, DYNAMIC_MAP):
        if wanted.name in wants:
            yield from (motion.SCALING, wanted)
    if "vtk" in wants:
        yield of.MESH if varies_by(scene) else of.FIELDS
