"""Laws through points: linear, polynomial, power-law and nonlinear fits, right to 13 digits."""
