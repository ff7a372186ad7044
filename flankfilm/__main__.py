"""``python -m flankfilm``, such as under ``mpiexec -n 8 python -m mpi4py.futures -m flankfilm study ...``."""

from flankfilm.cli import main

if __name__ == "__main__":
    main()
