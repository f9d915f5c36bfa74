r"""Permittivity and loss of films between plates, from sweeps of an LCR meter.

$$ \epsilon_r = \frac{C_p}{\epsilon_0} \frac{d}{A}, \qquad \tan\delta = \frac{G}{\omega C_p} $$

What the numbers cannot show: an air gap of 1 % of the thickness costs 1 to 4 %, always downwards.
See docs/methods/permittivity.md.

Source: ASTM D150; Sikulskyi et al. 2022, Front. Robot. AI 9:1034914, section 3.3 (plates of
45 x 45 mm, films of 300 um, LCR-6020, thickness under 5 N corrected with the measured modulus).
"""

from __future__ import annotations

from deamat.core.register import RegisterForm
from deamat.core.technique import Technique
from deamat.techniques.permittivity.config import MODULUS, YIELDS, PermittivityConfig
from deamat.techniques.permittivity.figure import figure
from deamat.techniques.permittivity.reduce import reduce
from deamat.techniques.permittivity.summarise import summarise

TECHNIQUE = Technique(
    key="permittivity",
    yields=YIELDS,
    needs=(MODULUS,),
    config=PermittivityConfig,
    required=(),  # a spectrometer's file states the film itself
    optional=(
        "thickness_m",
        "plate_length_m",
        "plate_width_m",
        "micrometer_force_N",
        "anvil_diameter_m",
    ),
    reduce=reduce,
    summarise=summarise,
    figure=figure,
    register=RegisterForm(
        asked=(
            "thickness_m",
            "plate_length_m",
            "plate_width_m",
            "micrometer_force_N",
            "anvil_diameter_m",
        )
    ),
    measures=("impedance",),
)
