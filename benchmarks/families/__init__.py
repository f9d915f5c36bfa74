"""Families of estimators that are charted, one module each."""
