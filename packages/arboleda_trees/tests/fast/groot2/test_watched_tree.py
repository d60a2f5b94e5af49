"""Answers to Groot2 on a cell: replies of its protocol, and nothing that could change the plant."""

from __future__ import annotations

import json
import random
import re
import struct
from typing import Any

import pytest

from arboleda_trees.groot2.watched_tree import MOST_TRANSITIONS, WatchedTree

IDLE, RUNNING, SUCCESS, FAILURE = range(4)
STATUSES = {IDLE: "INVALID", RUNNING: "RUNNING", SUCCESS: "SUCCESS", FAILURE: "FAILURE"}


def tree(*statuses: int, name: str = "work", **given: Any) -> list[dict[str, Any]]:
    """A sequence and its steps, which stand so."""
    paths = ["root", *map(str, range(len(statuses) - 1))]
    return [
        {
            "path": path,
            "name": name if path == "root" else f"step {path}",
            "kind": "sequence" if path == "root" else "command",
            "status": STATUSES[status],
            "parameters": {} if path == "root" else given,
        }
        for path, status in zip(paths, statuses, strict=True)
    ]


def header(type: str, number: int = 7, protocol: int = 2) -> bytes:
    return struct.pack("<BBI", protocol, ord(type), number)


class Client:
    """Asks a cell that saw `rows`, and takes replies apart."""

    def __init__(self, *rows: dict[str, Any], **facts: Any) -> None:
        self.cell = WatchedTree(lambda data: json.dumps(data).encode())
        if rows:
            self.cell.saw(rows, facts, 0)

    def ask(self, type: str, *words: str, now_us: int = 0) -> list[bytes]:
        first, *parts = self.cell.answer([header(type), *(word.encode() for word in words)], now_us)
        assert first[:6] == header(type)
        assert len(first) == 22
        return parts

    def refused(self, type: str, *words: str) -> str:
        said, why = self.cell.answer([header(type), *(word.encode() for word in words)], 0)
        assert said == b"error"
        return why.decode()

    @property
    def tree_name(self) -> bytes:
        return self.cell.answer([header("S")], 0)[0][6:]

    @property
    def statuses(self) -> list[int]:
        (packed,) = self.ask("S")
        rows = list(struct.iter_unpack("<HB", packed))
        assert [number for number, _ in rows] == list(range(1, len(rows) + 1))
        return [code for _, code in rows]

    @property
    def transitions(self) -> list[tuple[int, int, int]]:
        (packed,) = self.ask("t")
        rows = [packed[start : start + 9] for start in range(0, len(packed), 9)]
        return [(int.from_bytes(row[:6], "little"), *struct.unpack("<HB", row[6:])) for row in rows]


def test_the_tree_is_xml_whose_numbers_are_those_of_the_statuses() -> None:
    client = Client(*tree(RUNNING, SUCCESS, RUNNING, IDLE))
    (xml,) = client.ask("T")
    assert re.findall(r'name="([^"]*)" _uid="(\d+)"', xml.decode()) == [
        ("work", "1"),
        ("step 0", "2"),
        ("step 1", "3"),
        ("step 2", "4"),
    ]
    assert client.statuses == [RUNNING, SUCCESS, RUNNING, IDLE]


def test_a_node_that_is_idle_again_keeps_how_it_ended() -> None:
    client = Client(*tree(RUNNING, SUCCESS, FAILURE, IDLE))
    client.cell.saw(tree(IDLE, IDLE, IDLE, IDLE), {}, 1)
    assert client.statuses == [10 + RUNNING, 10 + SUCCESS, 10 + FAILURE, IDLE]


def test_the_tree_stays_to_be_seen_after_its_task() -> None:
    client = Client(*tree(SUCCESS, SUCCESS))
    name = client.tree_name
    client.cell.saw([], {}, 1)
    assert client.tree_name == name
    assert client.statuses == [10 + SUCCESS, 10 + SUCCESS]


def test_a_cell_that_has_run_nothing_yet_has_a_tree_too() -> None:
    client = Client()
    assert b"no task yet" in client.ask("T")[0]
    assert client.statuses == [IDLE]


def test_a_tree_is_named_anew_only_when_its_nodes_are_others() -> None:
    client = Client(*tree(RUNNING, RUNNING))
    name = client.tree_name
    assert name[6] >> 4 == 4
    client.cell.saw(tree(RUNNING, RUNNING, command="7"), {}, 1)
    assert client.tree_name == name
    client.cell.saw(tree(RUNNING, RUNNING, name="other work"), {}, 2)
    assert client.tree_name != name


def test_a_large_tree_has_subtrees_which_stand_as_what_is_in_them() -> None:
    rows = tree(RUNNING, *[SUCCESS] * 19, RUNNING, *[IDLE] * 30)
    client = Client(*rows)
    (xml,) = client.ask("T")
    inside = re.findall(r'<SubTree ID="\w+" _fullpath="([^"]+)" _uid="(\d+)"/>', xml.decode())
    trees = dict(re.findall(r'<BehaviorTree ID="(\w+)" _fullpath="([^"]*)"', xml.decode()))
    assert {path for path, _ in inside} | {""} == set(trees.values())
    assert [client.statuses[int(number) - 1] for _, number in inside] == [SUCCESS, RUNNING, IDLE]
    numbers = [int(each) for each in re.findall(r'_uid="(\d+)"', xml.decode())]
    assert sorted(numbers) == list(range(1, len(client.statuses) + 1))


def test_a_blackboard_has_what_steps_were_given_and_that_of_the_main_tree_the_task() -> None:
    client = Client(*tree(RUNNING, RUNNING, q=[0.5, 1]), task_text="sis_a 0B 7")
    boards = json.loads(client.ask("B", "Work;nothing")[0])
    assert boards == {"Work": {"task_text": "sis_a 0B 7", "2 step 0": {"q": [0.5, 1]}}}
    assert client.ask("B", "nothing") == [b"null"]


def test_changes_are_recorded_from_start_to_stop_and_told_once() -> None:
    client = Client(*tree(RUNNING, RUNNING, IDLE))
    client.cell.saw(tree(RUNNING, SUCCESS, IDLE), {}, 900)
    assert client.ask("r", "start", now_us=1000) == [b"1000"]
    client.cell.saw(tree(RUNNING, SUCCESS, RUNNING), {}, 1500)
    client.cell.saw([], {}, 2500)
    told = [(500, 3, RUNNING), (1500, 1, IDLE), (1500, 2, IDLE), (1500, 3, IDLE)]
    assert client.transitions == told
    assert client.transitions == []
    assert client.ask("r", "stop") == []
    client.cell.saw(tree(RUNNING, RUNNING, IDLE), {}, 3500)
    assert client.transitions == []


def test_a_recording_that_nobody_fetches_is_bounded() -> None:
    client = Client(*tree(RUNNING, RUNNING))
    client.ask("r", "start")
    for at in range(2 * MOST_TRANSITIONS):
        client.cell.saw(tree(RUNNING, SUCCESS if at % 2 else RUNNING), {}, at)
    assert len(client.transitions) == MOST_TRANSITIONS


@pytest.mark.parametrize("type", ["I", "R", "U"])
def test_hooks_are_refused(type: str) -> None:
    assert Client(*tree(RUNNING)).refused(type, "{}").startswith("read only")


def test_there_is_no_hook_to_be_listed_or_removed() -> None:
    client = Client(*tree(RUNNING))
    assert client.ask("D") == [b"[]"]
    assert client.ask("A") == client.ask("X") == []


@pytest.mark.parametrize(
    ("parts", "why"),
    [
        ([], b"wrong request header"),
        ([b""], b"wrong request header"),
        ([header("S") + b"!"], b"wrong request header"),
        ([header("?")], b"Request not recognized"),
        ([header("N")], b"Request not recognized"),
        ([header("B")], b"must be 2 parts message"),
        ([header("r"), b"start", b"now"], b"must be 2 parts message"),
    ],
)
def test_what_is_no_request_is_answered_with_the_reason(parts: list[bytes], why: bytes) -> None:
    assert Client(*tree(RUNNING)).cell.answer(parts, 0) == [b"error", why]


@pytest.mark.long
def test_no_frames_raise_or_change_the_tree() -> None:
    chance = random.Random(22)
    client = Client(*tree(RUNNING, SUCCESS, RUNNING))
    before = client.ask("T"), client.statuses
    for _ in range(100_000):
        parts = [chance.randbytes(chance.choice((0, 5, 7, 40))) for _ in range(chance.randrange(3))]
        if chance.random() < 0.8:
            letter = chance.choice(b"TSBIRNUDAXrt\0" + chance.randbytes(1))
            parts.insert(0, bytes([2, letter]) + chance.randbytes(4))
        assert client.cell.answer(parts, chance.randrange(1 << 60))
    assert (client.ask("T"), client.statuses) == before


def test_of_a_task_that_is_done_the_last_step_is_too() -> None:
    client = Client(*tree(RUNNING, SUCCESS, RUNNING))
    client.ask("r", "start")
    client.cell.saw([], {}, 5, has_succeeded=True)
    assert client.statuses == [10 + SUCCESS, 10 + SUCCESS, 10 + SUCCESS]
    assert client.transitions[:2] == [(5, 1, SUCCESS), (5, 3, SUCCESS)]
