"""The solved cover in files for other programs, and the result file itself."""
