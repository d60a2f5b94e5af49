"""Telemetry that repeats the one before under another number: known by its bytes, without reading it."""

from __future__ import annotations

from dataclasses import dataclass

from .payloads import Telemetry
from .strict import LIMIT_BYTES, UINT32

NAME, KEY = b'"seq"', b'"seq":'
DIGITS = b"0123456789"
LONGEST = len(str(UINT32))


@dataclass(frozen=True, slots=True)
class Words:
    """An accepted message: up to its number, and after it; `after` is None where it has no number."""

    before: bytes
    after: bytes | None

    @classmethod
    def of(cls, raw: bytes, said: Telemetry) -> Words | None:
        """None where the bytes alone do not show which number is the message's own."""
        if said.seq is None:
            return cls(raw, None)
        before, _, rest = raw.partition(KEY)
        after = rest.lstrip(DIGITS)
        sure = (
            raw.count(NAME) == 1 and b"\\" not in raw and rest[: len(rest) - len(after)] == b"%d" % said.seq
        )
        return cls(before + KEY, after) if sure else None

    def number(self, raw: bytes) -> int | None:
        """The number of a message that says the same, 0 where such have none; None for any other message."""
        before, after = self.before, self.after
        if after is None:
            return 0 if raw == before else None
        if not raw.startswith(before) or not raw.endswith(after) or len(raw) > LIMIT_BYTES:
            return None
        digits = raw[len(before) : len(raw) - len(after)]
        if not digits.isdigit() or len(digits) > LONGEST:
            return None
        number = int(digits)
        return number if number <= UINT32 and b"%d" % number == digits else None  # else it is not JSON
