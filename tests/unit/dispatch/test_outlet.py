"""The outlet of commands: labels for their way are put on a copy, and are no values of a command."""

from __future__ import annotations

from dataclasses import dataclass, replace

import pytest

from arboleda.dispatch.outlet import labelled
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command, Home, Motion


@dataclass(frozen=True, slots=True, kw_only=True)
class Slide(Motion):
    """A motion of somebody's own kind, whose values are in slots."""

    by_m: float


COMMANDS = [
    MoveJoints(id="7-1", robot="ra1", q=(0.0, 0.5)),
    FollowPath(id="7-2", robot="rm1", nodes=(0, 3)),
    SetEffector(id="7-3", robot="ra1", on=True),
    Home(id="7-4", robot="ra1"),
    Slide(id="7-5", robot="ra1", by_m=0.2),
]


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: type(command).__name__)
def test_labels_are_put_on_a_copy_that_is_equal_but_for_them(command: Command) -> None:
    sent = labelled(command, heard=4, token="a1b2c3000500")
    assert type(sent) is type(command)
    assert sent == replace(command, heard=4, token="a1b2c3000500")
    assert (command.heard, command.token) == (None, None)
    assert sent.given == command.given
