"""Taylor polynomials of a motion in several freedoms."""

from dynamics.kernels.compiling import FloatArray, helper


@helper
def excite(
    systems: FloatArray, load: FloatArray, error: FloatArray, forces: FloatArray, push: FloatArray
) -> None:
    """Taylor coefficients `push`, (m, degree + 1), of all forces that do not depend on the state.

    `error` are those of e: y is the first coordinate less e, which is left behind as a force. `forces`,
    (p, degree + 1), are those of the periodic forces along their directions.
    """
    m, n = push.shape
    for i in range(m):
        for k in range(n - 2):
            push[i, k] = -systems[0, i, 0] * error[k] - load[1, i] * (k + 1) * error[k + 1]
        push[i, 0] += load[0, i]
        for j in range(len(forces)):
            for k in range(n - 2):
                push[i, k] += load[2 + j, i] * forces[j, k]
    for k in range(n - 2):
        push[0, k] -= (k + 1) * (k + 2) * error[k + 2]


@helper
def expand(
    systems: FloatArray, mesh: FloatArray, push: FloatArray, offset: float, kind: int, a: FloatArray
) -> None:  # fmt: skip
    """Taylor coefficients `a`, (m, degree + 1), of the motion whose first two columns are given.

    `kind` 0: in contact, 1: in the dead zone. `offset` is region D.
    """
    m, n = a.shape
    for k in range(n - 2):
        share, rate, pull = 1.0 / ((k + 1) * (k + 2)), k + 1.0, 0.0
        if kind == 0:
            for i in range(k + 1):
                pull += mesh[i] * a[0, k - i]
        for i in range(m):
            total = push[i, k]
            for j in range(m):
                total -= systems[0, i, j] * a[j, k] + rate * systems[1 + kind, i, j] * a[j, k + 1]
            a[i, k + 2] = total * share
        a[0, k + 2] -= pull * share
        if k == 0:
            for i in range(m):
                a[i, 2] -= 0.5 * offset * systems[0, i, 0]


@helper
def expand_many(systems: FloatArray, mesh: FloatArray, kind: int, begin: FloatArray, a: FloatArray) -> None:
    """Taylor coefficients `a`, (degree + 1, m, c), of many free motions from the first rows of `begin`, (2 m, c).

    A motion is a column, next to its neighbours in memory: the inner loops take several at once.
    """
    n, m, columns = a.shape
    for i in range(m):
        for c in range(columns):
            a[0, i, c] = begin[i, c]
            a[1, i, c] = begin[m + i, c]
    for k in range(n - 2):
        add_many(systems, mesh, kind, k, a)


@helper
def add_many(systems: FloatArray, mesh: FloatArray, kind: int, k: int, a: FloatArray) -> None:
    """The coefficients k + 2 of many free motions."""
    _, m, columns = a.shape
    share = 1.0 / ((k + 1) * (k + 2))
    for i in range(m):
        for c in range(columns):
            a[k + 2, i, c] = 0.0
        for j in range(m):
            p, q = -share * systems[0, i, j], -share * (k + 1) * systems[1 + kind, i, j]
            for c in range(columns):
                a[k + 2, i, c] += p * a[k, j, c] + q * a[k + 1, j, c]
    if kind == 0:
        for i in range(k + 1):
            p = -share * mesh[i]
            for c in range(columns):
                a[k + 2, 0, c] += p * a[k - i, 0, c]


@helper
def evaluate(a: FloatArray, t: float, out: FloatArray) -> None:
    """State, (2 m,), of polynomials at t."""
    m, n = a.shape
    for i in range(m):
        f = df = 0.0
        for k in range(n - 1, -1, -1):
            df = df * t + f
            f = f * t + a[i, k]
        out[i] = f
        out[m + i] = df


@helper
def evaluate_many(a: FloatArray, t: float, out: FloatArray) -> None:
    """States, (2 m, c), of many motions at t."""
    n, m, columns = a.shape
    for i in range(m):
        for c in range(columns):
            out[i, c] = out[m + i, c] = 0.0
        for k in range(n - 1, -1, -1):
            for c in range(columns):
                out[m + i, c] = out[m + i, c] * t + out[i, c]
                out[i, c] = out[i, c] * t + a[k, i, c]
