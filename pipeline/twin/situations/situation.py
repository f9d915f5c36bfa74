"""What a situation of a laboratory is: files with a fault, and the right answer to them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from numpy.random import Generator

from deamat.core.records import Condition

MATERIAL = "simulated"


@dataclass(frozen=True, slots=True)
class Made:
    """One material measured in a situation.

    Parameters
    ----------
    files : path below the technique's folder (`specimens.csv`, `1.csv`) to content
    truth : the right value of the property, in SI
    naive : what a short script says of the same numbers, in SI
    conditions : which record is meant, where the property has several
    elsewhere : further files, path relative to the campaign to content
    misstated : the fault is in what a row says of its specimen, not in the value: the value may be
        right, and yet what it is said to be of is not
    """

    files: Mapping[str, bytes]
    truth: float
    naive: float
    conditions: Mapping[str, Condition] = field(default_factory=dict)
    elsewhere: Mapping[str, bytes] = field(default_factory=dict)
    misstated: bool = False


@dataclass(frozen=True, slots=True)
class Situation:
    """Something that laboratories have and a textbook does not.

    Parameters
    ----------
    name : how the twin, the study and the page call it
    technique, key : the folder of its files, and the property that it distorts
    told : what happens in the laboratory, in one sentence
    answer : what is said of it on the card, in one sentence
    causes : names of the flags that name the cause; a value that is off and carries one is no
        silent error
    severity : what is varied, with its unit
    severities : three of them, which shift the naive value by about 3, 10 and 30 %; fewer where
        the situation has no such degrees
    make : a severity (0: no fault) to a material
    sound : at severity 0 nothing is wrong; False where another fault is left, which may be flagged
    undetectable : severity to the reason why the data cannot show it, for cells known to be silent
    """

    name: str
    technique: str
    key: str
    told: str
    answer: str
    causes: tuple[str, ...]
    severity: str
    severities: tuple[float, ...]
    make: Callable[[Generator, float], Made]
    undetectable: Mapping[float, str] = field(default_factory=dict)
    sound: bool = True
