"""Steps that a board does again for a later start: which of them are wrong."""

from __future__ import annotations

import pytest

from arboleda.kinds.joints.commands import MoveJoints
from arboleda.testing import shipped
from arboleda.wire.forms import form_of
from arboleda_proofs.simulator.recorded.starts import Starts, Step

ANOTHER_PLACE = (0.5, 0.2, 0.01)
HOME = (0.0, 0.0, 0.0)
ARM = shipped().robots["ra1"]


def gives(starts: Starts, path: str, *, start: int, token: str, q: tuple[float, ...]) -> None:
    starts.gave(Step("lot-1", path, move(token, q), start, retries=0, misled=False))


def does(starts: Starts, *, token: str | None, q: tuple[float, ...]) -> None:
    _, goal = form_of(ARM).goal(ARM, move(token, q), seq=1, epoch=1, heard=None, token=token)
    starts.carries_out(ARM.mqtt, goal)


def move(token: str | None, q: tuple[float, ...]) -> MoveJoints:
    return MoveJoints(id=f"1-{token}", robot=ARM.name, q=q, token=token)


@pytest.fixture
def starts() -> Starts:
    """A task of which the first start did two steps; the second one gives the first of them again."""
    starts = Starts(shipped())
    for path, token, q in (("0.1", "a", HOME), ("0.2", "b", ANOTHER_PLACE)):
        gives(starts, path, start=1, token=token, q=q)
        does(starts, token=token, q=q)
    starts.restart(undone=False)
    gives(starts, "0.1", start=2, token="c", q=HOME)
    return starts


def test_a_step_that_is_done_again_for_a_later_start_is_found(starts: Starts) -> None:
    does(starts, token="c", q=HOME)
    assert len(starts.twice) == 1


@pytest.mark.parametrize("token", ["d", None])
def test_where_that_command_was_lost_the_way_home_is_not_taken_for_it(
    starts: Starts, token: str | None
) -> None:
    does(starts, token=token, q=HOME)
    assert not starts.twice


def test_a_step_that_was_halted_may_be_done_again_for_a_later_start() -> None:
    starts = Starts(shipped())
    gives(starts, "0.1", start=1, token="a", q=HOME)
    does(starts, token="a", q=HOME)
    starts.gave_up("1-a")
    gives(starts, "0.2", start=1, token="b", q=ANOTHER_PLACE)
    does(starts, token="b", q=ANOTHER_PLACE)
    starts.restart(undone=False)
    gives(starts, "0.1", start=2, token="c", q=HOME)
    does(starts, token="c", q=HOME)
    assert not starts.twice
