"""Ways to an equilibrium, and the matrices they work with."""
