"""Needs across the devices of a cell: facts that another device has to report before a verb may leave."""

from __future__ import annotations

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.commands import Command
from arboleda.model.facts import shown
from arboleda.model.messages import Failure, Reason
from arboleda.model.plant_model import Cell, Need
from arboleda.model.sentence import Phrase, Sentence

NEEDS = Phrase("need.other", "{robot} needs {fact} of {other} to be {value}, and {other} said {told}")
UNSAID = Phrase("need.unsaid", "{robot} needs {fact} of {other} to be {value}, and {other} does not say it")
SILENT = Phrase("need.silent", "{robot} needs {fact} of {other} to be {value}, and {other} was not heard")
CHANGING = Phrase(
    "need.changing", "{robot} needs {fact} of {other} to be {value}, and {other} was told to change that"
)


class CellNeeds:
    """Guard of one cell: objects to a command whose needs other devices do not report as met."""

    def __init__(self, cell: Cell, dispatcher: Dispatcher) -> None:
        self._dispatcher = dispatcher
        self._needs: dict[tuple[str, str], list[Need]] = {}
        for need in cell.needs:
            self._needs.setdefault((need.device, need.word), []).append(need)

    def objection(self, command: Command) -> Failure | None:
        """The failure for the first need of a command that is not met."""
        unmet = filter(None, map(self._unmet, self._needs.get((command.robot, command.word), ())))
        sentence = next(unmet, None)
        return None if sentence is None else Failure(reason=Reason.PRECONDITION, sentence=sentence)

    def _unmet(self, need: Need) -> Sentence | None:
        reported = self._dispatcher.beliefs[need.other].fact(need.fact)
        robot, fact, other, value = need.device, need.fact, need.other, shown(need.value)
        if not self._dispatcher.beliefs[other].online:
            return SILENT(robot=robot, fact=fact, other=other, value=value)
        if reported is None:
            return UNSAID(robot=robot, fact=fact, other=other, value=value)
        if reported != need.value:
            return NEEDS(robot=robot, fact=fact, other=other, value=value, told=shown(reported))
        if self._is_changing(need):
            return CHANGING(robot=robot, fact=fact, other=other, value=value)
        return None

    def _is_changing(self, need: Need) -> bool:
        """True while the other device has a command that would end what is needed."""
        commands = (entry.command for entry in self._dispatcher.ledger.of_robot(need.other))
        return any(dict(each.sets).get(need.fact, need.value) != need.value for each in commands)
