"""Holds statements against each other: rows, files, siblings and dates."""
