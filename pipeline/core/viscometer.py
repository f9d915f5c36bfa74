"""What a rotary viscometer of the NDJ kind can show: full scale, torque window, speeds."""

from __future__ import annotations

from deamat.core.errors import OutOfRange

SPEEDS_RPM = (0.3, 0.6, 1.5, 3.0, 6.0, 12.0, 30.0, 60.0)

# Full scale of each rotor at 60 rpm; it goes with the inverse of the speed.
_FULL_SCALE_AT_60_RPM_PAS = {1: 0.1, 2: 0.5, 3: 2.0, 4: 10.0}


def full_scale_Pas(rotor: int, speed_rpm: float, spring_torque: float = 1.0) -> float:
    r"""Viscosity at full torque, $\eta_{100} = s\, \eta_{100}(60) \cdot 60 / N$ `[Pa.s]`.

    A reading obeys $\eta = \eta_{100} T / 100 \%$ with the torque T in percent.

    Parameters
    ----------
    rotor : 1 to 4
    speed_rpm : one of `SPEEDS_RPM`
    spring_torque : s, full torque of the spring over that of an NDJ-8S

    Raises
    ------
    OutOfRange : the instrument has no such rotor or speed

    Source: Brookfield LV constants, whose rotors 1 to 4 an NDJ-8S has.
    """
    if rotor not in _FULL_SCALE_AT_60_RPM_PAS:
        raise OutOfRange(f"an NDJ-8S has rotors 1 to 4, not {rotor}")
    if speed_rpm not in SPEEDS_RPM:
        speeds = ", ".join(f"{s:g}" for s in SPEEDS_RPM)
        raise OutOfRange(f"an NDJ-8S turns at {speeds} rpm, not at {speed_rpm:g}")
    return spring_torque * _FULL_SCALE_AT_60_RPM_PAS[rotor] * 60.0 / speed_rpm
