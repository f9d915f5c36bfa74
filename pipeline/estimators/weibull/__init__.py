"""The Weibull distribution of breakdown: fit, exact intervals, goodness, area scaling."""
