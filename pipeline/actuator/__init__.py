"""Unimorph dielectric elastomer actuators: from a layer stack and a voltage to a bent strip."""
