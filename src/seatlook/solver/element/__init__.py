"""The sheet: membrane, bending, folds across seams, mass and loads."""
