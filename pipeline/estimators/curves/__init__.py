"""Measured curves: branches and windows, slopes, contact points, unloading stiffness."""
