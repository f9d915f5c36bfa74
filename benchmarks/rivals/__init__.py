"""Other ways to the same numbers: what they lose is charted; no card is made by them."""
