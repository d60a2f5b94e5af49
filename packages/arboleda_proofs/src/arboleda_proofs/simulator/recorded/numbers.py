"""Numbers under which commands left for one board: each the one after the last."""

from __future__ import annotations

import json
from collections import OrderedDict
from typing import Any

from arboleda.drivers import Report
from arboleda.wire.transport import Publication

KEPT = 200  # numbers of a board, fewer than the bridge remembers


class KnownNumbers:
    """Commands behind the numbers of one board.

    `last` is the last number; `given` are those of this step, each with the number of commands that came
    before it in the step; `refused` are the commands with the words that refused them. `are_used`: the board
    has numbers at all.
    """

    def __init__(self, *, are_used: bool) -> None:
        self.are_used = are_used
        self.last = 0
        self.given: dict[tuple[int, int], int] = {}
        self.refused: set[tuple[str, str]] = set()
        self._commands: OrderedDict[tuple[int, int], str] = OrderedDict()  # (epoca, seq) -> command

    def give(self, command_id: str, publication: Publication, place: int) -> str:
        """Take in the number of a command, "" where nobody gave one; a sentence if it is not the next."""
        if not self.are_used:
            return ""
        body = json.loads(publication.payload)
        number = (body.get("epoca"), body.get("seq"))
        self.last += 1
        self._commands[number], self.given[number] = command_id, place
        if len(self._commands) > KEPT:
            self._commands.popitem(last=False)
        if number[1] == self.last:
            return ""
        return f"{publication.topic} has the number {number[1]} after {self.last - 1}"

    def names(self, report: Report, fields: dict[str, Any], place: int) -> bool:
        """True if a report names the commands of the board's numbers, as they were after `place` commands."""
        if not self.are_used:
            return report.accepted is None and report.done is None
        epoch, named = fields.get("epoca_ack"), []
        for key in ("ack", "hecho", "rechazo_seq"):
            number: tuple[Any, Any] = (epoch, fields.get(key))
            named.append(self._commands.get(number) if self.given.get(number, -1) < place else None)
        accepted, done, rejected = named
        if report.accepted != (accepted or None) or report.done != (done or None):
            return False
        if report.rejected is None:
            return True
        word = fields.get("rechazo")
        if word == "viejo" or (rejected == report.rejected and word == report.refusal):
            self.refused.add((report.rejected, report.refusal or ""))
        return (report.rejected, report.refusal) in self.refused
