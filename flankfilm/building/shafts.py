"""From the scene's shafts to the arguments of a drive train, in SI."""

from __future__ import annotations

from typing import Any

from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.section import required


def drive_arguments(scene: Scene) -> dict[str, Any]:
    """What `flankfilm.coupling.pair_drive` takes of [shafts]."""
    return required(scene.shafts, "[shafts]", "a drive train").drive_arguments()
