"""A material of the curves that a laboratory measured."""
