"""What goes between plant and bridge over ROS 2 as text: orders, reports, and the fields of goals."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from tests.unit.kinds.station import STATION, plant

from arboleda.kinds.declared import Device
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.errors import PayloadError, TextError
from arboleda.model.messages import MotionState, Report
from arboleda.model.text import parse
from arboleda.testing import shipped
from arboleda.wire.status import from_status, to_status
from arboleda_ros import order
from arboleda_ros.typed.fields import compose

STATION_1 = plant().robots["station"]
assert isinstance(STATION_1, Device)
WARM = STATION.command(id="7-1", robot="station", verb="warm", values={"celsius": 40.5})
GO = STATION.command(id="", robot="station", verb="go", values={})
HALT = Stop(id="7-2", robot="station", mode=StopMode.HALT)


@pytest.mark.parametrize(
    ("command", "copied", "text"),
    [
        (WARM, False, {"id": "7-1", "verb": "warm", "values": {"celsius": 40.5}}),
        (
            replace(WARM, heard=512, token="0a3f9x001a01"),
            False,
            {"id": "7-1", "verb": "warm", "values": {"celsius": 40.5}, "heard": 512, "token": "0a3f9x001a01"},
        ),
        (GO, False, {"verb": "go", "values": {}}),
        (HALT, False, {"id": "7-2", "stop": 2}),
        (HALT, True, {"id": "7-2", "stop": 2, "copied": 1}),
    ],
    ids=["work", "work of a step", "of somebody else", "halt", "halt with a copy"],
)
def test_a_command_comes_back_from_its_text(command: Command, copied: bool, text: dict[str, object]) -> None:
    written = order.write(command, copied=copied)
    assert json.loads(written) == text
    assert order.read(STATION_1, written) == (command, copied)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("go", "the message is not JSON"),
        ('["go"]', "not a JSON object"),
        ("{}", "verb is missing"),
        ('{"verb": "fly"}', "a station has no verb 'fly'"),
        ('{"verb": "light", "values": {"on": 1}}', "on of light is 1; a station takes true or false"),
        ('{"verb": "go", "values": []}', "values is []; an object is needed"),
        ('{"id": "a b", "verb": "go"}', "id is 'a b'; 1 to 64 of"),
        ('{"id": 7, "verb": "go"}', "id is 7; a text is needed"),
        ('{"stop": 3}', "stop is 3; allowed: 0 to 2"),
        ('{"stop": 2, "verb": "go"}', "verb is 'go'; a stop has none"),
    ],
)
def test_a_text_that_is_no_order_is_refused_in_a_sentence(text: str, why: str) -> None:
    with pytest.raises(PayloadError) as refused:
        order.read(STATION_1, text)
    assert why in str(refused.value)


def test_a_device_has_no_text_for_a_homing() -> None:
    with pytest.raises(TypeError, match="Home is no command of a device"):
        order.write(Home(id="7-1", robot="station"))


WORKING = Report(
    at=0.0,
    robot="station",
    epoch=9,
    boot_id=4,
    accepted="7-5",
    done="7-1",
    failed="7-2",
    failure="atasco",
    answered="7-3",
    answer="a b/c",
    state=MotionState.MOVING,
    facts=(("at", "left"), ("lamp", True), ("held", False), ("celsius", 40.0)),
)


@pytest.mark.parametrize("answer", ["a b/c", "", True, 3, 2.5], ids=repr)
def test_a_report_of_a_device_comes_back_from_its_status(answer: object) -> None:
    said = replace(WORKING, answer=answer)  # type: ignore[arg-type]
    status = to_status(STATION_1, said)
    heard = from_status(0.0, STATION_1, status)
    assert heard == said
    assert type(heard.answer) is type(answer)
    assert [type(value) for _, value in heard.facts or ()] == [str, bool, bool, float]


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ({"facts": '{"at": "left"'}, "facts: the message is not JSON"),
        ({"facts": '{"at": "left"}, {}'}, "facts: the message is not JSON"),
        ({"facts": "[]"}, "facts is []; an object is needed"),
        ({"facts": '{"speed": 1}'}, "'speed' is no fact of station"),
        ({"facts": '{"at": "up"}'}, "at is 'up'; station knows left, right"),
        ({"failed": "7-2"}, "failed and failure go together"),
        ({"answer": '"good"'}, "answered and answer go together"),
        ({"answered": "7-3", "answer": "{}"}, "answer is {}; a number is needed"),
    ],
)
def test_a_status_that_no_bridge_says_is_refused(values: dict[str, str], why: str) -> None:
    status = replace(to_status(STATION_1, replace(WORKING, facts=None)), values=values)
    with pytest.raises(PayloadError) as refused:
        from_status(0.0, STATION_1, status)
    assert why in str(refused.value)


SHIPPED = shipped()


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({"text": " sis_a 0B 7 #lot42 "}, "sis_a 0B 7 #lot42"),
        ({"text": "sis_a 0B 7", "id": "lot42"}, "sis_a 0B 7 #lot42"),
        ({"cell": "sis_a", "path": "0B", "station": "7"}, "sis_a 0B 7"),
        ({"cell": "sis_a", "recipe": "Storage", "path": "0B", "station": "7", "id": "#b"}, "sis_a 0B 7 #b"),
        ({"cell": "ra1", "recipe": "palletizing"}, "ra1 palletizing"),
        ({}, ""),
    ],
    ids=["text", "text and id", "storage", "storage by name", "palletizing", "nothing"],
)
def test_fields_spell_a_text(fields: dict[str, str], text: str) -> None:
    assert compose(**fields) == text


@pytest.mark.parametrize(
    ("fields", "names"),
    [
        ({}, ["empty"]),
        ({"cell": "sis_a", "path": "0B"}, ["2 words"]),
        ({"cell": "sis_a", "station": "7"}, ["'7' is neither a path of sis_a"]),
        ({"cell": "sis_a", "recipe": "sorting"}, ["'sorting'", "palletizing"]),
        ({"cell": "sis_a", "recipe": "palletizing", "path": "0B", "station": "7"}, ["4 words"]),
        ({"text": "sis_a 0B 7", "cell": "sis_b", "path": "0C", "station": "1"}, ["6 words"]),
        ({"cell": "sis_a", "path": "0B", "station": "7 #a", "id": "b"}, ["4 words"]),
    ],
    ids=["nothing", "no station", "no path", "recipe", "surplus fields", "text and fields", "two ids"],
)
def test_wrong_fields_are_refused_like_a_wrong_text(fields: dict[str, str], names: list[str]) -> None:
    with pytest.raises(TextError) as refusal:
        parse(compose(**fields), SHIPPED)
    for name in names:
        assert name in str(refusal.value)
