"""Verifies a scene: compares, and writes tables and a figure."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import gears
from base import Fault, InputError
from flankfilm.building.face import faults_of_face, varies_by
from flankfilm.coupling import Verification
from flankfilm.files.cache import results_cache
from flankfilm.files.folder import claim
from flankfilm.processes.progress import Progress, in_steps, silent
from flankfilm.products.closed_forms import VERIFICATION
from flankfilm.products.face import FACE_MODELS
from flankfilm.scene import Scene
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import PAIR

OF_OTHERS = ("wants", "film.meniscus_half_widths", "film.stiffness", "dynamics.damping_ratio")
"""Where faults of a face stand that no verification is concerned with."""


def verify_scene(
    scene: Scene, folder: Path | None, *, use_cache: bool = True, progress: Progress = silent
) -> Verification:
    """Compare every closed form with finite elements on a scene's pair, torque and tolerance.

    Parameters
    ----------
    scene : Scene
        Its sections pair, material, operating, alignment and shafts count, and stiffness.plane and contact_beyond_path.
    folder : Path or None
        Where the files will go, if anywhere; made, and seen to be writable, before anything is computed.
    use_cache : bool
        Whether results of earlier runs with the same inputs and code may serve.
    progress : callable
        Called with what is being done, steps done, and steps in all.

    Returns
    -------
    Verification

    Raises
    ------
    InputError
        Sections that are missing, geometry that cannot be built.
    SolverError
        Where the compliance misses its share of the tolerance.
    """
    lacking = [f"[{name}]" for name in ("pair", "material", "operating") if not scene.given_keys(name)]
    if lacking:
        raise InputError(
            Fault(name, "", "is required to verify", f"Add the section {name}") for name in lacking
        )
    if folder is not None:
        claim(folder, "verify.nc")
    announce, cache = in_steps(progress, 3), results_cache(use_cache)
    engine = Engine(scene, cache, lambda stage: announce(stage.title))
    verification = engine[VERIFICATION]
    if not varies_by(scene):
        return verification
    unknown = unknown_over_face(scene, engine[PAIR])
    if unknown:
        return replace(verification, message=f"Load over the face left out: {unknown}")
    elements = scene.stiffness.model_copy(update={"model": "fem", "pairs": "coupled"})
    by_elements = scene.model_copy(update={"stiffness": elements})
    whole = Engine(by_elements, cache, lambda stage: announce(stage.title))
    return replace(verification, over_face=whole[FACE_MODELS])


def unknown_over_face(scene: Scene, pair: gears.GearPair) -> str:
    """Parts of the stiffness that take no load that varies along the face; raises other faults of such a face."""
    faults = [fault for fault in faults_of_face(scene, pair) if fault.where not in OF_OTHERS]
    unknown = [fault for fault in faults if fault.where.startswith("stiffness.")]
    if len(unknown) < len(faults):
        raise InputError(faults)
    return "; ".join(str(fault) for fault in unknown)
