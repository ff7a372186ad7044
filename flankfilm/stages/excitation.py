"""The stages of what drives the motion beside the stiffness: the unloaded transmission error, and a revolution's."""

from __future__ import annotations

from typing import Any

from flankfilm import coupling
from flankfilm.building.face import face
from flankfilm.building.flanks import deviations
from flankfilm.building.pair import pinion_torque, tip_roundings
from flankfilm.scene.sections.section import required
from flankfilm.stages.damping import FILM_DAMPING, damping_ratio
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.mesh import MESH, PAIR
from flankfilm.stages.ranges import deflection, frequency_range

KEYS = "operating dynamics pair material heat tip_edges tolerance"


@stage("excitation", "unloaded transmission error", f"{KEYS} alignment wants", PAIR, MESH, FILM_DAMPING)
def EXCITATION(run: Engine) -> coupling.ErrorSeries | None:
    """Harmonics of the scene's curve of the error; None where it gives harmonics."""
    scene = run.scene
    section = required(scene.dynamics, "[dynamics]", "the motion")
    curve = section.error_curve
    if curve is None:
        return None
    given_stiffness = scene.stiffness.model == "given"
    asked: dict[str, Any] = {
        "order": None if section.error_order == "auto" else section.error_order,
        "share": scene.tolerance,
        "deflection": 0.0 if given_stiffness else deflection(run, section),
        "bounds": None if given_stiffness else frequency_range(run, section),
        "damping_ratio": damping_ratio(run),
    }
    if curve != "unloaded":
        about = "curve of the scene" if curve.file is None else f"curve of {curve.file}"
        at, error = curve.position, curve.value("error_um")
        assert at is not None
        return coupling.error_series(error, at, source=about, **asked)
    return coupling.unloaded_error(
        run[PAIR],
        deviations=deviations(scene, run[PAIR], every_tooth=False),
        tip_rounding=tip_roundings(scene),
        beyond_path=scene.tip_edges,
        back=pinion_torque(scene) < 0.0,
        alignment=face(scene).get("alignment"),
        **asked,
    )


@stage("revolution error", "error of a revolution", KEYS, PAIR)
def REVOLUTION_ERROR(run: Engine) -> coupling.ErrorSeries | None:
    """What deviations of single teeth add to the error over the hunting period; None where all teeth are alike."""
    scene = run.scene
    if scene.pair is None:
        return None
    each = deviations(scene, run[PAIR], every_tooth=True)
    if each is None or all(gear is None or gear.every_tooth_alike for gear in each):
        return None
    return coupling.revolution_error(
        run[PAIR],
        each,
        tip_rounding=tip_roundings(scene),
        beyond_path=scene.tip_edges,
    )
