"""Ids of goals, and what a server's list of them proves to a later start of the plant."""

from __future__ import annotations

from uuid import UUID, uuid5
from zlib import crc32

import pytest

from arboleda.drivers import Command, Receipt, Tokens
from arboleda_drivers.ros_action.events import ListedGoal, Status
from arboleda_drivers.ros_action.goal import Goal
from arboleda_drivers.ros_action.goal_history import FOREIGN_EPOCH, GoalHistory
from arboleda_drivers.ros_action.goal_id import GoalId, hash_of

OURS = GoalId(device=hash_of("arm"), epoch=1_790_000_000, number=7, is_last=True, token="ab05ba000401")
THEIRS = UUID("6f2c1a9e-8b1d-4c55-9a01-3d7e5f6b8c90").bytes  # of version 4, as clients make them


def begun(history: GoalHistory, *, parts: int = 1, id: str = "9-1", token: str | None = None) -> Goal:
    history.begin(Command(id=id, robot="arm", token=token))
    return Goal(id=id, parts=("goal",) * parts, sent_at=0.0)


def listed(uuid: bytes, s: int, status: Status | None = None) -> ListedGoal:
    return ListedGoal(uuid=uuid, stamp=(s, 0), status=status)


def test_an_id_reads_back_as_its_command() -> None:
    assert GoalId.read(OURS.uuid) == OURS
    plain = OURS._replace(token=None, is_last=False)
    assert GoalId.read(plain.uuid) == plain


def test_an_id_is_a_uuid_of_the_version_for_an_application() -> None:
    uuid = UUID(bytes=OURS.uuid)
    assert (uuid.version, uuid.variant) == (8, "specified in RFC 4122")


@pytest.mark.parametrize(
    "uuid",
    [THEIRS, uuid5(UUID(int=0), "9-1").bytes, b"", bytes(16)],
    ids=["of a client", "of a hash", "none", "zeros"],
)
def test_an_id_of_others_names_no_command(uuid: bytes) -> None:
    assert GoalId.read(uuid) is None


def test_an_accepted_goal_counts_its_command_and_the_last_part_ends_it() -> None:
    history = GoalHistory("arm")
    goal = begun(history, parts=2, token="ab05ba000401")
    first = history.send(goal)
    assert history.receipt is None
    history.answer(goal.key, accepted=True)
    assert (history.receipt, history.tokens) == (Receipt(9, 1), Tokens("ab05ba000401"))
    goal.advance(0.0)
    second = history.send(goal)
    history.answer(goal.key, accepted=True)
    history.end()
    assert (history.receipt, history.tokens) == (Receipt(9, 1, 1), Tokens("ab05ba000401", "ab05ba000401"))
    is_last = [GoalId.read(each).is_last for each in (first, second)]  # type: ignore[union-attr]
    assert is_last == [False, True]


def test_a_refused_goal_counts_nothing() -> None:
    history = GoalHistory("arm")
    goal = begun(history)
    history.send(goal)
    history.answer(goal.key, accepted=False)
    assert history.receipt is None


@pytest.mark.parametrize(("status", "done"), [(Status.SUCCEEDED, 7), (Status.ABORTED, None), (None, None)])
def test_a_list_tells_a_later_start_of_the_last_command(status: Status | None, done: int | None) -> None:
    history = GoalHistory("arm")
    history.list([listed(OURS.uuid, 5, status), listed(THEIRS, 4, Status.SUCCEEDED)])
    assert history.receipt == Receipt(OURS.epoch, 7, done)
    assert history.tokens == Tokens(OURS.token, OURS.token if done else None)


def test_a_part_that_is_not_the_last_ends_no_command() -> None:
    history = GoalHistory("arm")
    history.list([listed(OURS._replace(is_last=False).uuid, 5, Status.SUCCEEDED)])
    assert history.receipt == Receipt(OURS.epoch, 7)


@pytest.mark.parametrize(
    "last", [THEIRS, OURS._replace(device=hash_of("other")).uuid], ids=["a client", "another device"]
)
def test_the_last_goal_of_somebody_else_is_of_no_start_of_the_plant(last: bytes) -> None:
    history = GoalHistory("arm")
    history.list([listed(OURS.uuid, 5, Status.SUCCEEDED), listed(last, 6)])
    assert (history.receipt, history.tokens) == (Receipt(FOREIGN_EPOCH, crc32(last)), None)


def test_a_further_goal_of_somebody_else_is_seen_as_one_more() -> None:
    history = GoalHistory("arm")
    history.list([listed(THEIRS, 5)])
    before = history.receipt
    history.list([listed(THEIRS, 5)])
    assert history.receipt == before
    history.list([listed(THEIRS, 5), listed(bytes(16), 6)])
    assert history.receipt is not None and history.receipt != before


def test_a_list_from_before_the_last_goal_changes_nothing() -> None:
    history = GoalHistory("arm")
    goal = begun(history)
    own = history.send(goal)
    history.answer(goal.key, accepted=True)
    history.list([listed(OURS.uuid, 5, Status.SUCCEEDED)])
    history.list([listed(THEIRS, 5)])
    assert history.receipt == Receipt(9, 1)
    history.list([listed(own, 6), listed(THEIRS, 7)])
    assert history.receipt == Receipt(FOREIGN_EPOCH, crc32(THEIRS))
    history.list([listed(own, 6)])
    assert history.receipt == Receipt(9, 1)


def test_a_server_that_starts_anew_has_taken_nothing() -> None:
    history = GoalHistory("arm")
    history.list([listed(OURS.uuid, 5)])
    history.forget()
    assert history.receipt is None
