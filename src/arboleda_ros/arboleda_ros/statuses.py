"""DiagnosticStatus: made of plain data, and read from the `status` of a robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from rclpy.serialization import deserialize_message

from arboleda.drivers import Report, Robot
from arboleda.extension import PayloadError
from arboleda.wire.status import NUMBER, NUMBER_DIGITS, Status, from_status
from arboleda.wire.strict import UINT32

_TAIL = NUMBER_DIGITS + 1  # bytes of a serialized status that ends with its number: a zero follows it


def diagnostic(
    name: str, hardware_id: str, level: int, message: str, values: Mapping[str, str]
) -> DiagnosticStatus:
    """The message made of plain data; levels 0 OK, 1 WARN, 2 ERROR, 3 STALE."""
    pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
    return DiagnosticStatus(
        level=bytes([level]), name=name, hardware_id=hardware_id, message=message, values=pairs
    )


def report_of(at: float, robot: Robot, message: DiagnosticStatus) -> Report:
    """The report in a message received `at`; raises PayloadError for one that no bridge sends."""
    values = {pair.key: pair.value for pair in message.values}
    if len(values) < len(message.values):
        raise PayloadError(f"a key comes twice in {', '.join(pair.key for pair in message.values)}")
    plain = Status(
        name=message.name,
        hardware_id=message.hardware_id,
        level=message.level[0],
        message=message.message,
        values=values,
    )
    return from_status(at, robot, plain)


class StatusListener:
    """Reader of a robot's `status` as bytes, which skips parsing those that only repeat the last one."""

    def __init__(self, robot: Robot, clock: Callable[[], float], on_report: Callable[[Report], None]) -> None:
        self._robot = robot
        self._clock = clock
        self._on_report = on_report
        self._last: Report | None = None
        self._words = b""  # the last status, without the number at its end
        self._tail = 0  # length of that number in bytes; 0 if it has none

    def __call__(self, data: bytes) -> None:
        """Pass on the report in a message; raises PayloadError for one that no bridge sends."""
        at = self._clock()
        self._on_report(self._again(at, data) or self._read(at, data))

    def _repeats(self, data: bytes) -> bool:
        """True for a message with the words of the last one; its number may be another."""
        return self._last is not None and data[: len(data) - self._tail] == self._words

    def _again(self, at: float, data: bytes) -> Report | None:
        """The last report once more, if a message has the same meaning; else None."""
        if self._last is None or not self._repeats(data):
            return None
        number = data[len(data) - self._tail : -1]
        if not self._tail:
            return self._last.again(at)
        allowed = number.isdigit() and int(number) <= UINT32  # any other is parsed and refused
        return self._last.again(at, number=int(number)) if allowed else None

    def _read(self, at: float, data: bytes) -> Report:
        message = deserialize_message(data, DiagnosticStatus)
        report = report_of(at, self._robot, message)
        ends_with_number = bool(message.values) and message.values[-1].key == NUMBER
        self._tail = _TAIL if ends_with_number else 0
        self._last, self._words = report, data[: len(data) - self._tail]
        return report
