"""``python -m seatlook``."""

from seatlook.cli import main

main()
