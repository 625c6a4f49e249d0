"""Pictures of values on the cover, and quick previews of its shape."""
