"""The commands of other nodes that a bridge has taken in, until people are told of them.

`commands_of_others_are_told` finds by it a bridge that refuses what others command, and tells nobody.
"""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.drivers import Command
from arboleda.rig.moment import BridgeStep
from arboleda.wire.hop import FromPlant
from arboleda.wire.rejections import ForeignCommand, Rejection

# for so long a command may turn out to be a copy of one of the plant's, or a copy to be a foreign command
UNSURE_S = 1.0


class ForeignCommands:
    """Commands of other nodes; `untold`: those of which nobody was told in time, in this step."""

    def __init__(self) -> None:
        self.untold: list[Command] = []
        self._waiting: list[tuple[float, Command]] = []  # until when each must be told
        self._bridge: object = None

    def look(self, passed: Iterable[BridgeStep], obeyed: list[Command]) -> None:
        """Take in what bridges did; what a bridge `obeyed` because it heard no plant need not be told."""
        self.untold.clear()
        for each in passed:
            if each.bridge is not self._bridge:
                self._bridge = each.bridge
                self._waiting.clear()
            for event in each.events:
                if not isinstance(event, FromPlant) or not event.sender or event.message in obeyed:
                    continue
                if isinstance(event.message, Command):
                    self._waiting.append((each.now + UNSURE_S, event.message))
            if self._waiting:
                self._tell(each)

    def _tell(self, passed: BridgeStep) -> None:
        for report in (each for each in passed.out if isinstance(each, Rejection | ForeignCommand)):
            first = next((each for each in self._waiting if each[1].robot == report.robot), None)
            if first is not None:
                self._waiting.remove(first)
        self.untold += [command for due, command in self._waiting if due <= passed.now]
        self._waiting = [each for each in self._waiting if each[0] > passed.now]
