"""Last answers: what devices answered to the questions of each cell's tasks."""

from __future__ import annotations

from arboleda.drivers import Value

from .ended_commands import EndedCommand


class LastAnswers:
    """The last answer of each device to each query of each cell.

    It is the answer that counted: `an_answer_is_to_its_question` judges that the device gave it.
    """

    def __init__(self) -> None:
        self._last: dict[tuple[str, str], tuple[float, Value]] = {}  # when it was asked, s, and the answer

    def take(self, booked: EndedCommand) -> None:
        """Take in a query that has ended."""
        entry, command = booked.entry, booked.command
        if booked.done and entry.answer is not None:
            self._last[entry.cell, f"{command.robot}.{command.word}"] = booked.sent_at, entry.answer

    def since(self, began: float, cell: str) -> dict[str, Value]:
        """The last answers, as of `camera.look`, to what a cell asked since `began`, in s."""
        return {
            what: answer
            for (asker, what), (asked_at, answer) in self._last.items()
            if asker == cell and asked_at >= began
        }
