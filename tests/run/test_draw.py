"""Which figures a release has, how they are called, and what they rest on."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from deamat.core.records import Condition, Summary
from deamat.run.draw import FigureJob, draw_one, figure_jobs
from deamat.run.measure import Group
from deamat.techniques.shared.modulus import LoadingCurve
from tests.materials.samples import measurement, modulus, origin, refusal

CURVE = {"nominal_strain": [0.0, 0.1], "nominal_stress_Pa": [0.0, 10.0]}
A1 = measurement("A1", CURVE)
GROUP = Group("soft-2026", "gel-a", "compression", (), "k", (A1,), Summary((modulus(),)))
WARM: tuple[tuple[str, Condition], ...] = (("age", "2 months"), ("temperature_K", 323.15))


def jobs(*groups: Group) -> dict[str, tuple[FigureJob, dict[str, str]]]:
    info = SimpleNamespace(synthetic=False)
    campaigns = [SimpleNamespace(name=name, info=info) for name in ("soft-2026", "other")]
    run: Any = SimpleNamespace(
        surveys=[SimpleNamespace(campaign=campaign) for campaign in [*campaigns, None]],
        config=SimpleNamespace(name_of=str.upper),
    )
    return {job.name: (job, parts) for job, parts in figure_jobs(groups, run)}


def test_a_group_has_its_figure_and_a_campaign_that_of_its_moduli() -> None:
    made = jobs(GROUP)
    assert list(made) == ["soft-2026/gel-a-compression", "soft-2026/moduli"]
    job, parts = made["soft-2026/gel-a-compression"]
    assert (job.title, job.technique, job.synthetic) == ("GEL-A, compression", "compression", False)
    assert job.files == [f"figures/{job.name}.svg"]
    assert parts == {GROUP.subject: "k", "about": "GEL-A, compression False"}
    moduli, parts = made["soft-2026/moduli"]
    assert (moduli.title, moduli.technique) == ("Moduli, soft-2026", None)
    assert moduli.labels == (("gel-a", "GEL-A"),)
    assert parts[GROUP.subject] == "k"


def test_conditions_are_in_the_name_of_a_figure_and_tell_it_apart() -> None:
    cold = (WARM[0], ("temperature_K", 296.15))
    made = jobs(*(replace(GROUP, conditions=c, summary=None, key="to be redone")
                  for c in ((), WARM, cold)))  # fmt: skip
    names = [name for name in made if not name.endswith("moduli")]
    assert len(set(names)) == 3
    assert names[0] == "soft-2026/gel-a-compression"
    assert names[1].startswith("soft-2026/gel-a-compression-2-months-323.15k-")
    assert names[2].startswith("soft-2026/gel-a-compression-2-months-296.15k-")
    assert made[names[1]][0].title == "GEL-A, compression, age 2 months, temperature 50 °C"


def test_nothing_to_draw_is_no_figure() -> None:
    empty = replace(GROUP, measurements=(measurement("A1", {"nominal_strain": []}),))
    assert list(jobs(empty)) == ["soft-2026/moduli"]
    assert jobs(replace(GROUP, summary=None)) == {}
    other = modulus(key="elongation_at_break")
    assert list(jobs(replace(GROUP, summary=Summary((other,))))) == ["soft-2026/gel-a-compression"]
    refused = Summary((), refusals=(refusal("A1"),))
    assert "soft-2026/moduli" in jobs(replace(GROUP, summary=refused))


def test_the_moduli_of_another_campaign_have_a_figure_of_their_own() -> None:
    other = replace(GROUP, campaign="other", material="gel-b")
    made = jobs(GROUP, other)
    assert made["other/moduli"][0].labels == (("gel-b", "GEL-B"),)
    assert set(made["other/moduli"][1]) == {other.subject, "about"}


def test_a_figure_rests_on_the_files_of_its_curves_and_of_its_values() -> None:
    file = "soft-2026/compression/A1.csv"
    mine = replace(A1, specimen=replace(A1.specimen, file=file))
    by_hand = origin("bed", 1.0, 5, path=None)
    values = Summary((modulus(origins=(origin("A1", 1.0, 2), origin("A2", 1.0, 3), by_hand)),))
    job, _ = jobs(replace(GROUP, measurements=(mine,), summary=values))[
        "soft-2026/gel-a-compression"
    ]
    register = "soft-2026/compression/specimens.csv"
    assert job.rests_on == (file, "soft-2026/compression/A2.csv", register)


def test_one_job_makes_one_picture_in_a_folder_of_its_own(
    tmp_path: Path,
) -> None:
    curve = LoadingCurve(np.array([0.0, 0.1]), np.array([0.0, 10.0]), None)
    group = replace(GROUP, measurements=(replace(A1, result=curve),))
    for job, _ in jobs(group).values():
        draw_one(tmp_path / "deep" / "figures", job)
    place = tmp_path / "deep" / "figures" / "soft-2026"
    assert sorted(path.name for path in place.iterdir()) == ["gel-a-compression.svg", "moduli.svg"]
    drawn, moduli = (
        (place / name).read_text("utf-8") for name in ("gel-a-compression.svg", "moduli.svg")
    )
    assert "<title>GEL-A, compression</title>" in drawn
    assert "<title>Moduli, soft-2026</title>" in moduli
    assert ">GEL-A</text>" in moduli
