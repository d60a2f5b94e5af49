"""Serialisation of the few types of ROS 2 that a record has, as ROS 2 does it: CDR, little-endian.

Each number stands at a multiple of its size, counted from behind the head of four bytes. Of the library that
could do it, `mcap-ros2-support`, the writer makes a file of its own without our other channels.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping, Sequence

HEAD = b"\0\1\0\0"
UINT32, DOUBLE = struct.Struct("<I"), struct.Struct("<d")
STAMP = struct.Struct("<iI")  # whole seconds of Unix time, and the rest in ns
SECOND = 1_000_000_000
Status = tuple[str, str, int, str, Mapping[str, str]]  # name, hardware id, level, message, values


def uint8(value: int) -> bytes:
    """The bytes of a std_msgs/UInt8."""
    return HEAD + bytes([value])


def string(text: str) -> bytes:
    """The bytes of a std_msgs/String."""
    data = bytearray(HEAD)
    _add_text(data, text)
    return bytes(data)


class JointStates:
    """Serialiser of sensor_msgs/JointState for joints with these names: positions only."""

    def __init__(self, names: Sequence[str]) -> None:
        data = bytearray(HEAD + bytes(STAMP.size))
        _add_text(data, "")
        _add_texts(data, names)
        _add_count(data, len(names))
        _align(data, DOUBLE.size)
        self._before = bytes(data[len(HEAD) + STAMP.size :])
        self._positions = struct.Struct(f"<{len(names)}d")

    def of(self, unix_ns: int, positions: Sequence[float]) -> bytes:
        """The bytes of the message of a moment."""
        none = UINT32.pack(0) * 2
        return HEAD + _stamp(unix_ns) + self._before + self._positions.pack(*positions) + none


def diagnostics(unix_ns: int, statuses: Sequence[Status]) -> bytes:
    """The bytes of a diagnostic_msgs/DiagnosticArray."""
    data = bytearray(HEAD + _stamp(unix_ns))
    _add_text(data, "")
    _add_count(data, len(statuses))
    for name, hardware_id, level, message, values in statuses:
        data.append(level)
        for text in (name, message, hardware_id):
            _add_text(data, text)
        _add_count(data, len(values))
        for pair in values.items():
            for text in pair:
                _add_text(data, text)
    return bytes(data)


def _stamp(unix_ns: int) -> bytes:
    return STAMP.pack(*divmod(unix_ns, SECOND))


def _align(data: bytearray, size: int) -> None:
    data += bytes(-(len(data) - len(HEAD)) % size)


def _add_count(data: bytearray, count: int) -> None:
    _align(data, UINT32.size)
    data += UINT32.pack(count)


def _add_text(data: bytearray, text: str) -> None:
    """Append a text: its length, its bytes, and a zero."""
    encoded = text.encode(errors="replace") + b"\0"
    _add_count(data, len(encoded))
    data += encoded


def _add_texts(data: bytearray, texts: Iterable[str]) -> None:
    texts = tuple(texts)
    _add_count(data, len(texts))
    for text in texts:
        _add_text(data, text)
