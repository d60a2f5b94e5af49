"""Mappings of topics in a plant file: what is wrong is told, and what passes is shown."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.drivers import Evidence, FactType
from arboleda.model.errors import ConfigError
from arboleda.plant_file import drivers
from arboleda.plant_file.loader import load
from arboleda_drivers.meaning import UnreadableValue
from arboleda_drivers.mqtt_mapping.heard import Heard, Says, matches
from arboleda_drivers.mqtt_mapping.sent import Sent

from .mqtt_rig import plant_of
from .test_mqtt_mapping_machine import (
    ARM,
    ARM_MAPPING,
    COVER,
    COVER_MAPPING,
    OVEN,
    OVEN_MAPPING,
    PLUG,
    PLUG_MAPPING,
    REPLY_MAPPING,
)

BOOL = FactType(type=bool, words=(), first=False)
ONLINE = 'online: {hear: "tele/{device}/LWT", equals: Online}\n'
AT = 'facts: {open: {hear: door/at, words: {open: "1", shut: "0"}}}'
STATE = "state: {hear: door/state, words: {stopped: [open, closed], moving: [opening, closing]}}\n"


@pytest.mark.sampled(8)
@pytest.mark.parametrize(
    ("kind", "mapping", "old", "new", "told"),
    [
        (PLUG, REPLY_MAPPING, 'version: "5"', "", "only MQTT 5 has {reply}; write version"),
        (
            PLUG,
            REPLY_MAPPING,
            " reply: true,",
            "",
            "its answer is heard on {reply}; send it with reply: true",
        ),
        (PLUG, PLUG_MAPPING, ONLINE, "", "nothing says whether the device is there; write online"),
        (PLUG, PLUG_MAPPING, "{power: {hear", "{powr: {hear", "a thing has no fact powr; there are power"),
        (PLUG, PLUG_MAPPING, 'payload: "{to}"', 'payload: "{too}"', "there is no parameter too; "),
        (PLUG, PLUG_MAPPING, "stat/{device}/POWER", "stat/#/POWER", "hear is"),
        (PLUG, PLUG_MAPPING, 'on: "ON", off: "OFF"}}}', "up: 1}}}", "'up' is none of its values"),
        (PLUG, PLUG_MAPPING, "tele/{device}/LWT", "tele/+/a+", "hear is"),
        (
            COVER,
            COVER_MAPPING,
            "halt: [{topic: door/command, payload: STOP}]",
            "# halt:",
            "no stop would reach thing: say what is sent to stop it",
        ),
        (COVER, COVER_MAPPING, STATE, "", "nothing says whether it has ended move: say where its state"),
        (COVER, COVER_MAPPING, "payload: STOP", 'payload: "{to}"', "halt has no parameters, and names to"),
        (COVER, COVER_MAPPING, 'payload: "{to}"', 'retain: true, payload: "{to}"', "a retained order stays"),
        (ARM, ARM_MAPPING, 'deg: "{to}"', 'deg: "{too}"', "there is no parameter too; "),
        (
            ARM,
            ARM_MAPPING,
            'seq: "{number}", act: turn',
            "act: turn",
            "its end names the command; send it with",
        ),
        (
            OVEN,
            OVEN_MAPPING,
            "done:",
            "failed: {hear: oven/error, id: seq}\ndone:",
            "its end names the command; send it with",
        ),
        (ARM, ARM_MAPPING, "    id: seq\n", "", "its answer has to name the command: say where, id: PATH"),
        (PLUG, PLUG_MAPPING, "facts:", "unheard: [power]\nfacts:", "power is heard by facts; keep one"),
        (COVER, COVER_MAPPING, AT, "unheard: [open]", "only a switch may set open"),
        (ARM, ARM_MAPPING, "silent_after_s: 3", "silent_after_s: 0", "silent_after_s is 0; allowed: 0.5 to"),
        (
            COVER,
            COVER_MAPPING,
            "halt:",
            "done: {hear: door/state, equals: [open, done]}\nhalt:",
            "done is never heard at door/state: state knows open or closed, opening or closing there",
        ),
        (
            ARM.replace("angle: int", "angle: [0, 90]"),
            ARM_MAPPING,
            "done: {hear: arm/ack, id: seq, path: is, equals: done}",
            'done: {hear: arm/state, path: "joints[0].deg", equals: 45}',
            "45 is never heard at arm/state joints[0].deg: angle knows 0, 90 there",
        ),
        (PLUG, PLUG_MAPPING, '{on: "ON", off: "OFF"}}}', '{off: "OFF"}}}', "turn sets power to on"),
        (ARM, ARM_MAPPING, "near: 1", "scale: 0", "scale is 0; allowed: any number but 0"),
        (
            ARM.replace("angle: int", "angle: number"),
            ARM_MAPPING,
            "near: 1",
            "near: 4",
            "turn sets angle to 90, and nothing that is heard means that; look at scale and near",
        ),
    ],
)
def test_what_is_wrong_is_told(
    tmp_path: Path, kind: str, mapping: str, old: str, new: str, told: str
) -> None:
    assert old in mapping
    with pytest.raises(ConfigError) as error:
        plant_of(tmp_path, kind, mapping.replace(old, new))
    assert told in str(error.value) and str(error.value).count("plant.yaml:") == 1


def test_evidence_that_the_mapping_does_not_give_is_refused(tmp_path: Path) -> None:
    plant_of(tmp_path, PLUG, PLUG_MAPPING)
    file = tmp_path / "plant.yaml"
    text = file.read_text("utf-8").replace("kind: thing\n", "kind: thing\n        evidence: ids\n")
    file.write_text(text, "utf-8")
    with pytest.raises(ConfigError, match="this mapping proves facts"):
        load(file)


def test_what_passes_is_shown_with_examples(tmp_path: Path) -> None:
    lines = [*drivers.messages_of(plant_of(tmp_path, ARM, ARM_MAPPING))]
    assert lines[0] == "thing: evidence ids: it says which command it has done"
    assert '  turn 90: arm/do {"seq":1,"act":"turn","deg":90}' in lines
    assert "  angle: arm/state joints[0].deg" in lines
    plug = [*drivers.messages_of(plant_of(tmp_path, PLUG, PLUG_MAPPING))]
    assert "  turn on: cmnd/thing/POWER ON" in plug and "  stop reaches nothing of thing" in plug


def test_a_switch_of_which_nothing_is_heard_is_not_checked(tmp_path: Path) -> None:
    heard = 'facts: {power: {hear: "stat/{device}/POWER", words: {on: "ON", off: "OFF"}}}'
    plant = plant_of(tmp_path, PLUG, PLUG_MAPPING.replace(heard, "unheard: [power]"))
    assert plant.robots["thing"].evidence is Evidence.STATE
    assert "what becomes of it is not checked" in next(iter(drivers.messages_of(plant)))


def test_a_sensor_needs_no_verb(tmp_path: Path) -> None:
    kind = "facts: {door: [open, closed]}"
    mapping = "silent_after_s: 60\nfacts: {door: {hear: door, words: {open: [up, ajar], closed: true}}}"
    plant = plant_of(tmp_path, kind, mapping)
    assert plant.robots["thing"].evidence is Evidence.JOINTS
    assert [*drivers.messages_of(plant)] == [
        "thing: evidence facts: nothing is sent to it; what it tells is known",
        "  door: door up or ajar is open, true is closed",
    ]


def test_a_bool_has_words() -> None:
    homed = Heard(hear="t", words={"true": "xyz"}, otherwise=False)
    assert homed.problem(BOOL) == ""
    assert [homed.read(raw, BOOL) for raw in ("xyz", "")] == [True, False]
    assert homed.shown(True) == "xyz"


@pytest.mark.parametrize(
    ("filter", "topic", "is_on"),
    [
        ("a/+/c", "a/b/c", True),
        ("a/#", "a", True),
        ("a/#", "a/b/c", True),
        ("a", "a/b", False),
        ("+", "a/b", False),
    ],
)
def test_a_topic_matches_as_brokers_do(filter: str, topic: str, *, is_on: bool) -> None:
    assert matches(filter, topic) is is_on


@pytest.mark.parametrize(
    ("source", "payload", "raw"),
    [
        (Heard(hear="t"), b" 23.5\n", "23.5"),
        (Heard(hear="t", path="a[1].b"), b'{"a": [0, {"b": 7}]}', 7),
        (Heard(hear="t", pattern=r"T:(\d+)"), b"ok T:42 /50", "42"),
    ],
)
def test_a_value_is_found_in_a_message(source: Heard, payload: bytes, raw: object) -> None:
    assert source.raw(payload) == raw


def test_what_is_no_json_is_not_read() -> None:
    for payload in (b"{", b"[" * 100_000, b'{"a": NaN}', b"\xff"):
        with pytest.raises(UnreadableValue):
            Heard(hear="t", path="a").raw(payload)


def test_a_message_is_filled_and_read_again() -> None:
    sent = Sent(topic="{device}/set", payload={"state": "{to}", "id": "{number}", "n": 1}, words={"on": "ON"})
    message = sent.filled({"device": "lamp", "to": "on", "number": 4})
    assert (message.topic, message.payload) == ("lamp/set", b'{"state":"ON","id":4,"n":1}')
    assert sent.values(message.topic, message.payload) == {"device": "lamp", "to": "ON", "number": 4}
    assert sent.values("lamp/set", b'{"state":"ON","id":4,"n":2}') is None


def test_a_message_says_it_of_one_command() -> None:
    says = Says(hear="t", path="is", equals=["done", "ok"], id="seq", why="text")
    assert says.is_said(b'{"is": "ok", "seq": 3}', ("c9", "3"))
    assert not says.is_said(b'{"is": "ok", "seq": 4}', ("c9", "3"))
    assert not says.is_said(b'{"is": "no", "seq": 3}', ("c9", "3"))
    assert says.reason(b'{"text": "jam"}') == "jam"
