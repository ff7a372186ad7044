"""The form has every key of a scene; an edit changes its key and nothing else of the file."""

from __future__ import annotations

import difflib
import tomllib
from pathlib import Path

import pytest

from base import InputError
from flankfilm.app.document import Document
from flankfilm.app.form import form, form_keys
from flankfilm.scene import template

ROOT = Path(__file__).parents[3]
EXAMPLES = sorted((ROOT / "examples").glob("*.toml"))


def leaves(raw: dict, start: str = ""):
    for name, value in raw.items():
        path = f"{start}{name}"
        if path in form_keys():
            yield path
        elif isinstance(value, dict):
            yield from leaves(value, f"{path}.")
        else:
            yield f"lost: {path}"


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_every_key_of_an_example_has_its_place_in_the_form(example):
    paths = list(leaves(tomllib.loads(example.read_text(encoding="utf-8"))))
    assert [path for path in paths if path.startswith("lost")] == []
    document = Document.read(example.read_text(encoding="utf-8"))
    assert set(document.values) == set(paths)


def test_keys_have_units_meanings_bounds_and_choices_of_the_scene():
    keys = form_keys()
    assert all(key.meaning for key in keys.values())
    assert keys["pair.module_mm"].unit == "mm"
    assert (keys["pair.module_mm"].low, keys["pair.module_mm"].high) == (0.01, 1000.0)
    assert "fem" in keys["stiffness.model"].choices
    assert keys["stiffness.model"].kind == "choice"
    assert keys["wants"].kind == "words"
    assert "sweep" in keys["wants"].choices
    assert keys["pair.tight"].kind == "switch"
    assert keys["pair.pinion.teeth"].required
    assert keys["tolerance"].default == "0.005"
    assert len({section.path for section in form()}) == len(form())


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_values_typed_again_leave_the_file_as_it_is(example):
    text = example.read_text(encoding="utf-8")
    document = Document.read(text)
    for path, value in document.values.items():
        assert document.with_value(path, value).text == text, path


def test_an_edit_changes_one_line_and_keeps_its_comment():
    before = Document.read((ROOT / "examples" / "article.toml").read_text(encoding="utf-8"))
    after = before.with_value("material.youngs_modulus_GPa", "206e0")
    changed = [
        line
        for line in difflib.unified_diff(before.text.split("\n"), after.text.split("\n"), n=0)
        if line[0] in "+-" and line[1] not in "+-"
    ]
    assert len(changed) == 2
    assert changed[1].startswith("+youngs_modulus_GPa = 206e0 ")
    assert changed[1].endswith("# gives E' = 220 GPa, as the article has it")


def test_a_key_that_is_emptied_goes_with_a_table_that_it_empties():
    document = Document.read('wants = ["geometry"]\n[pair]\nmodule_mm = 2 # both\npinion = { teeth = 36 }\n')
    made = document.with_value("pair.pinion.tip_relief.amount_um", "10").with_value("pair.rack", "ISO 53 C")
    assert tomllib.loads(made.text)["pair"]["pinion"] == {"teeth": 36, "tip_relief": {"amount_um": 10}}
    gone = made.with_value("pair.pinion.tip_relief.amount_um", "").with_value("pair.rack", "")
    assert tomllib.loads(gone.text) == tomllib.loads(document.text)
    assert "# both" in gone.text


@pytest.mark.parametrize(
    ("path", "typed", "value"),
    [
        ("pair.module_mm", "2.", "2."),
        ("pair.module_mm", "-", "-"),
        ("pair.module_mm", "1e", "1e"),
        ("pair.module_mm", "1,5", "1,5"),
        ("pair.module_mm", "2 # x", "2 # x"),
        ("pair.module_mm", '"""', '"""'),
        ("pair.module_mm", "2\n[film]", "2\n[film]"),
        ("pair.pinion.teeth", "36", 36),
        ("pair.tight", "true", True),
        ("pair.tight", "tru", "tru"),
        ("title", "12", "12"),
        ("title", 'a "b" \\ c', 'a "b" \\ c'),
        ("film.model", "ehl", "ehl"),
        ("dynamics.damping_ratio", "film", "film"),
        ("tolerance", "0.5%", "0.5%"),
        ("operating.torques_Nm", "[100, 200", "[100, 200"),
        ("operating.torques_Nm", "[100, 200]", [100, 200]),
    ],
)
def test_what_is_half_typed_is_a_word_and_the_file_is_toml_all_the_time(path, typed, value):
    document = Document.read(template()).with_value(path, typed)
    held = tomllib.loads(document.text)
    for part in path.split("."):
        held = held[part]
    assert held == value
    assert type(held) is type(value)


def test_keys_that_the_form_has_not_and_files_that_are_no_toml_are_refused():
    with pytest.raises(InputError, match="is not a key of the form"):
        Document.read("").with_value("pair.__class__", "1")
    with pytest.raises(InputError, match="must be TOML"):
        Document.read("[pair")
    with pytest.raises(InputError, match="cannot be put into the file"):
        Document.read("pair = 3").with_value("pair.module_mm", "2")
    with pytest.raises(InputError, match="is larger than"):
        Document.read("#" * 2_000_000)
