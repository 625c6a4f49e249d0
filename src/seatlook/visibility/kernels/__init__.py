"""Compiled loops of the visibility score."""
