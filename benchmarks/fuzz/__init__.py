"""Spoils good files and registers, and judges what cards say of them."""
