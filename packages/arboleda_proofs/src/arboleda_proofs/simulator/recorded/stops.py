"""Record of moves that reach the bridge before a stop or halt although the plant gave them after it.

`no_move_after_its_halt` finds by it a halt that overtakes its move on another topic.
"""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.drivers import Motion
from arboleda.model.messages import Heartbeat
from arboleda.wire.hop import FromPlant, is_stop

Number = tuple[int, int]  # the number of the plant's start, and that of the command in it


class EarlyStops:
    """Early stops; `overtaken` are sentences on such moves of this step. Messages of others have no order."""

    def __init__(self) -> None:
        self.overtaken: list[str] = []
        self._last: dict[str, Number] = {}

    def look(self, taken: Iterable[FromPlant], epoch: int) -> None:
        """Take in what the bridge took in, in its order; `epoch` is that of the running plant."""
        self.overtaken.clear()
        for command in (each.message for each in taken):
            if isinstance(command, Heartbeat):
                continue
            number = _number(command.id)
            if number is None or number[0] != epoch:
                continue
            if is_stop(command):
                self._last[command.robot] = max(number, self._last.get(command.robot, number))
            elif isinstance(command, Motion):
                self._judge(command, number)

    def _judge(self, command: Motion, number: Number) -> None:
        stopped = self._last.get(command.robot)
        if stopped is not None and number < stopped:
            what = f"{type(command).__name__} {command.id} reaches the bridge for {command.robot}"
            self.overtaken.append(f"{what} after its stop {stopped[0]}-{stopped[1]}")


def _number(id: str) -> Number | None:
    """The number in a command's id; None for a command of somebody else."""
    epoch, _, count = id.partition("-")
    return (int(epoch), int(count)) if epoch.isdigit() and count.isdigit() else None
