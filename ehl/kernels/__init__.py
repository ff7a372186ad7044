"""Compiled kernels of the film, of its heat and of its shear: plain arrays in and out."""
