"""What a plant has written is synced; only some of it, and only commands, wait for that."""

from __future__ import annotations

import pytest
from tests.patience import SOON_S

from arboleda.adapters import clock
from arboleda.core.leaving import MOST_UNSYNCED_S
from arboleda.model.errors import ArboledaError
from arboleda.runtime.parts.durability import Durability

from .syncs import Disk, People
from .syncs import disk as disk
from .syncs import durability as durability
from .syncs import people as people


@pytest.fixture
def now(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    moved = [100.0]
    monkeypatch.setattr(clock, "seconds", lambda: moved[0])
    return moved


def test_a_command_waits_only_for_writes_that_it_must_not_precede(durability: Durability, disk: Disk) -> None:
    durability.wrote(precedes_commands=False)
    durability.let_commands_leave()
    assert disk.syncs == 0
    durability.wrote(precedes_commands=True)
    durability.let_commands_leave()
    durability.let_commands_leave()
    assert disk.syncs == 1


def test_no_command_leaves_while_a_write_is_not_durable_for_too_long(
    durability: Durability, disk: Disk, now: list[float]
) -> None:
    durability.wrote(precedes_commands=False)
    now[0] += MOST_UNSYNCED_S
    durability.let_commands_leave()
    assert disk.syncs == 0
    now[0] += 0.01
    durability.let_commands_leave()
    assert disk.syncs == 1
    durability.wrote(precedes_commands=False)
    durability.let_commands_leave()
    assert disk.syncs == 1


def test_one_sync_is_for_all_that_was_written_by_then(
    durability: Durability, disk: Disk, people: People
) -> None:
    for _ in range(100):
        durability.wrote(precedes_commands=True)
    durability.tell("last")
    assert disk.syncs == 1 and people.told == [("last", None)]


def test_a_sync_that_fails_is_the_last_one_and_whoever_waits_hears_of_it(
    durability: Durability, disk: Disk, people: People
) -> None:
    durability.wrote(precedes_commands=False)
    durability.tell("kept")
    disk.error = ArboledaError("The disk is broken.")
    durability.wrote(precedes_commands=True)
    durability.tell("lost")
    disk.error = None
    with pytest.raises(ArboledaError, match=r"The disk is broken\."):
        durability.let_commands_leave()
    assert [(message, str(failure)) for message, failure in people.told] == [
        ("kept", "None"),
        ("lost", "The disk is broken."),
    ]
    assert [str(each) for each in people.failures] == ["The disk is broken."]
    assert disk.syncs == 1 and not durability.reach(2, SOON_S)


def test_whoever_is_told_and_raises_ends_the_plant_and_keeps_nobody_else_from_being_told(
    durability: Durability, people: People
) -> None:
    durability.tell("raise")
    durability.tell("last")
    assert [type(each) for each in people.failures] == [ValueError]
    assert people.all_told.is_set()


def test_a_plant_without_a_memory_tells_at_once(people: People) -> None:
    durability = Durability(None, people.tell, people.failures.append)
    durability.tell("last")
    durability.let_commands_leave()
    assert people.told == [("last", None)]
