"""Which of the commands without an id are only copies of what the plant has said with one."""

from __future__ import annotations

from arboleda.model.commands import Command

from .hop import without_id

COPY_S = 5.0  # after its original a copy comes at once, or as late as a lossy network repeats it


class Copies:
    """Those of one robot; `expected` are still to come. `flow`: whether the plant makes any now."""

    def __init__(self) -> None:
        self.flow = False
        self._expected: list[tuple[float, Command]] = []

    def expect(self, at: float, command: Command) -> None:
        """The plant has given this command, and a copy of it is to come."""
        self._forget(at)
        self._expected.append((at, without_id(command)))

    def take(self, at: float, command: Command) -> bool:
        """Whether a command without an id is one of those to come, which it then is no more."""
        self._forget(at)
        for each in self._expected:
            if each[1] == command:
                self._expected.remove(each)
                return True
        return False

    def _forget(self, at: float) -> None:
        self._expected = [each for each in self._expected if each[0] + COPY_S > at]
