"""Numeric constants of the solvers, doubled and halved one at a time: which of them decide an answer.

``python -m benchmarks.constants gears meshes fem ehl`` takes some minutes.
"""
