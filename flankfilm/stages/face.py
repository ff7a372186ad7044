"""The stage of the load over the face by other models."""

from __future__ import annotations

from flankfilm import coupling
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.mesh import COMPLIANCE, DRY_CYCLE, TEETH, loaded_teeth


@stage("load over the face", "load over the face by other models", TEETH, DRY_CYCLE)
def FACE_MODELS(run: Engine) -> coupling.FaceLoadModels:
    """Walls, slices and ISO 6336-1 beside the mesh cycle, of a scene whose load varies along the face."""
    return coupling.face_load_models(loaded_teeth(run), run[DRY_CYCLE])


@stage(
    "face over tolerance",
    "load over the face over a tolerance of the alignment",
    f"{TEETH} alignment",
    COMPLIANCE,
)
def FACE_TOLERANCE(run: Engine) -> coupling.FaceTolerance:
    """Face-load factors with the axes as the scene has them, and by its tolerance more and less out of parallel."""
    section = run.scene.alignment
    tolerance = 0.0 if section is None else section.value("in_plane_tolerance_um")
    return coupling.face_load_tolerance(loaded_teeth(run), tolerance)
