"""A user's own script: pandas, numpy, sqlite and one picture for each material, and nothing else.

`python script.py CAMPAIGN OUT` answers what `deamat all` answers of compression curves: a modulus
with its standard error for each specimen, the mean of each material with its own, a database and a
figure. Written as a fair user would write it and then left alone: no project code, no tricks.
"""

from __future__ import annotations

import sqlite3
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

WINDOW = 0.05  # strain


def read(path: Path) -> pd.DataFrame:
    """Read one export: comma with a units row, or tab with decimal commas."""
    if path.suffix == ".csv":
        table = pd.read_csv(path, skiprows=[1])
    else:
        table = pd.read_csv(path, sep="\t", decimal=",")
    table.columns = ["time_s", "travel_mm", "load_N"]
    return table


def main() -> None:
    """Read, fit, store and draw."""
    campaign, out = Path(sys.argv[1]), Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    register = pd.read_csv(campaign / "compression" / "specimens.csv")
    values = []
    for material, specimens in register.groupby("material"):
        fig, ax = plt.subplots()
        for row in specimens.to_dict("records"):
            table = read(campaign / "compression" / row["file"])
            strain = (table.travel_mm / row["height_mm"]).to_numpy()
            stress = (table.load_N / (np.pi / 4 * row["diameter_mm"] ** 2)).to_numpy()  # MPa
            chosen = strain <= WINDOW
            fit, covariance = np.polyfit(strain[chosen], stress[chosen], 1, cov=True)
            values.append((material, row["specimen"], fit[0], np.sqrt(covariance[0, 0])))
            ax.plot(100 * strain, 1e3 * stress, lw=0.8)
            ax.plot([0, 100 * WINDOW], [1e3 * np.polyval(fit, e) for e in (0, WINDOW)], "k", lw=1)
        ax.axvspan(0, 100 * WINDOW, color="0.9")
        ax.set_xlabel("strain [%]")
        ax.set_ylabel("stress [kPa]")
        ax.set_title(str(material))
        fig.savefig(out / f"{material}.png", dpi=150)
        plt.close(fig)
    moduli = pd.DataFrame(values, columns=["material", "specimen", "modulus_MPa", "se_MPa"])
    means = moduli.groupby("material").modulus_MPa.agg(["mean", "sem", "count"]).reset_index()
    with sqlite3.connect(out / "materials.sqlite") as database:
        moduli.to_sql("specimens", database, index=False, if_exists="replace")
        means.to_sql("materials", database, index=False, if_exists="replace")


if __name__ == "__main__":
    main()
