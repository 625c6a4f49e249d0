"""Several variants of one cover side by side."""
