"""The machine, its load and the libraries that a measurement ran on; nothing that names a person or a host."""

from __future__ import annotations

import os
import platform
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from flankfilm.files.cache import LIBRARIES
from flankfilm.processes.worker_processes import cores
from flankfilm.studies.executors import THREADS


@dataclass(frozen=True)
class Machine:
    """What a measurement ran on.

    Attributes
    ----------
    processor : str
        Model as the system names it.
    cores : int
        Cores that this process may use.
    memory_GiB : float
        NaN where the system does not report it.
    system : str
        Operating system and architecture.
    python, blas : str
        Versions.
    libraries : dict
        Name to version.
    threads : dict
        Variables that limit threads, where they are set.
    load : float
        Processes that wanted a core during the last minute, when the measurement began; NaN where unknown.
    """

    processor: str
    cores: int
    memory_GiB: float
    system: str
    python: str
    blas: str
    libraries: dict[str, str]
    threads: dict[str, str]
    load: float

    def described(self) -> tuple[tuple[str, str], ...]:
        """Pairs of name and text for tables."""
        memory = f"{self.memory_GiB:.0f} GiB" if self.memory_GiB == self.memory_GiB else "unknown"
        return (
            ("processor", f"{self.processor}, {self.cores} core{'s' if self.cores > 1 else ''}"),
            ("memory", memory),
            ("system", self.system),
            ("Python", self.python),
            ("linear algebra", self.blas),
            ("libraries", ", ".join(f"{name} {number}" for name, number in self.libraries.items())),
            ("threads", ", ".join(f"{k}={v}" for k, v in self.threads.items()) or "not limited"),
            ("load when it began", busy(self.load)),
        )


def busy(load: float) -> str:
    """Text of a machine's load."""
    return f"{load:.1f} processes" if load == load else "unknown"


def this_machine() -> Machine:
    """Describe the machine that this process runs on."""
    return Machine(
        _processor(),
        cores(),
        _memory(),
        f"{platform.system()}, {platform.machine()}",
        f"{platform.python_implementation()} {platform.python_version()}",
        _blas(),
        {name: version(name) for name in ("flankfilm", *LIBRARIES)},
        {name: os.environ[name] for name in THREADS if name in os.environ},
        load(),
    )


def load() -> float:
    """Mean number of processes that wanted a core during the last minute; NaN where the system does not report it."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")


def _processor() -> str:
    source = Path("/proc/cpuinfo")
    if source.is_file():
        for line in source.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def _memory() -> float:
    names = ("SC_PAGE_SIZE", "SC_PHYS_PAGES")
    if not hasattr(os, "sysconf") or not all(name in os.sysconf_names for name in names):
        return float("nan")
    size, pages = (os.sysconf(name) for name in names)
    return size * pages / 2**30


def _blas() -> str:
    import numpy as np

    config: Any = np.show_config(mode="dicts")
    blas = config.get("Build Dependencies", {}).get("blas", {})
    return " ".join(str(blas[key]) for key in ("name", "version") if blas.get(key)) or "unknown"
