"""Columns that a motion carries along: derivatives by its start, or directions that grow."""

import math

from dynamics.kernels.compiling import FloatArray, helper


@helper
def straighten(jac: FloatArray, h: float) -> None:
    """Make the columns of all rows but the last orthonormal, and add the logarithms of their lengths to that."""
    n = jac.shape[1]
    m = n // 2
    for i in range(m, n):
        for j in range(n):
            jac[i, j] /= h
    for j in range(n):
        for _ in range(2):
            for k in range(j):
                along = 0.0
                for i in range(n):
                    along += jac[i, k] * jac[i, j]
                for i in range(n):
                    jac[i, j] -= along * jac[i, k]
            size = 0.0
            for i in range(n):
                size += jac[i, j] * jac[i, j]
            size = math.sqrt(size)
            jac[n, j] += math.log(size)
            for i in range(n):
                jac[i, j] /= size
    for i in range(m, n):
        for j in range(n):
            jac[i, j] *= h


@helper
def multiply(turned: FloatArray, jac: FloatArray, spare: FloatArray) -> None:
    """Multiply the first rows of `jac`, an even number, by the transpose of a square that a matrix begins with."""
    n = jac.shape[1]
    for i in range(0, n, 2):  # two rows of two at once: half the loads and stores
        for j in range(n):
            spare[i, j] = spare[i + 1, j] = 0.0
        for k in range(0, n, 2):
            p, q, r, s = turned[k, i], turned[k + 1, i], turned[k, i + 1], turned[k + 1, i + 1]
            for j in range(n):
                first, second = jac[k, j], jac[k + 1, j]
                spare[i, j] += p * first + q * second
                spare[i + 1, j] += r * first + s * second
    for i in range(n):
        for j in range(n):
            jac[i, j] = spare[i, j]


@helper
def scale_rows(jac: FloatArray, factor: float) -> None:
    """Multiply the rows of the speeds."""
    n = jac.shape[1]
    for i in range(n // 2, n):
        for j in range(n):
            jac[i, j] *= factor
