"""The script `run`: set-up and jobs, with stand-ins for Python, pip and apt-get.

A folder of its own serves as PATH. It holds the few POSIX tools that the script may use and a
stand-in for Python that writes down how it was called; so nothing is installed and no network used.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import time
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[2]
TOOLS = """cat chmod cmp cp date dirname env find flock getconf grep id ls mkdir mv nproc readlink rm sed sh
sleep tail touch"""
LIBRARIES = """libGL.so.1 libEGL.so.1 libGLU.so.1 libXcursor.so.1 libXft.so.2 libXinerama.so.1
libgomp.so.1"""

PYTHON = r"""#!/bin/sh
echo "$*" >>"$CALLS"
case "$*" in
    *sys.base_prefix*) echo "${FAKE_VERSION:-3.11.2} /usr" ;;
    *"-m venv "*)
        for last; do :; done
        mkdir -p "$last/bin" && cp "$0" "$last/bin/python" && cp "$FLANKFILM" "$last/bin/flankfilm" ;;
    *"-m pip install"*) echo "pip says $*"; sleep "${PIP_SECONDS:-0}"; exit "${PIP_STATUS:-0}" ;;
    *"-m pytest"*)
        [ ! -e /proc/self/fd/9 ] || exit 99
        [ -z "${PYTHONPATH:-}" ] || exit 98
        [ -z "${PYTHONDONTWRITEBYTECODE:-}" ] || exit 97
        sleep "${JOB_SECONDS:-0}"; exit "${JOB_STATUS:-0}" ;;
    *"-m ruff"* | *"-m mypy"* | *"-m sphinx"*) exit "${JOB_STATUS:-0}" ;;
esac
"""

FLANKFILM = r"""#!/bin/sh
echo "flankfilm $*" >>"$CALLS"
while [ $# -gt 0 ]; do
    case $1 in
        --out) mkdir -p "$2" && touch "$2/report.html" ;;
        --out=*) mkdir -p "${1#--out=}" && touch "${1#--out=}/report.html" ;;
    esac
    shift
done
exit "${JOB_STATUS:-0}"
"""

APT_GET = r"""#!/bin/sh
echo "apt-get $*" >>"$CALLS"
case "$*" in *" -s "*) echo "Inst libglvnd0 (1.6 Debian)"; echo "Inst libgl1 (1.6 Debian)"; exit ;; esac
case "$*" in *install*python3*) cp "$PYTHON_STAND_IN" "$(dirname "$0")/python3" ;; esac
case "$*" in *install*) touch "$LIBRARIES_THERE" ;; esac
"""

LDCONFIG = f"""#!/bin/sh
[ -e "$LIBRARIES_THERE" ] || exit 0
for file in {" ".join(LIBRARIES.split())}; do echo "	$file (libc6,x86-64) => /lib/$file"; done
"""


def write_program(path: Path, text: str) -> Path:
    path.write_text(text)
    path.chmod(0o755)
    return path


@dataclass
class Sandbox:
    """A copy of the script in a folder of its own, with nothing but stand-ins on PATH."""

    root: Path
    bin: Path
    calls_file: Path
    environment: dict[str, str] = field(default_factory=dict)

    def start(self, *arguments: str, cwd: Path | None = None, script: Path | None = None, **settings: str):
        return subprocess.Popen(
            [str(script or self.root / "run"), *arguments],
            cwd=cwd or self.root,
            env=self.environment | settings,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def run(self, *arguments: str, **settings) -> subprocess.CompletedProcess[str]:
        process = self.start(*arguments, **settings)
        out, err = process.communicate(timeout=60)
        return subprocess.CompletedProcess(arguments, process.returncode, out, err)

    def calls(self, containing: str = "") -> list[str]:
        lines = self.calls_file.read_text().splitlines() if self.calls_file.exists() else []
        return [line for line in lines if containing in line]

    def forget_calls(self) -> None:
        self.calls_file.unlink(missing_ok=True)

    @property
    def stamp(self) -> Path:
        return self.root / ".venv" / ".stamp"


@pytest.fixture
def sandbox(tmp_path: Path) -> Sandbox:
    root, tools, parts = tmp_path / "a b" / "main", tmp_path / "bin", tmp_path / "parts"
    for folder in (root / "examples", tools, parts, tmp_path / "home"):
        folder.mkdir(parents=True)
    for name in ("run", "requirements.txt", "pyproject.toml"):
        shutil.copy(ROOT / name, root / name)
    (root / "requirements.txt").chmod(0o644)
    for tool in TOOLS.split():
        found = shutil.which(tool)
        if found is None:
            pytest.skip(f"this system has no {tool}")
        (tools / tool).symlink_to(found)
    write_program(tools / "python3", PYTHON)
    write_program(tools / "ldconfig", LDCONFIG)
    (parts / "libraries").touch()
    environment = {
        "PATH": str(tools),
        "HOME": str(tmp_path / "home"),
        "CALLS": str(tmp_path / "calls"),
        "FLANKFILM": str(write_program(parts / "flankfilm", FLANKFILM)),
        "PYTHON_STAND_IN": str(write_program(parts / "python3", PYTHON)),
        "LIBRARIES_THERE": str(parts / "libraries"),
    }
    return Sandbox(root, tools, tmp_path / "calls", environment)


def become(sandbox: Sandbox, uid: int) -> None:
    (sandbox.bin / "id").unlink()
    write_program(sandbox.bin / "id", f"#!/bin/sh\necho {uid}\n")


# ---------------------------------------------------------------- words


@pytest.mark.parametrize("shell", ["sh", "dash"])
def test_syntax_is_posix(shell: str) -> None:
    if shutil.which(shell) is None:
        pytest.skip(f"this system has no {shell}")
    subprocess.run([shell, "-n", str(ROOT / "run")], check=True)


def test_script_is_executable_and_names_no_registry() -> None:
    assert os.access(ROOT / "run", os.X_OK)
    text = (ROOT / "run").read_text()
    assert text.startswith("#!/bin/sh\n")
    for word in ("http:", "https:", "--index-url", "--find-links", "[["):
        assert word not in text


@pytest.mark.parametrize("arguments", [(), ("help",), ("-h",), ("--help",)])
def test_help(sandbox: Sandbox, arguments: tuple[str, ...]) -> None:
    done = sandbox.run(*arguments)
    assert done.returncode == 0
    assert done.stdout.startswith("usage: ./run JOB")
    assert all(f"\n  {job}" in done.stdout for job in ("demo", "test", "check", "docs", "setup", "help"))
    assert not sandbox.calls()
    assert not (sandbox.root / ".venv").exists()


@pytest.mark.parametrize(
    "arguments", [("tset",), ("check", "more"), ("docs", "more"), ("setup", "more"), ("",)]
)
def test_wrong_usage(sandbox: Sandbox, arguments: tuple[str, ...]) -> None:
    done = sandbox.run(*arguments)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "usage: ./run JOB" in done.stderr
    assert arguments[-1] in done.stderr
    assert not (sandbox.root / ".venv").exists()


# ---------------------------------------------------------------- the environment


def test_first_set_up_installs_the_pins(sandbox: Sandbox) -> None:
    done = sandbox.run("setup")
    assert done.returncode == 0, done.stderr
    assert len(sandbox.calls("-m venv")) == 1
    fetched, project = sandbox.calls("-m pip install")
    for call in (fetched, project):
        assert "--only-binary :all:" in call
    assert fetched.endswith(f"--require-hashes -r {sandbox.root}/requirements.txt")
    assert project.endswith("--no-deps --no-build-isolation -e .")  # fetches nothing, and so needs no hash
    assert sandbox.stamp.read_text().endswith((sandbox.root / "pyproject.toml").read_text())
    assert not (sandbox.root / ".venv" / ".unfinished").exists()


def test_second_call_only_looks(sandbox: Sandbox) -> None:
    sandbox.run("setup")
    sandbox.forget_calls()
    for _ in range(3):
        assert sandbox.run("test", "one").returncode == 0
    assert not sandbox.calls("pip")
    assert len(sandbox.calls()) == 6  # each time: is the Python still the same, and pytest


def test_set_up_compiles_once_and_goes_on_where_that_fails(sandbox: Sandbox) -> None:
    done = sandbox.run("setup", JOB_STATUS="1")
    assert done.returncode == 0
    assert sandbox.calls("flankfilm") == ["flankfilm warm-up"]
    assert "warning: compiling failed" in done.stderr
    assert sandbox.run("demo").returncode == 0
    assert len(sandbox.calls("warm-up")) == 1


@pytest.mark.parametrize("job", ["check", "docs"])
def test_jobs_that_compute_nothing_compile_nothing(sandbox: Sandbox, job: str) -> None:
    sandbox.run(job)
    assert sandbox.stamp.exists()
    assert not sandbox.calls("warm-up")


@pytest.mark.parametrize("name", ["requirements.txt", "pyproject.toml"])
def test_changed_pins_update_in_place(sandbox: Sandbox, name: str) -> None:
    sandbox.run("setup")
    with (sandbox.root / name).open("a") as file:
        file.write("# changed\n")
    sandbox.forget_calls()
    assert sandbox.run("test").returncode == 0
    assert len(sandbox.calls("-m pip install")) == 2
    assert not sandbox.calls("-m venv")


def test_moved_folder_is_made_anew(sandbox: Sandbox) -> None:
    sandbox.run("setup")
    sandbox.forget_calls()
    sandbox.root = sandbox.root.rename(sandbox.root.with_name("elsewhere"))
    assert sandbox.run("test").returncode == 0
    assert len(sandbox.calls("-m venv")) == 1


def test_another_python_makes_it_anew(sandbox: Sandbox) -> None:
    sandbox.run("setup")
    other = write_program(sandbox.bin / "python9", PYTHON.replace("${FAKE_VERSION:-3.11.2}", "3.12.1"))
    sandbox.forget_calls()
    assert sandbox.run("test", PYTHON=str(other)).returncode == 0
    assert len(sandbox.calls("-m venv")) == 1
    sandbox.forget_calls()
    assert sandbox.run("test").returncode == 0  # any Python will do: the one in place stays
    assert not sandbox.calls("-m venv")


def test_replaced_system_python_makes_it_anew(sandbox: Sandbox) -> None:
    sandbox.run("setup")
    sandbox.forget_calls()
    (sandbox.root / ".venv" / "bin" / "python").unlink()
    assert sandbox.run("test").returncode == 0
    assert len(sandbox.calls("-m venv")) == 1


def test_unsuitable_python_is_named(sandbox: Sandbox) -> None:
    done = sandbox.run("setup", PYTHON="/nowhere/python3")
    assert done.returncode == 3
    assert "PYTHON=/nowhere/python3" in done.stderr


def test_environment_made_by_hand_is_kept(sandbox: Sandbox) -> None:
    programs = sandbox.root / ".venv" / "bin"
    programs.mkdir(parents=True)
    write_program(programs / "python", PYTHON)
    (programs / "mine").touch()
    assert sandbox.run("test").returncode == 0
    assert not sandbox.calls("-m venv")
    assert (programs / "mine").exists()


def test_failure_of_pip_shows_the_log_and_heals(sandbox: Sandbox) -> None:
    done = sandbox.run("test", PIP_STATUS="1")
    assert done.returncode == 3
    assert "pip says" in done.stderr
    assert str(sandbox.root / ".venv" / "setup.log") in done.stderr
    assert not sandbox.calls("-m pytest")
    sandbox.forget_calls()
    assert sandbox.run("test").returncode == 0
    assert len(sandbox.calls("-m venv")) == 1


def test_failed_update_leaves_the_environment_standing(sandbox: Sandbox) -> None:
    sandbox.run("setup")
    with (sandbox.root / "requirements.txt").open("a") as file:
        file.write("# changed\n")
    assert sandbox.run("test", PIP_STATUS="1").returncode == 3
    sandbox.forget_calls()
    assert sandbox.run("test").returncode == 0
    assert not sandbox.calls("-m venv")
    assert sandbox.calls("-m pip install")


# ---------------------------------------------------------------- pages


def test_pages_are_built_without_warnings(sandbox: Sandbox) -> None:
    done = sandbox.run("docs")
    assert done.returncode == 0, done.stderr
    (build,) = sandbox.calls("-m sphinx")
    assert "-W" in build
    assert build.endswith("docs out/docs")
    assert done.stderr.splitlines()[-1] == f"run: the pages: {sandbox.root}/out/docs/index.html"


def test_a_warning_of_the_documentation_is_a_failure(sandbox: Sandbox) -> None:
    done = sandbox.run("docs", JOB_STATUS="2")
    assert done.returncode == 1
    assert "the pages" not in done.stderr


# ---------------------------------------------------------------- set-ups that end early, and two at once


def wait_for(condition, seconds: float = 30.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.02)


def test_killed_installation_is_made_anew(sandbox: Sandbox) -> None:
    process = sandbox.start("test", PIP_SECONDS="60")
    wait_for(lambda: sandbox.calls("-m pip install"))
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()
    (sandbox.root / ".venv" / "half").touch()
    sandbox.forget_calls()
    assert sandbox.run("test").returncode == 0
    assert len(sandbox.calls("-m venv")) == 1
    assert len(sandbox.calls("-m pip install")) == 2
    assert not (sandbox.root / ".venv" / "half").exists()


def test_orphaned_pip_is_waited_for(sandbox: Sandbox) -> None:
    process = sandbox.start("test", PIP_SECONDS="3")
    wait_for(lambda: sandbox.calls("-m pip install"))
    os.kill(process.pid, signal.SIGKILL)  # the script alone: its pip goes on
    began = time.monotonic()
    done = sandbox.run("test")
    assert done.returncode == 0
    assert "waiting" in done.stderr
    assert time.monotonic() - began > 1.0
    process.communicate()


def test_two_at_once_install_once(sandbox: Sandbox) -> None:
    first = sandbox.start("test", PIP_SECONDS="1")
    wait_for(lambda: sandbox.calls("-m pip install"))
    second = sandbox.run("test", PIP_SECONDS="1")
    first.communicate()
    assert first.returncode == second.returncode == 0
    assert "another set-up is at work" in second.stderr
    assert len(sandbox.calls("-m pip install")) == 2  # the two steps of one installation
    assert len(sandbox.calls("-m pytest")) == 2


def test_running_job_holds_no_lock(sandbox: Sandbox) -> None:
    sandbox.run("setup")
    job = sandbox.start("test", JOB_SECONDS="60")
    wait_for(lambda: sandbox.calls("-m pytest"))
    with (sandbox.root / "requirements.txt").open("a") as file:
        file.write("# changed\n")
    done = sandbox.run("setup")
    assert done.returncode == 0
    assert "waiting" not in done.stderr
    os.killpg(job.pid, signal.SIGKILL)
    job.communicate()


def test_unwritable_folder(sandbox: Sandbox) -> None:
    (sandbox.root / ".venv").write_text("a file in the way")
    done = sandbox.run("test")
    assert done.returncode == 3
    assert "cannot write in" in done.stderr


@pytest.mark.parametrize("home", [None, "/nonexistent"])
def test_no_home(sandbox: Sandbox, home: str | None) -> None:
    del sandbox.environment["HOME"]
    done = sandbox.run("test", **({} if home is None else {"HOME": home}))
    assert done.returncode == 0, done.stderr


# ---------------------------------------------------------------- the system


def test_missing_python_without_rights(sandbox: Sandbox) -> None:
    become(sandbox, 1000)
    (sandbox.bin / "python3").unlink()
    write_program(sandbox.bin / "apt-get", APT_GET)
    Path(sandbox.environment["LIBRARIES_THERE"]).unlink()
    done = sandbox.run("demo")
    assert done.returncode == 3
    (line,) = [line for line in done.stderr.splitlines() if "sudo" in line]
    assert line.endswith(
        "sudo apt-get install --no-install-recommends python3 python3-venv "
        "libgl1 libegl1 libglu1-mesa libxcursor1 libxft2 libxinerama1 libgomp1"
    )
    assert not sandbox.calls("apt-get")


def test_missing_python_as_root(sandbox: Sandbox) -> None:
    become(sandbox, 0)
    (sandbox.bin / "python3").unlink()
    write_program(sandbox.bin / "apt-get", APT_GET)
    Path(sandbox.environment["LIBRARIES_THERE"]).unlink()
    done = sandbox.run("test")
    assert done.returncode == 0, done.stderr
    (install,) = sandbox.calls("apt-get -q -y -o DPkg::Lock::Timeout=300 install")
    assert "--no-install-recommends python3 python3-venv libgl1" in install
    assert "DPkg::Lock::Timeout" in install
    assert "warning" not in done.stderr


@pytest.mark.parametrize("uid", [0, 1000])
def test_missing_libraries(sandbox: Sandbox, uid: int) -> None:
    become(sandbox, uid)
    write_program(sandbox.bin / "apt-get", APT_GET)
    Path(sandbox.environment["LIBRARIES_THERE"]).unlink()
    done = sandbox.run("test", JOB_STATUS="4")
    assert done.returncode == 4  # the job went on
    assert bool(sandbox.calls("apt-get")) == (uid == 0)
    assert ("sudo apt-get install --no-install-recommends libgl1" in done.stderr) == (uid != 0)


def test_what_is_installed_is_said_before_and_can_be_prevented(sandbox: Sandbox) -> None:
    become(sandbox, 0)
    # a stand-in that knows what was said until it was called
    said = sandbox.bin.parent / "said"
    write_program(
        sandbox.bin / "apt-get", APT_GET.replace("apt-get $*", 'apt-get $(cat "$SAID" | grep -c libgl1) $*')
    )
    Path(sandbox.environment["LIBRARIES_THERE"]).unlink()
    done = sandbox.run("test", FLANKFILM_NO_APT="1")
    assert done.returncode == 0
    assert not sandbox.calls("apt-get")
    assert "sudo apt-get install --no-install-recommends libgl1" in done.stderr
    with said.open("w") as file:
        subprocess.run(
            [str(sandbox.root / "run"), "setup"],
            env=sandbox.environment | {"SAID": str(said)},
            check=True,
            stderr=file,
        )
    asked, all_of_it = [line for line in said.read_text().splitlines() if "libgl1" in line]
    assert asked.endswith(
        "libgl1 libegl1 libglu1-mesa libxcursor1 libxft2 libxinerama1 libgomp1 (FLANKFILM_NO_APT=1 prevents it)"
    )
    assert all_of_it.endswith("installs now: libglvnd0 libgl1")  # with what they need
    lines_said = [int(call.split()[1]) for call in sandbox.calls("apt-get")]
    assert lines_said == [
        1,
        1,
        2,
    ]  # before the lists are fetched, before the simulation, before the installation


@pytest.mark.parametrize("job", ["check", "docs"])
def test_checks_and_pages_need_no_libraries(sandbox: Sandbox, job: str) -> None:
    become(sandbox, 1000)
    Path(sandbox.environment["LIBRARIES_THERE"]).unlink()
    assert "libgl1" not in sandbox.run(job).stderr


# ---------------------------------------------------------------- jobs


@pytest.mark.parametrize("status", [0, 1, 5, 77])
def test_exit_status_passes_through(sandbox: Sandbox, status: int) -> None:
    assert sandbox.run("test", JOB_STATUS=str(status)).returncode == status
    assert sandbox.run("demo", JOB_STATUS=str(status)).returncode == status
    assert sandbox.run("check", JOB_STATUS=str(status)).returncode == min(status, 1)


def test_whole_suite_runs_on_all_cores(sandbox: Sandbox) -> None:
    sandbox.run("test")
    sandbox.run("test", "--slow")
    calls = [re.fullmatch(r"-m pytest (.*)-n (\d+)(.*)", call) for call in sandbox.calls("-m pytest")]
    assert [call and (call[1], call[3]) for call in calls] == [
        ("", " --dist worksteal"),
        ("-m slow --timeout 1800 ", ""),
    ]
    assert all(call and 1 <= int(call[2]) <= 8 for call in calls)


def test_slow_studies(sandbox: Sandbox) -> None:
    sandbox.run("test", "--slow", "tests/fem")
    assert sandbox.calls("-m pytest") == ["-m pytest -m slow --timeout 1800 tests/fem"]


def test_arguments_keep_their_spaces(sandbox: Sandbox) -> None:
    sandbox.run("test", "-k", "film and not slow")
    assert sandbox.calls("-m pytest") == ["-m pytest -k film and not slow"]


def test_all_checks_run_even_when_one_fails(sandbox: Sandbox) -> None:
    sandbox.run("check", JOB_STATUS="1")
    assert sandbox.calls("-m ruff") + sandbox.calls("-m mypy") == [
        "-m ruff check",
        "-m ruff format --check",
        "-m mypy",
    ]


def test_demo_says_where_the_report_is(sandbox: Sandbox) -> None:
    done = sandbox.run("demo", cwd=Path("/"))
    out = sandbox.root / "out" / "article"
    assert sandbox.calls("flankfilm run") == [
        f"flankfilm run {sandbox.root}/examples/article.toml --out {out}"
    ]
    assert done.stderr.splitlines()[-1] == f"run: the report: {out}/report.html"


def test_demo_with_options_only(sandbox: Sandbox) -> None:
    sandbox.run("demo", "--tolerance", "1%")
    (call,) = sandbox.calls("flankfilm run")
    assert call.endswith(
        "/examples/article.toml --out " + str(sandbox.root / "out/article") + " --tolerance 1%"
    )


@pytest.mark.parametrize("form", [("--out", "mine here"), ("--out=mine here",)])
def test_demo_with_own_scene(sandbox: Sandbox, tmp_path: Path, form: tuple[str, ...]) -> None:
    done = sandbox.run("demo", "my scene.toml", *form, cwd=tmp_path)
    assert sandbox.calls("flankfilm run") == ["flankfilm run my scene.toml " + " ".join(form)]
    assert done.stderr.splitlines()[-1] == f"run: the report: {tmp_path}/mine here/report.html"


def test_through_a_symbolic_link(sandbox: Sandbox, tmp_path: Path) -> None:
    link = tmp_path / "link"
    link.symlink_to(sandbox.root / "run")
    done = sandbox.run("test", script=link, cwd=tmp_path, PYTHONPATH="/elsewhere")
    assert done.returncode == 0
    assert sandbox.stamp.exists()
    assert not (tmp_path / ".venv").exists()


def test_processes_of_tests_keep_what_python_compiles(sandbox: Sandbox) -> None:
    assert sandbox.run("test", PYTHONDONTWRITEBYTECODE="1").returncode == 0


# ---------------------------------------------------------------- what it installs


def pins() -> dict[str, list[str]]:
    """Lines of the file of versions, each with its hashes."""
    found: dict[str, list[str]] = {}
    pin = ""
    for line in (ROOT / "requirements.txt").read_text().splitlines():
        if line.startswith("    --hash="):
            found[pin].append(line.strip().rstrip(" \\"))
        elif not line.startswith("#"):
            pin = line.rstrip(" \\")
            found[pin] = []
    return found


def test_every_version_is_exact_and_has_hashes() -> None:
    for pin, hashes in pins().items():
        assert re.fullmatch(r"[A-Za-z0-9._-]+(\[[a-z,]+\])?==[^ ]+( ; .+)?", pin)
        assert hashes, pin
        assert all(re.fullmatch("--hash=sha256:[0-9a-f]{64}", one) for one in hashes)
    assert "://" not in (ROOT / "requirements.txt").read_text()  # which index is the user's to say


def test_all_that_the_project_asks_for_is_there_in_a_version_that_will_do() -> None:
    table = tomllib.loads((ROOT / "pyproject.toml").read_text())
    asked = [*table["build-system"]["requires"], "editables", *table["project"]["dependencies"]]
    asked += [one for lines in table["project"]["optional-dependencies"].values() for one in lines]
    versions = {canonicalize_name(one.name): one.specifier for one in map(Requirement, pins())}
    for one in map(Requirement, asked):
        (exact,) = versions[canonicalize_name(one.name)]
        assert one.specifier.contains(exact.version), f"{one}: .ci/pin writes requirements.txt anew"


def test_the_continuous_integration_names_its_workers():
    # `./run test` divides the tests among all cores only when it has no argument of pytest.
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    suites = re.findall(r"\./run test\b[^|]*", script)
    assert len(suites) == 2
    assert all(" -n 2 " in suite for suite in suites)
