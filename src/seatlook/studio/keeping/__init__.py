"""What was changed stays: files written whole, the journal, changes put together."""
