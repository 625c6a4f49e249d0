"""Damage done to files of every format that is read: what comes out of a reader then.

From the folder of the tests: ``python -m support.fuzz --count 10000 --cover``; ``make fuzz``.
"""
