"""Copies, without an id, of commands that the plant has sent with one."""

from __future__ import annotations

from arboleda.model.commands import Command

from .hop import without_id

COPY_S = 5.0  # after its original a copy comes at once, or as late as a lossy network repeats it


class Copies:
    """Copies of commands for one robot; `expected` are still to come. `flow`: the plant makes copies now."""

    def __init__(self) -> None:
        self.flow = False
        self._expected: list[tuple[float, Command]] = []

    def expect(self, at: float, command: Command) -> None:
        """Expect a copy of a command that the plant has given."""
        self._forget(at)
        self._expected.append((at, without_id(command)))

    def take(self, at: float, command: Command) -> bool:
        """True if a command without an id is an expected copy; it is expected no more then.

        It is that of the latest equal command: a copy that never comes is expected no longer than COPY_S.
        """
        self._forget(at)
        for each in reversed(self._expected):
            if each[1] == command:
                self._expected.remove(each)
                return True
        return False

    def _forget(self, at: float) -> None:
        self._expected = [each for each in self._expected if each[0] + COPY_S > at]
