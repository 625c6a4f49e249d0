"""Results and decks of LS-DYNA in, and the solved cover as a deck out."""
