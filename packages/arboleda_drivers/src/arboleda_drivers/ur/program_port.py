"""Port of programs: each has a number of its own, and a stop is a program, too."""

from __future__ import annotations

from typing import Any

from .port_data import PRIMARY, Send
from .programs import LAST_NUMBER
from .rtde import Frame


class ProgramPort:
    """Port to which programs are sent, whatever connection there is."""

    def __init__(self, out: list[Any]) -> None:
        self._out = out
        self._number = 0  # of the last program

    def run(self, program: str) -> None:
        self._out.append(Send(port=PRIMARY, data=program.encode()))

    def next_number(self, frame: Frame | None) -> int:
        """A number that no driver has given since the controller was switched on; `frame` is its last one."""
        if frame is None:
            self._number += 1
        else:
            self._number = max(self._number, frame.begun, frame.done, 0) % LAST_NUMBER + 1
        return self._number
