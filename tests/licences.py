"""Licences of what the packages need to run, as the installed libraries state them.

``python -m tests.licences`` prints the tables of ``docs/licences.md``.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]

CLASSES = "License :: OSI Approved :: "
"""Beginning of the classifiers that name a licence."""

OF_USERS = ("app", "optimise", "dask", "mpi")
"""Extras of users; the others serve development."""

FOUND_BY_HAND = {"graphemeu": "MIT"}
"""Libraries whose metadata name no licence; read in the files that they bring."""


def project() -> dict[str, list[Requirement]]:
    """What the packages need, and each extra of users besides."""
    table = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    asked = {"": table["dependencies"]}
    asked |= {extra: table["optional-dependencies"][extra] for extra in OF_USERS}
    return {extra: [Requirement(one) for one in lines] for extra, lines in asked.items()}


def licence(name: str) -> str:
    """Licence of an installed library: SPDX where it gives that, else what its classifiers say."""
    about = metadata.metadata(name)
    if about.get("License-Expression"):
        return str(about.get("License-Expression"))
    classes = [
        one.removeprefix(CLASSES) for one in about.get_all("Classifier", []) if one.startswith(CLASSES)
    ]
    stated = about.get("License") or ""
    if not classes and "\n" not in stated and stated:  # several lines are the text of a licence, not its name
        return str(stated)
    return ", ".join(classes) or FOUND_BY_HAND[canonicalize_name(name)]


def brought(asked: Iterable[Requirement]) -> Iterator[str]:
    """Names of all installed libraries that these need, themselves included, each once."""
    left, seen = list(asked), set()
    while left:
        one = left.pop()
        name = canonicalize_name(one.name)
        if name in seen:
            continue
        try:
            needs = metadata.requires(name) or []
        except metadata.PackageNotFoundError:
            continue  # of an extra, or of another platform
        seen.add(name)
        yield name
        extras = one.extras or {""}
        of_these = [Requirement(text) for text in needs]
        left += [r for r in of_these if not r.marker or any(r.marker.evaluate({"extra": e}) for e in extras)]


def direct_rows() -> list[str]:
    """Rows of the table of what is asked for by name."""
    rows = []
    for extra, asked in project().items():
        for one in asked:
            try:
                text = licence(one.name)
            except metadata.PackageNotFoundError:
                continue
            rows.append(f"| {one.name} | {str(one.specifier) or 'any'} | {extra} | {text} |")
    return rows


def further_rows() -> list[str]:
    """Rows of the table of what those need in turn."""
    asked = [one for lines in project().values() for one in lines]
    named = {canonicalize_name(one.name) for one in asked}
    return [f"| {name} | {licence(name)} |" for name in sorted(set(brought(asked)) - named)]


if __name__ == "__main__":
    print("\n".join([*direct_rows(), "", *further_rows()]))
