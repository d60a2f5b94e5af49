"""Copies without an id of the plant's commands, beside the commands of others."""

from __future__ import annotations

from arboleda.drivers import Command
from arboleda.wire.hop import without_id

COPIES_S = 5.0  # how far a copy and its original may come apart
EARLY_S = 0.2  # how long before its original a copy may come where others publish on its topic, too


class KnownCopies:
    """Copies that are expected, and commands without an id (`early`) with the time up to which their original
    may still come.
    """

    def __init__(self) -> None:
        self.early: list[tuple[float, Command]] = []
        self._expected: list[tuple[float, Command]] = []

    def expect(self, at: float, command: Command) -> None:
        """Expect a copy of a command of the plant, unless it came before."""
        plain = without_id(command)
        if not _take(self.early, plain):
            self._expected.append((at, plain))

    def take(self, at: float, command: Command, sender: str) -> bool:
        """True if a command without an id is an expected copy; another one may prove to be one yet.

        One that names a `sender` beside the plant may be theirs, so its original is not waited for as long.
        """
        self._expected = [each for each in self._expected if each[0] + COPIES_S > at]
        if _take(self._expected, command, latest=True):
            return True
        self.early.append((at + (EARLY_S if sender else COPIES_S), command))
        return False

    def end_step(self, now: float) -> None:
        self.early = [each for each in self.early if each[0] > now]


def _take(rows: list[tuple[float, Command]], command: Command, *, latest: bool = False) -> bool:
    """Take the first row of this command out, or the `latest` one; False if there is none."""
    row = next((each for each in (reversed(rows) if latest else rows) if each[1] == command), None)
    if row is not None:
        rows.remove(row)
    return row is not None
