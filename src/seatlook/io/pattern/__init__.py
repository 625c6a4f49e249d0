"""Patterns in and out: DXF, and the seams file beside it."""
