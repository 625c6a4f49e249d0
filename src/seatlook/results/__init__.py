"""Readings of a solution: gap, deviation, ring pulls, energy balance."""
