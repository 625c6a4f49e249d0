"""``python -m seatlook``."""

from seatlook.cli import main

if __name__ == "__main__":
    main()
