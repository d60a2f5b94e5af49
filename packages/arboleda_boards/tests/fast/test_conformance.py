"""The conformance kit: good boards pass at their level, bad ones fail by name; time moved by hand."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from arboleda.kinds.arm import Arm
from arboleda.kinds.joints import Joint
from arboleda.model.commands import StopMode
from arboleda.model.plant_model import Evidence
from arboleda.sim.arm import ArmBody
from arboleda.sim.board import Board
from arboleda.sim.body import BodyReport
from arboleda.sim.motors import Motors
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire.payloads import Beat, EffectorGoal, Goal, HomeGoal, JointsGoal, StopGoal, Telemetry
from arboleda.wire.transport import Delivery, Publication
from arboleda_boards.conformance.judge import CHECKS, Judge

from .conformance_trial import Trial, wrong

NEVER_TOLD = 50_000  # reports: a trial takes 10 minutes
PLANT = shipped("sis_a", "sis_c")


def trial(kind: Callable[..., Board] = Board, cell: str = "sis_a", **declared: Any) -> Judge:
    arm = replace(StorageLayout(PLANT.cell(cell)).arm, **declared)
    board = kind(arm, ArmBody(arm, start=arm.reference, pickups=()), boot_id=9, now_us=1_000_000_000)
    return Trial(arm, board).run()


@pytest.mark.parametrize("cell", ["sis_a", "sis_c"], ids=["scara", "cr10a"])
def test_the_virtual_board_passes_at_the_top(cell: str) -> None:
    judge = trial(cell=cell)
    assert wrong(judge) == {}
    assert [finding.check.name for finding in judge.findings] == [check.name for check in CHECKS]
    assert [finding.untried for finding in judge.findings if finding.untried] == []
    assert judge.reached is Evidence.IDS


def test_a_board_without_numbers_reaches_joints() -> None:
    judge = trial(evidence=Evidence.JOINTS)
    assert wrong(judge) == {}
    assert judge.reached is judge.spoken is Evidence.JOINTS


def test_a_board_that_is_not_homed_is_homed_first() -> None:
    def not_homed(*args: Any, **how: Any) -> Board:
        board = Board(*args, **how)
        board.homed = False
        return board

    assert trial(not_homed).reached is Evidence.IDS


class OnlyCodes(Board):
    """Says its code and nothing else."""

    def take(self) -> list:
        said = super().take()
        return [sent._replace(payload=_code(sent.payload)) for sent in said]


def _code(payload: bytes) -> bytes:
    at = payload.find(b'"estado":')
    return b"{" + payload[at : at + 10] + b"}" if at >= 0 else payload


class Forgetful(Board):
    """Obeys old numbers as well."""

    def _obey(self, goal: Goal) -> None:
        last = (self._receipts.epoch or 0, self._receipts.accepted or 0)
        old = isinstance(goal, JointsGoal) and goal.seq is not None and (goal.epoch, goal.seq) < last
        if old and self._refusal(goal) is None:
            self._accept(goal)
        else:
            super()._obey(goal)


class Truncating(Motors):
    """Cuts targets off to whole motor steps."""

    def steps(self, q: tuple[float, ...]) -> tuple[int, ...]:
        return tuple(_cut(joint, value) for joint, value in zip(self._joints, q, strict=True))


def _cut(joint: Joint, value: float) -> int:
    return math.trunc(value / joint.step + math.copysign(0.05, value))


class Eager(Board):
    """Takes what a broker kept for a command of now."""

    def receive(self, now_us: int, delivery: Delivery) -> None:
        super().receive(now_us, delivery._replace(retain=False))


class Deaf(Board):
    """Does not mind whether anybody beats."""

    def _hear(self, beat: object) -> None:
        pass


class Unfenced(Board):
    """Hears that somebody else commands now, and says so, but obeys who commanded before."""

    def _obey(self, goal: Goal) -> None:
        overtaken = goal.epoch == self._receipts.epoch != self._receipts.least
        if overtaken and goal.seq > (self._receipts.accepted or 0):
            self._accept(goal)
        else:
            super()._obey(goal)


class Gullible(Board):
    """Believes a beat of any epoch."""

    def _hear(self, beat: Beat) -> None:
        self._receipts.hear(beat.epoch)
        self._receipts.least = beat.epoch
        super()._hear(beat)


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


class Believing(Board):
    """Takes a damaged goal for what can be read of it."""

    def receive(self, now_us: int, delivery: Delivery) -> None:
        if delivery.payload == b'{"q1":9}':
            self.body.start(now_us, JointsGoal(q_deg=(9.0, 0.0, 0.0), seq=None, epoch=None))
        super().receive(now_us, delivery)


class Unhalting(Board):
    """Obeys a halt only with good numbers."""

    def _obey(self, goal: Goal) -> None:
        if isinstance(goal, StopGoal) and goal.epoch == 1:
            self._refuse("viejo", goal.seq, goal.epoch)
        else:
            super()._obey(goal)


class Unlimited(Board):
    """Goes wherever it is sent, its limits or not."""

    def _refusal(self, goal: Goal) -> str | None:
        word = super()._refusal(goal)
        return None if word == "limite" else word


class Dropping(Board):
    """Lets go at whatever comes."""

    def _act(self, goal: Goal) -> None:
        super()._act(goal)
        if isinstance(goal, (EffectorGoal, HomeGoal)) or getattr(goal, "mode", None) is StopMode.HALT:
            self.body.switch_effector(False)


class Patient(Board):
    """Does not mind how long a command waited on its way."""

    def _refusal(self, goal: Goal) -> str | None:
        return super()._refusal(goal if isinstance(goal, StopGoal) else replace(goal, heard=None))


class Hasty(Board):
    """Finds everything too late that says what was heard."""

    def _refusal(self, goal: Goal) -> str | None:
        return "tarde" if getattr(goal, "heard", None) is not None else super()._refusal(goal)


class Trusting(Board):
    """Believes that somebody heard what it has not said."""

    def _refusal(self, goal: Goal) -> str | None:
        heard = getattr(goal, "heard", None) or 0
        return super()._refusal(replace(goal, heard=None) if heard > NEVER_TOLD else goal)


class Strict(Board):
    """Wants stops to come in time as well."""

    def receive(self, now_us: int, delivery: Delivery) -> None:
        if b'"paro"' in delivery.payload and b'"visto"' in delivery.payload:
            self._refuse("tarde", None, None)
        else:
            super().receive(now_us, delivery)


class Tokenless(Board):
    """Knows no tokens, as boards of before."""

    def _telemetry(self, told: BodyReport) -> Telemetry:
        return replace(super()._telemetry(told), ack_token=None, done_token=None)


class Mixing(Board):
    """Goes on with the token of the last command that had one."""

    kept: str | None = None

    def _telemetry(self, told: BodyReport) -> Telemetry:
        said = super()._telemetry(told)
        self.kept = said.ack_token or self.kept
        return replace(said, ack_token=self.kept)


class Muddled(Board):
    """Says of what is done the number, and the token of nothing."""

    def _telemetry(self, told: BodyReport) -> Telemetry:
        return replace(super()._telemetry(told), done_token=None)


def truncating(robot: Arm, body: ArmBody, **how: Any) -> Board:
    body.motors = Truncating(robot.joints)
    return Board(robot, body, **how)


BAD = [
    pytest.param(Forgetful, {"old", "old epoch"}, Evidence.JOINTS, id="obeys old numbers"),
    pytest.param(truncating, {"rounds"}, Evidence.STATE, id="cuts off"),
    pytest.param(Eager, {"retained"}, Evidence.JOINTS, id="obeys retained"),
    pytest.param(Unfenced, {"beaten off"}, Evidence.JOINTS, id="obeys who was superseded"),
    pytest.param(Gullible, {"far future"}, Evidence.JOINTS, id="believes any beat"),
    pytest.param(Deaf, {"silence", "beaten off", "far future"}, Evidence.JOINTS, id="deaf to beats"),
    pytest.param(Unlatched, {"latch"}, Evidence.JOINTS, id="no latch"),
    pytest.param(Boastful, {"halted", "silence"}, Evidence.JOINTS, id="done when halted"),
    pytest.param(Believing, {"malformed"}, Evidence.STATE, id="half a goal"),
    pytest.param(Unhalting, {"stop from anybody"}, Evidence.JOINTS, id="no halt from others"),
    pytest.param(Unlimited, {"limits", "words"}, Evidence.STATE, id="no limits"),
    pytest.param(Patient, {"late"}, Evidence.JOINTS, id="takes what has waited"),
    pytest.param(Hasty, {"late"}, Evidence.JOINTS, id="finds everything late"),
    pytest.param(Trusting, {"late"}, Evidence.JOINTS, id="takes what nobody can have heard"),
    pytest.param(Strict, {"late"}, Evidence.JOINTS, id="finds a stop late"),
    pytest.param(Mixing, {"token"}, Evidence.JOINTS, id="mixes tokens"),
    pytest.param(Muddled, {"token"}, Evidence.JOINTS, id="no token of what is done"),
    pytest.param(Dropping, {"effector"}, Evidence.JOINTS, id="effector never on"),
]


@pytest.mark.sampled(4)
@pytest.mark.parametrize(("kind", "names", "level"), BAD)
def test_a_bad_board_fails_by_name(kind: Callable[..., Board], names: set[str], level: Evidence) -> None:
    judge = trial(kind)
    assert set(wrong(judge)) == names, wrong(judge)
    assert judge.reached is level


def test_a_board_that_knows_no_visto_is_told_what_to_build_and_what_it_costs_not_to() -> None:
    found = wrong(trial(Patient))["late"]
    assert "with tarde" in found
    assert "remember which seq it told when; without that, what has waited moves it" in found


def test_a_board_that_knows_no_tokens_keeps_its_level_and_the_check_is_left_out() -> None:
    judge = trial(Tokenless)
    assert wrong(judge) == {}
    assert [each.check.name for each in judge.findings if each.untried] == ["token"]
    assert judge.reached is Evidence.IDS


def test_a_board_that_says_only_its_code_reaches_state() -> None:
    judge = trial(OnlyCodes)
    assert wrong(judge) == {}
    assert judge.reached is Evidence.STATE


def test_a_board_that_falls_silent_under_way_is_gone_and_blamed_for_nothing() -> None:
    class Unplugged(Board):
        told = 0

        def take(self) -> list[Publication]:
            self.told += len(heard := super().take())
            return heard if self.told <= 300 else []

    judge = trial(Unplugged)
    assert judge.is_gone and wrong(judge) == {}
    assert judge.findings[-1].untried == "nothing was heard of the board for 15 s"
    assert len(judge.findings) < len(CHECKS)


def test_silence_is_one_finding_and_no_level() -> None:
    arm = StorageLayout(PLANT.cell("sis_a")).arm
    judge, now = Judge(arm, epoch=50, now=0.0), 0.0
    while not judge.over:
        judge.step(now, [])
        now = judge.next_deadline or now
    assert list(wrong(judge)) == ["telemetry"]
    assert judge.reached is None
