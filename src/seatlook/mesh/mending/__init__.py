"""Surfaces as they come out of other programs and scanners, mended step by step with a report."""
