"""Draws charts as SVG, straight from their values: quick, small, and the same bytes each time."""
