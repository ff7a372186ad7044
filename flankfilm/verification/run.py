"""Verifies a scene: compares, and writes tables and a figure."""

from __future__ import annotations

from pathlib import Path

from base import Fault, InputError
from flankfilm.cache import results_cache
from flankfilm.coupling import Verification
from flankfilm.folder import claim
from flankfilm.progress import Progress, in_steps, silent
from flankfilm.scene import Scene
from flankfilm.stages.catalogue import VERIFICATION
from flankfilm.stages.engine import Engine


def verify_scene(
    scene: Scene, folder: Path | None, *, use_cache: bool = True, progress: Progress = silent
) -> Verification:
    """Compare every closed form with finite elements on a scene's pair, torque and tolerance.

    Parameters
    ----------
    scene : Scene
        Its sections pair, material and operating count, and stiffness.plane and contact_beyond_path.
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
    lacking = [f"[{name}]" for name in ("pair", "material", "operating") if not scene.given(name)]
    if lacking:
        raise InputError(
            Fault(name, "", "is required to verify", f"Add the section {name}") for name in lacking
        )
    if folder is not None:
        claim(folder, "verify.nc")
    announce = in_steps(progress, 3)
    return Engine(scene, results_cache(use_cache), lambda stage: announce(stage.title))[VERIFICATION]
