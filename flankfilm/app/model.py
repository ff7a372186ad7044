"""What one window of the page is about: a scene that is edited, its faults and answers, and its run.

Nothing here is about browsers: the page shows what `Model.view` gives, and calls the other methods.
"""

from __future__ import annotations

import dataclasses
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from base import FlankfilmError, InputError
from flankfilm.app.answers import instant
from flankfilm.app.checking import Checked, checked
from flankfilm.app.contact import answerable
from flankfilm.app.document import Document
from flankfilm.app.drawing import drawing
from flankfilm.app.live import Live
from flankfilm.app.running import Run, RunState
from flankfilm.app.scene_files import Opened, SceneFiles, python_of
from flankfilm.app.side_by_side import compared
from flankfilm.app.sliders import Slider, beside, sliders
from flankfilm.app.studies import asked_rows
from flankfilm.building.pair import gear_pair

__all__ = ["Model"]

SUFFIX = "-results"
"""What the folder of a scene's results ends in, as of the command line."""

UNNAMED = "scene"
"""Name of the results of a scene that is not saved."""

MOST_UNDONE = 200
"""Edits that can be taken back."""


class Model:
    """One window: what it shows changes with each call.

    Parameters
    ----------
    files : SceneFiles
    tell : callable
        Takes what comes later, in another thread: a kind, "live", "run", "rows" or "comparison", and plain values.
    name : str
        Scene to open, from the folder of the files; the template if empty.

    Raises
    ------
    InputError
        Where the scene cannot be opened.
    """

    def __init__(
        self, files: SceneFiles, tell: Callable[[str, Mapping[str, Any]], None], name: str = ""
    ) -> None:
        self.files, self._tell = files, tell
        self._opened = files.open(name) if name else files.example("")
        self._before: list[Opened] = []
        self._live = Live(lambda message: tell("live", message))
        self._run: Run | None = None
        self._number = 0
        self._judged = Checked(None)
        self._sliders: tuple[Slider, ...] = ()
        self._judge()
        self._sliders = self._ranges()

    @property
    def judged(self) -> Checked:
        """The scene as it was judged last."""
        return self._judged

    @property
    def text(self) -> str:
        """The file as it would be saved."""
        return self._opened.document.text

    def view(self) -> dict[str, Any]:
        """All that the page shows of the scene, as plain values; later answers have its ``number``."""
        judged, opened = self._judged, self._opened
        view: dict[str, Any] = {
            "name": opened.name,
            "saved": bool(opened.name) and not self._before,
            "values": opened.document.values,
            "faults": judged.by_key,
            "heard": [*opened.notes, *judged.heard],
            "number": self._number,
            "answers": [],
            "drawing": None,
            "sliders": [vars(slider) for slider in self._sliders],
            "why_no_curves": "Correct the faults first."
            if judged.scene is None
            else answerable(judged.scene),
        }
        if judged.scene is not None and judged.scene.pair is not None:
            pair = gear_pair(judged.scene)
            view["answers"] = [vars(one) for one in instant(judged.scene, pair)]
            view["drawing"] = vars(drawing(pair))
        return view

    def edit(self, path: str, typed: str) -> None:
        """Give a key another value; an empty one takes it out.

        Parameters
        ----------
        path : str
            A key of the form.
        typed : str

        Raises
        ------
        InputError
            Where the file cannot hold it.
        """
        self._change(self._opened.document.with_value(path, typed))

    def _change(self, document: Document) -> None:
        if document is not self._opened.document:
            self._before = [*self._before[-MOST_UNDONE:], self._opened]
            self._opened = dataclasses.replace(self._opened, document=document)
            self._judge()

    def drag(self, path: str, typed: str) -> None:
        """Edit a key of a slider, with what must be there beside it.

        Parameters
        ----------
        path : str
            A key that has a slider.
        typed : str
        """
        document = self._opened.document
        for other, text in beside(document, path).items():
            document = document.with_value(other, text)
        self._change(document.with_value(path, typed))

    def resume(self, other: Model) -> None:
        """Go on with the scene of another window, and with the edits that it could take back."""
        before, ranges = [*other._before], other._sliders  # either window then takes back by itself
        self._take(other._opened)
        self._before, self._sliders = before, ranges

    def undo(self) -> None:
        """Take the last edit back."""
        if self._before:
            self._opened = self._before.pop()
            self._judge()

    def open(self, name: str) -> None:
        """Open a file of the folder; see `SceneFiles.open`."""
        self._take(self.files.open(name))

    def example(self, name: str) -> None:
        """Open an example, or the template; see `SceneFiles.example`."""
        self._take(self.files.example(name))

    def save(self, name: str) -> tuple[str, ...]:
        """Save the scene, or its pair as gear data, by the ending of the name; give what was left out."""
        if Path(name).suffix != ".toml" and self._judged.scene is not None:
            return self.files.save_gear_data(self._judged.scene, name)
        self._opened, self._before = self.files.save(self._opened, name), []
        return ()

    def python(self) -> str:
        """Python that computes the same."""
        return python_of(self._opened.document, self._results.name)

    def run(self) -> RunState:
        """Start a run of the scene as it is.

        Raises
        ------
        InputError
            Where the scene has faults, or a run of this window is at work.
        """
        self._refuse_second()
        if self._judged.scene is None:
            raise InputError(self._judged.faults)
        place, folder = self._opened.place, self.files.place.inside(str(self._results))
        arguments = (str(place.root), str(place.folder), str(folder))
        self._run = Run("run", arguments, folder, self._tell, self._opened.document.text)
        return self._run.state

    def rows(self, name: str, example: str = "", resume: str = "") -> RunState:
        """Start a study or an optimisation.

        Parameters
        ----------
        name : str
            Of `flankfilm.app.studies.rows_files`.
        example, resume : str
            Whether it is an example, and whether rows that are there are kept; "" for no.

        Raises
        ------
        InputError
            Where there is none of that name, or a run of this window is at work.
        """
        self._refuse_second()
        asked, place, file = asked_rows(self.files, name, bool(example))
        folder = self.files.place.inside(asked.folder)
        arguments = (str(place.root), str(place.folder), str(folder), str(file))
        kept = ("resume",) if resume else ()
        self._run = Run(asked.kind, (*arguments, *kept), folder, self._tell)
        return self._run.state

    def _refuse_second(self) -> None:
        if self._run is not None and self._run.running:
            raise InputError.at("run", "", "is at work already", "Cancel it first")

    def cancel(self) -> None:
        """End the run."""
        if self._run is not None:
            self._run.cancel()

    def compare(self, *names: str) -> None:
        """Compare results of the folder in another thread, which hands on a "comparison".

        Parameters
        ----------
        *names : str
            Of `flankfilm.app.kept.kept_results`.
        """
        threading.Thread(target=self._compare, args=(names,), daemon=True).start()

    def _compare(self, names: Sequence[str]) -> None:
        try:
            comparison = dataclasses.asdict(compared(self.files.place, names))
        except (FlankfilmError, OSError) as error:
            comparison = {"problem": str(error)}
        self._tell("comparison", comparison)

    @property
    def run_state(self) -> RunState | None:
        """How the last run stands; None before the first."""
        return None if self._run is None else self._run.state

    @property
    def processes(self) -> tuple[int, ...]:
        """Numbers of the processes that this window has started."""
        return () if self._live.process is None else (self._live.process,)

    def close(self) -> None:
        """End all that this window has started."""
        self._live.close()
        if self._run is not None:
            self._run.close()

    @property
    def _results(self) -> Path:
        name = Path(self._opened.name or UNNAMED)
        return self.files.root / name.parent / f"{name.stem}{SUFFIX}"

    def _take(self, opened: Opened) -> None:
        self._opened, self._before = opened, []
        self._judge()
        self._sliders = self._ranges()

    def _ranges(self) -> tuple[Slider, ...]:
        """Sliders of the scene as it was opened."""
        scene = self._judged.scene
        distance = None if scene is None or scene.pair is None else gear_pair(scene).working_centre_distance
        return sliders(self._opened.document, None if distance is None else round(1e3 * distance, 4))

    def _judge(self) -> None:
        """Judge the scene, and ask for its answers."""
        self._judged = checked(self._opened.document, self._opened.place)
        scene = self._judged.scene
        if scene is None or answerable(scene):
            self._live.forget()
        else:
            self._number = self._live.ask(self._opened.document, self._opened.place)
