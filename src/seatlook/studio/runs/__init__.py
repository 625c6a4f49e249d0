"""Runs in processes of their own: they can be cancelled, and none of them ends the server."""
