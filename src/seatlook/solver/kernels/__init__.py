"""Compiled loops: NumPy and Numba only, nothing raised, nothing checked."""
