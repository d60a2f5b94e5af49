"""The places of a cell on the page: how many parts each has, and what a person may say of it."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.dashboard.faces.moment import Moment
from arboleda.dashboard.faces.part_places import face
from arboleda.dashboard.wording import words


def place(name: str, parts: int, holds: int = 1, **more: Any) -> dict[str, Any]:
    told = {"name": name, "parts": parts, "holds": holds, "device": None, "by_people": False}
    return told | {"station": None} | more


def shown(*places: dict[str, Any], language: str = "en") -> dict[str, Any]:
    snapshot = {"cells": [{"name": "lab", "places": list(places)}]}
    moment = Moment(
        snapshot=snapshot, layout={}, links={}, trees={}, events=(), words=words(language), unix_s=0.0
    )
    return face(moment)


def test_a_cell_without_places_shows_none() -> None:
    assert shown() == {}


@pytest.mark.parametrize(("parts", "acts"), [(0, ["load"]), (1, ["load", "unload"]), (2, ["unload"])])
def test_a_person_may_say_what_can_be(parts: int, acts: list[str]) -> None:
    found = shown(place("bin", parts, 2))
    row = found["row/places.lab/bin"]
    assert found["rows/places.lab"] == ["bin"]
    assert row["texts"] == ["bin", f"{parts} of 2", ""]
    assert [each["act"] for each in row["acts"]] == acts
    assert all((each["of"], each["arguments"]) == ("lab", {"place": "bin"}) for each in row["acts"])


def test_what_people_keep_so_is_not_for_them_to_say() -> None:
    row = shown(place("rack", 1, by_people=True))["row/places.lab/rack"]
    assert (row["texts"][2], row["acts"]) == ("people fill or empty it", [])


def test_of_a_rack_the_stations_with_a_part_are_shown() -> None:
    found = shown(place("station_0", 0, station=0), place("station_1", 1, station=1))
    assert found["rows/places.lab"] == ["station_1"]
    assert [each["act"] for each in found["row/places.lab/station_1"]["acts"]] == ["unload"]


def test_the_device_of_a_place_is_named_in_each_language() -> None:
    inside = place("inside", 0, device="oven")
    assert shown(inside)["row/places.lab/inside"]["texts"][2] == "in oven"
    assert shown(inside, language="es")["row/places.lab/inside"]["texts"][1:] == ["0 de 1", "en oven"]
