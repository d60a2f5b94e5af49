"""Tasks at work are held before a planned change of leaders, and go on after it."""

from __future__ import annotations

from concurrent.futures import Future
from itertools import count
from types import SimpleNamespace
from typing import Any

import pytest
from tests.threads import AtOnce, stand_in

from arboleda.adapters import clock
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import OperatorAnswer, Verb
from arboleda.model.sentence import OWN
from arboleda.store.lead import Superseded
from arboleda.store.plant_memory import PlantMemory
from arboleda_fleet.standby import handover
from arboleda_fleet.standby import lease as lease_part
from arboleda_fleet.standby.handover import CellResumption, hold_all
from arboleda_fleet.standby.lease import LeasePart


class Plant:
    """Cells that are held as soon as somebody has looked twice, and are resumed the third time."""

    def __init__(self, **states: str) -> None:
        self.states = states
        self.said: list[tuple[Verb, str]] = []
        self.looks = 0
        self.screens = SimpleNamespace(snapshot=self._snapshot)

    def operate(self, verb: Verb, scope: str = "") -> Future[OperatorAnswer]:
        self.said.append((verb, scope))
        refusal = None
        if verb is Verb.HOLD:
            self.states[scope] = "holding"
        elif len(self.said) < 3:
            refusal = OWN(text="its robots are not heard")
        answer: Future[OperatorAnswer] = Future()
        answer.set_result(OperatorAnswer(request="", verb=verb, scope=scope, refusal=refusal))
        return answer

    def _snapshot(self) -> dict[str, Any]:
        self.looks += 1
        if self.looks > 3:
            self.states = {
                name: "held" if state == "holding" else state for name, state in self.states.items()
            }
        return {"cells": [{"name": name, "state": state} for name, state in self.states.items()]}


@pytest.fixture(autouse=True)
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing pauses, and a second passes from each look at the clock to the next."""
    monkeypatch.setattr(handover, "LOOK_S", 0.0)
    monkeypatch.setattr(clock, "seconds", count(1.0).__next__)
    for module in (handover, lease_part):
        stand_in(module, AtOnce, monkeypatch)


def test_what_is_at_work_is_held_until_it_stands_and_nothing_else() -> None:
    plant = Plant(a="execute", b="idle", c="held", d="aborted")
    assert hold_all(plant) == ["a"]
    assert plant.said == [(Verb.HOLD, "a")] and plant.states["a"] == "held"


def test_what_was_held_for_the_change_goes_on_once_that_is_possible() -> None:
    plant = Plant(a="held", b="held")
    part = CellResumption(plant, ["a"], 7)
    part.start()
    part.stop()
    assert plant.said == [(Verb.RESUME, "a")] * 3


def test_what_cannot_go_on_stays_held_and_is_named(
    caplog: pytest.LogCaptureFixture,
) -> None:
    plant = Plant(a="held")
    plant.operate = lambda verb, scope="": _refused(verb, scope)  # type: ignore[method-assign]
    part = CellResumption(plant, ["a"], 7)
    part.start()
    part.stop()
    assert "a stays held after the change of leaders: its robots are not heard" in caplog.text


def _refused(verb: Verb, scope: str) -> Future[OperatorAnswer]:
    answer: Future[OperatorAnswer] = Future()
    refusal = OWN(text="its robots are not heard")
    answer.set_result(OperatorAnswer(request="", verb=verb, scope=scope, refusal=refusal))
    return answer


class Memory:
    """Answers to `renew`, one after the other."""

    def __init__(self, *answers: bool | ArboledaError) -> None:
        self._answers = list(answers)
        self.closed = False
        self.lead = SimpleNamespace(renew=self._renew)

    def _renew(self) -> bool:
        answer = self._answers.pop(0) if len(self._answers) > 1 else self._answers[0]
        if isinstance(answer, ArboledaError):
            raise answer
        return answer

    def close(self) -> None:
        self.closed = True


def lease(memory: Any, calls: list[str]) -> LeasePart:
    store: PlantMemory = memory
    return LeasePart(
        store, 0.001, lambda name, error: calls.append(str(error)), lambda: calls.append("handed over")
    )


def test_a_leader_that_is_superseded_ends_the_plant() -> None:
    calls: list[str] = []
    part = lease(Memory(False, Superseded("Another process leads.")), calls)
    part.start()
    part.stop()
    assert calls == ["Another process leads."]


def test_a_database_that_is_away_for_a_moment_ends_nothing_and_a_wish_is_followed_once(
    caplog: pytest.LogCaptureFixture,
) -> None:
    calls: list[str] = []
    away, over = ArboledaError("It is away."), Superseded("It is over.")
    memory = Memory(away, away, True, True, over)
    part = lease(memory, calls)
    part.start()
    part.stop()
    assert calls == ["handed over", "It is over."] and memory.closed
    assert caplog.text.count("It is away.") == 1 and "the store is reached again" in caplog.text
