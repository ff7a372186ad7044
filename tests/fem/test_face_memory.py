"""Faces that take more memory than is free are refused before anything is solved."""

from __future__ import annotations

import re

import numpy as np
import pytest

import base.memory
import fem.pair.face_memory
from base import InputError, free_memory
from fem import compliance, mesh_cycle
from fem.elasticity.free_ends import half_face, unknowns_along
from fem.pair.face_memory import memory_of_cells, memory_of_ends
from gears import Alignment, Gear, GearPair

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3)


def test_a_remedy_is_named_that_fits(monkeypatch):
    bodies = compliance(PAIR, tolerance=0.05)
    monkeypatch.setattr(fem.pair.face_memory, "free_memory", lambda: 0.6e9)
    asked = {"positions": 40, "compliance": bodies, "alignment": Alignment(20e-6), "face_model": "walls"}
    with pytest.raises(
        InputError, match=r"cells = 512: must not take more memory than is free, 0.6 GB"
    ) as caught:
        mesh_cycle(PAIR, 100.0, cells=512, **asked)
    match = re.search(r"take (\d+) cells", str(caught.value), re.IGNORECASE)
    assert match is not None
    most = int(match[1])
    assert 8 <= most < 512
    assert most % 2 == 0
    assert memory_of_cells(PAIR, most, 40, False) <= 0.6e9 < memory_of_cells(PAIR, most + 2, 40, False)


def test_free_ends_of_a_long_face_are_refused_between_walls_they_are_not(monkeypatch):
    long = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=40.0).with_backlash(100e-6)
    bodies = compliance(long, tolerance=0.05)
    monkeypatch.setattr(fem.pair.face_memory, "free_memory", lambda: 2e9)
    with pytest.raises(InputError, match=r"face_model = 'free-ends'.*2e\+04 modules"):
        mesh_cycle(long, 1e5, 4, bodies, cells=8)
    assert mesh_cycle(long, 1e5, 4, bodies, cells=8, face_model="walls").converged


def test_what_a_node_has_of_unknowns():
    for width in (2.0, 20.0, 300.0):
        assert unknowns_along(width) == 3 * len(half_face(0.5 * width, 1.0).mass)
    # measured by the greatest memory of a process: 0.54 and 1.91 GB at 20 and 400 modules
    assert memory_of_ends(20.0) == pytest.approx(0.54e9, rel=0.15)
    assert memory_of_ends(400.0) == pytest.approx(1.91e9, rel=0.15)


def test_positions_put_together_in_parts_are_those_of_all(monkeypatch):
    bodies = compliance(PAIR, tolerance=0.05)
    given = {
        "positions": 6,
        "compliance": bodies,
        "alignment": Alignment(20e-6),
        "cells": 8,
        "face_model": "walls",
    }
    whole = mesh_cycle(PAIR, 100.0, **given)
    monkeypatch.setattr("fem.contact.cell_matrix.MOST_AT_ONCE", 3000)
    monkeypatch.setattr("fem.contact.cell_matrix.MOST_KEPT", 0)
    np.testing.assert_allclose(mesh_cycle(PAIR, 100.0, **given).line_load, whole.line_load, rtol=1e-10)


@pytest.mark.parametrize(
    ("most", "used", "files", "left"),
    [
        ("1000000\n", "400000\n", 0, 6e5),
        ("1000000\n", "990000\n", 590000, 6e5),
        ("max\n", "5\n", 0, np.inf),
        ("10\n", "20\n", 0, 0.0),
    ],
)
def test_the_limit_of_a_container_counts_without_pages_of_files(
    tmp_path, monkeypatch, most, used, files, left
):
    (tmp_path / "memory.max").write_text(most)
    (tmp_path / "memory.current").write_text(used)
    (tmp_path / "memory.stat").write_text(f"anon 7\nfile {files + 9}\ninactive_file {files}\nslab 3\n")
    monkeypatch.setattr(base.memory, "GROUP", tmp_path)
    meminfo = tmp_path / "meminfo"
    meminfo.write_text("MemTotal:  9000 kB\nMemFree:  10 kB\nMemAvailable:   2000 kB\n")
    monkeypatch.setattr(base.memory, "MEMINFO", meminfo)
    monkeypatch.setattr(base.memory, "_left_of_addresses", lambda: np.inf)
    assert free_memory() == min(left, 2000 * 1024.0)
