"""Curves of test rigs: a TOML file that names CSV files, their columns and units."""
