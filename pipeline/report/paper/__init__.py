"""The article's tables and figures, printed values beside recomputed ones, as one page."""
