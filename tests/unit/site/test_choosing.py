"""A task that names cells of several plants goes to the one that is expected to have done it first."""

from __future__ import annotations

import asyncio
from typing import Any
from urllib.parse import parse_qs, urlsplit

import pytest
from tests.web_plant import Plant

from arboleda.model.errors import TextError
from arboleda.model.sentence import Phrase
from arboleda.runtime.endpoints import Place
from arboleda.site.choosing import Choice, TaskRefused, chosen
from arboleda.site.reach import PlantRefusal, PlantSilent

BOTH = "north/sis_a,south/sis_b,south/sis_a 0b 7"
SILENT = Phrase("test.silent", "no answer")


class Reached:
    """The way to a plant that promises each of its tasks within so many seconds, or that is silent."""

    def __init__(self, seconds: float | None, has: str = "") -> None:
        self.place = Place(url="http://127.0.0.1:8080")
        self._plant = None if seconds is None else Plant()
        self._has = has
        if self._plant is not None:
            self._plant.seconds = seconds

    async def get(self, path: str) -> Any:
        if self._plant is None:
            raise PlantSilent(SILENT())
        if path.startswith("/api/tasks/"):
            if path != f"/api/tasks/{self._has}":
                raise PlantRefusal("The plant knows no such task.")
            return {}
        (text,) = parse_qs(urlsplit(path).query)["text"]
        try:
            return self._plant.promises(text)
        except TextError as error:
            raise PlantRefusal(error.sentence) from error


def choice(text: str, **plants: Reached) -> Choice:
    return asyncio.run(chosen(text, plants))


def test_the_plant_that_promises_to_be_first_gets_it_with_the_reason() -> None:
    found = choice(BOTH, north=Reached(50.0), south=Reached(20.0))
    assert (found.plant, found.text) == ("south", "sis_b 0B 7")
    assert str(found.why) == (
        "south/sis_b is expected to have done it first, in 20 s; north/sis_a in 50 s, south/sis_a in 20 s"
    )


def test_a_plant_that_does_not_answer_is_left_out_and_said_to_be() -> None:
    found = choice("south/sis_a,north/sis_a 0b 7", north=Reached(50.0), south=Reached(None))
    assert (found.plant, found.text) == ("north", "sis_a 0B 7")
    assert "north/sis_a is expected" in str(found.why) and "south" in str(found.why)


def test_with_an_id_it_is_given_to_nobody_while_a_plant_does_not_answer() -> None:
    with pytest.raises(TaskRefused, match=r"south .* may have #lot1 already"):
        choice("south/sis_a,north/sis_a 0b 7 #lot1", north=Reached(50.0), south=Reached(None))


def test_a_task_that_a_plant_has_already_stays_there() -> None:
    found = choice(f"{BOTH} #lot1", north=Reached(50.0, has="lot1"), south=Reached(20.0))
    assert (found.plant, found.text, found.why) == ("north", "sis_a 0b 7 #lot1", None)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("north/sis_a,sis_b 0b 7", "write plant/cell,plant/cell and the task"),
        ("north/sis_a,west/sis_b 0b 7", "there is no plant west on this page"),
        ("north/sis_a,south/sis_z 0b 7", r"south \('sis_z' is not a cell of this plant"),
        ("silent/sis_a 0b 7", "none of these plants answers: silent"),
    ],
)
def test_a_text_that_no_plant_can_take_is_given_to_nobody(text: str, why: str) -> None:
    with pytest.raises(TaskRefused, match=why):
        choice(text, north=Reached(50.0), south=Reached(20.0), silent=Reached(None))
