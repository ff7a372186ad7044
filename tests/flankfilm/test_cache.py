"""Cache and files: what is stored comes back whole or not at all."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import pickle
import stat
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from scipy.interpolate import RectBivariateSpline

from base.files import replacing
from flankfilm.coupling.losses.heated_table import HeatedTable
from flankfilm.files.cache import PACKAGES, Cache, CacheWarning, code_digest, results_cache
from flankfilm.files.plain_data import NotPlainDataError, read, written
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


def test_an_exchanged_entry_is_noticed(tmp_path):
    cache = Cache(tmp_path)
    cache.put("entry", {"k": 19.1})
    (tmp_path / "entry").rename(tmp_path / "other")
    with pytest.warns(CacheWarning, match="damaged"):
        assert cache.get("other") is None


class Runs:
    """Runs something when it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return open, (str(self.path), "w")


def test_no_entry_runs_code(tmp_path):
    """A pickle under the right digest."""
    payload = pickle.dumps(Runs(tmp_path / "executed"))
    head = hashlib.sha256(b"entry\n" + payload).hexdigest().encode()
    (tmp_path / "entry").write_bytes(head + b"\n" + payload)
    with pytest.warns(CacheWarning, match="damaged"):
        assert Cache(tmp_path).get("entry") is None
    assert not (tmp_path / "executed").exists()


@pytest.mark.parametrize(
    ("module", "name"),
    [
        ("os", "system"),
        ("subprocess", "Popen"),
        ("flankfilm.files.cache", "Path"),
        ("base.units", "factor"),
        ("gears", "x"),
    ],
)
def test_only_records_of_ours_are_made(module, name):
    head = json.dumps({"root": [0], "nodes": [["record", module, name, {"a": 1}]]}).encode()
    with pytest.raises(NotPlainDataError):
        read(len(head).to_bytes(8, "little") + head, PACKAGES)


@pytest.mark.parametrize(
    ("dtype", "shape"),
    [
        *(("<f8", shape) for shape in ([10**30], [0, 10**30], [-1], [2**63])),
        *(
            (dtype, [0])
            for dtype in ("O", "|O8", "(f8", "f8,(1", "V8", "", 8, None, "<U99999999999", "<f8, <f8")
        ),
    ],
)
def test_an_array_of_no_possible_shape_or_type_is_refused(dtype, shape):
    head = json.dumps({"root": [0], "nodes": [["array", dtype, shape, "C", True, 0]]}).encode()
    with pytest.raises(NotPlainDataError):
        read(len(head).to_bytes(8, "little") + head, ())


PLAIN = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False)
    | st.text()
    | arrays(
        st.sampled_from([np.dtype("f8"), np.dtype("i4"), np.dtype("?"), np.dtype("c16")]), array_shapes()
    ),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.lists(inner, max_size=4).map(tuple)
        | st.dictionaries(st.text() | st.integers(), inner, max_size=4)
    ),
    max_leaves=12,
)


@given(PLAIN)
def test_plain_values_come_back(value):
    assert same(read(written(value, ()), ()), value)


def same(a, b):
    """Whether two plain values are equal, their types too."""
    if type(a) is not type(b):
        return False
    if isinstance(a, np.ndarray):
        return (
            a.dtype == b.dtype and a.shape == b.shape and np.array_equal(a, b, equal_nan=a.dtype.kind in "fc")
        )
    if isinstance(a, dict):
        return list(a) == list(b) and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list | tuple):
        return len(a) == len(b) and all(map(same, a, b))
    return a == b


@given(st.binary(max_size=200), st.integers(0, 400), st.integers(0, 255))
def test_garbage_is_refused_as_such(garbage, at, byte):
    whole = bytearray(written({"a": np.arange(3.0), "b": (1, "x")}, ()))
    whole[at % len(whole)] = byte
    for content in (garbage, bytes(whole), bytes(whole[: at % len(whole)])):
        with contextlib.suppress(NotPlainDataError):
            read(content, PACKAGES)


def test_records_arrays_and_shared_parts_come_back_as_they_were(article_pair):
    fortran = np.asfortranarray(np.arange(6.0).reshape(2, 3))
    frozen = np.arange(3)
    frozen.flags.writeable = False
    pair, again, order, still, number = read(
        written((article_pair, article_pair, fortran, frozen, np.float64(0.1)), PACKAGES), PACKAGES
    )
    assert pair == article_pair
    assert again is pair
    assert order.flags.f_contiguous
    assert not still.flags.writeable
    assert type(number) is np.float64
    assert number == 0.1
    with pytest.raises(NotPlainDataError, match="no record"):
        written(article_pair, ("ehl",))
    with pytest.raises(NotPlainDataError, match="no data"):
        written(np.array([object()]), PACKAGES)


def test_a_fit_that_a_record_has_cached_does_not_keep_it_from_being_kept():
    """Losses of a misaligned pair were computed anew in every run, for a spline through their films."""
    x = np.linspace(0.0, 1.0, 4)
    table = HeatedTable(x, x, (), (343.0, 343.0))
    vars(table)["_splines"] = {"friction": RectBivariateSpline(x, x, np.outer(x, x))}
    back = read(written(table, PACKAGES), PACKAGES)
    np.testing.assert_array_equal(back.rho1, x)
    assert "_splines" not in vars(back)
    with pytest.raises(NotPlainDataError):
        written(replace(table, rows=vars(table)["_splines"]), PACKAGES)


def test_a_record_without_fields_comes_back():
    from ehl.oil.rheology import DowsonHigginson

    assert read(written({"law": DowsonHigginson()}, PACKAGES), PACKAGES) == {"law": DowsonHigginson()}


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no owners of folders")
class TestFolder:
    def test_it_is_made_for_the_user_alone(self, tmp_path, monkeypatch):
        monkeypatch.setenv("FLANKFILM_CACHE", str(tmp_path / "new"))
        cache = results_cache()
        assert cache.folder == tmp_path / "new" / "results"
        assert stat.S_IMODE(cache.folder.stat().st_mode) == 0o700
        cache.folder.chmod(0o755)
        results_cache()
        assert stat.S_IMODE(cache.folder.stat().st_mode) == 0o700

    @pytest.mark.parametrize("mode", [0o777, 0o775, 0o1777])
    @pytest.mark.parametrize("which", ["", "results"])
    def test_one_that_others_may_write_is_not_used(self, tmp_path, monkeypatch, mode, which):
        monkeypatch.setenv("FLANKFILM_CACHE", str(tmp_path))
        folder = tmp_path / which
        folder.mkdir(exist_ok=True)
        folder.chmod(mode)
        with pytest.warns(CacheWarning, match=f"chmod 700 {folder}"):
            assert results_cache().folder is None

    def test_one_of_somebody_else_is_not_used(self, tmp_path, monkeypatch):
        monkeypatch.setenv("FLANKFILM_CACHE", str(tmp_path))
        monkeypatch.setattr("os.getuid", lambda: tmp_path.stat().st_uid + 1)
        with pytest.warns(CacheWarning, match="belongs to another user"):
            assert results_cache().folder is None


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
