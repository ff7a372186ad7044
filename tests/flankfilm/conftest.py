"""A headless Chromium that opens pages, spoken to over its debugging pipe: no driver, no further package.

Rows of studies without processes of their own, and a run with fields.
"""

from __future__ import annotations

import base64
import contextlib
import itertools
import json
import os
import select
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any

import pytest

from flankfilm.studies import workers
from flankfilm.studies.executors import Pool

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
PATIENCE = 60.0
"""Seconds that one command may take."""

START = """import os, sys
ends = [os.dup(int(end)) for end in sys.argv[1:3]]
for end, wanted in zip(ends, (3, 4)):
    os.dup2(end, wanted)
    os.set_inheritable(wanted, True)
os.execv(sys.argv[3], sys.argv[3:])
"""
"""Makes the pipe's ends the file descriptors 3 and 4, where Chromium looks for them."""


BLANK = "about:blank"


class Browser:
    """One page of a headless Chromium; what it logs is kept in `logged`."""

    def __init__(self, executable: str, profile: Path) -> None:
        to_browser, self._commands = os.pipe()
        self._answers, from_browser = os.pipe()
        self._process = subprocess.Popen(
            [sys.executable, "-c", START, str(to_browser), str(from_browser), executable,
             "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
             "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage", "--hide-scrollbars",
             f"--user-data-dir={profile}", "--remote-debugging-pipe"],
            pass_fds=(to_browser, from_browser), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        os.close(to_browser)
        os.close(from_browser)
        self._numbers, self._rest, self._events = itertools.count(1), b"", []
        self.logged: list[str] = []
        target = self._call("Target.createTarget", {"url": BLANK}, None)["targetId"]
        attach = {"targetId": target, "flatten": True}
        self._session = self._call("Target.attachToTarget", attach, None)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Send one command to the page and return its result."""
        return self._call(method, parameters, self._session)

    def open(
        self, page: Path | str, width: int, height: int = 900, dark: bool = False, media: str = "screen"
    ) -> None:
        """Load a file, or what is at an address, as a screen of a given size and scheme shows it."""
        if self.run("location.href") != BLANK:  # what the page before still says is not this one's
            self._load(BLANK)
        self.logged.clear()
        phone = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600}
        self.call("Emulation.setDeviceMetricsOverride", **phone)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", media=media, features=[scheme])
        self._load(page if isinstance(page, str) else page.absolute().as_uri())

    def _load(self, address: str) -> None:
        self._events.clear()
        self.call("Page.navigate", url=address)
        self._until("Page.loadEventFired")

    def run(self, script: str) -> Any:
        """Give what a script returns."""
        found = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def shot(self, file: Path) -> None:
        """Write the whole page as it is seen to a PNG file."""
        taken = self.call("Page.captureScreenshot", captureBeyondViewport=True)
        file.write_bytes(base64.b64decode(taken["data"]))

    def close(self) -> None:
        """End the browser."""
        with contextlib.suppress(OSError):
            os.close(self._commands)
        self._process.terminate()
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._answers)

    def _call(self, method: str, parameters: dict[str, Any], session: str | None) -> dict[str, Any]:
        number = next(self._numbers)
        command = {"id": number, "method": method, "params": parameters}
        if session is not None:
            command["sessionId"] = session
        os.write(self._commands, json.dumps(command).encode() + b"\0")
        while True:
            reply = self._receive()
            if reply.get("id") == number:
                assert "error" not in reply, f"{method}: {reply['error']}"
                return dict(reply["result"])

    def _until(self, event: str) -> None:
        while event not in self._events:
            self._receive()

    def _receive(self) -> dict[str, Any]:
        end = time.monotonic() + PATIENCE
        while b"\0" not in self._rest:
            ready, _, _ = select.select([self._answers], [], [], max(0.0, end - time.monotonic()))
            part = os.read(self._answers, 1 << 16) if ready else b""
            if not part:
                pytest.fail("Chromium ended, or did not answer in time")
            self._rest += part
        line, _, self._rest = self._rest.partition(b"\0")
        reply: dict[str, Any] = json.loads(line)
        self._keep(reply)
        return reply

    def _keep(self, reply: dict[str, Any]) -> None:
        """Remember events, and what a developer would see in red or yellow."""
        method, inside = reply.get("method", ""), reply.get("params", {})
        self._events.append(method)
        if method == "Runtime.consoleAPICalled" and inside["type"] in ("error", "warning", "assert"):
            self.logged.append(json.dumps(inside["args"]))
        elif method == "Runtime.exceptionThrown":
            self.logged.append(json.dumps(inside["exceptionDetails"]))
        elif method == "Log.entryAdded" and inside["entry"]["level"] in ("error", "warning"):
            self.logged.append(inside["entry"]["text"])
        elif method == "Network.loadingFailed":
            self.logged.append(f"not loaded: {inside['errorText']}")


@pytest.fixture(scope="session")
def chromium() -> str:
    """Path of Chromium; where it is missing the test is skipped, or fails where FLANKFILM_REQUIRE_CHROMIUM is set."""
    executable = next((found for name in NAMES if (found := shutil.which(name))), None)
    if executable is None:
        reply = "no Chromium (apt-get install chromium)"
        if os.environ.get("FLANKFILM_REQUIRE_CHROMIUM"):
            pytest.fail(reply)
        pytest.skip(reply)
    return executable


@pytest.fixture(scope="session")
def browser(chromium: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """Chromium with one page."""
    opened = Browser(chromium, tmp_path_factory.mktemp("chromium"))
    yield opened
    opened.close()


@pytest.fixture(scope="session")
def run_with_fields(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of a run with three positions for ParaView, which nobody writes into."""
    from tests.flankfilm.fields import write_run

    return write_run(tmp_path_factory.mktemp("fields"))


class Here(Executor):
    """Computes a row where it is asked for, before the next one."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call; what it raises is the test's."""
        future: Future[Any] = Future()
        future.set_result(fn(*args, **kwargs))
        return future


@contextlib.contextmanager
def computed_here() -> Iterator[None]:
    """Rows in this process: each of their own takes two seconds to start."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            workers, "executor", lambda kind, count: contextlib.nullcontext(Pool(Here(), lambda: 1))
        )
        yield


@pytest.fixture
def rows_here() -> Iterator[None]:
    """Rows in the test's process, for tests that ask what is made of them."""
    with computed_here():
        yield


@pytest.fixture(scope="module")
def rows_of_module_here() -> Iterator[None]:
    """The same for all tests of a module, and for what they share."""
    with computed_here():
        yield
