"""Faults stand beside their keys, those that a run finds before it solves included; files stay below the folder."""

from __future__ import annotations

from pathlib import Path

import pytest

from base import InputError
from flankfilm.app.checking import Place, checked, key_at
from flankfilm.app.document import Document

ROOT = Path(__file__).parents[3]
ARTICLE = Document.read((ROOT / "examples" / "article.toml").read_text(encoding="utf-8"))
HERE = Place(ROOT, ROOT / "examples")


@pytest.mark.parametrize("example", sorted((ROOT / "examples").glob("*.toml")), ids=lambda path: path.stem)
def test_examples_have_no_faults(example):
    judged = checked(Document.read(example.read_text(encoding="utf-8")), HERE)
    assert judged.faults == ()
    assert judged.scene is not None


@pytest.mark.parametrize(
    ("path", "typed", "where", "said"),
    [
        ("pair.module_mm", "2.", "pair.module_mm", "must be a finite number"),
        ("pair.module_mm", "", "pair.module_mm", "is required"),
        ("pair.pinion.teeth", "3", "pair.pinion.teeth", "at least 5"),
        ("film.model", "eh", "film.model", "Did you mean 'ehl'?"),
        ("pair.backlash_um", "-9000", "pair.backlash_um", "must be"),
        ("dynamics.damping_ratio", "", "dynamics.damping_ratio", ""),
        ("operating.pinion_torque_Nm", "", "operating.pinion_torque_Nm", "is required"),
        ("pair.pinion.profile_shift", "3", "pair.pinion", ""),
    ],
)
def test_a_fault_stands_beside_its_key(path, typed, where, said):
    judged = checked(ARTICLE.with_value(path, typed), HERE)
    beside = judged.by_key
    if not judged.faults:
        assert said == ""  # a key that may be left out
        return
    keys = [key for key in beside if key.startswith(where)]
    assert keys, beside
    assert any(said in text for key in keys for text in beside[key])
    assert all("without quotes" not in text for texts in beside.values() for text in texts)


def test_axes_too_near_are_a_fault_of_the_geometry_beside_the_key():
    document = ARTICLE.with_value("pair.backlash_um", "").with_value("pair.centre_distance_mm", "70")
    (text,) = checked(document, HERE).by_key["pair.centre_distance_mm"]
    assert "sum of the base radii" in text


def test_places_of_faults():
    assert key_at("[lubricant]") == "lubricant"
    assert key_at("pair.pinion.tip_relief.amount_um") == "pair.pinion.tip_relief.amount_um"
    assert key_at("operating.torques_Nm.3") == "operating.torques_Nm"
    assert key_at("of nothing") == ""


@pytest.mark.parametrize("name", ["/etc/passwd", "../../../etc/passwd", "a\0b", "link/passwd"])
def test_files_outside_the_folder_are_not_read(tmp_path, name):
    (tmp_path / "link").symlink_to("/etc")
    place = Place(tmp_path, tmp_path)
    judged = checked(Document(f'[pair.pinion.wear]\nfile = "{name.replace(chr(0), "/../../../..")}"'), place)
    assert judged.scene is None
    assert "must be below" in str(judged.by_key["pair.pinion.wear.file"])
    with pytest.raises(InputError, match="must be below"):
        place.inside(name)


def test_files_below_the_folder_are_read(tmp_path):
    inside = tmp_path / "gears"
    inside.mkdir()
    assert Place(tmp_path, inside).inside("../flank.csv") == tmp_path / "flank.csv"
