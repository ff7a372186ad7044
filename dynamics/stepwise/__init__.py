"""The stepwise flow: steps of order 8 with a stated tolerance, for forces that are not piecewise linear."""
