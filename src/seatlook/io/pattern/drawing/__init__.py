"""Entities of a drawing: opened, decoded, by layer, each in the place it is used."""
