"""Cache and files: what is stored comes back whole or not at all."""

from __future__ import annotations

import os

import numpy as np
import pytest

from base.files import replacing
from flankfilm.cache import Cache, CacheWarning, code_digest
from flankfilm.output.files import write_text


def test_a_kept_value_comes_back(tmp_path):
    cache = Cache(tmp_path)
    key = cache.key("stage", {"a": 1.0}, ("gears",))
    assert cache.get(key) is None
    cache.put(key, np.arange(5.0))
    assert np.array_equal(cache.get(key), np.arange(5.0))


def test_the_key_follows_inputs_stage_and_code(tmp_path):
    cache = Cache(tmp_path)
    keys = {
        cache.key("stage", {"a": 1.0}, ("gears",)),
        cache.key("stage", {"a": 1.0 + 2e-16}, ("gears",)),
        cache.key("other", {"a": 1.0}, ("gears",)),
        cache.key("stage", {"a": 1.0}, ("ehl",)),
    }
    assert len(keys) == 4
    assert cache.key("stage", {"a": 1, "b": 2}, ("gears",)) == cache.key(
        "stage", {"b": 2, "a": 1}, ("gears",)
    )


def test_changed_code_changes_the_digest(tmp_path, monkeypatch):
    package = tmp_path / "somegear"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "helper.py").write_text("FACTOR = 2\n")
    monkeypatch.syspath_prepend(tmp_path)
    before = code_digest(("somegear",))
    code_digest.cache_clear()
    (package / "helper.py").write_text("FACTOR = 3\n")
    assert code_digest(("somegear",)) != before


@pytest.mark.parametrize("at", [3, 70, -2])
def test_a_flipped_bit_is_noticed_and_removed(tmp_path, at):
    cache = Cache(tmp_path)
    cache.put("entry", {"k": 19.1})
    raw = bytearray((tmp_path / "entry").read_bytes())
    raw[at] ^= 4
    (tmp_path / "entry").write_bytes(raw)
    with pytest.warns(CacheWarning, match="damaged"):
        assert cache.get("entry") is None
    assert not (tmp_path / "entry").exists()


def test_a_cut_entry_is_noticed(tmp_path):
    cache = Cache(tmp_path)
    cache.put("entry", list(range(1000)))
    raw = (tmp_path / "entry").read_bytes()
    (tmp_path / "entry").write_bytes(raw[: len(raw) // 2])
    with pytest.warns(CacheWarning, match="damaged"):
        assert cache.get("entry") is None


def test_no_folder_keeps_nothing():
    cache = Cache(None)
    cache.put("entry", 1)
    assert cache.get("entry") is None


def test_a_full_disk_is_a_warning(tmp_path, monkeypatch):
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.warns(CacheWarning, match="No space left"):
        Cache(tmp_path).put("entry", 1)
    assert list(tmp_path.iterdir()) == []


def test_what_killed_runs_left_is_swept(tmp_path):
    left, young, mine = (tmp_path / n for n in (".entry.0123456789ab", ".entry.ba9876543210", ".entry"))
    for path in (left, young, mine):
        path.write_text("half")
    for path in (left, mine):
        os.utime(path, (0, 0))
    Cache(tmp_path).put("entry", 1)
    assert sorted(p.name for p in tmp_path.iterdir()) == [".entry", ".entry.ba9876543210", "entry"]


def test_a_failed_write_keeps_the_old_file(tmp_path):
    path = tmp_path / "curve.csv"
    write_text(path, "old")

    def fail() -> None:
        with replacing(path) as beside:
            beside.write_text("ne")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["curve.csv"]
