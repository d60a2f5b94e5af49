"""Copies without an id of the plant's commands, beside the commands of others."""

from __future__ import annotations

from arboleda.model.commands import Command
from arboleda.wire.hop import without_id

COPIES_S, EARLY_S = 5.0, 0.2  # how late after its original, and how early before it a copy may come


class KnownCopies:
    """Copies that are expected, and commands without an id (`early`) whose original may still come."""

    def __init__(self) -> None:
        self.early: list[tuple[float, Command]] = []
        self._expected: list[tuple[float, Command]] = []

    def expect(self, at: float, command: Command) -> None:
        """Expect a copy of a command of the plant, unless it came before."""
        plain = without_id(command)
        if not _take(self.early, plain):
            self._expected.append((at, plain))

    def take(self, at: float, command: Command) -> bool:
        """True if a command without an id is an expected copy; another one may prove to be one yet."""
        self._expected = [each for each in self._expected if each[0] + COPIES_S > at]
        if _take(self._expected, command):
            return True
        self.early.append((at, command))
        return False

    def end_step(self, now: float) -> None:
        self.early = [each for each in self.early if each[0] + EARLY_S > now]


def _take(rows: list[tuple[float, Command]], command: Command) -> bool:
    """Take the first row of this command out; False if there is none."""
    row = next((each for each in rows if each[1] == command), None)
    if row is not None:
        rows.remove(row)
    return row is not None
