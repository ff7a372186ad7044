"""Verifies a scene: compares, and writes data, tables, a picture and a page."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import gears
from base import Fault, InputError
from flankfilm import figures
from flankfilm.building.face import faults_of_face, varies_by
from flankfilm.coupling import Verification
from flankfilm.files.cache import results_cache
from flankfilm.files.folder import occupied
from flankfilm.outcome.outcome import Line, Outcome, Picture, concluded
from flankfilm.processes.progress import Progress, in_steps, silent
from flankfilm.products.closed_forms import VERIFICATION
from flankfilm.products.face import FACE_MODELS
from flankfilm.scene import Scene
from flankfilm.scene.needs_of_helix import refuse_helix
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import PAIR
from flankfilm.verification.page import write_verification_page
from flankfilm.verification.tables import costs, dataset, face_table, table, write_tables

if TYPE_CHECKING:
    import xarray as xr

OF_OTHERS = ("wants", "film.meniscus_half_widths", "film.stiffness", "dynamics.damping_ratio")
"""Where faults of a face stand that no verification is concerned with."""


@dataclass(frozen=True, eq=False)
class VerificationOutcome(Outcome[Verification]):
    """Curves and differences as data and tables, the picture, and a page with all.

    Attributes
    ----------
    scene : Scene
        That was verified.
    """

    data = "verify.nc"

    scene: Scene = field(kw_only=True)

    @cached_property
    def dataset(self) -> xr.Dataset:
        """Curves of every closed form and of finite elements."""
        return dataset(self.result, self.scene)

    @property
    def lines(self) -> list[Line]:
        """Tables against all of the stiffness and like for like, load over the face, costs and files."""
        verification = self.result
        whole, *between, like_for_like = verification.references
        shown: list[Line] = [table(verification, whole), table(verification, like_for_like)]
        if verification.over_face is not None:
            shown.append(face_table(verification.over_face))
        elif verification.message:
            shown.append(verification.message)
        return [
            *shown,
            f"verify.csv holds the rest: {', '.join(reference.label for reference in between)}",
            costs(verification),
            f"{len(self.files)} files in {self.folder}: {', '.join(path.name for path in self.files)}",
        ]

    def tables(self, folder: Path) -> list[Path]:
        """Write differences and curves."""
        return write_tables(self.result, folder)

    @property
    def pictures(self) -> dict[str, Picture]:
        """Curves of all models."""
        return {"verify": figures.verification}

    def page(self, folder: Path) -> Path:
        """Write the page."""
        return write_verification_page(self.result, self.dataset, folder)


def verification_outcome(
    scene: Scene, folder: Path | None, *, use_cache: bool = True, progress: Progress = silent
) -> VerificationOutcome:
    """Compare every closed form with finite elements on a scene's pair, torque and tolerance, and write it.

    Parameters
    ----------
    scene : Scene
        Its sections pair, material, operating, alignment and shafts count, and stiffness.plane and contact_beyond_path.
    folder : Path or None
        Where the files go, made when it does not exist; None writes nothing.
    use_cache : bool
        Whether results of earlier runs with the same inputs and code may serve.
    progress : callable
        Called with what is being done, steps done, and steps in all.

    Raises
    ------
    InputError
        Sections that are missing, geometry that cannot be built; where the folder cannot be written.
    SolverError
        Where the compliance misses its share of the tolerance.
    """
    lacking = [f"[{name}]" for name in ("pair", "material", "operating") if not scene.given_keys(name)]
    if lacking:
        raise InputError(
            Fault(name, "", "is required to verify", f"Add the section {name}") for name in lacking
        )

    refuse_helix(scene, "a verification of the closed forms of single pairs")
    with occupied(folder, VerificationOutcome.data):
        verification = _verified(scene, use_cache, progress)
        return concluded(VerificationOutcome(verification, scene=scene), folder)


def _verified(scene: Scene, use_cache: bool, progress: Progress) -> Verification:
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
