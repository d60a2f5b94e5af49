"""What the page shows of a person who is asked something."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.model.messages import Verb

from ..kinds.test_people import attended, question, refill
from .test_own_cells import Told


@pytest.fixture
def here() -> Told:
    here = Told(attended(refill))
    here.submit("tending refill")
    assert here.wait(10.0, lambda: question(here) is not None)
    return here


def offers(here: Told) -> list[dict[str, Any]]:
    face = here.face()
    (row,) = face["rows/answers.ana"]
    return list(face[f"row/answers.ana/{row}"]["acts"])


def test_the_card_shows_the_question_its_time_and_a_button_for_each_answer(here: Told) -> None:
    here.wait(10.0)
    face = here.face()
    assert face["text/asked_who.ana"][0] == "ana is asked"
    assert face["text/asked.ana"][0] == "Is the pallet full again?"
    assert face["text/asked_left.ana"][0] == "50 s left to answer"
    asked = question(here)["id"]
    assert [(each["act"], each["of"], each["label"], each["arguments"]) for each in offers(here)] == [
        ("answer", "ana", "yes", {"question": asked, "answer": "yes"}),
        ("answer", "ana", "no parts left", {"question": asked, "answer": "no parts left"}),
    ]
    assert 'Answers "yes" to: Is the pallet full again?' in offers(here)[0]["does"]


def test_time_that_goes_by_does_not_announce_the_question_or_draw_its_buttons_again(here: Told) -> None:
    before = here.face()
    here.wait(3.0)
    after = here.face()
    assert before["text/asked_left.ana"] != after["text/asked_left.ana"]
    assert {key for key in after if "ana" in key and before.get(key) != after[key]} == {
        "text/asked_left.ana",
        "row/devices.tending/ana",
        "row/links/ana",
    }


def test_a_button_gives_its_answer_and_the_question_is_gone(here: Told) -> None:
    assert here.operate(Verb.ANSWER, offers(here)[1]["of"], **offers(here)[1]["arguments"]) is None
    face = here.face()
    assert face["rows/answers.ana"] == []
    assert {face[f"text/{key}.ana"][0] for key in ("asked_who", "asked", "asked_left")} == {""}


def test_title_and_header_tell_who_is_waited_for_as_a_wait(here: Told) -> None:
    face = here.face()
    assert face["text/title"] == ["? tending: waits for ana - shop", "waits"]
    assert face["text/needs"][0] == "tending"
    assert face["text/sum"] == ["waits for ana", "execute"]
    assert face["row/counts/execute"]["texts"] == ["working: 1"]
    assert here.face("es")["text/title"][0] == "? tending: espera a ana - shop"
    assert here.operate(Verb.ANSWER, "ana", answer="yes") is None
    assert here.face()["text/title"] == ["shop", "well"]
    assert here.face()["text/needs"][0] == ""


def test_trouble_comes_before_a_wait(here: Told) -> None:
    assert here.operate(Verb.HOLD, "tending") is None
    here.wait(1.0)
    assert here.face()["text/title"] == ["⚠ tending: held; tending: waits for ana - shop", "trouble"]


def test_the_step_that_asks_is_said_in_spanish(here: Told) -> None:
    face = here.face("es")
    assert face["text/tending.step"][0] == "preguntar a ana"
    assert face["text/tending.feedback"][0] == "preguntando a ana"
