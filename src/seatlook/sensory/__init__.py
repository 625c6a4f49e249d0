"""How visible a difference between two pictures is, and what people said about it."""
