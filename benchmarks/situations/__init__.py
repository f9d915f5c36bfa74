"""How often a situation that laboratories have ends in a wrong number that nothing warns of."""
