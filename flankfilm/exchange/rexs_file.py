"""Reads REXS files, as XML (.rexs), JSON (.rexsj) and either of them in a ZIP archive (.rexsz)."""

from __future__ import annotations

from pathlib import Path

from flankfilm.exchange.rexs_archive import LARGEST_FILE, MARK, unpacked
from flankfilm.exchange.rexs_json import model_of_json
from flankfilm.exchange.rexs_model import Model
from flankfilm.exchange.rexs_xml import model_of_xml
from flankfilm.files.folder import content_of


def read_model(path: Path) -> Model:
    """Read a REXS file, without trusting it: size and depth are bounded, and nothing outside it is read.

    What it is counts, not what it is called.

    Raises
    ------
    InputError
        Where the file is missing, too large, neither XML nor JSON nor an archive of either, or no REXS model.
    """
    content = content_of(path, LARGEST_FILE, "Name a REXS file", "Export the stage alone, without results")
    return parse_model(content, str(path))


def parse_model(content: bytes, name: str) -> Model:
    """Read the content of a REXS file that faults call `name`; see `read_model`."""
    if content.startswith(MARK):
        content, name = unpacked(content, name)
    text = content.removeprefix(b"\xef\xbb\xbf").lstrip()
    return model_of_json(content, name) if text.startswith(b"{") else model_of_xml(content, name)
