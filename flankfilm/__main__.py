"""Entry of the program: ``flankfilm``, and ``python -m flankfilm``, as under ``mpiexec -n 8``."""

import os

from flankfilm.processes.garbage import collect_rarely


def main() -> None:
    """Run the command line with one thread of linear algebra, unless the environment says otherwise."""
    os.environ["MPLBACKEND"] = (
        "agg"  # pictures go to files; a notebook's shell names a backend of its kernel alone
    )
    # Before numpy is loaded, which reads it once. The matrices are small: two threads take up to ten times the time
    # of one where another program works beside them.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # pydantic seeks plug-ins among all installed packages, whose lists it reads: the scene's schema has none.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    collect_rarely()
    from flankfilm.cli import main as commands

    commands()


if __name__ == "__main__":
    main()
