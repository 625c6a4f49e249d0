"""The virtual test rig, and every test once more in it."""
