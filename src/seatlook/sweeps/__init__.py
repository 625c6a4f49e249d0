"""Many covers: keys, variants and tolerances, and what they say together."""
