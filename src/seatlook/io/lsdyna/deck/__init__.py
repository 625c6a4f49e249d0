"""The keyword format: decks and dynain files."""
