"""The parts of the gallery page, each from the readings it shows."""
