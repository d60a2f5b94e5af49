"""Token of a step's command, which its board echoes: which task, which node of its tree, which attempt."""

from __future__ import annotations

import re
from functools import lru_cache
from hashlib import blake2b
from typing import NamedTuple

MOST_STEPS = 1 << 16
ATTEMPTS = 1 << 8  # they count on from 0 after that
_FORM = re.compile(r"[0-9a-f]{12}", re.ASCII)


class StepToken(NamedTuple):
    """Token of 12 hexadecimal characters: 6 of `task`, a hash of its id, 4 of `step`, the number of its node,
    and 2 of `attempt`. `CellCommands.send` writes it.
    """

    task: str
    step: int
    attempt: int

    @classmethod
    def read(cls, text: str) -> StepToken | None:
        """The token in what a board echoes; None for what this plant never gave."""
        if not _FORM.fullmatch(text):
            return None
        return cls(text[:6], int(text[6:10], 16), int(text[10:], 16))


@lru_cache(maxsize=256)
def hash_of(task: str) -> str:
    """The hash of a task's id, 6 characters."""
    return blake2b(task.encode(), digest_size=3).hexdigest()
