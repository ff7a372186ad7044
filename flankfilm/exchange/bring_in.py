"""From a file of gear data to a scene, with what is still open."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from pathlib import Path

from base import Fault, InputError
from flankfilm.building.pair import gear_pair
from flankfilm.exchange.draft import Draft, scene_text
from flankfilm.exchange.rexs_file import read_model
from flankfilm.exchange.rexs_pair import draft_of
from flankfilm.scene import parse_scene
from flankfilm.scene.sections.rack import ISO_53

MOST_NOTES = 50
"""Notes that are kept: a file may have thousands of modifications."""

LONGEST_NOTE = 500


@dataclass(frozen=True)
class Imported:
    """A scene from a file of gear data.

    Attributes
    ----------
    text : str
        The scene file.
    notes : tuple of str
        What was left out, and what defaults stand for.
    faults : tuple of Fault
        What must be given before the scene can be run, or what is wrong with the gears.
    """

    text: str
    notes: tuple[str, ...]
    faults: tuple[Fault, ...]


def imported(file: Path, *, stage: str | None = None, rack: str | None = None) -> Imported:
    """Make a scene from a REXS file.

    Parameters
    ----------
    file : Path
    stage : str, optional
        Id of the stage, where the file holds several.
    rack : {"A", "B", "C", "D"}, optional
        Basic rack of ISO 53, where the file names no tool.

    Raises
    ------
    InputError
        Where the file cannot be read, or holds gears that are out of scope.
    """
    draft = draft_of(read_model(file), str(file), stage)
    if rack is not None:
        _name_rack(draft, rack)
    text = scene_text(draft)
    faults = draft.lacking()
    if not faults:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # flankfilm check reports them
                gear_pair(parse_scene(text))
        except InputError as error:
            faults = error.faults
    notes = tuple(note[:LONGEST_NOTE] for note in draft.notes[:MOST_NOTES])
    if len(draft.notes) > MOST_NOTES:
        notes += (f"{len(draft.notes) - MOST_NOTES} more notes are left out.",)
    return Imported(text, notes, faults)


def _name_rack(draft: Draft, name: str) -> None:
    """Fill in a rack of ISO 53 where the file has none."""
    _, h_fP, rho_fP = ISO_53[name]
    own = draft.pair["rack"]
    h, rho, alpha = (own[key] for key in ("h_fP", "rho_fP", "alpha_deg"))
    if not math.isnan(h) or not math.isnan(rho):
        allowed = f"the file has its own: h_fP = {h:g}, rho_fP = {rho:g}"
        raise InputError.at("--rack", name, allowed, "Leave it out, and change the scene")
    if not math.isnan(alpha) and abs(alpha - 20.0) > 1e-9:
        allowed = f"has 20 deg, but the file {alpha:g} deg"
        raise InputError.at("--rack", name, allowed, "Give h_fP and rho_fP in the scene")
    own |= {"h_fP": h_fP, "rho_fP": rho_fP}
    draft.notes.append(f"Basic rack: ISO 53 {name}, named by --rack.")
