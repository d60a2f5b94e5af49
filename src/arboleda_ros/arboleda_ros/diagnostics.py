"""DiagnosticArray of many statuses, few of which change: each is serialised once.

To build and serialise one of 300 statuses takes 5 ms, every second and at each change.
"""

from __future__ import annotations

import sys
from collections.abc import Generator, Iterable, Mapping

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.serialization import serialize_message

from arboleda_ros import statuses

Diagnostic = tuple[str, str, int, str, Mapping[str, str]]  # name, hardware id, level, message, values
_ENCAPSULATION = 4  # bytes before a serialised message, which are not counted where CDR aligns to 4
_LEVEL = slice(_ENCAPSULATION, _ENCAPSULATION + 1)
_REST = slice(_ENCAPSULATION + 4, None)  # the level is padded to the string that follows it
_PADDING = (b"", b"\0\0\0", b"\0\0", b"\0")


class Diagnostics:
    """Serialiser of arrays, which remembers the statuses of the last one by name."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[Diagnostic, bytes, bytes]] = {}

    def of(self, plain: Iterable[Diagnostic], stamp: Time) -> Generator[None, None, bytes]:
        """The array as CDR for Publisher.publish, in parts of one status each."""
        message = DiagnosticArray()
        message.header.stamp = stamp
        written = bytearray(serialize_message(message)[:-4])  # the number of statuses comes last, 0
        parts = []
        for each in plain:
            parts.append(self._status(each))
            yield
        written += len(parts).to_bytes(4, sys.byteorder)
        for level, rest in parts:
            written += level
            written += _PADDING[len(written) % 4]
            written += rest
        return bytes(written)

    def _status(self, plain: Diagnostic) -> tuple[bytes, bytes]:
        """The level, and all that follows its padding; the latter is aligned to 4."""
        known = self._known.get(plain[0])
        if known is None or known[0] != plain:
            data = serialize_message(statuses.diagnostic(*plain))
            known = self._known[plain[0]] = (plain, data[_LEVEL], data[_REST])
        return known[1], known[2]
