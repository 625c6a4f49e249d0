"""The frame of the gallery page: its data, its charts, its files."""
