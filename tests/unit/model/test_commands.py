"""Commands: their labels are no values of theirs, and are put on a copy."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command, Home

COMMANDS = [
    MoveJoints(id="7-1", robot="ra1", q=(0.0, 0.5)),
    FollowPath(id="7-2", robot="rm1", nodes=(0, 3)),
    SetEffector(id="7-3", robot="ra1", on=True),
    Home(id="7-4", robot="ra1"),
]


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: type(command).__name__)
def test_labels_are_put_on_a_copy_that_is_equal_but_for_them(command: Command) -> None:
    labelled = command.labelled(heard=4, token="a1b2c3000500")
    assert type(labelled) is type(command)
    assert labelled == replace(command, heard=4, token="a1b2c3000500")
    assert (command.heard, command.token) == (None, None)
    assert labelled.given == command.given
