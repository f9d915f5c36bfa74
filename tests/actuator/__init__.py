"""Tests of the actuator model."""
