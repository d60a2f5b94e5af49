"""Which commands may still be on their way to a robot."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.dispatch.underway import PATIENCE_S, UnderWay, Unfinished, UnnamedCommands
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Switch
from arboleda.model.messages import Report
from arboleda.model.plant_model import QUIET_S, Evidence
from arboleda.testing import shipped
from arboleda.testing.plants import shared
from arboleda.testing.storage_layout import StorageLayout

MODEL = shared()
ARM = next(StorageLayout(cell).arm.name for cell in MODEL.cells if StorageLayout(cell).space.zones)
MUTE = next(each.name for cell in MODEL.cells for each in cell.robots if each.evidence is Evidence.JOINTS)
MOVES = [MoveJoints(id=f"7-{number}", robot=ARM, q=(0.0, 0.0, 0.0)) for number in (1, 2)]


def test_what_left_is_under_way_until_it_or_a_later_one_is_named() -> None:
    under_way = UnderWay(MODEL)
    for move in MOVES:
        under_way.leaves(move)
    under_way.hear(Report(at=1.0, robot=ARM), 1.0)
    assert under_way.ids == {ARM: ["7-1", "7-2"]}
    under_way.hear(Report(at=1.1, robot=ARM, accepted="7-2"), 1.1)
    assert under_way.ids == {}


def test_what_a_heard_arm_does_not_name_in_time_was_lost() -> None:
    under_way = UnderWay(MODEL)
    under_way.leaves(MOVES[0])
    under_way.hear(Report(at=1.0, robot=ARM), 1.0)
    assert not under_way.is_overdue(ARM, 1.0)
    assert under_way.is_overdue(ARM, 1.0 + PATIENCE_S)


def test_an_arm_that_shares_nothing_is_not_followed() -> None:
    under_way = UnderWay(shipped("sis_a"))
    under_way.leaves(MoveJoints(id="7-1", robot="ra1", q=(0.0, 0.0, 0.0)))
    assert under_way.ids == {}


def test_work_of_an_arm_that_names_no_command_is_under_way_until_its_end_or_the_time_of_an_answer() -> None:
    under_way = UnderWay(MODEL)
    move = MoveJoints(id="7-1", robot=MUTE, q=(0.0, 0.0, 0.0))
    under_way.leaves(move)
    for at in (1.0, 1.0 + QUIET_S / 2):
        under_way.hear(Report(at=at, robot=MUTE), at)
        assert under_way.ids == {MUTE: ["7-1"]}
    under_way.hear(Report(at=1.0 + QUIET_S, robot=MUTE), 1.0 + QUIET_S)
    assert under_way.ids == {}
    under_way.leaves(move)
    under_way.ended(move)
    assert under_way.ids == {}


def test_what_left_for_a_board_is_counted_until_it_or_a_later_one_is_named() -> None:
    unnamed = UnnamedCommands(MODEL)
    for move in MOVES:
        unnamed.leaves(move)
    unnamed.hear(Report(at=1.0, robot=ARM, accepted="7-1"))
    assert len(unnamed.ids[ARM]) == 1
    unnamed.hear(Report(at=1.1, robot=ARM, rejected="7-2"))
    assert len(unnamed.ids[ARM]) == 0


def test_who_numbers_nothing_has_nothing_to_name() -> None:
    unnamed = UnnamedCommands(MODEL)
    unnamed.leaves(MoveJoints(id="7-1", robot=MUTE, q=(0.0, 0.0, 0.0)))
    assert MUTE not in unnamed.ids


def clamp(number: int, *, on: bool) -> Switch:
    return SetEffector(id=f"7-{number}", robot=ARM, on=on)


def unfinished(command: Switch) -> Unfinished:
    """A command to a hand that cells share has failed at 1.0, and may take 2 s."""
    (first, *more) = MODEL.cells
    cells = tuple(replace(cell, shared=(ARM,)) if ARM in cell.holders else cell for cell in (first, *more))
    found = Unfinished(replace(MODEL, cells=cells))
    found.expect(command, 2.0, 1.0)
    return found


@pytest.mark.parametrize("on", [True, False])
def test_a_hand_that_cells_share_may_grip_on_a_command_to_grip_that_has_failed(*, on: bool) -> None:
    assert unfinished(clamp(1, on=on)).may_grip(ARM) is on


def test_a_hand_may_grip_for_as_long_as_that_takes_from_when_it_has_named_the_command() -> None:
    found = unfinished(clamp(1, on=True))
    for at in (4.0, 5.0):
        assert not found.hear(Report(at=at, robot=ARM), at, is_well=True, unnamed=["7-1"])
    assert not found.hear(Report(at=6.9, robot=ARM), 6.9, is_well=True, unnamed=())
    assert found.may_grip(ARM)
    assert found.hear(Report(at=7.0, robot=ARM), 7.0, is_well=True, unnamed=())
    assert not found.may_grip(ARM)
