"""Runs the stages that a scene needs, each once, from the cache where its inputs are unchanged."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, is_dataclass
from functools import reduce
from typing import Any, Generic, TypeVar, get_type_hints

from base import InputError, SolverError
from flankfilm.coupling.mesh.warn_once import distinct
from flankfilm.files.cache import Cache
from flankfilm.processes.progress import Progress, rows_of, silent
from flankfilm.scene import Scene
from flankfilm.scene.sections.section import Section
from flankfilm.stages.failures import Failure, failure_of

T = TypeVar("T")

Inputs = Callable[[Scene], Mapping[str, Any]]
Settings = Callable[["Engine"], Mapping[str, Any]]


@dataclass(frozen=True, eq=False)
class Stage(Generic[T]):
    """One step from the scene to a result of type T.

    Attributes
    ----------
    name : str
        Of the stage among all.
    title : str
        What a person reads while it runs.
    compute : callable
        Gives the result; asks the engine for the scene and for other stages.
    inputs : callable
        The part of the scene that the result depends on, as plain values; with the inputs of
        the stages in `needs` it makes the cache's key.
    needs : tuple of Stage
        Stages that `compute` may ask for.
    kept : tuple of str
        Packages whose code decides the result, of one that is worth a place in the cache; none for all others.
    settings : callable
        What decisions of other stages hand to this one, as plain values; in the cache's key like `inputs`. Of a
        stage that is decided on it has no more than what was decided, so that a change elsewhere in the scene
        which leaves the decision as it was leaves the result in the cache.
    by_parts : bool
        Whether `compute` keeps parts of the result by `Engine.parts`, and the cache nothing of the whole.
    finish : callable
        What is done with a result, computed or from the cache, by keys of the scene that cost nothing to follow and
        are in no key of the cache.
    """

    name: str
    title: str
    compute: Callable[[Engine], T]
    inputs: Inputs
    needs: tuple[Stage[Any], ...] = ()
    kept: tuple[str, ...] = ()
    settings: Settings = lambda engine: {}
    by_parts: bool = False
    finish: Callable[[Engine, Any], Any] = lambda engine, value: value


def stage(
    name: str,
    title: str,
    keys: str,
    *needs: Stage[Any],
    kept: str = "",
    of: Callable[[Scene], Scene] = lambda scene: scene,
    settings: Settings = lambda engine: {},
    by_parts: bool = False,
    finish: Callable[[Engine, Any], Any] = lambda engine, value: value,
) -> Callable[[Callable[[Engine], T]], Stage[T]]:
    """Make a stage of the function that computes it.

    Parameters
    ----------
    name, title, needs, settings, by_parts, finish
        As of `Stage`.
    keys : str
        Sections of the scene, or single keys of them, that the result depends on, separated by blanks.
    kept : str
        As of `Stage`, separated by blanks.
    of : callable
        Leaves out of the scene what makes no difference to the result.
    """

    def inputs(scene: Scene) -> dict[str, Any]:
        values = {key: reduce(getattr, key.split("."), of(scene)) for key in keys.split()}
        return {key: v.model_dump() if isinstance(v, Section) else v for key, v in values.items()}

    packages = tuple(kept.split())
    return lambda compute: Stage(name, title, compute, inputs, needs, packages, settings, by_parts, finish)


@dataclass(frozen=True)
class StageRun:
    """How a stage got its result.

    Attributes
    ----------
    seconds : float
        Time of this stage alone, without those it asked for [s].
    cached : bool
        Whether the result, or all kept parts that it asked for, were read from the cache.
    warnings : tuple of str
        What the ground floors warned of meanwhile; kept with the result.
    """

    name: str
    title: str
    seconds: float
    cached: bool
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class KeptPart:
    """Keeps parts of a stage's result in the cache, and notes which of them it held.

    Attributes
    ----------
    cache : Cache
    packages : tuple of str
        Whose code decides the parts.
    on_start : callable
        Called before the first part that has to be computed.
    hits : list of bool
        Grows by one with each part asked for.
    """

    cache: Cache
    packages: tuple[str, ...]
    on_start: Callable[[], None]
    hits: list[bool] = field(default_factory=list)

    def __call__(self, name: str, inputs: Mapping[str, Any], compute: Callable[[], T]) -> T:
        """Part of a name with plain inputs, from the cache or computed."""
        key = self.cache.key(name, inputs, self.packages)
        value: T | None = self.cache.get(key)
        if not _record_of(value, self.packages):  # somebody put it there
            value = None
        if value is None and all(self.hits):
            self.on_start()
        self.hits.append(value is not None)
        if value is None:
            value = compute()
            self.cache.put(key, value)
        return value


@dataclass
class Engine:
    """Holds the results of one run; the only thing here that changes.

    `on_start` is called with each stage before it is computed, `on_end` when its result is there.
    """

    scene: Scene
    cache: Cache
    on_start: Callable[[Stage[Any]], None] = lambda stage: None
    on_end: Callable[[Stage[Any]], None] = lambda stage: None
    runs: dict[str, StageRun] = field(default_factory=dict)
    failures: dict[str, Failure] = field(default_factory=dict)
    progress: Progress = silent
    _values: dict[str, Any] = field(default_factory=dict)
    _promised: dict[str, Callable[[], Any]] = field(default_factory=dict)
    _elsewhere: list[float] = field(default_factory=list)
    _parts: list[KeptPart] = field(default_factory=list)

    def __getitem__(self, stage: Stage[T]) -> T:
        """Return the result of a stage, computed when first asked for; one that failed raises its error again."""
        if (failed := self.failures.get(stage.name)) is not None:
            raise failed.error
        if stage.name not in self._values:
            with self._noting(stage.name, stage.title):
                self._values[stage.name] = self._obtain(stage)
            self.on_end(stage)
        stage_result: T = self._values[stage.name]
        return stage_result

    def inputs(self, stage: Stage[Any]) -> dict[str, Any]:
        """Everything that decides a stage's result, down to the scene's keys."""
        # apart: a setting may be called like a section, as the film's tolerance and [film] are
        own = {"keys": stage.inputs(self.scene), "decided": stage.settings(self)}
        return {stage.name: own, **{need.name: self.inputs(need) for need in stage.needs}}

    def promise(self, stage: Stage[T], result: Callable[[], T]) -> None:
        """Have a result that somebody else computes taken from there when its stage is asked for.

        The time of the stage is that of waiting for it.
        """
        self._promised[stage.name] = result

    def results(self) -> dict[str, Any]:
        """Results that have been asked for so far, by the names of their stages."""
        return dict(self._values)

    @contextmanager
    def _noting(self, name: str, title: str) -> Iterator[None]:
        """Note a part that fails, and what it failed by."""
        try:
            yield
        except (InputError, SolverError) as error:
            self.failures[name] = failure_of(name, title, error, self.failures)
            raise

    def timed(self, name: str, title: str, work: Callable[[], T]) -> T:
        """Do work that is no stage, such as writing files, and note its cost, or its failure, beside the stages'."""
        start = time.perf_counter()
        with self._noting(name, title):
            done = work()
        self.runs[name] = StageRun(name, title, time.perf_counter() - start, cached=False)
        return done

    @property
    def parts(self) -> KeptPart:
        """Keeper of parts of the running stage's result that other scenes have too, such as a gear of another pair."""
        return self._parts[-1]

    def rows(self, stage: Stage[Any]) -> Callable[[str, int, int], None]:
        """Shows what a long stage counts, how many are done and of how many, with the time left."""
        return rows_of(self.progress, stage.title)

    def _obtain(self, stage: Stage[T]) -> T:
        packages = packages_of(stage)
        part = KeptPart(self.cache, packages, lambda: self.on_start(stage))
        start = time.perf_counter()
        self._elsewhere.append(0.0)
        self._parts.append(part)
        try:
            (computed, heard), cached = self._found(stage, packages)
            value: T = stage.finish(self, computed)
        finally:  # a stage that fails leaves the clocks of the others right
            self._parts.pop()
            whole = time.perf_counter() - start
            own = whole - self._elsewhere.pop()
            if self._elsewhere:
                self._elsewhere[-1] += whole
        cached = cached or (bool(part.hits) and all(part.hits))
        self.runs[stage.name] = StageRun(stage.name, stage.title, own, cached, heard)
        return value

    def _found(self, stage: Stage[T], packages: tuple[str, ...]) -> tuple[tuple[T, tuple[str, ...]], bool]:
        """Result of a stage with what was warned of, and whether the cache held it."""
        whole_kept = bool(stage.kept) and not stage.by_parts
        key = self.cache.key(stage.name, self.inputs(stage), packages) if whole_kept else ""
        kept = _believed(stage, self.cache.get(key)) if whole_kept else None
        if kept is not None:
            return kept, True
        if not stage.by_parts:
            self.on_start(stage)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            promised = self._promised.get(stage.name)
            value = stage.compute(self) if promised is None else promised()
        computed = value, tuple(str(warning.message) for warning in distinct(caught))
        if whole_kept:
            self.cache.put(key, computed)
        return computed, False


def _believed(stage: Stage[T], entry: Any) -> tuple[T, tuple[str, ...]] | None:
    """Result and warnings that the cache holds of a stage; None where somebody put something else there."""
    if not (isinstance(entry, tuple) and len(entry) == 2 and isinstance(entry[1], tuple)):
        return None
    value, heard = entry
    of_type = isinstance(value, get_type_hints(stage.compute)["return"])
    return (value, heard) if of_type and all(isinstance(text, str) for text in heard) else None


def _record_of(value: object, packages: tuple[str, ...]) -> bool:
    """Whether a value is a record of one of these packages, as parts of results are."""
    return is_dataclass(value) and type(value).__module__.partition(".")[0] in packages


def packages_of(stage: Stage[Any]) -> tuple[str, ...]:
    """Packages whose code decides a stage's result: its own, those of what it needs, and the ground of all."""
    return tuple(sorted({"base", *stage.kept, *(p for need in stage.needs for p in packages_of(need))}))
