"""A file is the old one or the new one, whatever happens while it is written."""

from __future__ import annotations

import pytest

from base.files import replacing


def test_a_write_that_fails_leaves_the_old_file_and_no_other(tmp_path):
    path = tmp_path / "old.vtu"
    path.write_text("old")

    def half_a_file():
        with replacing(path) as beside:
            beside.write_text("half")
            raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        half_a_file()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]
