"""Mutation testing: small slips are put into the package one at a time, and the tests must fail."""
