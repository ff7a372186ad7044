"""Memory that a process may still take, as the system reports it."""

from __future__ import annotations

import math
from pathlib import Path

__all__ = ["free_memory"]

MEMINFO = Path("/proc/meminfo")
GROUP = Path("/sys/fs/cgroup")
"""Of the process' own group, where it is in a container."""


def free_memory() -> float:
    """Bytes that a process may take before the system kills it; infinite where the system does not say.

    The minimum of what is available on the machine, of what the container's limit leaves (cgroups, version 2), and
    of what the limit of the address space leaves.

    Examples
    --------
    >>> from base import free_memory
    >>> free_memory() > 0.0
    True
    """
    return min(_available(), _left_in_group(), _left_of_addresses())


def _available() -> float:
    try:
        lines = MEMINFO.read_text(encoding="ascii", errors="replace").splitlines()
    except OSError:
        return math.inf
    for line in lines:
        name, _, value = line.partition(":")
        if name == "MemAvailable":
            return 1024.0 * float(value.split()[0])
    return math.inf


def _left_in_group() -> float:
    try:
        most, used, parts = (
            (GROUP / f"memory.{name}").read_text(encoding="ascii") for name in ("max", "current", "stat")
        )
    except OSError:
        return math.inf
    if most.strip() == "max":
        return math.inf
    # pages of files that nothing reads now count as used, and are given back before anything is killed
    given_back = sum(
        float(count) for name, count in map(str.split, parts.splitlines()) if name == "inactive_file"
    )
    return max(float(most) - float(used) + given_back, 0.0)


def _left_of_addresses() -> float:
    try:
        import resource
    except ImportError:  # Windows has no such limit
        return math.inf
    most, _ = resource.getrlimit(resource.RLIMIT_AS)
    if most == resource.RLIM_INFINITY:
        return math.inf
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    except OSError:
        pages = 0
    return max(float(most - pages * resource.getpagesize()), 0.0)
