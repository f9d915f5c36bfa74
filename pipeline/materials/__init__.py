"""From records to what leaves the house: cards, the database, the curves, the trace of a number."""
