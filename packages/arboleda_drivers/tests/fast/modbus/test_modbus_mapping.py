"""Mappings of Modbus in a plant file: what is wrong is told with its place and what to write."""

from __future__ import annotations

from pathlib import Path

import pytest
from plc.mappings import EXAMPLE, Example

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Robot
from arboleda.plant_file import loader
from arboleda_drivers.modbus.settings import Settings

GATE_FACT = "gate: {discrete: 0, words: {closed: 0, open: 1}}"
LOAD = "load: {write: [{holding: 0, value: 1}]}"


MAPPED = Example(file="plant.yaml", driver="modbus", settings=Settings)
UNCHANGED = MAPPED.text


@pytest.fixture(scope="module")
def belt() -> Robot:
    return loader.load(EXAMPLE / "plant.yaml").robots["belt"]


def changed(folder: Path, old: str, new: str) -> ConfigError:
    """What the plant is refused with."""
    for name in ("plant.yaml", "recipes.py"):
        (folder / name).write_text((EXAMPLE / name).read_text("utf-8").replace(old, new), "utf-8")
    with pytest.raises(ConfigError) as raised:
        loader.load(folder / "plant.yaml")
    return raised.value


def test_the_example_is_good(belt: Robot) -> None:
    assert MAPPED.problems(belt, "name: plc_conveyor", "name: another") == ()


def test_what_does_not_fit_the_kind_is_told_with_file_and_line(tmp_path: Path) -> None:
    told = str(changed(tmp_path, "scan: {write", "scna: {write"))
    assert (
        "plant.yaml:47:21: cells.line.devices.belt.driver.modbus.verbs.scna: a belt has no verb scna" in told
    )


def test_what_cannot_be_read_is_told_with_file_and_line(tmp_path: Path) -> None:
    (told,) = changed(tmp_path, "mm_s: {input: 11}", "mm_s: {input: -1}").problems
    assert (
        "plant.yaml:35:21: cells.line.devices.belt.driver.modbus.facts.mm_s: input -1 is out of range" in told
    )


@pytest.mark.sampled(5)
@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (
            "load: {write",
            "lode: {write",
            "verbs.lode: a belt has no verb lode; there are load, advance, gate, scan",
        ),
        (LOAD, "", "verbs: load of a belt is missing: say what is written for it"),
        ("mm_s: {input: 11}", "speed: {input: 11}", "facts.speed: a belt has no fact speed; there are"),
        ("mm_s: {input: 11}", "", "facts: mm_s of a belt is missing: say where the PLC shows it"),
        (
            "mm_s: {input: 11}",
            "mm_s: {input: 65536}",
            "facts.mm_s: input 65536 is out of range; allowed: 0 to 65535",
        ),
        ("mm_s: {input: 11}", "mm_s: {inptu: 11}", 'the key "inptu" is not known; did you mean "input"?'),
        (
            "mm_s: {input: 11}",
            "mm_s: {input: 11, scale: 0.5}",
            "facts.mm_s: is a whole number, which a scale",
        ),
        ("mm_s: {input: 11}", "mm_s: {discrete: 11}", "facts.mm_s: discrete 11 is one bit, and the value is"),
        (
            "mm_s: {input: 11}",
            "mm_s: {input: 9, type: int32}",
            "facts.mm_s: input 9 is read as int32 here and as uint16 in facts.part_at; one register",
        ),
        (
            GATE_FACT,
            "gate: {discrete: 0}",
            "facts.gate: has no number for closed, open; write words: {closed: 0}",
        ),
        (LOAD, "load: {write: []}", "verbs.load: nothing is written for load"),
        (LOAD, "load: {write: [{input: 0, value: 1}]}", "no input can be written; allowed: coil, holding"),
        (
            LOAD,
            "load: {write: [{holding: 0, value: $to}]}",
            "value: load has no parameter to; there are none",
        ),
        (LOAD, "load: {write: [{holding: 0}]}", 'verbs.load.write[0]: the key "value" is missing'),
        (", answer: {input: 12, words: {good: 1, bad: 2}}", "", "verbs.scan: scan is a query: say where"),
        (
            "latched: 3}}",
            "stuck: 3}}",
            "state.words.stuck: there is no state stuck; there are stopped, moving",
        ),
        ("{stopped: 0, moving: 1, fault: 2, latched: 3}", "{stopped: 0}", "state: has no number for moving"),
        (
            "            halt: [{coil: 0, value: true}]\n",
            "",
            "halt is missing: say what is written to end a motion",
        ),
        (
            "write: {holding: 3}",
            "write: {coil: 3}",
            "sequence.write: must be a holding register of type uint16",
        ),
        (
            "host: 127.0.0.1",
            "serial: /dev/ttyUSB0\n            host: 127.0.0.1",
            "needs either host (Modbus TCP) or",
        ),
        (
            "host: 127.0.0.1",
            "serial: /dev/ttyUSB0\n            framing: rtu",
            "framing is for host; a serial line",
        ),
        ("port: 5020", "framing: ascii", "framing"),
        ("port: 5020", "poll_s: 2.0", "poll_s is 2; allowed: 0.005 to 0.5"),
    ],
)
def test_what_is_wrong_has_its_place_and_a_hint(belt: Robot, old: str, new: str, told: str) -> None:
    found = MAPPED.problems(belt, old, new)
    assert any(told in each for each in found), found
    assert all("plant.yaml:" in each for each in found)


def test_ids_need_numbers_that_the_plc_echoes(belt: Robot) -> None:
    start, end = UNCHANGED.index("            sequence:"), UNCHANGED.index("            facts:")
    found = MAPPED.problems(belt, UNCHANGED[start:end], "")
    assert any("evidence: ids needs sequence" in each for each in found), found


def test_a_robot_has_no_mapping() -> None:
    arm = loader.load(None).robots["ra1"]
    assert list(Settings(host="10.0.0.7").problems(arm)) == [
        ((), "reaches devices of declared kinds; ra1 is of the kind arm")
    ]
