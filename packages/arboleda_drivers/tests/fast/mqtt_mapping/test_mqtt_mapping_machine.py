"""The driver `mqtt` against the virtual device of its mapping: what counts as done, and as there."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.drivers import Evidence, MotionState, StopMode

from .mqtt_rig import Rig, device_in, plant_of

PLUG = """
facts: {power: [off, on]}
verbs: {turn: {effect: switch, with: {to: [off, on]}, sets: {power: $to}, takes_s: 0.2, at_most_s: 3}}
"""
PLUG_MAPPING = """
online: {hear: "tele/{device}/LWT", equals: Online}
facts: {power: {hear: "stat/{device}/POWER", words: {on: "ON", off: "OFF"}}}
verbs: {turn: {send: [{topic: "cmnd/{device}/POWER", payload: "{to}", words: {on: "ON", off: "OFF"}}]}}
"""
LAMP = PLUG.replace("switch", "process, on_stop: finish")
REPLY_MAPPING = (
    PLUG_MAPPING.replace('"{to}",', '"{to}", reply: true,')
    + """
version: "5"
done: {hear: "{reply}", path: power}
failed: {hear: "{reply}", path: error, why: error}
"""
)
COVER = """
facts: {open: [shut, open]}
verbs: {move: {effect: motion, with: {to: [shut, open]}, sets: {open: $to}, takes_s: 2, at_most_s: 8}}
"""
COVER_MAPPING = """
online: {hear: door/status, equals: online}
state: {hear: door/state, words: {stopped: [open, closed], moving: [opening, closing]}}
facts: {open: {hear: door/at, words: {open: "1", shut: "0"}}}
verbs: {move: {send: [{topic: door/command, payload: "{to}", words: {open: OPEN, shut: CLOSE}}]}}
halt: [{topic: door/command, payload: STOP}]
"""
ARM = """
facts: {angle: int}
verbs:
  turn: {effect: motion, with: {to: [0, 90]}, sets: {angle: $to}, takes_s: 1, at_most_s: 8}
  weigh: {effect: query, answers: number, takes_s: 0.2, at_most_s: 3}
"""
ARM_MAPPING = """
silent_after_s: 3
state: {hear: arm/state, path: mode, words: {stopped: idle, moving: busy, fault: error}}
facts: {angle: {hear: arm/state, path: "joints[0].deg", near: 1}}
accepted: {hear: arm/ack, id: seq, path: is, equals: taken}
done: {hear: arm/ack, id: seq, path: is, equals: done}
failed: {hear: arm/ack, id: seq, path: is, equals: failed, why: text}
verbs:
  turn: {send: [{topic: arm/do, payload: {seq: "{number}", act: turn, deg: "{to}"}}]}
  weigh:
    send: [{topic: arm/do, payload: {seq: "{number}", act: weigh}}]
    answer: {hear: arm/weight, path: g, scale: 0.001}
    id: seq
halt: [{topic: arm/stop}]
"""
OVEN = """
verbs: {bake: {effect: process, takes_s: 1, at_most_s: 5, on_stop: finish}}
"""
OVEN_MAPPING = """
online: {hear: oven/is}
done: {hear: oven/event, equals: baked}
verbs: {bake: {send: [{topic: oven/bake}]}}
"""


def rig_of(folder: Path, kind: str, mapping: str) -> Rig:
    rig = Rig(*device_in(plant_of(folder, kind, mapping)))
    rig.run(1.2)
    return rig


@pytest.fixture
def plug(tmp_path: Path) -> Rig:
    return rig_of(tmp_path, PLUG, PLUG_MAPPING)


@pytest.fixture
def cover(tmp_path: Path) -> Rig:
    return rig_of(tmp_path, COVER, COVER_MAPPING)


@pytest.fixture
def arm(tmp_path: Path) -> Rig:
    return rig_of(tmp_path, ARM, ARM_MAPPING)


@pytest.fixture
def oven(tmp_path: Path) -> Rig:
    return rig_of(tmp_path, OVEN, OVEN_MAPPING)


@pytest.mark.parametrize(
    ("kind", "mapping", "level"),
    [
        (PLUG, PLUG_MAPPING, Evidence.JOINTS),
        (COVER, COVER_MAPPING, Evidence.JOINTS),
        (ARM, ARM_MAPPING, Evidence.IDS),
        (OVEN, OVEN_MAPPING, Evidence.STATE),
    ],
)
def test_the_evidence_follows_from_the_mapping(
    tmp_path: Path, kind: str, mapping: str, level: Evidence
) -> None:
    device, _ = device_in(plant_of(tmp_path, kind, mapping))
    assert device.evidence is level


def test_a_switch_sends_its_words_and_the_fact_comes_back(plug: Rig) -> None:
    plug.give("turn", to="on")
    assert plug.sent[-1].topic == "cmnd/thing/POWER" and plug.sent[-1].payload == b"ON"
    assert dict(plug.report.facts or ()) == {"power": "off"}
    plug.run(0.5)
    assert dict(plug.report.facts or ()) == {"power": "on"}


def test_an_answer_of_mqtt_5_ends_the_order_that_it_is_about(tmp_path: Path) -> None:
    plug = Rig(*device_in(plant_of(tmp_path, LAMP, REPLY_MAPPING)))
    assert plug.device.evidence is Evidence.IDS
    plug.faults.switch("mute", on=True)
    plug.give("turn", to="on")
    assert (plug.sent[-1].reply, plug.sent[-1].about) == ("arboleda/replies/thing", b"c1")
    for about in ("", "c0"):
        plug.tell("arboleda/replies/thing", '{"power": "ON"}', about=about)
        assert plug.report.done is None
    plug.tell("arboleda/replies/thing", '{"power": "ON"}', about="c1")
    assert plug.report.done == "c1"
    plug.give("turn", "c2", to="off")
    plug.tell("arboleda/replies/thing", '{"error": "hot"}', about="c2")
    assert (plug.report.failed, plug.report.failure) == ("c2", "hot")


def test_the_virtual_device_answers_as_its_mapping_has_it(tmp_path: Path) -> None:
    plug = Rig(*device_in(plant_of(tmp_path, LAMP, REPLY_MAPPING)))
    plug.give("turn", to="on")
    plug.run(0.5)
    assert (plug.report.done, dict(plug.report.facts or ())) == ("c1", {"power": "on"})


def test_an_order_is_neither_retained_nor_sent_twice_by_default(plug: Rig) -> None:
    plug.give("turn", to="on")
    assert (plug.sent[-1].qos, plug.sent[-1].retain) == (0, False)


def test_a_last_will_is_the_end_of_the_link(plug: Rig) -> None:
    plug.tell("tele/thing/LWT", "Offline")
    assert (
        str(plug.report.lost) == "thing has said Offline on tele/thing/LWT; it is there while it says Online"
    )
    assert plug.refusal("turn", to="on") == str(plug.report.lost)
    plug.tell("tele/thing/LWT", "Online")
    assert plug.report.state is MotionState.STOPPED


def test_a_broker_that_is_gone_is_named(plug: Rig) -> None:
    plug.report = plug.driver.connected(plug.now, up=False)[-1]  # type: ignore[assignment]
    assert str(plug.report.lost) == "the MQTT broker at 127.0.0.1:1883 is not there"


def test_silence_is_the_end_of_the_link(arm: Rig) -> None:
    arm.faults.switch("mute", on=True)
    arm.run(2.5)
    assert arm.report.lost is None
    arm.run(1.0)
    assert "thing has said nothing for 3 s on arm/state" in str(arm.report.lost)
    arm.faults.switch("mute", on=False)
    arm.run(1.2)
    assert arm.report.state is MotionState.STOPPED


def test_a_retained_message_of_unknown_age_says_nothing(arm: Rig) -> None:
    arm.tell("arm/state", '{"mode": "busy", "joints": [{"deg": 90}]}', retain=True)
    assert dict(arm.report.facts or ()) == {"angle": 0} and arm.report.state is MotionState.STOPPED


def test_an_order_is_done_once_its_number_comes_back(arm: Rig) -> None:
    arm.give("turn", to=90)
    arm.run(0.2)
    assert (arm.report.accepted, arm.report.done) == ("c1", None)
    assert arm.report.state is MotionState.MOVING
    arm.run(1.0)
    assert arm.report.done == "c1" and arm.report.state is MotionState.STOPPED
    assert dict(arm.report.facts or ()) == {"angle": 90}


def test_an_end_of_another_order_is_none_of_this(arm: Rig) -> None:
    arm.faults.switch("stick", on=True)
    arm.give("turn", to=90)
    arm.tell("arm/ack", '{"seq": 0, "is": "done"}')
    assert arm.report.done is None
    arm.tell("arm/ack", '{"seq": 1, "is": "done"}', retain=True)
    assert arm.report.done is None
    arm.tell("arm/ack", '{"seq": 1, "is": "done"}')
    assert arm.report.done == "c1"


def test_a_failure_before_it_was_accepted_is_a_refusal(arm: Rig) -> None:
    arm.faults.switch("refuse", on=True)
    arm.give("turn", to=90)
    assert (arm.report.rejected, arm.report.refusal) == ("c1", "refused")


def test_what_was_accepted_before_has_failed(arm: Rig) -> None:
    arm.faults.switch("stick", on=True)
    arm.give("turn", to=90)
    arm.tell("arm/ack", '{"seq": 1, "is": "failed", "text": "jam"}')
    assert (arm.report.accepted, arm.report.failed, arm.report.failure) == ("c1", "c1", "jam")


def test_an_answer_names_its_question(arm: Rig) -> None:
    arm.faults.switch("stick", on=True)
    arm.give("weigh")
    arm.tell("arm/weight", '{"seq": 7, "g": 5000}')
    assert arm.report.answered is None
    arm.tell("arm/weight", '{"seq": 1, "g": 2500}')
    assert (arm.report.answered, arm.report.answer) == ("c1", 2.5)


def test_a_device_is_not_said_to_stand_by_a_state_from_before_its_order(cover: Rig) -> None:
    assert cover.report.state is MotionState.STOPPED
    cover.faults.switch("mute", on=True)
    cover.give("move", to="open")
    cover.stop(StopMode.HALT)
    assert cover.report.state is None and cover.report.accepted is None
    cover.faults.switch("mute", on=False)
    cover.run(1.2)
    assert cover.report.state is MotionState.STOPPED and cover.report.accepted == "s1"
    assert cover.thing.done == []


def test_a_stop_that_was_never_confirmed_takes_no_answer_from_a_later_order(arm: Rig) -> None:
    arm.faults.switch("mute", on=True)
    arm.give("turn", to=90)
    arm.stop(StopMode.HALT)
    arm.give("turn", id="c2", to=0)
    arm.tell("arm/ack", '{"seq": 2, "is": "taken"}')
    arm.tell("arm/state", '{"mode": "idle", "joints": [{"deg": 0}]}')
    assert arm.report.accepted == "c2"


def test_a_latched_device_takes_no_order_until_it_is_cleared(cover: Rig) -> None:
    cover.stop(StopMode.LATCH)
    assert cover.report.state is MotionState.STOP_LATCHED
    assert cover.refusal("move", to="open") == "thing is stopped until it is cleared"
    cover.stop(StopMode.CLEAR)
    assert cover.refusal("move", to="open") == ""


def test_a_word_that_is_not_mapped_makes_a_fact_unknown(plug: Rig) -> None:
    plug.tell("stat/thing/POWER", "TOGGLE")
    assert plug.report.unknown == ("power",) and not plug.report.facts
    assert "thing: of a message on stat/thing/POWER" in plug.log[-1]


def test_work_that_finishes_goes_on_after_a_stop(oven: Rig) -> None:
    oven.give("bake")
    oven.stop(StopMode.HALT)
    assert oven.report.state is MotionState.MOVING and oven.report.accepted == "s1"
    oven.run(1.5)
    assert oven.report.state is MotionState.STOPPED and oven.thing.done == ["bake"]


def test_another_order_waits_while_a_late_end_could_be_taken_for_its_own(oven: Rig) -> None:
    oven.faults.switch("stick", on=True)
    oven.give("bake")
    oven.run(6.0)
    assert oven.refusal("bake", id="c2").startswith("thing has not said yet that it has ended bake")
    oven.run(4.5)
    assert oven.refusal("bake", id="c2") == ""


def test_two_devices_of_one_name_are_named(tmp_path: Path) -> None:
    rig = rig_of(tmp_path, PLUG, PLUG_MAPPING + "boot: {hear: tele/thing/BOOT}\n")
    boots = {rig.report.boot_id}
    for boot in ("17", "18"):
        rig.tell("tele/thing/BOOT", boot)
        boots.add(rig.report.boot_id)
        assert rig.report.lost is None
    assert len(boots) == 3
    rig.tell("tele/thing/BOOT", "17")
    assert str(rig.report.lost).startswith("two devices call themselves thing, as their boots alternate")


def test_an_uptime_that_falls_is_a_boot(tmp_path: Path) -> None:
    rig = rig_of(tmp_path, PLUG, PLUG_MAPPING + "boot: {hear: up, falls: true}\n")
    rig.tell("up", "100")
    before = rig.report.boot_id
    rig.tell("up", "200")
    assert rig.report.boot_id == before
    rig.tell("up", "3")
    assert rig.report.boot_id != before


def test_a_device_moves_while_its_facts_change(tmp_path: Path) -> None:
    mapping = COVER_MAPPING.replace(
        "state: {hear: door/state, words: {stopped: [open, closed], moving: [opening, closing]}}",
        "still: {facts: [open], for_s: 1}",
    )
    rig = rig_of(tmp_path, COVER, mapping)
    assert rig.report.state is MotionState.STOPPED
    rig.tell("door/at", "1")
    assert rig.report.state is MotionState.MOVING
    rig.run(0.8)  # the virtual one says its own again, which is another one
    rig.faults.switch("mute", on=True)
    rig.run(1.2)
    assert rig.report.state is MotionState.STOPPED


def test_a_retained_state_counts_again_after_the_broker_was_gone(cover: Rig) -> None:
    cover.give("move", to="open")
    cover.run(3.0)
    for up in (False, True):
        cover.driver.connected(cover.now, up=up)
    cover.tell("door/status", "online", retain=True)
    assert "has not told its state yet" in str(cover.report.lost)
    cover.tell("door/state", "open", retain=True)
    assert cover.report.state is MotionState.STOPPED


def test_a_message_without_the_path_of_a_fact_that_was_never_heard_is_named(tmp_path: Path) -> None:
    mapping = PLUG_MAPPING.replace('stat/{device}/POWER", words', 'stat/{device}/POWER", path: a.b, words')
    rig = Rig(*device_in(plant_of(tmp_path, PLUG, mapping)))
    rig.faults.switch("mute", on=True)
    rig.driver = type(rig.driver)(rig.device, rig.settings)
    rig.driver.connected(rig.now, up=True)
    rig.tell("stat/thing/POWER", '{"c": 1, "d": 2}')
    assert rig.log[-1] == "thing: of a message on stat/thing/POWER: it has no a.b; it has c, d"


def test_what_is_not_known_is_asked(tmp_path: Path) -> None:
    rig = Rig(*device_in(plant_of(tmp_path, PLUG, PLUG_MAPPING + "ask: [{topic: ask/it}]\n")))
    assert [each.topic for each in rig.sent] == ["ask/it"]
    rig.run(10.0)
    assert len(rig.sent) == 1  # it has told all


def test_a_device_that_tells_nothing_unasked_is_asked_until_it_shows_what_was_ordered(tmp_path: Path) -> None:
    rig = Rig(*device_in(plant_of(tmp_path, COVER, COVER_MAPPING + "ask: [{topic: ask/it}]\n")))
    rig.run(1.0)
    for fault in ("stick", "mute"):
        rig.faults.switch(fault, on=True)
    rig.give("move", to="open")
    rig.sent.clear()
    rig.run(6.0)
    assert [each.topic for each in rig.sent] == ["ask/it"] * 5, "every 1.2 s, as it reports every 0.3 s"
    rig.tell("door/at", "1")
    rig.tell("door/state", "open")
    rig.sent.clear()
    rig.run(10.0)
    assert rig.sent == [] and rig.report.state is MotionState.STOPPED


def test_what_never_comes_is_not_asked_for_without_end(tmp_path: Path) -> None:
    rig = Rig(*device_in(plant_of(tmp_path, PLUG, PLUG_MAPPING + "ask: [{topic: ask/it}]\n")))
    rig.run(1.0)
    rig.faults.switch("mute", on=True)
    rig.give("turn", to="on")
    rig.run(6.0)  # twice its at_most_s
    rig.sent.clear()
    rig.run(20.0)
    assert rig.sent == []
