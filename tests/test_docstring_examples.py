"""Examples in docstrings run, and every public function of a finished package has one."""

from __future__ import annotations

import doctest
import importlib
import inspect

import numpy as np
import pytest

PACKAGES: tuple[str, ...] = (
    "base",
    "dynamics",
    "dynamics.inverse",
    "ehl",
    "fem",
    "flankfilm",
    "flankfilm.coupling",
    "gears",
    "gears.closed_form",
    "meshes",
)
"""Packages whose public functions all have an example."""

CASES = {
    id(value): (package, name, value)
    for package in PACKAGES
    for name in importlib.import_module(package).__all__
    if inspect.isfunction(value := getattr(importlib.import_module(package), name)) or inspect.isclass(value)
}
"""Of each function and class one, however many packages show it."""


@pytest.mark.parametrize(
    ("package", "name", "value"), CASES.values(), ids=[f"{p}.{n}" for p, n, _ in CASES.values()]
)
def test_examples_run(package: str, name: str, value: object, tmp_path, monkeypatch, request):
    monkeypatch.chdir(tmp_path)
    if name == "forget_gears":
        request.getfixturevalue("no_gear_solved")  # tests after it would solve all gears anew
    tests = [t for t in doctest.DocTestFinder(recurse=True).find(value, name) if t.examples]
    if inspect.isfunction(value):
        assert tests, f"{package}.{name} has no example"
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
    # numbers are shown as they are in an interpreter, whatever the version of numpy
    with np.printoptions(legacy="1.25"):
        for test in tests:
            heard: list[str] = []
            runner.run(test, out=heard.append, clear_globs=False)
            assert runner.summarize(verbose=False).failed == 0, "".join(heard)
