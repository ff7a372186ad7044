"""Calls that a page may make of its window, by their names; whatever goes wrong is an answer, not an end."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, MutableMapping
from typing import Any

from base import FlankfilmError, InputError
from flankfilm.app.form import form
from flankfilm.app.kept import kept_results
from flankfilm.app.model import Model
from flankfilm.app.scene_files import SceneFiles
from flankfilm.app.studies import rows_files

__all__ = ["Tabs", "Window"]

LONGEST = 1_000_000
"""Characters of an argument."""


Tabs = MutableMapping[str, Model]
"""Last window of each tab of a browser, by the key that the tab keeps while its page is loaded again."""

MOST_TABS = 32
"""Tabs whose edits are kept; those of the one that was loaded first go."""


class Window:
    """One window of the page: its model, and what the page may call.

    Parameters
    ----------
    files : SceneFiles
    name : str
        Scene to open; the template if empty.
    tell : callable
        Takes what comes later, in another thread.
    tabs : mutable mapping, optional
        In which the page, loaded again, finds the scene that its tab was at.
    """

    def __init__(
        self,
        files: SceneFiles,
        name: str,
        tell: Callable[[str, Mapping[str, Any]], None],
        tabs: Tabs | None = None,
    ) -> None:
        self._first, self._tabs = "", {} if tabs is None else tabs
        try:
            self._model = Model(files, tell, name)
        except InputError as error:
            self._model = Model(files, tell)
            self._first = str(error)
        self._calls: dict[str, Callable[..., dict[str, Any] | None]] = {
            "start": self._start,
            "edit": self._model.edit,
            "drag": self._model.drag,
            "undo": self._model.undo,
            "open": self._model.open,
            "example": self._model.example,
            "save": self._save,
            "run": self._run,
            "rows": self._rows,
            "studies": lambda: {"studies": [vars(asked) for asked in rows_files(files)]},
            "cancel": self._model.cancel,
            "compare": self._model.compare,
            "python": lambda: {"python": self._model.python()},
            "text": lambda: {"text": self._model.text},
            "listed": self._listed,
        }

    def call(self, method: str, *arguments: str) -> dict[str, Any]:
        """Call a method of the window.

        Parameters
        ----------
        method : str
            One of a fixed list.
        *arguments : str

        Returns
        -------
        dict
            ``view`` of the model, what the method gives besides, and a ``problem`` where it failed.
        """
        answer: dict[str, Any] = {"problem": self._first}
        self._first = ""
        texts = all(isinstance(one, str) and len(one) <= LONGEST for one in arguments)
        try:
            if method not in self._calls or not texts:
                raise InputError.at("call", str(method)[:80], "is none of this page", "Load the page again")
            answer |= self._calls[method](*arguments) or {}
        except InputError as error:
            answer["problem"] = "; ".join(map(str, error.faults))
        except FlankfilmError as error:
            answer["problem"] = str(error)
        except OSError as error:
            answer["problem"] = f"{error.filename or ''}: {error.strerror or error}"
        except TypeError as error:
            logging.getLogger(__name__).exception(method)
            answer["problem"] = f"the page and the program do not agree: {error}; load the page again"
        return answer | {"view": self._model.view()}

    def close(self) -> None:
        """End all that the window has started."""
        self._model.close()

    def _start(self, tab: str = "") -> dict[str, Any]:
        if (before := self._tabs.pop(tab, None)) is not None:
            self._model.resume(before)
        if tab:
            self._tabs[tab] = self._model
            for oldest in list(self._tabs)[:-MOST_TABS]:
                del self._tabs[oldest]
        sections = [{**vars(section), "keys": [vars(key) for key in section.keys]} for section in form()]
        return {"form": sections, **self._listed()}

    def _listed(self) -> dict[str, Any]:
        files = self._model.files
        return {
            "files": files.listed(),
            "examples": files.examples(),
            "folder": str(files.root),
            "results": self._results(),
        }

    def _results(self) -> list[dict[str, Any]]:
        return [vars(kept) for kept in kept_results(self._model.files.root)]

    def _save(self, name: str) -> dict[str, Any]:
        left_out = self._model.save(name)
        return {"notes": left_out, **self._listed()}

    def _run(self) -> dict[str, Any]:
        return {"run": vars(self._model.run())}

    def _rows(self, *arguments: str) -> dict[str, Any]:
        return {"run": vars(self._model.rows(*arguments))}
