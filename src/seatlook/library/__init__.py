"""A folder of seats, patterns, foams, materials, rigs, limits and results, to be found again."""
