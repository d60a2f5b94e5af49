"""Messages that left for a board, against the commands that came for it in one step."""

from __future__ import annotations

import pytest

from arboleda.model.commands import Command, Stop, StopMode
from arboleda.testing import shipped
from arboleda.wire.transport import Publication
from arboleda_proofs.simulator.recorded.board_step import BoardStep
from arboleda_proofs.simulator.recorded.passed_commands import PassedCommands

ARM = shipped().robots["ra1"]
LATCH, CLEAR, HALT = StopMode.LATCH, StopMode.CLEAR, StopMode.HALT


class Judge:
    """Says what is wrong in a step of a board that is there, and `stirred` where it is just back."""

    def __init__(self) -> None:
        self.rule = PassedCommands(ARM)
        self.sent = 0

    def __call__(
        self, *came: Command, at: float = 1.0, sends: tuple[StopMode, ...] = (), stirred: bool = False
    ) -> list[str]:
        step = BoardStep()
        step.now, step.was_up, step.plants, step.is_stirred = at, True, [1], stirred
        for each in came:
            step.command(at, each, 1)
        for mode in sends:
            self.sent += 1
            step.published.append(left(self.sent, mode))
        return list(self.rule.breaches(step))


@pytest.fixture
def breaches() -> Judge:
    return Judge()


def stop(number: int, mode: StopMode) -> Stop:
    return Stop(id=f"1-{number}", robot=ARM.name, mode=mode)


def unnamed(mode: StopMode) -> Stop:
    return Stop(id="", robot=ARM.name, mode=mode)


def left(number: int, mode: StopMode) -> Publication:
    body = b'{"paro":%d,"seq":%d,"epoca":1}' % (mode.value, number)
    return Publication(topic=f"{ARM.mqtt}/paro", payload=body, qos=1)


def test_the_latch_of_a_board_that_is_back_is_repeated_before_a_clear_that_came_as_late(
    breaches: Judge,
) -> None:
    """As where the bridge was stalled from before the stop until after the clear."""
    assert not breaches(stop(1, LATCH), stop(2, CLEAR), sends=(LATCH, LATCH, CLEAR), stirred=True)


def test_a_latch_that_nobody_commanded_is_found(breaches: Judge) -> None:
    assert breaches(stop(1, CLEAR), sends=(LATCH, CLEAR), stirred=True)


def test_a_command_that_neither_leaves_nor_is_refused_is_found(breaches: Judge) -> None:
    assert breaches(stop(1, LATCH))


def test_a_number_that_is_left_out_is_found(breaches: Judge) -> None:
    breaches.sent = 1
    assert breaches(stop(1, HALT), sends=(HALT,))


@pytest.mark.parametrize(("later_s", "is_missed"), [(4.0, False), (6.0, True)])
def test_a_halt_of_others_has_to_leave_unless_it_may_be_a_copy(
    breaches: Judge, later_s: float, is_missed: bool
) -> None:
    assert not breaches(stop(1, HALT), sends=(HALT,))
    assert bool(breaches(unnamed(HALT), at=1.0 + later_s)) is is_missed
