"""Output that is the effector of an arm."""

from __future__ import annotations

from arboleda.drivers import NotSent, SetEffector
from arboleda_drivers.connections.receipts import Receipts

from . import programs
from .dashboard import LOCAL, Dashboard
from .primary import READ_ONLY, ScriptError
from .programs import ProgramPort
from .rtde import Frame

SWITCH_S = 1.0  # an output that has not followed by then does not


class Output:
    """Output of this number, which should switch while there is a command for it."""

    def __init__(
        self, number: int | None, port: ProgramPort, dashboard: Dashboard, receipts: Receipts
    ) -> None:
        self._number, self._port, self._dashboard, self._receipts = number, port, dashboard, receipts
        self._command: SetEffector | None = None
        self._sent_at = 0.0

    def switch(self, now: float, command: SetEffector) -> None:
        if self._number is None:
            raise NotSent("it has no output in the plant file")
        if not self._dashboard.rejects(command.id):
            self._command, self._sent_at = command, now
            self._port.run(programs.switch(self._number, on=command.on))

    def is_on(self, frame: Frame) -> bool | None:
        return None if self._number is None else bool(frame.outputs >> self._number & 1)

    def see(self, now: float, frame: Frame) -> None:
        """Find the end of a switch in a frame."""
        command = self._command
        if command is None:
            return
        if self.is_on(frame) is command.on:
            self._command = None
            self._receipts.tell(accepted=command.id)
        elif now - self._sent_at > SWITCH_S:
            # It has left: what takes effect later is still this command's.
            self._receipts.tell(failed=command.id, failure="output_does_not_follow")
            self._command = None

    def refuse(self, error: ScriptError) -> None:
        """Take the controller's error about the program of a switch, if one is under way."""
        self._reject(LOCAL if error.code == READ_ONLY else f"program_refused {error.text}")

    def forget(self) -> None:
        """Forget a switch: the controller was switched on anew."""
        self._command = None

    def _reject(self, word: str) -> None:
        if self._command is not None:
            self._receipts.reject(self._command.id, word)
        self._command = None
