"""Results of other programs, assessed and drawn."""
