"""The simulator gets everywhere: every kind of fault, and every branch that a run can take, fires."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest

from arboleda.dispatch import ledger
from arboleda.dispatch.ledger import Feed, State
from arboleda.model import cell_states
from arboleda.model.cell_states import Cause, CellState
from arboleda.model.messages import Reason, Verb
from arboleda.wire.payloads import REFUSALS
from arboleda_proofs.simulator.faults import OF_DEVICES, OF_PLACES, ON_ONE_HOST

from . import campaign

REASONS_THAT_CANNOT_BE = {
    Reason.INTERNAL: "it is a defect; an invariant forbids it",
    Reason.INTERRUPTED: "only a plant that is asked to end interrupts a task, and nobody here asks it",
    Reason.PRECONDITION: "no arm or mobile needs a fact before it is told something",
}
CELL_ROWS_THAT_CANNOT_BE = {
    (CellState.HOLDING, Cause.STUCK): "it is a defect; an invariant forbids it",
    (CellState.HELD, Cause.STUCK): "it is a defect; an invariant forbids it",
    (CellState.RESETTING, Cause.STOP): "a reset passes through that state within one event",
}
COMMAND_ROWS_THAT_CANNOT_BE = {
    (State.RUNNING, Feed.ACCEPTED): "what runs was accepted, and no rule of the evidence says that twice",
    (State.CANCELLING, Feed.CANCEL): "the dispatcher cancels once",
    (State.RUNNING, Feed.REJECTED): (
        "not provoked: a late copy of a move has to reach its board within the ramp of a halt by a stranger"
    ),
}
WORDS_THAT_CANNOT_BE = {
    "paro": "a board is stopped through the bridge, which then refuses by itself what it would have to send",
}
VERBS_THAT_CANNOT_BE = {
    Verb.ANSWER: "these plants have nobody to be asked",
    Verb.LOAD: "the cells of these plants have no places",
    Verb.DO: "no fault says it: people do it where it is advised",
}
FAULTS_THAT_CANNOT_BE = {
    **dict.fromkeys(OF_DEVICES, "these plants have no device of a declared kind"),
    **dict.fromkeys(OF_PLACES, "the cells of these plants have no places"),
}
BRANCHES = (
    *(f"recovery: {leaf}" for leaf in ("settle", "rise", "take zones", "part back", "holds nothing")),
    *(f"recovery: {leaf}" for leaf in ("move to pick-up", "effector off", "move to home")),
    "step: tried again",
    "step: gripped again",
    "latch: told again by the plant",
    "latch: told again by the bridge",
    "zone: quarantined",
    "zone: restored",
    "zone: overridden",
    "bridge: old_epoch",
    "bridge: no_link",
    "bridge: paro",
    "board: halts in silence",
)
# "bridge: raised its epoch" is for a board that heard a fresher sender: the simulator has none, by its rules.


def _expected() -> Iterable[str]:
    yield from BRANCHES
    yield from (f"task: {each.value}" for each in Reason if each not in REASONS_THAT_CANNOT_BE)
    said = [verb for verb in Verb if verb not in VERBS_THAT_CANNOT_BE]
    yield from (f"verb: {verb.value} {end}" for verb in said for end in ("done", "refused"))
    yield from (f"board: {word}" for word in sorted(REFUSALS) if word not in WORDS_THAT_CANNOT_BE)


@pytest.mark.timeout(600)
def test_everything_that_can_happen_happens(monkeypatch: pytest.MonkeyPatch) -> None:
    cells = [row for row in cell_states.TABLE if row not in CELL_ROWS_THAT_CANNOT_BE]
    commands = [row for row in ledger.TABLE if row not in COMMAND_ROWS_THAT_CANNOT_BE]

    def never(fired: campaign.Fired) -> dict[str, list[Any]]:
        missing = {
            "faults": [
                kind for kind in ON_ONE_HOST if not fired.kinds[kind] and kind not in FAULTS_THAT_CANNOT_BE
            ],
            "branches": [name for name in _expected() if not fired.probes[name]],
            "rows of cells": [row for row in cells if not fired.cells.fired[row]],
            "rows of commands": [row for row in commands if not fired.commands.fired[row]],
        }
        return {family: names for family, names in missing.items() if names}

    fired = campaign.run(monkeypatch, enough=lambda fired: not never(fired))
    assert not never(fired), f"never fired: {never(fired)}"
