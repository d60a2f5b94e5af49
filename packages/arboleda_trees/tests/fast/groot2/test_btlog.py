"""Course of a tree, as the file that FileLogger2 of BehaviorTree.CPP writes."""

from __future__ import annotations

import re
import struct
from typing import Any

from arboleda_trees.groot2.btlog import btlog

BEGAN_US = 1_700_000_000_000_000
IDLE, RUNNING, SUCCESS, FAILURE = range(4)


def tree(*statuses: str, name: str = "work") -> list[dict[str, Any]]:
    """A sequence with two steps."""
    rows = zip(
        ("root", "0", "1"), (name, "first", "second"), ("sequence", "step", "step"), statuses, strict=True
    )
    return [
        {"path": path, "name": title, "kind": kind, "status": status} for path, title, kind, status in rows
    ]


def read(content: bytes) -> tuple[str, int, list[tuple[int, int, int]]]:
    """XML, when it began, and time, number and status of each change."""
    assert content[:19] == b"BTCPP4-FileLogger2\x01"
    (length,) = struct.unpack_from("<i", content, 19)
    rest = content[23 + length :]
    changes = [rest[start : start + 9] for start in range(8, len(rest), 9)]
    told = [(int.from_bytes(each[:6], "little"), *struct.unpack("<HB", each[6:])) for each in changes]
    return content[23 : 23 + length].decode(), struct.unpack("<q", rest[:8])[0], told


WENT = [
    (BEGAN_US, tree("RUNNING", "RUNNING", "INVALID")),
    (BEGAN_US + 70_000, tree("RUNNING", "SUCCESS", "RUNNING")),
    (BEGAN_US + 5_000_000_000, []),
]


def test_it_has_the_tree_and_each_change_with_its_time() -> None:
    xml, began_us, told = read(btlog(WENT, has_succeeded=True))
    assert re.findall(r'name="(\w+)" _uid="(\d)"', xml) == [("work", "1"), ("first", "2"), ("second", "3")]
    assert began_us == BEGAN_US
    assert told[:4] == [(0, 1, RUNNING), (0, 2, RUNNING), (70_000, 2, SUCCESS), (70_000, 3, RUNNING)]
    last = 5_000_000_000
    assert told[4:6] == [(last, 1, SUCCESS), (last, 3, SUCCESS)]
    assert told[6:] == [(last, 1, IDLE), (last, 2, IDLE), (last, 3, IDLE)]


def test_of_a_task_that_failed_nobody_knows_how_its_last_step_ended() -> None:
    _, _, told = read(btlog(WENT, has_succeeded=False))
    assert [status for _, _, status in told[4:]] == [IDLE, IDLE, IDLE]


def test_a_further_try_with_another_tree_is_the_one_that_is_told() -> None:
    other = (BEGAN_US - 9, tree("RUNNING", "FAILURE", "INVALID", name="other"))
    assert read(btlog([other, *WENT], has_succeeded=True)) == read(btlog(WENT, has_succeeded=True))
