"""Lines of JSON between the page's process and the processes that compute for it."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator, Mapping
from typing import IO, Any

__all__ = ["Message", "heard", "own_output", "send"]

Message = Mapping[str, Any]


def send(stream: IO[str], message: Message) -> None:
    """Write a message and have it leave at once.

    Parameters
    ----------
    stream : text file
    message : mapping
        Of plain values; numbers keep all their digits.

    Examples
    --------
    >>> send(sys.stdout, {"number": 1})
    {"number": 1}
    """
    stream.write(json.dumps(message, allow_nan=False) + "\n")
    stream.flush()


def heard(stream: IO[str]) -> Iterator[dict[str, Any] | str]:
    r"""Messages of a stream, and lines that are none, such as what a library prints.

    Parameters
    ----------
    stream : text file

    Examples
    --------
    >>> import io
    >>> list(heard(io.StringIO('{"number": 1}\nhello\n')))
    [{'number': 1}, 'hello']
    """
    for line in stream:
        try:
            message = json.loads(line) if line.startswith("{") else line.rstrip("\n")
        except ValueError:
            message = line.rstrip("\n")
        yield message


def own_output() -> IO[str]:
    """Take standard output for messages alone: what libraries print goes to standard error from now on."""
    kept = os.fdopen(os.dup(sys.stdout.fileno()), "w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    return kept
