"""Two commits on one machine, compared bit by bit: every example scene and study, and arrays of the Python interface.

``python -m benchmarks.freeze COMMIT [COMMIT]``; the second is the working tree unless given. Nothing is stored between
runs: another processor, BLAS or compiler has other last bits.
"""
