"""Token of a step's command, which its board echoes: the task, the node of its tree, and the attempt."""

from __future__ import annotations

import re
from functools import lru_cache
from hashlib import blake2b
from typing import NamedTuple

MOST_STEPS = 1 << 16
ATTEMPTS = 1 << 8  # after so many they count from 0 again
_FORM = re.compile(r"[0-9a-f]{12}", re.ASCII)


class StepToken(NamedTuple):
    """Token of 12 hexadecimal characters, as `CellCommands.send` writes it.

    It has 6 of `task`, the hash of its id, 4 of `step`, the number of its node, and 2 of `attempt`.
    """

    task: str
    step: int
    attempt: int

    @classmethod
    def read(cls, text: str) -> StepToken | None:
        """The token that a board echoes; None for a text that no plant gives."""
        if not _FORM.fullmatch(text):
            return None
        return cls(text[:6], int(text[6:10], 16), int(text[10:], 16))


@lru_cache(maxsize=256)
def hash_of(task: str) -> str:
    """The hash of a task's id, 6 characters."""
    return blake2b(task.encode(), digest_size=3).hexdigest()
