"""The conformance kit on devices of declared kinds: good boards pass, bad ones fail by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from arboleda.kinds.declared import Device
from arboleda.model.plant_model import Evidence
from arboleda.plant_file.loader import load
from arboleda.sim.board import Board
from arboleda.sim.machine import MachineBody
from arboleda.wire.payloads import Goal, StopGoal, VerbGoal
from arboleda.wire.transport import Delivery
from arboleda_boards.conformance.judge import DEVICE_CHECKS, Judge

from .conformance_trial import Trial, wrong

EXAMPLES = Path(__file__).parents[4] / "examples"


@cache
def device(example: str, name: str) -> Device:
    found = load(EXAMPLES / example / "plant.yaml").robots[name]
    assert isinstance(found, Device)
    return found


def trial(
    kind: Callable[..., Board] = Board, body: Callable[..., MachineBody] = MachineBody, **declared: Any
) -> Judge:
    valve = replace(device("own_board", "valve"), **declared)
    return Trial(valve, kind(valve, body(valve.kind), boot_id=9, now_us=1_000_000_000)).run()


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("example", "name"), [("own_board", "valve"), ("lab_bench", "heater"), ("machine_tending", "mill")]
)
def test_the_virtual_board_of_a_device_passes_at_the_top(example: str, name: str) -> None:
    robot = device(example, name)
    judge = Trial(robot, Board(robot, MachineBody(robot.kind), boot_id=9, now_us=1_000_000_000)).run()
    assert wrong(judge) == {}
    assert [finding.check.name for finding in judge.findings] == [check.name for check in DEVICE_CHECKS]
    assert judge.reached is Evidence.IDS


def test_every_check_is_made_on_a_device_with_all_effects() -> None:
    assert [finding.check.name for finding in trial().findings if finding.untried] == []


def test_a_device_without_numbers_reaches_facts() -> None:
    judge = trial(evidence=Evidence.JOINTS)
    assert wrong(judge) == {}
    assert judge.reached is judge.spoken is Evidence.JOINTS


def test_a_device_that_says_only_its_code_reaches_state() -> None:
    judge = trial(evidence=Evidence.STATE)
    assert wrong(judge) == {}
    assert judge.reached is judge.spoken is Evidence.STATE


class Forgetful(Board):
    """Obeys old numbers as well."""

    def _obey(self, goal: Goal) -> None:
        last = (self._receipts.epoch or 0, self._receipts.accepted or 0)
        old = isinstance(goal, VerbGoal) and goal.seq is not None and (goal.epoch, goal.seq) < last
        if old and not self._receipts.repeats(goal) and self._refusal(goal) is None:
            self._accept(goal)
        else:
            super()._obey(goal)


class OneCopy(Board):
    """Knows only the last command again."""

    def _boot(self, boot_id: int, *, homed: bool) -> None:
        self._knows = 1
        super()._boot(boot_id, homed=homed)


class Eager(Board):
    """Takes what a broker kept for an order of now."""

    def receive(self, now_us: int, delivery: Delivery) -> None:
        super().receive(now_us, delivery._replace(retain=False))


class Deaf(Board):
    """Does not mind whether anybody beats."""

    def _hear(self, beat: object) -> None:
        pass


class Unlatched(Board):
    """Stops, and forgets that it should stay so."""

    def _stop(self, *, latch: bool) -> None:
        super()._stop(latch=False)


class Boastful(Board):
    """Says done for whatever has come to rest."""

    def _break_off(self, word: str | None = None) -> None:
        job = self._job
        super()._break_off(word)
        if job is not None:
            self._receipts.finish(job)


class Unhalting(Board):
    """Obeys a halt only with good numbers."""

    def _obey(self, goal: Goal) -> None:
        if isinstance(goal, StopGoal) and goal.epoch == 1:
            self._refuse("viejo", goal.seq, goal.epoch)
        else:
            super()._obey(goal)


class Patient(Board):
    """Does not mind how long an order waited on its way."""

    def _refusal(self, goal: Goal) -> str | None:
        return super()._refusal(replace(goal, heard=None) if isinstance(goal, VerbGoal) else goal)


class Obliging(MachineBody):
    """Does what it is told, whatever has to be so before."""

    def objection(self, goal: VerbGoal, *, latched: bool, faulted: bool) -> str | None:
        word = super().objection(goal, latched=latched, faulted=faulted)
        return None if word == "condicion" else word


class Lenient(MachineBody):
    """Overlooks values that its verb does not have."""

    def command(self, goal: VerbGoal) -> Any:
        verb = self.kind.verbs.get(goal.verb)
        known = dict(verb.parameters) if verb else {}
        values = tuple((name, value) for name, value in goal.values if name in known)
        return super().command(replace(goal, values=values))


def idle(kind: Any) -> MachineBody:
    """Says that its work is done, and does nothing."""
    body = MachineBody(kind)
    body.does = lambda goal: False
    return body


BAD = [
    pytest.param({"kind": Forgetful}, {"old", "old epoch"}, Evidence.JOINTS, id="obeys old numbers"),
    pytest.param({"kind": OneCopy}, {"duplicate"}, Evidence.JOINTS, id="knows one copy"),
    pytest.param({"kind": Eager}, {"retained"}, Evidence.JOINTS, id="obeys retained"),
    pytest.param(
        {"kind": Deaf}, {"silence", "beaten off", "far future"}, Evidence.JOINTS, id="deaf to beats"
    ),
    pytest.param({"kind": Unlatched}, {"latch"}, Evidence.JOINTS, id="no latch"),
    pytest.param(
        {"kind": Boastful}, {"halted", "stop from anybody", "silence"}, Evidence.JOINTS, id="done when halted"
    ),
    pytest.param({"kind": Unhalting}, {"stop from anybody"}, Evidence.JOINTS, id="no halt from others"),
    pytest.param({"kind": Patient}, {"late"}, Evidence.JOINTS, id="takes what has waited"),
    pytest.param({"body": Obliging}, {"needs"}, Evidence.JOINTS, id="minds no condition"),
    pytest.param({"body": Lenient}, {"unknown", "words"}, Evidence.STATE, id="overlooks values"),
]


@pytest.mark.sampled(2)
@pytest.mark.parametrize(("how", "names", "level"), BAD)
def test_a_bad_board_of_a_device_fails_by_name(how: Any, names: set[str], level: Evidence) -> None:
    judge = trial(**how)
    assert set(wrong(judge)) == names, wrong(judge)
    assert judge.reached is level


def test_a_device_that_only_says_that_it_works_reaches_no_more_than_that() -> None:
    judge = trial(body=idle)
    assert "what that sets is not so" in wrong(judge)["numbers"]
    assert judge.reached is Evidence.STATE
