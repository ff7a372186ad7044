"""The page in a headless Chromium: drags, faults, runs, two windows, small screens, and what it refuses."""

from __future__ import annotations

import http.client
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote, urlsplit

import pytest

from tests.flankfilm.app.test_model import RUN
from tests.flankfilm.app.test_side_by_side import results
from tests.flankfilm.app.test_studies import STUDY
from tests.flankfilm.conftest import Browser
from tests.processes import MARK, left_after, marked, new_mark
from tests.seeds import SEED

ROOT = Path(__file__).parents[3]
PATIENCE = 60.0
CHECKS = (Path(__file__).parents[1] / "page_checks.js").read_text(encoding="utf-8")

pytestmark = pytest.mark.slow


@dataclass(frozen=True)
class Served:
    """A page that a process of its own serves."""

    address: str
    folder: Path
    process: subprocess.Popen[str]
    mark: str

    @property
    def port(self) -> int:
        return urlsplit(self.address).port or 0

    @property
    def secret(self) -> str:
        return self.address.partition("secret=")[2]

    def get(self, path: str, **headers: str) -> http.client.HTTPResponse:
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        connection.request(
            "GET", path, headers={name.replace("_", "-"): text for name, text in headers.items()}
        )
        return connection.getresponse()

    @property
    def children(self) -> list[str]:
        return [line for number, line in marked(self.mark).items() if number != self.process.pid]


@pytest.fixture
def served(tmp_path) -> Iterator[Served]:
    """The page on a copy of the article's scene; it leaves no process."""
    shutil.copy(ROOT / "examples" / "article.toml", tmp_path)
    (tmp_path / "pair.toml").write_text(RUN, encoding="utf-8")
    mark = new_mark()
    process = subprocess.Popen(
        [sys.executable, "-m", "flankfilm", "app", str(tmp_path / "article.toml"), "--no-browser"],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, cwd=tmp_path,
        env={**os.environ, MARK: f"{os.environ.get(MARK, '')} {mark}"},
    )  # fmt: skip
    assert process.stdout is not None
    line = process.stdout.readline()
    assert "the page is at http://127.0.0.1:" in line
    yield Served(line.split()[-1], tmp_path, process, mark)
    process.send_signal(signal.SIGINT)
    assert process.wait(PATIENCE) in (0, 130)
    process.stdout.close()
    assert left_after(mark) == {}


def wait(browser: Browser, script: str, seconds: float = PATIENCE):
    until = time.monotonic() + seconds
    while not (found := browser.run(script)):
        if time.monotonic() > until:
            pytest.fail(
                f"not so after {seconds:.0f} s: {script}\n{browser.run('document.body.innerText')[:3000]}"
            )
        time.sleep(0.1)
    return found


def typed(label: str, text: str) -> str:
    return f"""(() => {{ const field = [...document.querySelectorAll('.ff-form .v-text-field')].find(
      (one) => one.querySelector('label').textContent === {label!r}).querySelector('input');
      field.focus(); field.value = {text!r}; field.dispatchEvent(new Event('input')); return true; }})()"""


def dragged(number: int, value: float) -> str:
    return f"""(() => {{ const one = document.querySelectorAll('.ff-sliders input')[{number}];
      one.value = {value!r}; one.dispatchEvent(new Event('input')); return true; }})()"""


PRESS = "[...document.querySelectorAll('.ff button')].find((one) => one.textContent.trim() === {!r}).click() || true"
SOLVED = "document.querySelector('.ff-state').innerText.includes('solved in')"
ROOTS = "document.querySelector('.ff-main').innerText.includes('maximum root stress')"
FIGURES = "document.querySelector('.ff-main').innerText.includes('peak to peak')"


def opened(
    browser: Browser, served: Served, width: int = 1280, height: int = 720, dark: bool = False
) -> None:
    browser.open("about:blank", width)  # what a page of another server still logs is not this one's
    browser.run("new Promise((after) => setTimeout(after, 200))")
    browser.open(served.address, width, height, dark)
    wait(browser, "!!document.querySelector('.ff-sliders input')")
    wait(browser, f"{SOLVED} && {FIGURES}")


def test_a_drag_changes_curves_and_figures_and_shows_the_old_ones(served, browser):
    opened(browser, served)
    assert served.secret not in browser.run("location.href")
    wait(browser, f"document.querySelectorAll('.ff-curves svg[role=img]').length === 7 && {ROOTS}")
    assert browser.run("document.querySelectorAll('.ff-faint').length") == 0
    time.sleep(1.6)
    browser.run(dragged(0, 450))
    wait(browser, "document.querySelectorAll('.ff-faint').length > 3")
    wait(browser, "document.querySelector('.ff-main').innerText.includes('7.09 µm')")  # as of a run: 7.09
    wait(
        browser, "document.querySelectorAll('figure:last-child .ff-faint').length === 2"
    )  # root stress of both
    wait(browser, "!document.querySelector('.ff-curves').innerText.includes('solving')")
    # the keyboard alone: the first slider is reached by Tab and moved by an arrow
    browser.run("document.querySelector('.ff-sliders input').focus()")
    for kind in ("keyDown", "keyUp"):
        browser.call(
            "Input.dispatchKeyEvent", type=kind, key="ArrowRight", code="ArrowRight", windowsVirtualKeyCode=39
        )
    wait(browser, "document.querySelector('.ff-sliders output').innerText.startsWith('455')")
    for _ in range(3):
        for kind in ("keyDown", "keyUp"):
            browser.call("Input.dispatchKeyEvent", type=kind, key="Tab", code="Tab", windowsVirtualKeyCode=9)
    assert browser.run("document.activeElement.type") == "range"
    assert browser.logged == []


@pytest.mark.parametrize(("width", "dark"), [(1280, False), (1280, True), (400, False), (400, True)])
def test_the_page_is_read_on_small_screens_light_and_dark(served, browser, width, dark):
    opened(browser, served, width, 720, dark)
    found = browser.run(CHECKS)
    outside = [name for name in found["wide"] if not name.startswith(("g ", "polygon ", "line ", "circle "))]
    assert (outside, found["screen"]) == ([], width)
    assert found["faint"] == []
    assert found["tiny"] == []
    assert found["doubled"] == []
    background = browser.run("getComputedStyle(document.querySelector('.v-application')).backgroundColor")
    channels = [int(part) for part in background[4:-1].split(",")[:3]]
    assert max(channels) < 60 if dark else min(channels) > 200
    assert browser.logged == []


def test_a_half_typed_number_is_a_fault_beside_its_key_until_it_is_whole(served, browser):
    opened(browser, served)
    browser.run(typed("module_mm", "2."))
    wait(
        browser,
        "document.querySelector('.ff-form .v-messages').innerText.includes('must be a finite number')",
    )
    assert browser.run("document.querySelector('.ff-state').innerText").startswith("The scene has faults")
    assert (
        browser.run("document.querySelectorAll('.ff-curves svg[role=img]').length") >= 6
    )  # the last ones stay
    browser.run(typed("module_mm", "2.5"))
    wait(browser, "!document.querySelector('.ff-form').innerText.includes('must be')")
    wait(browser, SOLVED)
    assert browser.logged == []


def test_a_run_has_a_stage_and_a_report_and_is_cancelled(served, browser):
    opened(browser, served)
    browser.run(PRESS.format("Run"))
    wait(browser, "document.querySelector('.ff-run')?.innerText.includes('Cancel')")
    wait(browser, r"/about \d+ s left/.test(document.querySelector('.ff-run').innerText)")
    browser.run(PRESS.format("Cancel"))
    wait(browser, "document.querySelector('.ff-run').innerText.includes('Run cancelled')")
    browser.run(PRESS.format("Open"))
    wait(
        browser,
        "[...document.querySelectorAll('.v-dialog button')].some((one) => one.textContent === 'pair.toml')",
    )
    browser.run(
        "[...document.querySelectorAll('.v-dialog button')].find((one) => one.textContent === 'pair.toml').click()"
    )
    wait(browser, "document.querySelector('.ff-name').innerText === 'pair.toml'")
    browser.run(PRESS.format("Run"))
    address = wait(browser, "document.querySelector('.ff-run a')?.href")
    page = browser.run(f"fetch({address!r}).then((reply) => reply.text())")
    assert "contact ratio" in page
    assert (served.folder / "pair-results" / "report.html").read_text(encoding="utf-8") == page
    assert browser.logged == []


@pytest.mark.parametrize(("width", "dark"), [(1280, False), (400, True)])
def test_results_of_runs_are_compared_side_by_side(served, browser, width, dark):
    for name, stiffness in (("first-results", 8.0e8), ("second-results", 8.8e8)):
        results(served.folder, name, stiffness, 0.005)
    opened(browser, served, width, 720, dark)
    browser.run(PRESS.format("Results"))
    wait(browser, "document.querySelectorAll('.ff-kept input').length === 2")
    for number in (0, 1):
        browser.run(f"document.querySelectorAll('.ff-kept input')[{number}].click()")
        wait(
            browser,
            f"document.querySelector('.ff-results button').innerText.trim() === 'Compare {number + 1}'",
        )
    browser.run(PRESS.format("Compare 2"))
    wait(browser, "document.querySelectorAll('.ff-side figure path').length >= 4")
    table = browser.run("document.querySelector('.ff-side table').innerText")
    assert "mean mesh stiffness (tangent), without film" in table
    assert "+2" in table or "-2" in table
    assert browser.run("document.querySelectorAll('.ff-side td b').length") >= 1
    read = browser.run(CHECKS)
    assert (read["faint"], read["tiny"], read["doubled"], read["screen"]) == ([], [], [], width)
    assert browser.logged == []


def test_a_study_fills_its_table_is_cancelled_and_resumed_to_its_report(served, browser):
    text = STUDY.replace("steps = 4", "steps = 60")
    (served.folder / "shift.toml").write_text(text, encoding="utf-8")
    opened(browser, served)

    def press(button: str) -> None:
        browser.run(PRESS.format("Studies"))
        item = "[...document.querySelectorAll('.ff-kept li')].find((one) => one.innerText.includes('shift.toml'))"
        wait(browser, f"{item}?.querySelector('button').innerText.trim() === {button!r}")
        browser.run(f"{item}.querySelector('button').click()")

    press("Start")
    wait(browser, "document.querySelectorAll('.ff-rows tbody tr').length > 2")
    assert "contact_ratio" in browser.run("document.querySelector('.ff-rows thead').innerText")
    browser.run(PRESS.format("Cancel"))
    wait(browser, "document.querySelector('.ff-run').innerText.includes('Cancelled')")
    press("Resume")
    address = wait(browser, "document.querySelector('.ff-run a')?.href")
    assert browser.run("document.querySelectorAll('.ff-rows tbody tr').length") == 60
    page = browser.run(f"fetch({address!r}).then((reply) => reply.text())")
    assert "Contact ratio over the profile shift" in page
    assert browser.logged == []


def test_two_windows_do_not_disturb_each_other_and_one_that_is_closed_ends_what_it_started(
    served, browser, chromium, tmp_path_factory
):
    other = Browser(chromium, tmp_path_factory.mktemp("other"))
    try:
        opened(browser, served)
        opened(other, served)
        assert len(served.children) == 2
        browser.run(dragged(0, 300))
        other.run(dragged(0, 900))
        for window, shown in ((browser, "300"), (other, "900")):
            wait(window, f"document.querySelector('.ff-sliders output').innerText.startsWith('{shown}')")
            wait(window, SOLVED)
        assert browser.run("document.querySelector('.ff-sliders output').innerText").startswith("300")
    finally:
        other.close()
    until = time.monotonic() + 15.0
    while len(served.children) > 1 and time.monotonic() < until:
        time.sleep(0.1)
    assert len(served.children) == 1
    browser._events.clear()
    browser.call("Page.reload")
    browser._until("Page.loadEventFired")
    wait(browser, f"!!document.querySelector('.ff-sliders input') && {SOLVED}")  # by the cookie
    assert browser.run("document.querySelector('.ff-sliders output').innerText").startswith("300")
    browser.run(PRESS.format("Undo"))  # the edits of before can be taken back
    wait(browser, "!document.querySelector('.ff-sliders output').innerText.startsWith('300')")


def test_a_connection_that_stalls_is_said_and_continues_and_a_browser_that_comes_back_has_a_window(
    served, browser
):
    opened(browser, served)
    network = {"latency": 0, "downloadThroughput": -1, "uploadThroughput": -1}
    browser.call("Network.emulateNetworkConditions", offline=True, **network)
    try:
        browser.run(dragged(0, 450))
        wait(browser, "document.querySelector('.ff-state').innerText.includes('does not answer')")
    finally:
        browser.call("Network.emulateNetworkConditions", offline=False, **network)
    wait(
        browser, "document.querySelector('.ff-main').innerText.includes('7.09 µm')"
    )  # what was dragged meanwhile
    wait(browser, "!document.querySelector('.ff-state').innerText.includes('does not answer')")
    before = served.children
    browser.call("Page.navigate", url="about:blank")
    until = time.monotonic() + 15.0
    while served.children and time.monotonic() < until:
        time.sleep(0.1)
    assert len(before) == 1
    assert served.children == []  # what the window started has ended with it
    opened(browser, served)
    shown = browser.run("document.querySelector('.ff-sliders output').innerText")
    assert shown.startswith("450")  # the scene of its tab
    assert browser.logged == []


@pytest.mark.long
def test_200_random_drags_leave_no_error_and_no_memory(served, browser):
    opened(browser, served)
    dice = random.Random(SEED)
    values = "[...document.querySelectorAll('.ff-sliders input')].map((one) => Number(one.value))"
    first = browser.run(values)[:6]

    def drags(number: int) -> None:
        for _ in range(number):
            which = dice.choice([0, 1, 2, 3, 4, 5])
            ends = "(one) => [one.min, one.max].map(Number)"
            low, high = browser.run(f"({ends})(document.querySelectorAll('.ff-sliders input')[{which}])")
            browser.run(dragged(which, dice.uniform(low, high)))
            time.sleep(dice.choice([0.0, 0.02, 0.2]))
        for which, value in enumerate(first):  # back to what is shown before and after
            browser.run(dragged(which, value))
        time.sleep(1.0)
        wait(browser, "!document.querySelector('.ff-state').innerText.includes('solving')")
        time.sleep(4.0)

    def heap() -> float:
        for _ in range(3):
            browser.call("HeapProfiler.collectGarbage")
        return float(browser.call("Runtime.getHeapUsage")["usedSize"])

    drags(140)  # until the browser has compiled what it uses; from then on 100 drags add less than 1 %
    before = heap()
    drags(200)
    after = heap()
    assert after < 1.1 * before, (before, after)
    wait(browser, "!document.querySelector('.ff-state').innerText.includes('solving')")
    assert len(served.children) == 1
    assert browser.logged == []


def test_who_does_not_have_the_address_is_refused(served):
    key = {
        "Connection": "Upgrade",
        "Upgrade": "websocket",
        "Sec_WebSocket_Version": "13",
        "Sec_WebSocket_Key": "x" * 22 + "==",
    }
    page = f"/index.html?secret={served.secret}&sessionURL=x"
    assert served.get("/").status == 403
    assert served.get("/index.html?secret=wslink-secret").status == 403
    assert served.get("/ws", **key).status == 403
    assert served.get(page).status == 200
    assert served.get(page, Host="evil.example").status == 403
    assert served.get(page, Origin="http://evil.example").status == 403
    cookie = served.get(page).headers["Set-Cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie
    cookie = cookie.partition(";")[0]
    assert served.get("/ws", Cookie=cookie, Origin="http://evil.example", **key).status == 403
    assert served.get("/ws", Cookie=cookie, Origin=f"http://127.0.0.1:{served.port}", **key).status == 101
    for path in ("../../../etc/passwd", "..%2f..%2fetc/passwd", "article.toml", quote("../report.html", "")):
        assert served.get(f"/results/{path}", Cookie=cookie).status in (403, 404), path
    policy = served.get(page).headers["Content-Security-Policy"]
    assert "default-src 'self'" in policy


def test_other_interfaces_are_not_listened_on(served):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.connect(("192.0.2.1", 9))  # which sends nothing
        own = probe.getsockname()[0]
    assert own != "127.0.0.1"
    with (
        pytest.raises(OSError, match=r"refused|unreachable|timed out"),
        socket.create_connection((own, served.port), 5.0),
    ):
        pass


@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGKILL])
def test_an_end_by_a_signal_leaves_no_process(served, browser, how):
    opened(browser, served)
    assert served.children
    served.process.send_signal(how)
    served.process.wait(PATIENCE)
    assert left_after(served.mark) == {}
    wait(browser, "document.body.innerText.includes('The connection to flankfilm is lost')")
    served.process.send_signal = lambda _: None
    served.process.wait = lambda _: 0
