"""The one list of techniques."""

from __future__ import annotations

from deamat.core.properties import property_key
from deamat.techniques import TECHNIQUES


def test_every_room_is_listed_under_its_own_key_and_yields_known_properties() -> None:
    assert {"compression", "tension"} <= set(TECHNIQUES)
    for key, technique in TECHNIQUES.items():
        assert technique.key == key
        assert technique.version >= 1
        for name in technique.yields:
            assert property_key(name).key == name


def test_every_default_of_every_section_stands_in_its_class_with_a_description() -> None:
    for technique in TECHNIQUES.values():
        technique.config()
        for name, field in technique.config.model_fields.items():
            assert field.description, f"{technique.key}.{name}"
