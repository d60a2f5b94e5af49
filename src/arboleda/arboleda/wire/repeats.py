"""Detects by its bytes, without parsing, telemetry that repeats the last one under another number.

The joints of a moving arm may be others.
"""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.model.messages import MotionState

from .payloads import Telemetry, read_angles
from .strict import LIMIT_BYTES, UINT32

NAME, KEY = b'"seq"', b'"seq":'
DIGITS = b"0123456789"
LONGEST = len(str(UINT32))


@dataclass(frozen=True, slots=True)
class SplitTelemetry:
    """Accepted telemetry, split at its number; `after` is None if it has no number.

    `joints` is the number of bytes with joints that may change; 0 if none may.
    """

    before: bytes
    after: bytes | None
    joints: int = 0

    @classmethod
    def of(cls, raw: bytes, message: Telemetry) -> SplitTelemetry | None:
        """The split of a message; None if its bytes do not show which number is that of the message."""
        seq, joints = message.seq, _joints(raw, message)
        if seq is None:
            return cls(raw, None, joints)
        before, _, behind = raw.partition(KEY)
        after = behind.lstrip(DIGITS)
        sure = raw.count(NAME) == 1 and b"\\" not in raw and behind[: len(behind) - len(after)] == b"%d" % seq
        return cls(before + KEY, after, joints) if sure else None

    def turned(self, raw: bytes, joints: int) -> SplitTelemetry:
        """The split of a message that begins with other joints and goes on like this one."""
        return SplitTelemetry(raw[:joints] + self.before[self.joints :], self.after, joints)

    def number(self, raw: bytes) -> int | None:
        """The number of a message that repeats this one, 0 if these have none; None for any other message."""
        before, after = self.before, self.after
        if len(raw) > LIMIT_BYTES:
            return None
        if after is None:
            return 0 if raw == before else None
        if not raw.startswith(before) or not raw.endswith(after):
            return None
        digits = raw[len(before) : len(raw) - len(after)]
        if not digits.isdigit() or len(digits) > LONGEST:
            return None
        number = int(digits)
        return number if number <= UINT32 and b"%d" % number == digits else None  # else it is not JSON


def _joints(raw: bytes, message: Telemetry) -> int:
    """The number of bytes that hold joints; 0 unless the arm moves, as joints at rest may end a motion."""
    if message.q_deg is None or message.state is not MotionState.MOVING:
        return 0
    read = read_angles(raw, len(message.q_deg))
    return 0 if read is None else read[1]
