"""REXS models in ZIP archives (.rexsz), one in each, which other files may accompany."""

from __future__ import annotations

import struct
import zipfile
import zlib
from io import BytesIO

from base import InputError, shorten

LARGEST_FILE = 50_000_000
"""Bytes of a model; a gear unit with all its bearings and results is a few megabytes."""

LARGEST_ARCHIVE = 10_000_000
"""Bytes of an archive; a model shrinks to a tenth or less."""

MOST_ENTRIES = 1000
"""Files of an archive."""

MARK = b"PK"
"""Beginning of an archive."""

ENDINGS = (".rexs", ".rexsj", ".rexs.xml", ".rexs.json")
"""Of the model among the files of an archive."""

METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
"""How files may be packed: others need unbounded memory to unpack."""

DAMAGED = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    RuntimeError,
    ValueError,
    LookupError,
    OSError,
)
"""What the library raises on archives that are none, or have been changed."""


def unpacked(content: bytes, name: str) -> tuple[bytes, str]:
    """Content of the one model in an archive, and what faults call it.

    Nothing is written to disk, no name in the archive is used as a path, and no more than `LARGEST_FILE` bytes are
    unpacked, whatever the archive says of its sizes.

    Parameters
    ----------
    content : bytes
    name : str
        What faults call the archive.

    Raises
    ------
    InputError
        Of an archive that is damaged, encrypted, too large, or holds no model or several.
    """
    if len(content) > LARGEST_ARCHIVE:
        allowed = f"is an archive of more than {LARGEST_ARCHIVE:,} bytes"
        raise InputError.at(name, "", allowed, "Export the stage alone, without results")
    try:
        with zipfile.ZipFile(BytesIO(content)) as archive:
            entry = _model_in(archive, name)
            with archive.open(entry) as packed:
                model_bytes = packed.read(LARGEST_FILE + 1)
    except DAMAGED as fault:
        if isinstance(fault, InputError):
            raise
        allowed = f"must be a ZIP archive: {shorten(str(fault))}"
        raise InputError.at(name, "", allowed, "Export the model again as REXS") from fault
    if len(model_bytes) > LARGEST_FILE:
        allowed = f"unpacks to more than {LARGEST_FILE:,} bytes"
        raise InputError.at(name, "", allowed, "Export the stage alone, without results")
    return model_bytes, f"{name}: {shorten(entry.filename)}"


def _model_in(archive: zipfile.ZipFile, name: str) -> zipfile.ZipInfo:
    """Entry of the one model."""
    entries = archive.infolist()
    if len(entries) > MOST_ENTRIES:
        raise InputError.at(name, f"{len(entries):,} files", f"must hold at most {MOST_ENTRIES:,}")
    models = [member for member in entries if _is_model(member.filename)]
    if len(models) != 1:
        allowed = f"must hold one REXS model, a file that ends in {' or '.join(ENDINGS)}"
        listed = ", ".join(shorten(member.filename) for member in models[:3]) or "none"
        raise InputError.at(name, listed, allowed, "Unpack it and name the model")
    entry = models[0]
    if entry.flag_bits & 1 or entry.compress_type not in METHODS:
        allowed = "must be packed without password, stored or deflated"
        raise InputError.at(name, shorten(entry.filename), allowed, "Unpack it and name the model")
    return entry


def _is_model(path: str) -> bool:
    """Whether a path in an archive is that of a model; the shadows that macOS adds are none."""
    last = path.replace("\\", "/").rpartition("/")[2]
    return last.lower().endswith(ENDINGS) and not last.startswith("._")


def packed(text: str, inner: str) -> bytes:
    """Archive with one model, the same bytes for the same text.

    Parameters
    ----------
    text : str
        The model.
    inner : str
        Its name in the archive.
    """
    content = BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(zipfile.ZipInfo(inner, (1980, 1, 1, 0, 0, 0)), text, zipfile.ZIP_DEFLATED)
    return content.getvalue()
