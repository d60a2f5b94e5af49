"""Mappings of OPC UA in a plant file: what is wrong is told with its place and what to write."""

from __future__ import annotations

from pathlib import Path

import pytest
from plc.mappings import EXAMPLE, Example

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Robot
from arboleda.plant_file import loader
from arboleda_drivers.opcua.settings import Settings

MAPPED = Example(file="opcua.yaml", driver="opcua", settings=Settings)
UNCHANGED = MAPPED.text
LOAD = "load: {call: ns=2;s=Load, on: ns=2;s=Device}"
URL = "url: opc.tcp://127.0.0.1:4840"
MM_S = "mm_s: {node: ns=2;s=mm_s}"


@pytest.fixture(scope="module")
def belt() -> Robot:
    return loader.load(EXAMPLE / "opcua.yaml").robots["belt"]


def test_the_example_is_good(belt: Robot) -> None:
    assert MAPPED.problems(belt, "name: opcua_conveyor", "name: another") == ()


def test_what_does_not_fit_the_kind_is_told_with_file_and_line(tmp_path: Path) -> None:
    (tmp_path / "recipes.py").write_text((EXAMPLE / "recipes.py").read_text("utf-8"), "utf-8")
    file = tmp_path / "plant.yaml"
    file.write_text(UNCHANGED.replace(LOAD, LOAD.replace("load:", "lode:")), "utf-8")
    with pytest.raises(ConfigError) as raised:
        loader.load(file)
    where = "plant.yaml:36:21: cells.line.devices.belt.driver.opcua.verbs.lode: a belt has no verb lode"
    assert where in str(raised.value)


@pytest.mark.sampled(5)
@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (LOAD, "", "verbs: load of a belt is missing: say which method is called for it"),
        (MM_S, "speed: {node: ns=2;s=mm_s}", "facts.speed: a belt has no fact speed; there are"),
        (MM_S, "", "facts: mm_s of a belt is missing: say which variable shows it"),
        (MM_S, "mm_s: {node: mm_s}", "facts.mm_s: 'mm_s' is no node; write it as ns=2;s=Belt.State"),
        (MM_S, "mm_s: {node: ns=2;s=mm_s, words: {slow: 1}}", "facts.mm_s: has words, and is"),
        (MM_S, "mm_s: {nod: ns=2;s=mm_s}", 'the key "nod" is not known; did you mean "node"?'),
        ("words: {none: 0, entry: 1, exit: 2}", "words: {none: 0}", "part_at: has no number for entry, exit"),
        (
            "words: {none: 0, entry: 1, exit: 2}",
            "words: {none: 0, entry: 0}",
            "two words have the same number",
        ),
        ("value: $speed_mm_s", "value: $sped_mm_s", "advance has no parameter sped_mm_s"),
        (
            "{value: $speed_mm_s, type: uint16}",
            "{value: $speed_mm_s, type: string}",
            "type: the value is 100, 200, 400; allowed: sbyte",
        ),
        (
            "{value: $speed_mm_s, type: uint16}",
            "{value: $speed_mm_s, type: sbyte}",
            "200 is no sbyte; write a type that holds",
        ),
        ("{value: $speed_mm_s, type: uint16}", "{value: 70000, type: uint16}", "70000 is no uint16"),
        (
            "answer: {node: ns=2;s=seen, words: {good: 1, bad: 2}}",
            "",
            "verbs.scan: scan is a query: say which variable",
        ),
        ("latched: 3}}", "stuck: 3}}", "state.words.stuck: there is no state stuck; there are stopped"),
        (
            "            halt: {call: ns=2;s=Halt, on: ns=2;s=Device}\n",
            "",
            "halt is missing: say which method",
        ),
        (URL, "url: http://127.0.0.1:4840", "write opc.tcp://10.0.0.30:4840"),
        (URL, f"{URL}\n            timeout_s: 50", "timeout_s is 50; allowed: 0.05 to 5"),
        (URL, f"{URL}\n            publish_s: 5", "publish_s is 5; allowed: 0.01 to 0.5"),
        (URL, f"{URL}\n            user: cell", "set ARBOLEDA_OPCUA_USER and ARBOLEDA_OPCUA_PASSWORD in the"),
        (URL, f"{URL}\n            password: x", "user and password are never in a plant file"),
        (URL, "url: opc.tcp://cell:x@127.0.0.1:4840", "user and password are never in a plant file"),
        (URL, f"{URL}\n            secrets: line-1", "secrets is how names in the environment begin"),
        ("security: none", "security: some", "sign_and_encrypt"),
        ("security: none", "security: none\n            policy: basic256", "aes128_sha256_rsaoaep"),
        ("security: none", "security: none\n            heartbeat_type: string", "is string; allowed: sbyte"),
        (LOAD, LOAD.replace(", on: ns=2;s=Device", ""), "verbs.load: call needs on, the object that"),
        (
            LOAD,
            "load: {write: [{node: ns=2;s=Verb, value: 1, type: byte}]}",
            "verbs.load: is written, and sequence has no write",
        ),
        (LOAD, "load: {write: [{node: Verb, value: 1, type: byte}]}", "write[0]: 'Verb' is no node"),
        (
            "accepted: ns=2;s=accepted",
            "busy: ns=2;s=busy\n              write: ns=2;s=asked",
            "verbs.load: is a method, and busy says nothing of methods",
        ),
        (
            "{node: ns=2;s=mm_s}",
            "{node: nsu=http://maker.example/belt/;s=mm_s, words: {slow: 1}}",
            "facts.mm_s: has words, and is",
        ),
    ],
)
def test_what_is_wrong_has_its_place_and_a_hint(belt: Robot, old: str, new: str, told: str) -> None:
    found = MAPPED.problems(belt, old, new)
    assert any(told in each for each in found), found
    assert all("plant.yaml:" in each for each in found)


def test_ids_need_numbers_that_the_server_echoes(belt: Robot) -> None:
    start, end = UNCHANGED.index("            sequence:"), UNCHANGED.index("            facts:")
    found = MAPPED.problems(belt, UNCHANGED[start:end], "")
    assert any("evidence: ids needs sequence" in each for each in found), found


def test_a_robot_has_no_mapping() -> None:
    arm = loader.load(None).robots["ra1"]
    assert list(Settings(url="opc.tcp://10.0.0.7:4840").problems(arm)) == [
        ((), "reaches devices of declared kinds; ra1 is of the kind arm")
    ]
