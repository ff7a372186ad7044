"""Runs the stages that a scene needs, each once, from the cache where its inputs are unchanged."""

from __future__ import annotations

import re
import time
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from flankfilm.cache import Cache
from flankfilm.scene import Scene

T = TypeVar("T")
Compute = Callable[["Engine"], Any]


@dataclass(frozen=True)
class Stage:
    """One step from the scene to a result.

    Attributes
    ----------
    name : str
        Name under which other stages ask for the result.
    title : str
        What a person reads while it runs.
    compute : callable
        Gives the result; asks the engine for the scene and for other stages.
    inputs : callable
        The part of the scene that the result depends on, as plain values; with the inputs of
        the stages in `needs` it makes the cache's key.
    needs : tuple of str
        Names of the stages that `compute` may ask for.
    packages : tuple of str
        Packages whose code decides the result.
    kept : bool
        Whether the result is worth a place in the cache.
    settings : callable
        What decisions of other stages tell this one, as plain values; in the cache's key like `inputs`. Of a
        stage that is decided on it has no more than what was decided, so that a change elsewhere in the scene
        which leaves the decision as it was leaves the result in the cache.
    """

    name: str
    title: str
    compute: Compute
    inputs: Callable[[Scene], Mapping[str, Any]]
    needs: tuple[str, ...] = ()
    packages: tuple[str, ...] = ()
    kept: bool = False
    settings: Callable[[Engine], Mapping[str, Any]] = lambda engine: {}


@dataclass(frozen=True)
class StageRun:
    """How a stage came to its result.

    Attributes
    ----------
    seconds : float
        Time of this stage alone, without those it asked for [s].
    cached : bool
        Whether the result was read from the cache.
    warnings : tuple of str
        What the ground floors warned of meanwhile.
    """

    name: str
    title: str
    seconds: float
    cached: bool
    warnings: tuple[str, ...] = ()


@dataclass
class Engine:
    """Holds the results of one run; the only thing here that changes."""

    scene: Scene
    stages: Mapping[str, Stage]
    cache: Cache
    on_start: Callable[[Stage], None] = lambda stage: None
    runs: dict[str, StageRun] = field(default_factory=dict)
    _values: dict[str, Any] = field(default_factory=dict)
    _elsewhere: list[float] = field(default_factory=list)

    def __getitem__(self, name: str) -> Any:
        """Return the result of a stage, computed when first asked for."""
        if name not in self._values:
            self._values[name] = self._obtain(self.stages[name])
        return self._values[name]

    def inputs(self, name: str) -> dict[str, Any]:
        """Everything that decides a stage's result, down to the scene's keys."""
        stage = self.stages[name]
        # apart: a setting may be called like a section, as the film's tolerance and [film] are
        own = {"keys": stage.inputs(self.scene), "decided": stage.settings(self)}
        return {name: own, **{n: self.inputs(n) for n in stage.needs}}

    def packages(self, name: str) -> tuple[str, ...]:
        """Packages whose code decides a stage's result."""
        stage = self.stages[name]
        return tuple(sorted({*stage.packages, *(p for n in stage.needs for p in self.packages(n))}))

    def results(self) -> dict[str, Any]:
        """Results that have been asked for so far."""
        return dict(self._values)

    def timed(self, name: str, title: str, work: Callable[[], T]) -> T:
        """Do work that is no stage, such as writing files, and note its cost beside the stages'."""
        start = time.perf_counter()
        done = work()
        self.runs[name] = StageRun(name, title, time.perf_counter() - start, cached=False)
        return done

    def _obtain(self, stage: Stage) -> Any:
        start = time.perf_counter()
        self._elsewhere.append(0.0)
        key = (
            self.cache.key(stage.name, self.inputs(stage.name), self.packages(stage.name))
            if stage.kept
            else ""
        )
        value = self.cache.get(key) if stage.kept else None
        cached = value is not None
        caught: list[warnings.WarningMessage] = []
        if not cached:
            self.on_start(stage)
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                value = stage.compute(self)
            if stage.kept:
                self.cache.put(key, value)
        whole = time.perf_counter() - start
        own = whole - self._elsewhere.pop()
        if self._elsewhere:
            self._elsewhere[-1] += whole
        told = _once_each(str(w.message) for w in caught)
        self.runs[stage.name] = StageRun(stage.name, stage.title, own, cached, told)
        return value


def _once_each(messages: Iterable[str]) -> tuple[str, ...]:
    """Drop messages that differ from an earlier one in their numbers alone."""
    seen: dict[str, str] = {}
    for message in messages:
        seen.setdefault(re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "#", message), message)
    return tuple(seen.values())
