"""Verbs that are carried out cell by cell, and the act of an operator that is being done."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial, reduce

from arboleda.dispatch.ledger import Entry
from arboleda.model.advice import OR
from arboleda.model.cell_states import CellState
from arboleda.model.errors import IllegalTransition
from arboleda.model.messages import OperatorRequest
from arboleda.model.sentence import Phrase, Sentence

from ..cell import CellRun
from .scopes import VerbRefusal

OTHER_STATE = Phrase("refusal.other_state", "{cell} is {state}; this needs a cell that is {allowed}")
BROKE = Phrase("act.broke", "{cell} failed on an internal error meanwhile; the log has its details")
AT_REST = (CellState.IDLE, CellState.HELD)

Check = Callable[[CellRun, frozenset[str]], "Sentence | None"]
Do = Callable[[CellRun, frozenset[str]], None]
Plan = Callable[[OperatorRequest, str], Callable[[], None]]
"""Makes the function that carries out a request on a scope; VerbRefusal where something speaks against it."""


class Doing:
    """The act that is being done: commands that were sent for it, and cells that broke down in it."""

    def __init__(self, broke: Callable[[str, Exception], None]) -> None:
        self.sent: list[Entry] = []
        self.defects: list[Sentence] = []
        self._broke = broke

    def begin(self) -> None:
        self.sent, self.defects = [], []

    def do(self, act: Do, cell: CellRun, robots: frozenset[str]) -> None:
        """Do an act in one cell. A cell that breaks down must not keep the others from a stop."""
        try:
            act(cell, robots)
        except (VerbRefusal, IllegalTransition):
            raise
        except Exception as error:  # noqa: BLE001 - whatever it is, it ends the work of this cell, not the plant
            self.defects.append(BROKE(cell=cell.cell.name))
            self._broke(cell.cell.name, error)


def always(cell: CellRun, robots: frozenset[str]) -> Sentence | None:
    """Nothing speaks against it."""
    return None


class CellByCell:
    """A verb that is carried out cell by cell: `do` in each cell in which `check` finds no refusal.

    `first` is done in all cells before `do` in any: so all robots are latched before any cell ends its task.
    A cell that refuses is left out; if it is in a state of `must_all`, nothing is done in any cell.
    """

    def __init__(
        self,
        doing: Doing,
        *,
        check: Check = always,
        do: Do,
        first: Do | None = None,
        must_all: tuple[CellState, ...] = (),
    ) -> None:
        self._doing = doing
        self._check = check
        self._acts = [do] if first is None else [first, do]
        self._must_all = must_all

    def planned(self, robots: frozenset[str], cells: list[CellRun]) -> Callable[[], None]:
        """The function that carries the verb out; VerbRefusal where that can be done nowhere."""
        refusals = {}
        for cell in cells:
            if (why := self._check(cell, robots)) is not None:
                refusals[cell.cell.name] = why
        firm = [
            cell.cell.name for cell in cells if cell.state in self._must_all and cell.cell.name in refusals
        ]
        if firm or len(refusals) == len(cells):
            raise VerbRefusal(refusals[firm[0]] if firm else next(iter(refusals.values())))
        return partial(self._do, [cell for cell in cells if cell.cell.name not in refusals], robots)

    def _do(self, cells: list[CellRun], robots: frozenset[str]) -> None:
        for act in self._acts:
            for cell in cells:
                self._doing.do(act, cell, robots)


def in_states(*states: CellState) -> Check:
    """The check that a cell is in one of these states."""
    first, *others = (state.sentence for state in states)
    allowed = reduce(lambda before, other: OR(first=before, second=other), others, first)

    def check(cell: CellRun, robots: frozenset[str]) -> Sentence | None:
        if cell.state in states:
            return None
        return OTHER_STATE(cell=cell.cell.name, state=cell.state.sentence, allowed=allowed)

    return check


at_rest = in_states(*AT_REST)
