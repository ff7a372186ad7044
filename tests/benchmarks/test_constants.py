"""Numeric constants: each has an entry, none decides an answer unseen, and laws have tests that see them doubled."""

from __future__ import annotations

import os
import re

import pytest

from benchmarks.constants.laws import LAWS, OPEN, SHAPES
from benchmarks.constants.moving import fresh, known, moved
from benchmarks.constants.scanned import PACKAGES, ROOT, changed, compiled, constants, reads, usable

QUICK = tuple(
    f"fem: {name}"
    for name in (
        "steel on POM",
        "both flanks",
        "roots",
        "compliance",
        "tips free",
        "path only",
        "tip relief",
        "rounded tips",
        "fields",
    )
)
"""Answers without cells of the face; each constant by the first two that read it."""

PAGE = (ROOT / "docs/validation/constants.md").read_text(encoding="utf-8")
NAMES = {str(constant): constant for package in PACKAGES for constant in constants(package)}


@pytest.mark.parametrize("package", PACKAGES)
def test_the_page_counts_all_constants(package):
    """A new one is studied (``python -m benchmarks.constants``) and entered."""
    (row,) = re.findall(rf"^\| {package} \| (\d+) \|", PAGE, re.MULTILINE)
    assert int(row) == len(constants(package))


def test_constants_of_the_page_and_of_the_lists_are_there():
    named = set(re.findall(r"`((?:fem|gears|ehl|dynamics)(?:\.\w+)*\.[A-Z_]+)`", PAGE))
    assert named
    assert sorted(({*LAWS, *OPEN, *SHAPES} | named) - NAMES.keys()) == []
    assert sorted(name for name in {*LAWS, *OPEN, *SHAPES} if f"`{name}`" not in PAGE) == []


def test_tests_of_laws_are_there():
    for test in LAWS.values():
        file, _, name = test.partition("::")
        assert f"def {name.partition('[')[0]}(" in (ROOT / file).read_text(encoding="utf-8")


@pytest.mark.slow
def test_no_constant_of_finite_elements_decides_a_quick_answer_beyond_its_error():
    """Doubled, but for laws and for what is known to be open."""
    moves = [
        moved(constant, True, name)
        for constant in constants("fem")
        if usable(constant.value) and not compiled(constant) and str(constant) not in {*LAWS, *SHAPES}
        for name in [name for name in QUICK if any(map(reads(constant), known(name).code))][:2]
    ]
    assert len({str(move.constant) for move in moves}) > 80
    assert {str(move.constant): str(move) for move in moves if move.worst > 1.0}.keys() == OPEN.keys()


@pytest.mark.slow
@pytest.mark.parametrize("name", LAWS)
def test_the_test_of_a_law_fails_when_it_is_doubled(name):
    command = ["-q", "-p", "no:cacheprovider", "-n", "0", os.fspath(ROOT / LAWS[name])]
    assert pytest.main(command) == pytest.ExitCode.OK
    with changed(NAMES[name], True), fresh():
        assert pytest.main(command) == pytest.ExitCode.TESTS_FAILED
