"""The traps of the viscometer, the LCR meter and the high-voltage ramp, in the order of the notes."""

from __future__ import annotations

from tests.formats.trap_files import (
    ELAPSED,
    FILM,
    IDENTITY,
    RAMPED,
    STAMPED,
    VISCOSITIES,
    Trap,
    fluid,
    line_of,
    log,
    ramp,
    sweep,
)  # fmt: skip

FILM_OF = {"relative_permittivity": 2.63}
FIELD = {"breakdown_field": 60e6}

VISCOMETER = (
    Trap(
        "`-.-` no probe", "a reading without a temperature", "20:30:00\t3#30 RPM   645 16.1  -.-\n",
        columns={"viscosity_Pas": [0.645], "torque": [0.161], "rotor": [3], "speed_rpm": [30]},
    ),
    Trap(
        "No timestamp: the PC stamps it.", "stamps by the clock, mixing time in the register",
        log(), "viscosity", STAMPED, values=VISCOSITIES,
    ),
    Trap(
        "No timestamp: the PC stamps it.", "stamps by the clock, no mixing time anywhere",
        log(), "viscosity", ELAPSED, refused="the readings are stamped by the clock, and the "
        "register has no `mixed_at`; fill it in (2022-03-01T20:15:00)",
    ),
    Trap(
        "labs also keep a plain CSV (time, rotor, rpm, viscosity, torque, temperature)",
        "all six columns",
        "time_h,rotor,speed_rpm,viscosity_mPas,torque_percent,temperature_C\n"
        "0.25,3,30,1925,48.1,22.0\n",
        columns={"time_s": [900], "viscosity_Pas": [1.925], "torque": [0.481],
                 "temperature_K": [295.15]},
    ),
    Trap(
        "Audit identity: viscosity = full scale * torque / 100.", "one torque of another reading",
        log({6.0: "3#12 RPM  5140 12.3 22.0"}), "viscosity", STAMPED, values=VISCOSITIES,
        flags=("contradicting: viscosity, torque and speed disagree: 1 readings left out, lines "
               f"{line_of(6.0)}",),
    ),
    Trap(
        "Valid torque 10-100 %", "a reading at 5 % of full torque",
        log({6.0: "3#12 RPM  500 5.0  22.0"}), "viscosity", STAMPED, values=VISCOSITIES,
        flags=("outside-torque-window: torque outside 10-100 %: 1 readings left out, lines "
               f"{line_of(6.0)}",),
    ),
    Trap(
        "error +-2 % of full scale [R] (so +-20 % of reading at 10 %)", "an undeclared instrument",
        log(), "viscosity", STAMPED, values=VISCOSITIES, shared={"viscosity": 0.01 * 10.0},
        words="errors a constant fraction of full scale (0.30% noise of a reading, 1.00% calibration",
    ),
    Trap(
        "Over-range `EEEE`", "over range in one line",
        log({6.0: "3#12 RPM  EEEE"}), "viscosity", STAMPED, values=VISCOSITIES,
        flags=(f"over-range: 1 readings left out: lines {line_of(6.0)}",),
    ),
    Trap(
        "under-range flashes", "nothing in the line tells: the torque does",
        log({6.0: "3#12 RPM     0  0.0  22.0"}), "viscosity", STAMPED, values=VISCOSITIES,
        flags=("outside-torque-window: ",),
    ),
    Trap(
        "negative `----`", "below zero in one line",
        log({6.0: "3#12 RPM  ----  ----  22.0"}), "viscosity", STAMPED, values=VISCOSITIES,
        flags=(f"below-zero: 1 readings left out: lines {line_of(6.0)}",),
    ),
    Trap(
        "Power-law fluid in a wide cup: rate = 2 omega / n", "sweeps of a fluid with n = 0.4",
        fluid(0.4), "viscosity", STAMPED,
        values={"flow_index": 0.4, "flow_consistency": 30.0,
                "flow_consistency_wide_cup": 30.0 * 0.4**0.4},
        within=5e-3,
    ),
    Trap(
        "treat shear-rate factors as declared input with a source", "a rotor without one",
        fluid(0.4, rotor=2, consistency=4.0), "viscosity", STAMPED,
        refused="no shear rate is declared for rotor 2",
    ),
)  # fmt: skip

METER = (
    Trap(
        "`*IDN?` has a comma inside the vendor name.", "the reply as it is", IDENTITY
        + "# FUNC? => Cp-D\n1.0e+01,+1.58e-10,+1.2e-03,OK\n",
        columns={"frequency_Hz": [10], "parallel_capacitance_F": [158e-12]},
    ),
    Trap(
        "primary, secondary, monitors, flags", "a reply of seven fields in the sweep",
        "# FUNC? => Cp-D\n-3.11391e-03,+2.33504e-02,+8.38128e+02,+1.06598e-04,OUT ,AUX-NG,NG\n",
        rejected="x, line 2, column 4: 7 fields where frequency, primary, secondary and a status "
        "belong",
    ),
    Trap(
        "no units, no mode: FUNC (Cp-D, Cs-D, R-X...) must be stored with it",
        "a log without FUNC", sweep(""), rejected="x, line 1: ",
    ),
    Trap(
        "`LEV:VOLT?` -> `1.000e-01V`.", "a level with its unit behind it",
        sweep(level="1.000e-01V"), "permittivity", FILM, values=FILM_OF,
    ),
    Trap(
        "a PC-logged form (`# key => reply` header, then `frequency_Hz,primary,secondary,flags`)",
        "ten frequencies", sweep(), "permittivity", FILM, values=FILM_OF,
    ),
    Trap(
        "also read a plain CSV", "capacitance in pF", "frequency_Hz,Cp_pF,D\n10,158.2,0.0012\n",
        columns={"frequency_Hz": [10], "parallel_capacitance_F": [158.2e-12]},
    ),
    Trap(
        "Accuracy grows steeply at low frequency and small C", "100 Mohm at 10 Hz", sweep(),
        "permittivity", FILM, words="LCR meter",
        flags=("meter-limit: at |Z| = 1e+08 ohm the meter promises no better than +- 10 %",),
    ),
    Trap(
        "Cp and Cs differ by 1 + D^2", "a lossy film in series", sweep("Cs-D", tangent=0.2),
        "permittivity", FILM, values={**FILM_OF, "loss_tangent": 0.2},
    ),
    Trap(
        "series electrode resistance bends C down at high f", "3 kohm in series",
        sweep(resistance_ohm=3e3), "permittivity", FILM, values=FILM_OF,
        flags=("series-resistance: loss rises in proportion to frequency up to 10000 Hz, as 3e+03",),
    ),
    Trap(
        "an air gap of t_gap/t = 1 % costs 1-4 %", "1 % of the thickness is air: no sweep tells",
        sweep(gap=0.01), "permittivity", FILM,
        values={"relative_permittivity": 1.0 / (0.99 / 2.63 + 0.01)},
    ),
    Trap(
        "edge field of equal plates (ASTM D150) 0.5-4 %", "a film between plates of its size",
        sweep(), "permittivity", FILM,
        flags=("edge-field: not corrected: by ASTM D150 eps_r is 1.3 % too high",),
    ),
    *(
        Trap(
            said, f"at 1 kHz: {row}", sweep(changes={1000: row}), "permittivity", FILM,
            values=FILM_OF, flags=("over-range: ",),
        )
        for said, row in (
            ("9.9E37", "1.00000e+03,+9.90000e+37,+9.90000e+37,OK"),
            ("9.99999E37", "1.00000e+03,+9.99999E37,+1.00000e-02,OK"),
            ("`OUT `", "1.00000e+03,+1.58210e-10,+1.00000e-02,OUT "),
            ("`OVER`", "1.00000e+03,+1.58210e-10,+1.00000e-02,OVER"),
        )
    ),
    Trap(
        "status 1", "an E4980A in overload",
        "Function,CPD\nFrequency (Hz),Primary,Secondary,Status\n"
        "2.0E+01,+1.5E-10,+1.0E-02,+0\n1.0E+03,+1.5E-10,+1.0E-02,+1\n",
        columns={"over_range": [0, 1]},
        flags=("over-range: ",),
    ),
)  # fmt: skip

RAMP = (
    Trap(
        "time, voltage monitor (1 V / 2 kV), current monitor", "both monitors",
        "# channel 1: voltage monitor, 2000 V/V\n# channel 2: current monitor, 2e-3 A/V\n"
        "time_s,ch1_V,ch2_V\n0.5,1.25,0.5\n",
        columns={"time_s": [0.5], "voltage_V": [2500], "current_A": [1e-3]},
    ),
    Trap(
        "breakdown = first collapse of voltage with a current spike", "a collapse at 6 kV", ramp(),
        "breakdown", RAMPED, values=FIELD, words="first collapse with a current spike",
    ),
    Trap(
        "a specimen that reaches 20 kV is right-censored, not broken at 20 kV", "held at 20 kV",
        ramp(20e3, end="held"), "breakdown", RAMPED, values={"breakdown_field": 200e6},
        flags=("right-censored: it reached the amplifier's limit: it bore this field unbroken",),
    ),
    Trap(
        "a DC test is D149-style (DC: D3755, IEC 60243-2): say so on the card.", "any ramp",
        ramp(), "breakdown", RAMPED,
        words="DC, in the style of ASTM D149 (made for AC; for DC: ASTM D3755, IEC 60243-2)",
    ),
    Trap(
        "rate of rise constant within 20 %", "a ramp that bends", ramp(knee=2.0), "breakdown",
        RAMPED, values=FIELD, flags=("rate-of-rise: ",),
    ),
    Trap(
        "time to breakdown (> 120 s for slow rise [R])", "broken after a minute", ramp(seconds=60),
        "breakdown", RAMPED, values=FIELD,
        flags=("fast-rise: it broke after 60 s; a slow rise takes more than 120 s",),
    ),
    Trap(
        "start at 50 % of the short-time value", "a start at 83 %", ramp(start_V=5000), "breakdown",
        RAMPED, values=FIELD, flags=("high-start: the ramp started at 83.3 % of the voltage",),
    ),
    Trap(
        "flashovers discarded", "30 % lost in one sample", ramp(dip_at=50), "breakdown", RAMPED,
        values=FIELD, flags=("flashover: at 4.232 kV a part of the voltage was lost and came back",),
    ),
    Trap(
        "thickness at the breakdown site", "no thickness in the register", ramp(), "breakdown",
        "specimen,material,file\nb,m,f\n", refused="the register gives no thickness of this "
        "specimen, so its breakdown voltage is not a field; add thickness_<unit>, measured at the "
        "place of the breakdown",
    ),
    Trap(
        "n >= 5 (paper: 20).", "four specimens", "", "breakdown",
        "specimen,material,breakdown_field_V_per_um\na,m,60\nb,m,55\nc,m,64\nd,m,58\n",
        flags=("few-failures: ",),
    ),
)  # fmt: skip
