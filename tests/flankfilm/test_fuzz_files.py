"""Every file that we read, changed at random: it is read, or refused with a list of faults; it runs nothing.

The default suite tries a few of each kind. The slow test tries ``FLANKFILM_FUZZ`` in all (400 if it is not set);
``FLANKFILM_SEED`` repeats them. Ten thousand:

    FLANKFILM_FUZZ=10000 ./run test --slow -s tests/flankfilm/test_fuzz_files.py
"""

from __future__ import annotations

import gc
import hashlib
import json
import pickle
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time
import warnings
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest
import xarray as xr

from base import FlankfilmError
from fem import forget_gears
from flankfilm.exchange.bring_in import imported
from flankfilm.figures.rendering.animation import Frame, _view
from flankfilm.files.cache import Cache
from flankfilm.files.manifest import conclude
from flankfilm.optimisation.task import read_task
from flankfilm.output.files import write_netcdf
from flankfilm.output.reproduce import scene_in
from flankfilm.runs.check import check_scene
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene, read_scene, template
from flankfilm.scene.tables.trace_files import read_curves
from flankfilm.studies.execution import Execution
from flankfilm.studies.kept import Work, kept_rows
from flankfilm.studies.plan import read_plan
from flankfilm.studies.run import refuse_unknown, run_study
from flankfilm.studies.table import Columns
from tests.flankfilm.program import EXAMPLES
from tests.flankfilm.scenes import ARTICLE
from tests.flankfilm.test_exchange_rexs import OLD
from tests.mutations import FILES, changed_bytes, changed_file, changed_text, changed_value
from tests.seeds import SEED

LONGEST = 20.0
"""Seconds of processor time that one file may take."""

BLOCKED = 900.0
"""Seconds after which it waits for something."""

FORBIDDEN = ("os.system", "os.exec", "os.posix_spawn", "os.fork", "subprocess.Popen", "pickle.find_class",
             "socket.connect", "ctypes.dlopen", "code.__new__", "os.symlink", "os.chmod")  # fmt: skip
"""Audit events that reading a file must not cause."""

WATCHED: list[str] = []
"""What happened of these while a file was read."""


class Watch:
    """Notes forbidden events of the thread that it is on in; an audit hook cannot be taken away again."""

    thread = 0
    there = False


def _audit(event: str, arguments: tuple[Any, ...]) -> None:
    if Watch.thread == threading.get_ident() and event in FORBIDDEN:
        WATCHED.append(f"{event} {arguments!r}"[:300])


def _thrown_away(fault: Any) -> None:
    """Note a traceback that a destructor would print."""
    WATCHED.append(f"{fault.exc_value!r} in {fault.object!r}"[:300])


@contextmanager
def watched() -> Iterator[None]:
    """Fail on what is run, and on what takes too long."""
    if not Watch.there:
        sys.addaudithook(_audit)
        Watch.there = True

    def late(*_: object) -> None:
        raise AssertionError(f"took longer than {LONGEST} s of work, or {BLOCKED} s in all")

    clocks = ((signal.SIGPROF, signal.ITIMER_PROF, LONGEST), (signal.SIGALRM, signal.ITIMER_REAL, BLOCKED))
    before = [signal.signal(number, late) for number, _, _ in clocks]
    hook, sys.unraisablehook = sys.unraisablehook, _thrown_away
    for _, clock, seconds in clocks:
        signal.setitimer(clock, seconds)
    Watch.thread = threading.get_ident()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        Watch.thread = 0
        sys.unraisablehook = hook
        for (number, clock, _), handler in zip(clocks, before, strict=True):
            signal.setitimer(clock, 0.0)
            signal.signal(number, handler)
    assert WATCHED == [], WATCHED


class Kind(ABC):
    """One kind of file: examples, how they are changed, and what reads them."""

    def __init__(self, folder: Path, source: Path) -> None:
        self.folder = folder
        self.source = source

    @abstractmethod
    def fresh(self, chance: random.Random) -> bytes:
        """Give the content of a changed file."""

    @abstractmethod
    def read(self, content: bytes) -> None:
        """Read it as commands do."""


SCENES = [path.read_text(encoding="utf-8") for path in sorted(EXAMPLES.glob("*.toml"))]
STUDIES = [path.read_text(encoding="utf-8") for path in sorted((EXAMPLES / "studies").glob("*.toml"))]
TASKS = [path.read_text(encoding="utf-8") for path in sorted((EXAMPLES / "optimise").glob("*.toml"))]
TRACES = [path.read_text(encoding="utf-8") for path in sorted((EXAMPLES / "measured").glob("*.csv"))]

ENTITIES = [f'<!ENTITY {chr(98 + i)} "{10 * f"&{chr(97 + i)};"}">' for i in range(10)]
BOMB = f"""<!DOCTYPE model [<!ENTITY a "aaaaaaaaaa">{"".join(ENTITIES)}<!ENTITY x SYSTEM "file:///etc/passwd">]>"""


class Scenes(Kind):
    """Scene files, checked with their geometry."""

    def fresh(self, chance: random.Random) -> bytes:
        return changed_file(chance, chance.choice([*SCENES, template()]), chance.choice(SCENES))

    def read(self, content: bytes) -> None:
        path = self.folder / "scene.toml"
        path.write_bytes(content)
        check_scene(read_scene(path))


class Studies(Kind):
    """Study files beside a scene."""

    texts, reader = STUDIES, staticmethod(lambda path: read_plan(path).identity())

    def fresh(self, chance: random.Random) -> bytes:
        if not (self.folder / "studies").exists():  # scenes and tables that they name
            for path in (*EXAMPLES.rglob("*.toml"), *EXAMPLES.rglob("*.csv")):
                target = self.folder / path.relative_to(EXAMPLES)
                target.parent.mkdir(exist_ok=True)
                target.write_bytes(path.read_bytes())
        return changed_file(chance, chance.choice(self.texts), chance.choice([*STUDIES, *TASKS]))

    def read(self, content: bytes) -> None:
        path = self.folder / "studies" / "changed.toml"
        path.write_bytes(content)
        self.reader(path)


class Tasks(Studies):
    """Optimisation files."""

    texts, reader = TASKS, staticmethod(read_task)


class Rexs(Kind):
    """REXS files, some with entities."""

    def fresh(self, chance: random.Random) -> bytes:
        text = OLD
        if chance.random() < 0.1:
            text = text.replace("?>\n", "?>\n" + BOMB, 1)
        if chance.random() < 0.2:
            text = text.replace(
                "UTF-8", chance.choice(["UTF-16", "latin-1", "UTF-7", "cp037", "x" * 50, "idna"]), 1
            )
        return changed_file(chance, text, OLD)

    def read(self, content: bytes) -> None:
        path = self.folder / "pair.rexs"
        path.write_bytes(content)
        parse_scene(imported(path).text)


class Traces(Kind):
    """CSV files of measured flanks and wear."""

    def fresh(self, chance: random.Random) -> bytes:
        text = "\n".join(chance.choice(TRACES).splitlines()[: chance.choice((5, 50, 400))])
        if chance.random() < 0.2:
            text = text.replace(",", ";").replace(".", ",")
        return changed_file(chance, text, chance.choice(TRACES))

    def read(self, content: bytes) -> None:
        path = self.folder / "traces.csv"
        path.write_bytes(content)
        for name in ("material_um", "depth_um"):
            with suppress(FlankfilmError):
                read_curves(path, name, "pair.pinion.wear")


class Results(Kind):
    """Files results.nc: bytes, attributes and variables changed; read for their scene and for pictures.

    Reading takes as long as there are variables, a hundred and more. So most files have those alone that pictures are
    made of, and one more: each byte of them is likelier to matter, and ten are read in the time of a whole one.
    """

    drawn = ("field_point", "field_centre", "field_reach", "field_von_mises", "field_triangles", "pair_module",
             "pair_base_pitch", "pair_base_radii", "path_point_rho1", "path_point_place",
             "dry_transmission_error", "outline_centre", "pair_form_radii", "pair_root_radii")  # fmt: skip

    def __init__(self, folder: Path, source: Path) -> None:
        super().__init__(folder, source)
        _view(source, Frame())  # libraries are loaded before it is watched what reading causes
        with xr.open_dataset(source / "results.nc", engine="h5netcdf") as whole:
            write_netcdf(folder / "few.nc", whole[list(self.drawn)].load())
        self.read((folder / "few.nc").read_bytes(), suppressed=())  # it lacks nothing

    def fresh(self, chance: random.Random) -> bytes:
        path = self.source / "results.nc" if chance.random() < 0.1 else self.folder / "few.nc"
        whole = path.read_bytes()
        if chance.random() < 0.6:
            if chance.random() < 0.5:
                return changed_bytes(chance, whole)
            # the part that says what is where, rather than the numbers
            return changed_bytes(chance, whole[:20_000]) + whole[20_000:]
        return self._edited(chance, whole)

    def _edited(self, chance: random.Random, whole: bytes) -> bytes:
        import h5py
        import numpy as np

        path = self.folder / "edited.nc"
        path.write_bytes(whole)
        odd = [1, -1.0, float("nan"), b"\xff", "x" * 10_000, "[1]", "{", "[" * 50_000, np.zeros((3, 2)), np.zeros(0),
               np.array(["a", "b"], dtype=h5py.string_dtype()), np.float64(1e308), '{"wants": 3}']  # fmt: skip
        with h5py.File(path, "r+") as file:
            for _ in range(chance.choice((1, 1, 3))):
                how, name = chance.randrange(6), chance.choice(sorted(file))
                if how == 0:
                    file.attrs[chance.choice(sorted(file.attrs))] = chance.choice(odd)
                elif how == 1:
                    key = chance.choice(["scene_json", "versions_json"])
                    file.attrs[key] = changed_text(chance, str(file.attrs[key]), SCENES[0])[:60_000].replace(
                        "\0", ""
                    )
                elif how == 2:
                    del file[name]
                elif how == 3:
                    del file[name]
                    file[name] = chance.choice(odd[:3] + odd[8:11])
                elif how == 4:
                    del file[name]
                    file[name] = chance.choice(
                        [h5py.SoftLink("/nowhere"), h5py.SoftLink(f"/{name}")]
                        + [
                            h5py.ExternalLink(other, "/x")
                            for other in ("/dev/zero", "/etc/passwd", "results.nc")
                        ]
                    )
                elif isinstance(file[name], h5py.Dataset) and file[name].dtype.kind == "f":
                    value = chance.choice([0.0, float("nan"), float("inf"), -1.0, 1e308, 5e-324])
                    with np.errstate(over="ignore"):  # in single precision the largest is infinite
                        file[name][...] = np.asarray(value).astype(file[name].dtype)
        return path.read_bytes()

    def read(self, content: bytes, suppressed: tuple[type[Exception], ...] = (FlankfilmError,)) -> None:
        path = self.folder / "results.nc"
        path.write_bytes(content)
        (self.folder / "mesh_cycle.pvd").write_bytes((self.source / "mesh_cycle.pvd").read_bytes())
        with suppress(*suppressed):
            scene_in(path)
        # the files for ParaView are not looked into, which would take as long as a hundred reads
        looked_into = patch("flankfilm.figures.rendering.animation._stress_where", return_value=1e8)
        with suppress(*suppressed), looked_into:
            _view(self.folder, Frame())


class CacheEntries(Kind):
    """Entries of the cache: changed bytes, and under the right digest changed content, and pickles."""

    def fresh(self, chance: random.Random) -> bytes:
        kept = sorted((self.source / "cache" / "results").iterdir())
        head, _, payload = chance.choice(kept).read_bytes().partition(b"\n")
        how = chance.random()
        if how < 0.2:
            return changed_bytes(chance, head + b"\n" + payload)
        if how < 0.3:
            payload = changed_bytes(chance, payload)
        elif how < 0.35:
            payload = pickle.dumps(Runs(str(self.folder / "executed")), protocol=chance.randrange(6))
        else:
            size = int.from_bytes(payload[:8], "little")
            value = json.loads(payload[8 : 8 + size])
            for _ in range(chance.choice((1, 1, 2, 5))):
                value = changed_value(chance, value)
            new = json.dumps(value).encode()
            payload = len(new).to_bytes(8, "little") + new + payload[8 + size :]
        return hashlib.sha256(b"entry\n" + payload).hexdigest().encode() + b"\n" + payload

    def read(self, content: bytes) -> None:
        (self.folder / "entry").write_bytes(content)
        Cache(self.folder).get("entry")


class Runs:
    """What a pickle would run."""

    def __init__(self, path: str) -> None:
        self.path = path

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[str, str]]:
        return open, (self.path, "w")


class Rows(Kind):
    """Tables of rows and the notes beside them, which a study that is taken up again finds."""

    text = (
        'outputs = ["contact_ratio"]\n[vary]\n"pair.pinion.profile_shift" = { from = -0.2, to = 0.4, steps = 4 }\n'
        "[scene.pair]\nmodule_mm = 2.0\nface_width_mm = 40.0\npinion = { teeth = 36 }\nwheel = { teeth = 40 }\n"
    )

    def fresh(self, chance: random.Random) -> bytes:
        whole = self.source / "rows"
        if not whole.exists():
            (self.source / "rows.toml").write_text(self.text, encoding="utf-8")
            run_study(read_plan(self.source / "rows.toml"), whole, Execution(workers=1))
        name = chance.choice(["rows.csv", "study.json"])
        text = (whole / name).read_text(encoding="utf-8")
        return name.encode() + b"\n" + changed_file(chance, text, text)

    def read(self, content: bytes) -> None:
        name, _, content = content.partition(b"\n")
        rows = self.folder / "rows"
        rows.mkdir(exist_ok=True)
        for path in (self.source / "rows").glob("[rs]*.[cj]s*"):
            (rows / path.name).write_bytes(path.read_bytes())
        (rows / name.decode()).write_bytes(content)
        plan = read_plan(self.source / "rows.toml")
        work = Work("study", plan.title, plan.identity(), Columns(plan.keys, plan.outputs))
        with kept_rows(rows, work, True) as kept:
            refuse_unknown(self.folder, kept.lines, plan)


class Lists(Kind):
    """Lists of a run's files, which the next run there takes away."""

    def fresh(self, chance: random.Random) -> bytes:
        text = (self.source / "files.json").read_text(encoding="utf-8")
        if chance.random() < 0.3:
            return json.dumps(changed_value(chance, json.loads(text))).encode()
        return changed_file(chance, text, text)

    def read(self, content: bytes) -> None:
        place = self.folder / "listed"
        place.mkdir(exist_ok=True)
        (place / "mine.txt").write_text("mine")
        (place / "files.json").write_bytes(content)
        conclude(place, [])
        assert (place / "mine.txt").read_text() == "mine"


KINDS: dict[type[Kind], int] = {
    Scenes: 10, Studies: 8, Tasks: 8, Rexs: 10, Traces: 8, Results: 10, CacheEntries: 11, Rows: 5, Lists: 5,
}  # fmt: skip
"""Kinds, and how many of a hundred files are of each; the rest are made in test_fuzz_scene.py."""


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """A finished run with its cache, to be changed."""
    folder = tmp_path_factory.mktemp("source")
    forget_gears()  # what the process has solved already would not be asked of the cache
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FLANKFILM_CACHE", str(folder / "cache"))
        wants = '["stiffness", "vtk"]'
        text = f'title = "Changed"\nwants = {wants}\ntolerance = 0.05\n{ARTICLE}\n[film]\nmodel = "none"\n'
        run_scene(parse_scene(text), folder)
    return folder


def tried(kind: Kind, count: int, chance: random.Random) -> float:
    """Read so many changed files; give the longest time that one took."""
    slowest = 0.0
    gc.collect()  # what earlier tests left: their destructors are not ours to watch
    for number in range(count):
        content = kind.fresh(chance)
        began = time.process_time()
        try:
            with watched(), suppress(FlankfilmError):
                kind.read(content)
        except BaseException as fault:
            kept = (
                Path(tempfile.mkdtemp(prefix="flankfilm-fuzz-")) / type(kind).__name__
            )  # outlives the session
            kept.write_bytes(content)
            fault.add_note(f"FLANKFILM_SEED={SEED}, {type(kind).__name__} number {number}, kept as {kept}")
            raise
        slowest = max(slowest, time.process_time() - began)
    return slowest


@pytest.mark.slow
@pytest.mark.timeout(0)
@pytest.mark.parametrize("kind", KINDS)
def test_changed_files_are_read_or_refused(kind, source, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    count = FILES * KINDS[kind] // sum(KINDS.values())
    slowest = tried(kind(tmp_path, source), count, random.Random(f"{SEED} {kind.__name__}"))
    assert not list(tmp_path.rglob("executed"))
    print(f"\n{kind.__name__}: {count}, FLANKFILM_SEED={SEED}, slowest {slowest:.1f} s")


@pytest.mark.parametrize("kind", [Scenes, Rexs, Traces, Lists, Tasks])
def test_some_changed_files_are_read_or_refused(kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "files.json").write_text(json.dumps({"sha256": {"a": "0" * 64}}))
    tried(kind(tmp_path, tmp_path), 12, random.Random(SEED))
    assert not list(tmp_path.rglob("executed"))


def test_the_watch_sees_what_is_run(tmp_path):
    """Else the absence of events would mean nothing."""
    payload = pickle.dumps(Runs(str(tmp_path / "executed")))
    with pytest.raises(AssertionError, match="find_class"), watched():
        pickle.loads(payload)
    WATCHED.clear()
    assert (tmp_path / "executed").exists()
    with pytest.raises(AssertionError, match="Popen"), watched():
        subprocess.run([sys.executable, "-c", ""], check=True)
    WATCHED.clear()
