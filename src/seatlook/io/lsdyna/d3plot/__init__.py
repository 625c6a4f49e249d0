"""The d3plot format: results of all states."""
