"""The making of the cover in time: ties, stages, steps, and the verdict at the end."""
