"""3 000 spoilt files: none crashes, none hangs, and silence stays as rare as it is."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import pytest

from benchmarks.fuzz.cases import draw
from benchmarks.fuzz.fuzzer import Fuzzer
from benchmarks.fuzz.page import DAMAGED
from deamat.techniques import TECHNIQUES

EVERY_FOURTH = 4  # is judged among its siblings too

# Files, and how many of them may be silent: damaged, readable but wrong, registers.
STUDY = {
    "compression": (650, 1, 5, 2),
    "tension": (650, 1, 19, 8),
    "permittivity": (600, 1, 4, 4),
    "nanoindentation": (500, 1, 7, 5),
    "breakdown": (250, 1, 2, 2),
    "viscosity": (250, 1, 12, 1),
    "handling": (100, 0, 0, 6),
}


@pytest.fixture(scope="module")
def fuzzer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Fuzzer]:
    with Fuzzer(tmp_path_factory.mktemp("fuzz")) as made:
        yield made


def test_the_study_has_3000_files_of_every_technique_and_reader(fuzzer: Fuzzer) -> None:
    assert sum(count for count, *_ in STUDY.values()) == 3000
    assert STUDY.keys() == TECHNIQUES.keys()
    readers = {good.sheets[0].reader for good in fuzzer.goods.values() if good.files}
    assert readers >= {*_READERS}


_READERS = (
    "antonpaar", "bluehill", "e4980a", "e4990a", "flow_tab", "hv_ramp", "hysitron", "lcr6000",
    "lcr_csv", "lvm", "mark10", "mts", "ndj8s", "nexygen", "phantom", "plain", "rheocompass",
    "rheodata", "rigol", "schmid", "soro", "tektronix", "viscometer_csv", "zwick",
)  # fmt: skip


@pytest.mark.parametrize("technique", STUDY)
def test_spoilt_files_crash_nothing_and_are_seldom_silent(fuzzer: Fuzzer, technique: str) -> None:
    count, damaged, wrong, register = STUDY[technique]
    silent: Counter[str] = Counter()
    for seed in range(count):
        case = draw(seed, fuzzer.goods, [technique])
        result = fuzzer.judge(case, group=seed % EVERY_FOURTH == 0)
        assert not {"crash", "hang"} & set(result.verdicts().values()), (case, result.bad)
        if result.bad is not None:
            silent["damaged" if case.kind in DAMAGED else case.kind] += 1
    assert silent["damaged"] <= damaged
    assert silent["wrong"] <= wrong
    assert silent["register"] <= register
