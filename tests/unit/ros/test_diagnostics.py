"""Statuses that are serialised once make the same array as all of them serialised anew."""

from __future__ import annotations

from itertools import permutations

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed")

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.serialization import deserialize_message, serialize_message

from arboleda.runtime.parts.slices import Slices
from arboleda_ros import statuses
from arboleda_ros.diagnostics import Diagnostics

STAMP = Time(sec=1_700_000_000, nanosec=5)
ROWS = [  # strings that end at each place between two multiples of 4, and none at all
    ("arboleda: a", "", 0, "ready", {}),
    ("arboleda: ab", "a_1", 1, "ready", {"k": "v"}),
    ("arboleda: abc", "a_12", 2, "in fault: ¡paró!", {"k": "va", "key": ""}),
    ("arboleda: abcd", "a_123", 3, "", {"k": "val"}),
    ("arboleda: abcde", "a_1234", 0, "x", {"k": "valu"}),
]


def array(rows):
    message = DiagnosticArray(status=[statuses.diagnostic(*row) for row in rows])
    message.header.stamp = STAMP
    return message


def bytes_of(diagnostics, rows):
    slices = Slices(diagnostics.of(rows, STAMP))
    while not slices.cut(0.0):
        pass
    return slices.result


@pytest.mark.parametrize("rows", [[], ROWS, *([row] for row in ROWS), *permutations(ROWS, 2)], ids=len)
def test_the_bytes_say_what_the_message_says(rows):
    written = bytes_of(Diagnostics(), rows)
    assert deserialize_message(written, DiagnosticArray) == array(rows)
    assert len(written) == len(serialize_message(array(rows)))  # padding may hold anything


def test_what_changed_is_made_anew():
    diagnostics = Diagnostics()
    before = [("a", "", 0, "ready", {"q": "1"}), ("b", "", 0, "ready", {"q": "1"})]
    after = [before[0], ("b", "", 2, "in fault", {"q": "2"})]
    for rows in (before, after, before, after[:1]):
        assert deserialize_message(bytes_of(diagnostics, rows), DiagnosticArray) == array(rows)
