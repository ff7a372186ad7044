"""Files of a commit, or of the working tree, in a temporary folder."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WORKING_TREE = "working tree"


class CommitError(Exception):
    """git knows no such commit."""


def git(*arguments: str, root: Path = ROOT) -> str:
    """Output of a git command in the project's folder.

    Raises
    ------
    CommitError
        With what git says, where the command fails.
    """
    done = subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, text=True, check=False)
    if done.returncode:
        raise CommitError(f"git {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout


def described(commit: str | None, root: Path = ROOT) -> str:
    """Short hash and subject of a commit; the working tree by name."""
    if commit is None:
        return WORKING_TREE
    return git("log", "-1", "--format=%h %s", git("rev-parse", "--verify", f"{commit}^{{commit}}", root=root).strip(),
               root=root).strip()  # fmt: skip


@contextmanager
def checked_out(commit: str | None, folder: Path, root: Path = ROOT) -> Iterator[Path]:
    """Files of a commit in a new folder, which is removed at the end; None copies the working tree.

    A copy, since the working tree may be edited while a comparison runs, and since cases write into their tree.
    """
    if commit is None:
        _copy(root, folder)
        yield folder
        return
    git("worktree", "add", "--detach", "--force", "--quiet", str(folder), commit, root=root)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        git("worktree", "prune", root=root)


def _copy(root: Path, folder: Path) -> None:
    """Copy what git tracks or would track: neither ignored files nor the history."""
    listed = git("ls-files", "-z", "--cached", "--others", "--exclude-standard", root=root)
    for name in filter(None, listed.split("\0")):
        source, target = root / name, folder / name
        if source.is_file():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source, target)
