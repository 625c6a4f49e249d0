"""The version of seatlook; below everything, so that any module may name it."""

__version__ = "0.4.0"
