"""The pair that turns on a page: numbers decoded again, no request, drawn in a browser, folded in reports."""

from __future__ import annotations

import base64
import json
import re
import shutil
import zlib
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread

import numpy as np
import pytest
import pyvista as pv
import xarray as xr

from base import InputError
from fem.fields.surface_frames import Surfaces
from flankfilm.figures.rendering.turning import VALUES
from flankfilm.figures.rendering.turning_page import write_turning
from flankfilm.figures.rendering.view import steps
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from tests.flankfilm.fields import SCENE
from tests.flankfilm.program import command

REQUESTS = re.compile(
    r"""\b(?:src|href)\s*=|url\(|@import|\bimport\s*\(|\bfetch\(|XMLHttpRequest|WebSocket|https?:"""
)


@pytest.fixture(scope="module")
def run(run_with_fields: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Copy of a run with three positions, which pages are written into."""
    return Path(shutil.copytree(run_with_fields, tmp_path_factory.mktemp("turning") / "run"))


@pytest.fixture(scope="module")
def page(run) -> Path:
    return write_turning(run, run / "turning.html")


def held(page: Path) -> tuple[dict, np.ndarray]:
    """Head of a page, and its numbers."""
    text = page.read_text(encoding="utf-8")
    head = json.loads(text.split('class="turning-head">')[1].split("</script>")[0])
    packed = zlib.decompress(
        base64.b64decode(text.split('class="turning-numbers">')[1].split("</script>")[0])
    )
    low, high = np.frombuffer(packed, dtype=np.uint8).reshape(2, -1).astype(np.uint16)
    return head, low | (high << 8)


def test_numbers_decoded_again_are_the_fields_within_their_steps(run, page):
    head, numbers = held(page)
    assert len(head["at"]) == len(steps(run)) == 3
    with xr.open_dataset(run / "results.nc", engine="h5netcdf") as results:
        centre, width = results["outline_centre"].values[1], float(results["pair_face_width"])
    grids = [{name: pv.read(file) for name, file in files.items()} for files in steps(run).values()]
    surfaces = Surfaces.of(grids[0], centre, width)
    frames = [surfaces.frame(one) for one in grids]
    at = 0

    def take(*shape: int) -> np.ndarray:
        nonlocal at
        at += (count := int(np.prod(shape)))
        return numbers[at - count : at].reshape(shape)

    for index, gear in enumerate(head["gears"]):
        low, high = np.array(gear["low"]), np.array(gear["high"])
        tooth, n = surfaces.teeth[index], gear["values"]
        points = low + take(gear["points"], 3) / 65535 * (high - low)
        assert np.abs(points - tooth.points).max() <= 0.5001 * (high - low).max() / 65535
        np.testing.assert_array_equal(take(gear["triangles"], 3), tooth.triangles)
        np.testing.assert_array_equal(take(gear["points"]), tooth.value)
        before: dict[int, np.ndarray] = {}
        for frame, first, angles in zip(frames, gear["first"], gear["angles"], strict=True):
            own = frame.gears[index]
            assert (first, len(angles)) == (own.first, len(own.angles))
            np.testing.assert_allclose(angles, own.angles, atol=1e-7)
            known = {}
            for k in range(len(angles)):
                known[first + k] = both = take(4 * n) + before.get(first + k, np.zeros(4 * n, np.uint16))
                moved = (both[: 3 * n].reshape(n, 3) - 2047.0) / 2047.0 * head["moved"]
                assert np.abs(moved - own.displacement[k]).max() <= 0.5001 / 2047 * head["moved"]
                stress = both[3 * n :] / VALUES * head["stress"]
                assert np.abs(stress - own.von_mises[k]).max() <= 0.5001 / VALUES * head["stress"]
            before = known
    for name, size in (("ends", 6), ("moved", 6), ("load", 3)):
        values = np.concatenate([getattr(frame.contacts, name).reshape(-1, size) for frame in frames])
        found = (take(*values.shape) - 32767.0) / 32767.0 * head["loads"][name]
        assert np.abs(found - values).max() <= 0.5001 / 32767 * head["loads"][name]
    assert at == len(numbers)


def test_a_page_asks_for_nothing_else_and_names_units(page):
    text = page.read_text(encoding="utf-8")
    assert REQUESTS.findall(re.sub(r'class="turning-numbers">[^<]*', "", text)) == []
    assert "A pair &lt;b&gt; that turns" in text
    assert "von Mises stress [MPa]" in text
    assert "N/mm" in text
    assert len(text) < 600_000


def test_faults_are_reported(run, tmp_path):
    with pytest.raises(InputError, match=r"must end in \.html"):
        write_turning(run, tmp_path / "pair.png")
    with pytest.raises(InputError, match='wants "vtk"'):
        write_turning(tmp_path, tmp_path / "pair.html")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_the_command_writes_the_page_of_a_folder_or_a_scene(run, tmp_path):
    (tmp_path / "pair-results").symlink_to(run)
    command("view", "pair.toml", "--html", "--scale", "40", cwd=tmp_path)
    head, _ = held(run / "mesh_cycle.html")
    assert head["scale"] == 40.0
    wrong = command(
        "view", run, "--html", "--field", "displacement_m", "--position", "1", cwd=tmp_path, status=2
    )
    assert "--field" in wrong.stderr
    assert "--position" in wrong.stderr


READY = "!!document.querySelector('.turning-ready')"
STOPPED = """(() => { const run = document.querySelector('.turning-run');
  if (run.textContent === 'Stop') run.click(); return run.textContent; })()"""
DRAWN = "new Promise((after) => requestAnimationFrame(() => requestAnimationFrame(() => after(true))))"
PICTURE = """(() => { const canvas = document.querySelector('.turning-canvas'), flat = document.createElement('canvas');
  [flat.width, flat.height] = [canvas.width, canvas.height];
  const on = flat.getContext('2d'); on.drawImage(canvas, 0, 0);
  const pixels = on.getImageData(0, 0, flat.width, flat.height).data;
  let covered = 0, sum = 0; const colours = new Set();
  for (let i = 0; i < pixels.length; i += 4) {
    if (pixels[i + 3] > 0) covered++;
    sum = (31 * sum + pixels[i] + 7 * pixels[i + 1] + 13 * pixels[i + 2]) % 1000003;
    colours.add((pixels[i] >> 3) * 1024 + (pixels[i + 1] >> 3) * 32 + (pixels[i + 2] >> 3));
  }
  return { part: 4 * covered / pixels.length, sum, colours: colours.size }; })()"""
OF_SOFTWARE = ("software WebGL", "GPU stall")
"""What Chromium says of drawing without a graphics card."""


def moved_to(frame: int) -> str:
    return f"""(() => {{ const one = document.querySelector('.turning-frame');
      one.value = {frame}; one.dispatchEvent(new Event('input')); return one.value; }})()"""


def until(browser, script: str) -> None:
    assert browser.run(f"""new Promise((after) => {{ let left = 300; const ask = () => {{
      if ({script}) after(true); else if (left-- === 0) after(false); else setTimeout(ask, 100); }}; ask(); }})""")


def complaints(browser) -> list[str]:
    return [text for text in browser.logged if not any(known in text for known in OF_SOFTWARE)]


@pytest.mark.slow
@pytest.mark.parametrize(("width", "dark"), [(1280, False), (400, True)])
def test_a_browser_draws_the_pair_and_the_slider_moves_it(page, browser, width, dark):
    browser.open(page, width, 900, dark)
    until(browser, READY)
    assert browser.run(STOPPED) == "Play"
    pictures = []
    for frame in (0, 2, 0):
        browser.run(moved_to(frame))
        browser.run(DRAWN)
        pictures.append(browser.run(PICTURE))
    assert pictures[0]["part"] > 0.2
    assert pictures[0]["colours"] > 30
    assert pictures[0] == pictures[2] != pictures[1]
    assert browser.run("document.querySelector('.turning-place').textContent").endswith("base pitches from A")
    # the keyboard turns the view; Home brings it back
    browser.run("document.querySelector('.turning-canvas').focus()")
    for key in ("ArrowLeft", "Home"):
        browser.call("Input.dispatchKeyEvent", type="keyDown", key=key)
        browser.run(DRAWN)
        pictures.append(browser.run(PICTURE))
    assert pictures[3] != pictures[2] == pictures[4]
    assert browser.run("document.documentElement.scrollWidth") <= width
    assert complaints(browser) == []


@pytest.mark.slow
def test_the_browser_decodes_the_same_numbers(run, page, browser):
    browser.open(page, 800)
    until(browser, READY)
    head, numbers = held(page)
    gear = head["gears"][0]
    n, start = gear["values"], 4 * gear["points"] + 3 * gear["triangles"]
    found = browser.run("""(() => { const gear = document.querySelector('.turning').turning.gears[0];
      return { values: gear.starts.map((at) => [...gear.values.slice(4 * at, 4 * (at + gear.each))]),
               points: [...gear.points] }; })()""")
    before: dict[int, np.ndarray] = {}
    for frame, (first, angles) in enumerate(zip(gear["first"], gear["angles"], strict=True)):
        known = {}
        for tooth in range(first, first + len(angles)):
            own = numbers[start : start + 4 * n]
            known[tooth], start = own + before.get(tooth, np.zeros(4 * n, np.uint16)), start + 4 * n
        before = known
        values = np.array(found["values"][frame]).reshape(n, 4)
        np.testing.assert_array_equal(values[:, :3].ravel(), known[first][: 3 * n])
        np.testing.assert_array_equal(values[:, 3], known[first][3 * n :])
    low, high = np.array(gear["low"]), np.array(gear["high"])
    points = low + numbers[: 3 * gear["points"]].reshape(-1, 3) / 65535 * (high - low)
    np.testing.assert_allclose(np.array(found["points"]).reshape(-1, 3), points, atol=1e-8)


@pytest.mark.slow
def test_a_browser_without_webgl_says_what_is_missing(page, browser, tmp_path):
    text = page.read_text(encoding="utf-8").replace('getContext("webgl2"', 'getContext("no such thing"')
    (tmp_path / "bare.html").write_text(text, encoding="utf-8")
    browser.open(tmp_path / "bare.html", 800)
    until(browser, "document.querySelector('.turning-missing').innerText.includes('WebGL 2 is missing')")
    assert complaints(browser) == []


@pytest.mark.slow
def test_a_report_has_the_view_folded_and_small(browser, tmp_path):
    scene = parse_scene(SCENE.replace('"vtk"]', '"vtk", "report"]'))
    run_scene(scene, tmp_path / "with")
    without = parse_scene(SCENE.replace('"vtk"]', '"report"]'))
    run_scene(without, tmp_path / "without")
    report = (tmp_path / "with" / "report.html").read_text(encoding="utf-8")
    assert "turning" not in (tmp_path / "without" / "report.html").read_text(encoding="utf-8")
    view = report[report.index('<details class="view">') :]
    assert len(view[: view.index("</details>")]) < 1_500_000
    browser.open(tmp_path / "with" / "report.html", 1280)
    assert browser.run("typeof document.querySelector('.turning').turning") == "undefined"
    browser.run("document.querySelector('details.view summary').click()")
    until(browser, READY)
    browser.run(STOPPED)
    browser.run(DRAWN)
    assert browser.run(PICTURE)["part"] > 0.2
    assert complaints(browser) == []
    # the same numbers as of the files
    head, numbers = held(tmp_path / "with" / "report.html")
    other, again = held(write_turning(tmp_path / "with", tmp_path / "turning.html"))
    assert len(numbers) == len(again)
    assert np.mean(numbers == again) > 0.999
    assert head["ticks"] == other["ticks"]


@pytest.mark.slow
def test_loads_over_the_face_come_with_displacement_and_say_that_stress_is_missing(browser, tmp_path):
    over_face = SCENE.replace('"vtk"]', '"vtk", "report"]') + "[alignment]\nin_plane_um = 20\ncells = 8\n"
    run_scene(parse_scene(over_face), tmp_path)
    head, _ = held(tmp_path / "report.html")
    assert (head["field"], head["stress"]) == ("displacement", 0.0)
    assert min(head["loads"]["counts"]) > 4
    assert "stress is not found where the load varies along the face" in (tmp_path / "report.html").read_text(
        "utf-8"
    )
    browser.open(write_turning(tmp_path, tmp_path / "turning.html"), 1280)
    until(browser, READY)
    browser.run(STOPPED)
    browser.run(DRAWN)
    solid = "document.querySelector('.turning-glass').click()"
    pictures = [browser.run(PICTURE), browser.run(solid), browser.run(DRAWN), browser.run(PICTURE)]
    assert pictures[0]["part"] > 0.15
    assert pictures[0] != pictures[3]  # the wheel is no longer of glass
    assert complaints(browser) == []


@pytest.mark.slow
def test_the_view_begins_under_the_policy_of_the_app(page, browser, tmp_path):
    """Reports have no rights of the page that serves them; a view needs none."""
    policy = pytest.importorskip("flankfilm.app.page").SANDBOX

    class Served(SimpleHTTPRequestHandler):
        def end_headers(self) -> None:
            self.send_header("Content-Security-Policy", policy)
            super().end_headers()

        def log_message(self, *_: object) -> None:
            """Nothing on the terminal."""

    (tmp_path / "report.html").write_bytes(page.read_bytes())
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Served, directory=str(tmp_path))) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        browser.open(f"http://127.0.0.1:{server.server_port}/report.html", 1000)
        until(browser, READY)
        assert [text for text in complaints(browser) if "404" not in text] == []  # no icon is served
        server.shutdown()
