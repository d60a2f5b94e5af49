"""The thread that syncs what a plant has written."""

from __future__ import annotations

from arboleda.runtime.parts.durability import Durability

from ..patience import SOON_S
from ..unit.runtime.syncs import Disk, People
from ..unit.runtime.syncs import disk as disk
from ..unit.runtime.syncs import durability as durability
from ..unit.runtime.syncs import people as people


def test_what_is_written_while_a_sync_is_under_way_is_not_durable_by_that(
    durability: Durability, disk: Disk, people: People
) -> None:
    disk.let_go.clear()
    durability.start()
    durability.wrote(precedes_commands=False)
    durability.tell("first")
    durability.wake()
    assert disk.reached.wait(SOON_S)
    durability.wrote(precedes_commands=False)
    durability.tell("last")
    assert not durability.reach(1, 0.0) and people.told == []
    disk.let_go.set()
    assert people.all_told.wait(SOON_S)
    assert people.told == [("first", None), ("last", None)]
    assert disk.syncs == 2 and durability.reach(2, 0.0)


def test_the_thread_folds_the_log_and_who_waits_for_a_sync_does_not(
    durability: Durability, disk: Disk
) -> None:
    durability.wrote(precedes_commands=True)
    durability.let_commands_leave()
    assert disk.folders == []
    durability.start()
    durability.wrote(precedes_commands=False)
    durability.wake()
    assert durability.reach(2, SOON_S)
    durability.stop()
    assert set(disk.folders) == {"durability"}


def test_what_is_left_at_the_end_is_synced_and_told(
    durability: Durability, disk: Disk, people: People
) -> None:
    disk.let_go.clear()
    durability.start()
    durability.wrote(precedes_commands=False)
    durability.tell("last")
    disk.let_go.set()
    durability.stop()
    assert people.told == [("last", None)]
