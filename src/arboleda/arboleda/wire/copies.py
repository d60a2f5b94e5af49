"""Copies, without an id, of commands that the plant has sent with an id.

A plant over ROS 2 publishes each command twice, the second time for nodes that know no ids. The bridge must
carry it out once. A copy is known by its values and its time alone, and may overtake its original.
"""

from __future__ import annotations

from arboleda.model.commands import Command

from .hop import without_id

COPY_S = 5.0  # so late after its original a copy may come over a network that loses and repeats messages


class Copies:
    """Copies that are expected for one robot; `flow`: the plant sends copies at present."""

    def __init__(self) -> None:
        self.flow = False
        self._expected: list[tuple[float, Command]] = []

    def expect(self, at: float, command: Command) -> None:
        """Expect a copy of a command that the plant has given."""
        self._forget(at)
        self._expected.append((at, without_id(command)))

    def take(self, at: float, command: Command) -> bool:
        """True if a command without an id is an expected copy, which is then removed.

        Of equal commands, the latest one counts: the copy of an earlier one may be lost.
        """
        self._forget(at)
        for each in reversed(self._expected):
            if each[1] == command:
                self._expected.remove(each)
                return True
        return False

    def _forget(self, at: float) -> None:
        self._expected = [each for each in self._expected if each[0] + COPY_S > at]
