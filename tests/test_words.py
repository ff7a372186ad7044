"""Words that no page, docstring or message may use: engineers' English, subject first, the field's own terms.

Pages are read without their code. Of Python the test reads every string literal with more than one word, and all
comments. Names of the public interface (``least_film``) may use any word.
"""

from __future__ import annotations

import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
PACKAGES = ("base", "gears", "meshes", "ehl", "fem", "dynamics", "flankfilm", "examples")

REFUSED = {  # pattern: what to write instead
    r"\btold\b": "reported, distinguished",
    r"\btells?\b": "reports, shows",
    r"\b(comes?|came|coming) to\b": "reaches",
    r"(?<!affected )\bby what\b": "name it",
    r"\bof (its|their|our) own\b": "separate",
    r"(?<!\bat )\bleast\b(?! common multiple)(?![- ]squares)": "minimum, smallest",
    r"\bgreatest\b(?! common divisor)": "maximum, largest",
    r"\bmend(s|ed|ing)?\b": "correct, repair",
    r"\b(bears?|by) turns\b": "alternately",
    r"\bright to\b": "the error is",
    r"\bas they are(?=[.,;:)]|$)": "unchanged",
    r"\bwhat ([a-z]+ ){0,3}knows?\b": "name it",
    r"(±|\+-) stands\b|\bstands behind\b": "follows",
    r"\bfor who\b": "for users who",
    r"\bthe turn of\b": "rotation",
    r"\bplay\b": "backlash",
}
REFUSED_ON_PAGES = {  # things that are not alive
    r"\bknows?\b(?! how)": "includes, describes, depends on",
    r"\bfeels?\b": "is affected by",
    r"\basks? for\b": "needs, requires",
    r"\bbears?\b": "carries load, is in contact",
    r"\bhands? (it |them )?over\b": "transfers",
    r"\bstands? for\b": "replaces, corresponds to",
    r"\bgoes on\b": "continues",
    r"\bsays? so\b": "reports it",
    r"\bthrow-away\b": "independent",
    r"\bhardly any\b": "very small",
}
WORDS = {re.compile(pattern, re.IGNORECASE | re.MULTILINE): instead for pattern, instead in REFUSED.items()}
WORDS_OF_PAGES = WORDS | {re.compile(pattern): instead for pattern, instead in REFUSED_ON_PAGES.items()}
"""Patterns that match within a line: those that nothing in the whole text matches are in none of its lines."""
NAMES = re.compile(
    r"`[^`]*`|\{[^{}]*\}|^\s*(\w+, )*\w+ : "
)  # inline code, fields of a format, documented parameters
FIELDS = re.compile(r"\{[^{}\n]*\}")
ONE_WORD = re.compile(r"""[a-zA-Z]*(['"])[^\s]*\1""")


def prose_of_page(text: str) -> Iterator[tuple[int, str]]:
    """Numbered lines of a page without blocks of code, what a program printed, and inline code."""
    fenced = False
    for number, line in enumerate(text.split("\n"), 1):
        if line.startswith("```"):
            fenced = not fenced
        elif not fenced:
            yield number, re.sub(r"`[^`]*`", "``", line)


def prose_of_code(text: str) -> Iterator[tuple[int, str]]:
    """Numbered lines of all docstrings, messages, labels and comments of a module, without inline code and examples."""
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in (tokenize.STRING, tokenize.COMMENT) or ONE_WORD.fullmatch(token.string):
            continue
        for number, line in enumerate(token.string.split("\n"), token.start[0]):
            if not line.lstrip().startswith((">>>", "...")):
                yield number, NAMES.sub("", line)


def refused(path: Path) -> list[str]:
    text = path.read_text(encoding="utf-8")
    code = path.suffix == ".py"
    lines = list(
        prose_of_code(text)
        if code
        else prose_of_page(FIELDS.sub("", text) if path.suffix == ".toml" else text)
    )
    whole = "\n".join(line for _, line in lines)
    words = WORDS if code else WORDS_OF_PAGES
    there = {pattern: instead for pattern, instead in words.items() if pattern.search(whole)}
    return [
        f"{path.relative_to(ROOT)}:{number}: {found[0]!r}, write: {instead}"
        for number, line in (lines if there else ())
        for pattern, instead in there.items()
        if (found := pattern.search(line))
    ]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_a_page_uses_no_refused_word(page: Path):
    assert refused(page) == []


@pytest.mark.parametrize("package", PACKAGES)
def test_docstrings_messages_and_comments_use_no_refused_word(package: str):
    assert [fault for path in sorted((ROOT / package).rglob("*.py")) for fault in refused(path)] == []


@pytest.mark.parametrize("template", sorted((ROOT / "flankfilm").rglob("*.toml")), ids=lambda path: path.name)
def test_texts_of_reports_use_no_refused_word(template: Path):
    assert refused(template) == []


def test_a_refused_word_is_found_in_prose_alone():
    assert list(prose_of_page("a `mend` b\n```sh\nmend\n```\nmend")) == [(1, "a `` b"), (5, "mend")]
    assert list(prose_of_code('x = "mend"\ny = f"we mend {mend}"\n')) == [(2, 'f"we mend "')]
    assert list(prose_of_code("x = 1  # `least` mend\n")) == [(1, "#  mend")]
    assert [number for number, _ in prose_of_code('"""Play.\n\n>>> play\n"""')] == [1, 2, 4]
    assert list(prose_of_code('"""\n    play : float\n"""'))[1] == (2, "float")
