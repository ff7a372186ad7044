"""The gallery: each script draws, and prints what its page says."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import matplotlib.image
import pytest

from tests.example_scripts import FOLDER, example

DOCS = FOLDER.parent / "docs"
NAMES = sorted(path.stem for path in (FOLDER / "gallery").glob("*.py") if path.stem != "page")
QUICK, LONG = {"closed_forms", "starved_film"}, {"whole_overlap"}
NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?")


def page_of(name: str) -> str:
    return (DOCS / "gallery" / f"{name}.md").read_text(encoding="utf-8")


def said(name: str) -> str:
    found = re.search(r"^```text\n(.*?)^```", page_of(name), re.DOTALL | re.MULTILINE)
    assert found, name
    return found[1]


def unit(number: str) -> float:
    """The last place that a number shows."""
    digits, _, power = number.partition("e")
    return 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))


def same(one: str, other: str) -> bool:
    """Whether texts are equal but for a unit in the last place of their numbers, and errors but for a factor of 2."""
    if NUMBER.sub("#", one) != NUMBER.sub("#", other):
        return False
    for a, b in zip(NUMBER.finditer(one), NUMBER.findall(other), strict=True):
        mine, yours = float(a[0]), float(b)
        if abs(mine - yours) > 1.01 * max(unit(a[0]), unit(b)) and not (
            one[: a.start()].endswith("± ") and 0.5 <= mine / yours <= 2.0
        ):
            return False
    return True


def test_a_number_that_has_changed_is_seen():
    assert same("5.21 um ± 0.2 %", "5.22 um ± 0.1 %")
    assert same("5.21 um ± 0.05 %", "5.21 um ± 0.03 %")
    assert not same("5.21 um ± 0.05 %", "5.21 um ± 0.02 %")
    assert not same("5.21 um ± 0.2 %", "5.23 um ± 0.2 %")
    assert not same("5.21 um ± 0.2 %", "5.21 mm ± 0.2 %")


def entry(name: str) -> Any:
    if name in QUICK:
        return name
    # seven face widths from nothing, whose time is that of free ends
    marks = (
        [pytest.mark.slow, pytest.mark.long, pytest.mark.timeout(3600)] if name in LONG else pytest.mark.slow
    )
    return pytest.param(name, marks=marks)


@pytest.mark.filterwarnings("ignore:.*:UserWarning:distributed")
@pytest.mark.parametrize("name", [entry(name) for name in NAMES])
def test_a_script_draws_and_prints_what_its_page_says(name: str, tmp_path: Path, capsys, monkeypatch):
    monkeypatch.setenv("DASK_SCHEDULER_ADDRESS", "")  # whatever a script makes of it ends with the test
    script, out = example(name, "gallery"), tmp_path / "drawn.png"
    script.picture(script.draw, script.__file__, ["--out", str(out)])
    printed = capsys.readouterr().out
    assert same(printed, said(name)), printed
    drawn, shown = (matplotlib.image.imread(path) for path in (out, DOCS / "images" / f"gallery_{name}.png"))
    assert drawn.shape == shown.shape
    assert drawn[..., :3].std() > 0.05


@pytest.mark.parametrize("name", NAMES)
def test_a_page_shows_picture_command_and_script(name: str):
    text = page_of(name)
    assert f"](../images/gallery_{name}.png)" in text
    assert f"\npython examples/gallery/{name}.py\n" in text
    assert f"{{literalinclude}} ../../examples/gallery/{name}.py\n" in text
    assert (DOCS / "images" / f"gallery_{name}.png").stat().st_size < 120_000


@pytest.mark.parametrize("name", NAMES)
def test_numbers_in_sentences_are_printed_or_given(name: str):
    """Each with a decimal point, at the places that the sentence shows."""
    sentences = page_of(name).partition("```sh")[0]
    script = (FOLDER / "gallery" / f"{name}.py").read_text(encoding="utf-8")
    given = [n.partition("e")[0] for n in NUMBER.findall(script)]  # 3.2e-3 is 3.2 of another unit
    known = [abs(float(n)) for n in (*NUMBER.findall(said(name)), *given)]
    for number in re.findall(r"(?<![\d.])\d+\.\d+", sentences):
        assert any(abs(float(number) - one) <= 0.501 * unit(number) for one in known), number


def test_the_index_shows_every_picture_and_nothing_else():
    text = (DOCS / "gallery.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"\(images/gallery_(\w+)\.png\)\]\(gallery/\1\.md\)", text)) == NAMES
    assert sorted(re.findall(r"^gallery/(\w+)$", text, re.MULTILINE)) == NAMES
    assert sorted(path.stem for path in (DOCS / "gallery").glob("*.md")) == NAMES
    assert len(NAMES) == 16  # as the front pages write
    assert "Sixteen worked examples" in (DOCS.parent / "README.md").read_text(encoding="utf-8")
    assert "sixteen worked examples" in (DOCS / "index.md").read_text(encoding="utf-8")
