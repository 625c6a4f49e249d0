"""Lights as the renderer takes them, skies, and the exposure of a rig."""
