"""What left for a board, against the commands that came for it in one step."""

from __future__ import annotations

from collections import defaultdict

import pytest

from arboleda.model.commands import Stop, StopMode
from arboleda.testing import shipped
from arboleda.wire.transport import Publication
from arboleda_proofs.simulator.recorded.board_link import KnownLink
from arboleda_proofs.simulator.recorded.motions import KnownMotion
from arboleda_proofs.simulator.recorded.numbers import KnownNumbers
from arboleda_proofs.simulator.recorded.passed_commands import PassedCommands

ARM = shipped().robots["ra1"]


@pytest.fixture
def wrong() -> defaultdict[str, list[str]]:
    return defaultdict(list)


@pytest.fixture
def commands(wrong: defaultdict[str, list[str]]) -> PassedCommands:
    link = KnownLink(ARM, 2.0)
    link.up = True
    return PassedCommands(ARM, link, KnownMotion(), KnownNumbers(are_used=True), wrong)


def stop(number: int, mode: StopMode) -> Stop:
    return Stop(id=f"1-{number}", robot=ARM.name, mode=mode)


def unnamed(mode: StopMode) -> Stop:
    return Stop(id="", robot=ARM.name, mode=mode)


def left(number: int, mode: StopMode) -> Publication:
    body = b'{"paro":%d,"seq":%d,"epoca":1}' % (mode.value, number)
    return Publication(topic=f"{ARM.mqtt}/paro", payload=body, qos=1)


def test_the_latch_of_a_board_that_is_back_is_repeated_before_a_clear_that_came_as_late(
    commands: PassedCommands, wrong: defaultdict[str, list[str]]
) -> None:
    """As where the bridge was stalled from before the stop until after the clear."""
    for command in (stop(1, StopMode.LATCH), stop(2, StopMode.CLEAR)):
        commands.take(command, 1)
    published = [left(1, StopMode.LATCH), left(2, StopMode.LATCH), left(3, StopMode.CLEAR)]
    commands.compare([], published, returned=True, late=False)
    assert not wrong


def test_a_latch_that_nobody_commanded_is_found(
    commands: PassedCommands, wrong: defaultdict[str, list[str]]
) -> None:
    commands.take(stop(1, StopMode.CLEAR), 1)
    commands.compare([], [left(1, StopMode.LATCH), left(2, StopMode.CLEAR)], returned=True, late=False)
    assert wrong


def halt_of_others(commands: PassedCommands, at: float, sender: str) -> bool:
    """True if a halt without an id is one to be obeyed, and no copy of the plant's own."""
    before = len(commands.orders)
    commands.take_unnamed(at, unnamed(StopMode.HALT), sender, is_alone=False)
    return len(commands.orders) > before


def test_a_copy_that_came_long_before_its_original_makes_no_copy_of_what_others_command(
    commands: PassedCommands,
) -> None:
    halt_of_others(commands, 1.0, "")
    commands.copies.end_step(2.0)
    commands.copies.expect(3.0, stop(1, StopMode.HALT))
    assert halt_of_others(commands, 4.0, "/teleop")


def test_what_others_command_makes_no_order_of_the_copy_of_what_the_plant_commands_after_it(
    commands: PassedCommands,
) -> None:
    assert halt_of_others(commands, 1.0, "/teleop")
    commands.copies.end_step(2.0)
    commands.copies.expect(3.0, stop(1, StopMode.HALT))
    assert not halt_of_others(commands, 3.0, "")


def test_a_copy_is_that_of_the_latest_equal_command(commands: PassedCommands) -> None:
    for number, at in ((1, 0.0), (2, 4.0)):
        commands.copies.expect(at, stop(number, StopMode.HALT))
    assert not halt_of_others(commands, 4.0, "")
    assert halt_of_others(commands, 6.0, "/teleop")
