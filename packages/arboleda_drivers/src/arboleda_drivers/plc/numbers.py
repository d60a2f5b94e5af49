"""Commands as numbers that a PLC can echo."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable

LAST = 65535  # the greatest value of a register; 0 means "none yet"
REMEMBERED = 256  # commands; an open one is never that old


class Numbers:
    """Numbers of commands, from 1 to the greatest that fits, and the commands behind them."""

    def __init__(self, greatest: int = LAST) -> None:
        self._greatest = greatest
        self._last = 0
        self._shown: frozenset[int] = frozenset()
        self._ids: OrderedDict[int, str] = OrderedDict()

    def begin(self, accepted: int | None) -> None:
        """Forget all numbers given: those shown at a new connection are of no command.

        The first ones go on from the last that the PLC accepted, so that a later start of the plant can tell
        how many there were.
        """
        self._ids.clear()
        self._last = self._last or accepted or 0

    def see(self, shown: Iterable[int]) -> None:
        """Take the numbers that the PLC shows now; no new command gets one of them."""
        self._shown = frozenset(shown)

    def give(self, id: str) -> int:
        """The number for a command."""
        self._last = self._after()
        while self._last in self._shown:
            self._last = self._after()
        self._ids.pop(self._last, None)
        self._ids[self._last] = id
        if len(self._ids) > REMEMBERED:
            self._ids.popitem(last=False)
        return self._last

    def id_of(self, number: int | None) -> str | None:
        """The command of a number; None for a number that was not given."""
        return None if number is None else self._ids.get(number)

    def _after(self) -> int:
        return self._last % self._greatest + 1
