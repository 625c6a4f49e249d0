"""What a cover is lit by and looked at from."""
