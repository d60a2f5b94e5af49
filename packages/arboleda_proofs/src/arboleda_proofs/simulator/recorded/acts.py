"""Acts of operators on each cell since it worked last, as long as nothing else happened to it.

`advice_leads_out` finds by it a cell that is advised to retry for ever, after a reboot.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from arboleda.engine.inspection import Task, teaching_of
from arboleda.model.cell_states import CellState
from arboleda.model.messages import OperatorRequest, Verb
from arboleda.model.verbs import as_text

from .cells import KnownCell


class Acts:
    """Acts of operators, in words by cell; forgotten once the cell works, and at a fault anywhere."""

    def __init__(self) -> None:
        self.of: dict[str, list[str]] = {}
        self._had: dict[str, Task | None] = {}
        self._last_fault_at = -math.inf

    def look(self, cells: dict[str, KnownCell], *, last_fault_at: float, faults: int) -> None:
        """Forget what is over; called after every step of the plant."""
        if faults or last_fault_at != self._last_fault_at:
            self._last_fault_at = last_fault_at
            self.of.clear()
        for name in [name for name in self.of if self._works(cells[name])]:
            del self.of[name]

    def take(self, request: OperatorRequest, cells: Iterable[KnownCell], *, is_refused: bool) -> None:
        """Note that somebody asks for something on these cells.

        An answer is none of them: it ends its question, and a recipe may ask any number of them. Nor is what
        begins and ends manual mode. A refused act counts where it was done before: advice that is given again
        and again leads nowhere.
        """
        if request.verb is Verb.ANSWER or request.verb.row.mode:
            return
        of = as_text(request.verb, request.scope, request.arguments)
        line = f"{request.verb.value} {of}{' --by-hand' if request.by_hand else ''}"
        for cell in cells:
            known = self.of.get(cell.name)
            if is_refused and line not in (known or ()):
                continue
            if known is None:
                self._had[cell.name] = cell.run.task
            self.of.setdefault(cell.name, []).append(line)

    def _works(self, cell: KnownCell) -> bool:
        """True if a cell would start a task, or works on another one than at the first noted act."""
        run = cell.run
        if teaching_of(run) is not None:  # as its teacher wants it to be
            return True
        if run.state is CellState.IDLE:
            return run.not_ready is None
        return run.state is CellState.EXECUTE and run.task not in (None, self._had[cell.name])
