"""Paired comparisons by people: plan, pictures, votes and their statistics."""
