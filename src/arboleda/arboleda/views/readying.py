"""Way back to work of a cell, or of the whole plant: the next act, from the rows of a snapshot alone."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import takewhile
from typing import Any

from arboleda.model.advice import Hand
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Outcome, Verb
from arboleda.model.sentence import Sentence

Row = dict[str, Any]
UNREPORTED = (Hand.CHECK, Hand.REFERENCE)  # a person says that it is done, by the verb that follows
TOLD = {Hand.TAKE_OUT: Verb.UNLOAD, Hand.PUT_IN: Verb.LOAD, Hand.LEAVE_IN: Verb.LOAD}
"""Work of a hand that a verb tells the plant, with the place behind the cell in its scope."""
FIRST = (Verb.STOP, Verb.CLEAR, Verb.RESET)
LAST = (Verb.RESUME, Verb.RETRY, Verb.ABANDON)  # robots go to work once all are ready


@dataclass(frozen=True, kw_only=True)
class Due:
    """The next act on the way back to work.

    `advice`: the row of the verb to give, or of work that only a hand can do; None while the plant itself
    gets on. `before`: rows of work of a hand that has to be done first. `why`: what it waits for, as the end
    of work where the cell is `at_work`.
    """

    advice: Row | None = None
    before: tuple[Row, ...] = ()
    why: Sentence | str | None = None
    at_work: bool = False

    @property
    def is_act(self) -> bool:
        """True where a verb is due."""
        return self.advice is not None and not self.advice["hand"]

    @property
    def turn(self) -> int:
        """Its place among what is due in several cells; work of a hand in one holds up no other."""
        later = len(FIRST)
        if self.advice is None:
            return later + (3 if self.at_work else 1)
        do = self.advice["do"]
        if self.advice["hand"]:
            return later + 4
        return FIRST.index(do) if do in FIRST else later + (2 if do in LAST else 0)


def due_in_cell(snapshot: Row, cell: Row) -> Due | None:
    """The next act in a cell; None where it works, can work, or is taught."""
    if cell["teaching"]:
        return None
    if cell["state"] == CellState.EXECUTE:  # after a retry or a recovery its queue still waits for somebody
        return Due(why=cell["step"], at_work=True) if cell["paused"] else None
    if (act := _under_way(snapshot, cell)) is not None:
        return Due(why=act["sentence"])
    if not cell["advice"]:
        is_ready = cell["state"] == CellState.IDLE and cell["not_ready"] is None
        return None if is_ready else Due(why=cell["held_by"] or cell["not_ready"])
    return _first(cell["advice"])


def due_in_plant(snapshot: Row) -> Due | None:
    """The next act in any cell; `resume` for all cells at once where no other cell would take it."""
    dues = [due for cell in snapshot["cells"] if (due := due_in_cell(snapshot, cell)) is not None]
    first = min(dues, key=lambda due: due.turn, default=None)
    if first is None or first.advice is None or first.advice["do"] != Verb.RESUME:
        return first
    together = [due.advice for due in dues if due.advice is not None and due.advice["do"] == Verb.RESUME]
    takes_it = [cell["name"] for cell in snapshot["cells"] if Verb.RESUME not in cell["refused"]]
    if len(together) < 2 or {each["scope"] for each in together} != set(takes_it):
        return first
    moves = [robot for each in together for robot in each["moves"]]
    return Due(advice={**first.advice, "scope": "", "moves": list(dict.fromkeys(moves))})


def _first(ways: list[Row]) -> Due:
    """The first of the advice; what nobody can report, with the verb behind it that says so."""
    before = [*takewhile(lambda way: way["hand"] and way["do"] in UNREPORTED, ways)]
    behind = ways[len(before) : len(before) + 1]
    if before and (not behind or behind[0]["instead"] or behind[0]["hand"]):
        return Due(advice=before[0])
    advice = behind[0]
    if advice["refusal"] is not None:
        return Due(why=advice["refusal"])
    if advice["do"] in TOLD:
        return Due(advice=told(advice), before=(advice,))
    return Due(advice=advice, before=(*before,))


def told(advice: Row) -> Row:
    """The verb that tells the plant of work of a hand that is done."""
    cell, _, place = advice["scope"].partition(" ")
    verb = TOLD[Hand(advice["do"])]
    return {**advice, "do": verb.value, "hand": False, "scope": cell, "arguments": {"place": place}}


def _under_way(snapshot: Row, cell: Row) -> Row | None:
    """The act of an operator in this cell that devices carry out now."""
    here = (act for act in snapshot["acts"] if act["cell"] == cell["name"])
    return next((act for act in here if act["outcome"] == Outcome.UNDER_WAY), None)
