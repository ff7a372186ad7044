"""The command ``flankfilm app``: serves the page, or says how what it needs is installed."""

from __future__ import annotations

from importlib import util
from pathlib import Path

from base import InputError
from flankfilm.files.cache import keep_compiled_code

__all__ = ["app"]

NEEDED = ("trame", "trame_client", "trame_vuetify", "wslink", "aiohttp", "tomlkit")
"""Modules of the extra `app`."""


def app(
    scene: Path | None = None, /, *, folder: Path | None = None, port: int = 0, browser: bool = True
) -> int:
    """Show a page that edits SCENE, answers while you drag, and runs it; on this machine alone, until Ctrl-C.

    Parameters
    ----------
    scene : Path, optional
        The scene file (TOML) to open; the template if left out.
    folder : Path, optional
        Folder below which files may be opened and written; that of SCENE, or the current one if left out.
    port : int
        Port of 127.0.0.1; any that is free for 0.
    browser : bool
        Open the browser; the address is printed anyway.
    """
    if missing := [name for name in NEEDED if util.find_spec(name) is None]:
        allowed = f"needs {', '.join(missing)}, which the extra 'app' brings"
        remedy = 'Install it: ./run setup, or python -m pip install "flankfilm[app]"'
        raise InputError.at("flankfilm app", "", allowed, remedy)
    if not 0 <= port < 2**16:
        raise InputError.at("--port", port, "must be from 0 to 65535", "0 takes any that is free")
    root = (folder or (scene.parent if scene is not None else Path())).resolve()
    if not root.is_dir():
        raise InputError.at("--folder", root, "is no folder", "Name one that is there")
    name = "" if scene is None else _name(scene.resolve(), root)
    keep_compiled_code()
    from flankfilm.app.page import serve
    from flankfilm.app.scene_files import SceneFiles

    files = SceneFiles(root)
    if name:
        files.open(name)  # a scene that cannot be read is refused here
    serve(files, name, port, browser)
    return 0


def _name(scene: Path, root: Path) -> str:
    if not scene.is_relative_to(root):
        raise InputError.at(scene, "", f"must be below {root}", "Name another --folder")
    return scene.relative_to(root).as_posix()
