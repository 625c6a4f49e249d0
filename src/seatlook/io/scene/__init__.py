"""The scene file: everything one run needs, read and checked together."""
