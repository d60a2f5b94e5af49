from __future__ import annotations

import json

import pytest

from arboleda.model.errors import ArboledaError, TextError
from arboleda.model.sentence import NOTHING, OWN, Phrase, Sentence, as_sentence, from_data, in_json

OFFLINE = Phrase("robot.offline", "{robot} is offline")
LATE = Phrase("late", "{robots}: {seconds:.1f} s late, as {why}")
SPANISH = {"robot.offline": "{robot} está sin conexión", "late": "{why}: {robots}, {seconds:g} s tarde"}


def late(seconds: float = 1.25) -> Sentence:
    return LATE(robots=("ra1", "ra2"), seconds=seconds, why=OFFLINE(robot="ra3"))


def test_its_text_is_its_english_with_what_is_inside() -> None:
    assert str(late()) == "ra1, ra2: 1.2 s late, as ra3 is offline"
    assert repr(late()) == repr(str(late()))


def test_another_language_says_all_of_it() -> None:
    said = late().text_by(lambda phrase: SPANISH[phrase.key])
    assert said == "ra3 está sin conexión: ra1, ra2, 1.25 s tarde"


def test_equal_ones_have_the_same_key_and_values() -> None:
    assert {late(), late()} == {late()}
    assert late() != late(2.0)
    assert OFFLINE(robot="ra1") != Phrase("robot.lost", OFFLINE.english)(robot="ra1")
    assert OFFLINE(robot="ra1") != "ra1 is offline"


def test_its_parts_are_it_and_what_is_inside() -> None:
    assert [part.key for part in late().parts()] == ["late", "robot.offline"]


def test_only_nothing_is_false() -> None:
    assert OFFLINE(robot="")
    assert not NOTHING


def test_a_slot_in_a_value_is_no_slot() -> None:
    assert str(OFFLINE(robot="{robot}")) == "{robot} is offline"


def test_an_error_has_a_sentence_whatever_it_was_made_of() -> None:
    assert TextError(OFFLINE(robot="ra1")).sentence == OFFLINE(robot="ra1")
    assert str(TextError(OFFLINE(robot="ra1"))) == "ra1 is offline"
    assert ArboledaError("no disk").sentence == OWN(text="no disk")
    assert as_sentence(OSError(2, "No such file")) == OWN(text="[Errno 2] No such file")


def test_json_has_its_text_and_nothing_else_that_json_does_not_know() -> None:
    assert json.dumps({"why": OFFLINE(robot="ra1")}, default=in_json) == '{"why": "ra1 is offline"}'
    with pytest.raises(TypeError):
        json.dumps({"why": object()}, default=in_json)


def test_it_survives_as_data() -> None:
    data = json.loads(json.dumps(late().data()))
    assert data["values"]["why"] == {"key": "robot.offline", "values": {"robot": "ra3"}}
    assert from_data(data, {"late": LATE, "robot.offline": OFFLINE}) == late()


@pytest.mark.parametrize("data", [None, "late", {}, {"key": "other", "values": {}}, {"key": "late"}])
def test_what_is_no_data_of_a_sentence_is_refused(data: object) -> None:
    with pytest.raises(ValueError, match="is no sentence"):
        from_data(data, {"late": LATE})


def test_a_value_that_says_nothing_leaves_no_parentheses() -> None:
    held = Phrase("held", "{cell} is held ({why}); {next}")
    assert str(held(cell="sis_a", why="", next="retry")) == "sis_a is held; retry"
    assert str(held(cell="sis_a", why=NOTHING, next="retry")) == "sis_a is held; retry"
    assert str(held(cell="f ()", why="link", next="retry")) == "f () is held (link); retry"
    assert (
        held(cell="c", why="", next="n").text_by(lambda _: "{cell}: detenida ({why}); {next}")
        == "c: detenida; n"
    )
