"""What is made of one file: a run over time, or a flow curve at one time."""

from __future__ import annotations

from deamat.techniques.viscosity.flow_fit import FlowReadings
from deamat.techniques.viscosity.readings import Readings

Run = Readings | FlowReadings
