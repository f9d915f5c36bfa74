"""Simulates a whole campaign with known truth, in the instruments' own formats."""
