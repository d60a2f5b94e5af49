"""The places of a cell on the page: a dot for each, those of a rack in one row, and what a press says."""

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


@pytest.mark.parametrize(("parts", "act", "state"), [(0, "load", "free"), (1, "unload", "taken")])
def test_a_press_says_that_the_parts_of_a_full_place_were_taken_out_and_put_into_an_empty_one(
    parts: int, act: str, state: str
) -> None:
    row = shown(place("bin", parts, 2))["row/places.lab/bin"]
    (dot,) = row["acts"]
    assert row["texts"] == ["bin", ""]
    assert (dot["act"], dot["of"], dot["arguments"]) == (act, "lab", {"place": "bin"})
    assert (dot["label"], dot["state"], dot["refused"]) == (f"{parts}/2", state, False)
    assert dot["name"].startswith(f"bin: {parts} of 2")


def test_what_people_keep_so_is_not_for_them_to_say() -> None:
    row = shown(place("tray", 1, by_people=True))["row/places.lab/tray"]
    assert row["texts"][1] == "people fill or empty it" and row["acts"][0]["refused"]


@pytest.mark.parametrize(
    ("language", "question"),
    [("en", "Is a part still in vise?"), ("es", "¿Sigue habiendo una pieza en vise?")],
)
def test_a_place_that_a_failed_task_has_left_full_is_a_question(language: str, question: str) -> None:
    row = shown(place("vise", 1, by_people=True, asked=True), language=language)["row/places.lab/vise"]
    assert row["texts"][1] == question
    assert [(dot["act"], dot["refused"]) for dot in row["acts"]] == [("unload", False)]


def test_the_places_of_a_rack_are_one_row_of_dots_by_their_numbers() -> None:
    found = shown(place("station_0", 0, station=0), place("nest", 0), place("station_1", 1, station=1))
    assert found["rows/places.lab"] == ["station", "nest"]
    dots = found["row/places.lab/station"]["acts"]
    assert [(dot["label"], dot["act"]) for dot in dots] == [("0", "load"), ("1", "unload")]
    assert found["row/places.lab/nest"]["acts"][0]["label"] == ""


def test_the_device_of_a_place_is_named_in_each_language() -> None:
    inside = place("inside", 0, device="oven")
    assert shown(inside)["row/places.lab/inside"]["texts"][1] == "in oven"
    in_spanish = shown(inside, language="es")["row/places.lab/inside"]
    assert in_spanish["texts"][1] == "en oven" and in_spanish["acts"][0]["name"].startswith("inside: 0 de 1")
