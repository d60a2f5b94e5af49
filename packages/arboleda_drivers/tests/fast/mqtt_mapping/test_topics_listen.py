"""What `topics listen` proposes from what it hears: parts of a mapping, and what is left to fill in."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from arboleda.plant_file import drivers
from arboleda.plant_file.loader import load
from arboleda_drivers.mqtt_mapping.listen.hearing import Listening
from arboleda_drivers.mqtt_mapping.listen.proposal import proposal

from .mqtt_rig import RECIPE

Said = tuple[float, str, object]
LAMP: list[Said] = [
    (0.0, "tele/lamp/LWT", "Online"),
    (0.0, "tele/lamp/SENSOR", {"DS18B20": {"Temperature": 21.5}, "Uptime": 400}),
    (1.0, "stat/lamp/POWER", "OFF"),
    (2.0, "cmnd/lamp/POWER", "ON"),
    (2.2, "stat/lamp/POWER", "ON"),
    (5.0, "cmnd/lamp/POWER", "OFF"),
    (5.3, "stat/lamp/POWER", "OFF"),
]
ARM: list[Said] = [
    (0.0, "arm/pose", {"axis": [{"deg": 0}], "mode": "A"}),
    (1.0, "arm/cmd", {"seq": 7, "act": "turn", "deg": 90}),
    (1.1, "arm/ack", {"ref": 7, "is": "taken"}),
    (1.2, "arm/pose", {"axis": [{"deg": 40}], "mode": "B"}),
    (3.0, "arm/pose", {"axis": [{"deg": 90}], "mode": "A"}),
    (3.1, "arm/ack", {"ref": 7, "is": "done"}),
    (5.0, "arm/cmd", {"seq": 8, "act": "turn", "deg": 0}),
    (5.2, "arm/ack", {"ref": 8, "is": "failed", "why": "jam"}),
    (6.0, "arm/cmd/stop", ""),
    (7.0, "arm/pose", {"axis": [{"deg": 90}], "mode": "C"}),
]


def lines(said: list[Said]) -> list[str]:
    """The proposal; what is said at once is retained."""
    heard = Listening()
    for at, topic, payload in said:
        text = payload if isinstance(payload, str) else json.dumps(payload)
        heard.take(topic, text.encode(), retained=at == 0.0, at=at)
    return [*proposal(heard)]


def loaded(folder: Path, proposed: list[str]) -> list[str]:
    """The lines that `check --show` has of a plant with that proposal, taken as it is."""
    at = proposed.index("# and of the device:")
    device = "\n".join(f"        {line}" for line in proposed[at + 1 :])
    kinds = "\n".join(proposed[:at])
    cell = "cells:\n  shop:\n    devices:\n      it:\n        kind: thing"
    (folder / "recipes.py").write_text(RECIPE, "utf-8")
    file = folder / "plant.yaml"
    file.write_text(f"name: shop\nuses: [recipes.py]\n{kinds}\n{cell}\n{device}\n", "utf-8")
    return [*drivers.messages_of(load(file))]


def test_a_switch_is_proposed_with_what_it_shows_and_what_is_sent(tmp_path: Path) -> None:
    proposed = lines(LAMP)
    assert '    online: {hear: "tele/lamp/LWT", equals: "Online"}' in proposed
    assert proposed[3:5] == ["      power: [on, off]", "      temperature: number"]
    assert "      # uptime: int" in proposed, "what it tells of itself comes last, as a comment"
    turn = (
        "      power: {effect: switch, with: {to: [on, off]}, sets: {power: $to}, takes_s: 1, at_most_s: 5}"
    )
    assert turn in proposed
    assert any("stop: none  # nothing that stops it was heard" in line for line in proposed)
    shown = loaded(tmp_path, proposed)
    assert shown[0].startswith("it: evidence facts") and "  power on: cmnd/lamp/POWER ON" in shown


def test_a_motion_is_proposed_with_its_state_its_ends_and_its_stop(tmp_path: Path) -> None:
    proposed = lines(ARM)
    state = '    state: {hear: "arm/pose", path: "mode", words: {stopped: "A", moving: "B"}}'
    assert any(line.startswith(state) for line in proposed), "A before a command and again after it"
    assert '    # state: "C" was heard, too; put it to stopped, moving or fault' in proposed
    for end in (
        '    accepted: {hear: "arm/ack", path: "is", equals: "taken", id: "ref"}',
        '    done: {hear: "arm/ack", path: "is", equals: "done", id: "ref"}',
        '    failed: {hear: "arm/ack", path: "is", equals: "failed", id: "ref", why: "why"}',
        '    halt: [{topic: "arm/cmd/stop"}]',
    ):
        assert end in proposed
    sent = 'topic: "arm/cmd", payload: {"seq": "{number}", "act": "turn", "deg": "{deg}"}'
    assert f"      turn: {{send: [{{{sent}}}]}}" in proposed
    shown = loaded(tmp_path, proposed)
    assert shown[0].startswith("it: evidence ids") and "  halt: arm/cmd/stop" in shown


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ([(1.0, "a/temp", "20"), (4.0, "a/temp", "21")], "# verbs: no command was heard; write one for each"),
        ([(1.0, "a/temp", "20"), (4.0, "a/temp", "21")], "silent_after_s: 9  # nothing was heard that says"),
        (LAMP, "# state: nothing that was heard says whether it moves"),
        (LAMP, "# done: nothing that was heard says so by itself"),
        (ARM[:6], "# failed: no failure was heard"),
        ([(1.0, "a/set", "4"), (2.0, "a/x", "ok")], "# sets: no fact shows what set does"),
    ],
)
def test_what_cannot_be_known_is_said_where_it_belongs(said: list[Said], told: str) -> None:
    assert sum(told in line for line in lines(said)) == 1


def test_a_topic_without_a_telling_name_is_of_commands_where_each_message_has_an_answer() -> None:
    def speed(rpm: int, phase: str) -> dict[str, object]:
        return {"rpm": rpm, "phase": phase}

    proposed = lines(
        [
            (0.0, "lab/shaker/info", speed(0, "standstill")),
            (1.0, "lab/shaker/knob", {"n": 1, "rpm": 300}),
            (1.1, "lab/shaker/info", speed(300, "spinning")),
            (4.1, "lab/shaker/info", speed(300, "standstill")),
            (4.2, "lab/shaker/res", {"n": 1, "verdict": "ok"}),
            (6.0, "lab/shaker/knob", {"n": 2, "rpm": 1200}),
            (6.1, "lab/shaker/res", {"n": 2, "verdict": "jumped"}),
        ]
    )
    sent = 'topic: "lab/shaker/knob", payload: {"n": "{number}", "rpm": "{rpm}"}'
    assert f"      knob: {{send: [{{{sent}}}]}}" in proposed
    assert '    done: {hear: "lab/shaker/res", path: "verdict", equals: "ok", id: "n"}' in proposed
    assert '    # failed: "jumped" was heard there, too; put it to accepted, done or failed' in proposed
    assert "      info: int" not in proposed and "      rpm: int" in proposed


def test_the_name_of_a_bridge_hides_no_fact() -> None:
    proposed = lines([(1.0, "zigbee2mqtt/door", {"contact": True, "linkquality": 90})])
    assert "      contact: bool" in proposed and "      # linkquality: int" in proposed


def test_a_sensor_that_is_only_heard_is_a_whole_mapping(tmp_path: Path) -> None:
    shown = loaded(tmp_path, lines([(1.0, "a/temp", "20.5"), (4.0, "a/temp", "21"), (5.0, "a/raw", "\x00")]))
    assert shown[0].endswith("nothing is sent to it; what it tells is known")
    assert "  temp: a/temp" in shown
