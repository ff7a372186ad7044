"""Commands that bring gear data in and out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from flankfilm.faults import Fault, InputError


def import_gears(
    file: Path,
    /,
    *,
    out: Annotated[
        Path | None, Parameter(help="The scene to write; FILE.toml beside you if left out.")
    ] = None,
    stage: Annotated[str | None, Parameter(help="Id of the stage, where the file holds several.")] = None,
    rack: Annotated[
        Literal["A", "B", "C", "D"] | None,
        Parameter(help="Basic rack of ISO 53, where the file names no tool."),
    ] = None,
) -> int:
    """Write a scene from the gear data in FILE (REXS, XML).

    What the scene needs and FILE lacks is left open in the scene and listed.

    Parameters
    ----------
    file : Path
        A REXS file, versions 1.0 to 2.0.
    """
    from flankfilm.exchange.bring_in import imported

    target = out if out is not None else Path(f"{file.stem}.toml")
    brought = imported(file, stage=stage, rack=rack)
    _write_new(target, brought.text)
    for note in brought.notes:
        print(note)
    print(f"{target} is written.")
    if brought.faults:
        raise InputError(
            [Fault(f"{target}: {f.where}", f.value, f.allowed, f.remedy) for f in brought.faults]
        )
    print(f"Next: flankfilm check {target}")
    return 0


def export_rexs(
    scene: Path,
    /,
    *,
    out: Annotated[Path | None, Parameter(help="The file; SCENE.rexs beside you if left out.")] = None,
) -> int:
    """Write the pair of SCENE as a REXS file.

    Parameters
    ----------
    scene : Path
        The scene file (TOML); its sections pair and material count.
    """
    from flankfilm.build import gear_pair
    from flankfilm.dataset import write_text
    from flankfilm.exchange.rexs_write import rexs_text
    from flankfilm.scene import read_scene

    wanted = read_scene(scene)
    text, left_out = rexs_text(gear_pair(wanted), wanted.title or scene.stem)
    target = out if out is not None else Path(f"{scene.stem}.rexs")
    write_text(target, text)
    for told in left_out:
        print(told)
    print(f"{target} is written.")
    return 0


def _write_new(path: Path, text: str) -> None:
    """Write a file that must not exist yet."""
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError as fault:
        raise InputError(
            [Fault(str(path), "", "exists already and is kept", "Name another: --out")]
        ) from fault
