"""Studies over several states, variants or lights."""
