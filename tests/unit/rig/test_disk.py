"""The simulated disk keeps what the store keeps; a power cut undoes what nothing has synced."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from arboleda.core.intake import HISTORY
from arboleda.departures.leaving import SYNCED_WITHIN_S
from arboleda.model.messages import Fact, Reason, Remember, TaskChanged, TaskState
from arboleda.model.sentence import OWN
from arboleda.rig.disk import Disk, is_kept
from arboleda.runtime.memory import kept_tasks, remembered
from arboleda.store.sqlite import Store


def said(id: str, state: TaskState = TaskState.QUEUED, **why: object) -> TaskChanged:
    return TaskChanged(task=id, text="sis_a 0B 1", cell="sis_a", state=state, **why)  # type: ignore[arg-type]


def fact(kind: Fact, value: str | None, name: str = "ra1") -> Remember:
    return Remember(fact=kind, name=name, value=value)


LIFE = (
    said("a"),
    fact(Fact.LATCH, "on"),
    said("a", TaskState.RUNNING),
    said("b"),
    fact(Fact.EFFECTOR, "switching"),
    fact(Fact.EFFECTOR, "on"),
    said("a", TaskState.FAILED, reason=Reason.DEADLINE, sentence=OWN(text="late")),
    said("a", TaskState.DONE),
    said("a"),
    said("c", TaskState.RUNNING),
    said("", TaskState.REFUSED),
    fact(Fact.LATCH, None),
    said("c"),
    said("c", TaskState.RUNNING),
)


def test_it_has_what_the_store_has_after_the_same_commits() -> None:
    disk = Disk()
    with Store(Path(":memory:")) as store:
        for number, message in enumerate(LIFE):
            if isinstance(message, Remember):
                store.keep(message)
            else:
                store.tasks.keep(message, "storage", float(number))
            if is_kept(message):
                disk.commit(message, float(number))
        found = disk.found()
        assert {kind: found.facts.get(kind, {}) for kind in Fact} == remembered(store)
        now = float(len(LIFE))
        kept = [replace(task, recipe="") for task in kept_tasks(store, clock_s=now, unix_s=now)]
        assert list(found.tasks.values()) == kept


def test_a_start_finds_the_open_tasks_and_the_last_that_ended() -> None:
    disk = Disk()
    disk.commit(said("open"), 0.0)
    for number in range(HISTORY + 3):
        disk.commit(said(f"e{number}"), 1.0)
        disk.commit(said(f"e{number}", TaskState.DONE), 2.0)
    assert list(disk.found().tasks) == ["open", *(f"e{number}" for number in range(3, HISTORY + 3))]
    assert disk.ended("e0") is not None and disk.ended("open") is None


NOW, LATER = 1.0, 1.0 + SYNCED_WITHIN_S  # of commits, and when a thread has synced those


def test_a_power_cut_undoes_the_last_commits_that_nothing_has_synced() -> None:
    for reached, effector, zones in ((0, "switching", ["mesa"]), (1, "off", ["mesa"]), (2, "off", [])):
        disk = Disk()
        disk.commit(fact(Fact.QUARANTINE, "ra1", "mesa"), NOW)
        disk.commit(fact(Fact.EFFECTOR, "switching"), NOW)
        disk.sync()
        disk.commit(fact(Fact.EFFECTOR, "off"), NOW)
        disk.commit(fact(Fact.QUARANTINE, None, "mesa"), NOW)
        assert disk.unsynced(NOW) == 2
        disk.cut_power(reached, NOW)
        assert disk.facts[Fact.EFFECTOR] == {"ra1": effector}
        assert [*disk.facts[Fact.QUARANTINE]] == zones
        assert disk.unsynced(NOW) == 0


@pytest.mark.parametrize(("cut_at", "kept"), [(NOW, {}), (LATER, {"a": "1"})])
def test_a_thread_syncs_a_little_later_what_nobody_waits_for(cut_at: float, kept: dict[str, str]) -> None:
    disk = Disk()
    disk.commit(fact(Fact.STEP, "1", "a"), NOW)
    disk.cut_power(0, cut_at)
    assert disk.facts.get(Fact.STEP, {}) == kept


def test_a_slow_disk_syncs_later() -> None:
    disk = Disk()
    disk.slow.append(2.0)
    disk.commit(fact(Fact.STEP, "1", "a"), NOW, precedes_commands=False)
    assert disk.unsynced(NOW + 1.5) == 1 and disk.unsynced(NOW + 2.5) == 0


def test_a_command_waits_for_what_it_must_not_precede_and_for_nothing_else() -> None:
    disk = Disk()
    disk.slow.append(0.05)
    disk.commit(fact(Fact.STEP, "1", "a"), NOW, precedes_commands=False)
    assert disk.let_command_leave(NOW) == 0.0
    disk.commit(fact(Fact.EFFECTOR, "switching"), NOW)
    assert disk.let_command_leave(NOW) == pytest.approx(0.05)
    assert disk.let_command_leave(NOW) == 0.0
    disk.cut_power(0, NOW)
    assert disk.facts[Fact.EFFECTOR] == {"ra1": "switching"}


def test_a_command_waits_for_a_disk_that_hangs_whatever_it_was_to_keep() -> None:
    disk = Disk()
    disk.slow.append(2.0)
    disk.commit(fact(Fact.STEP, "1", "a"), NOW, precedes_commands=False)
    assert disk.let_command_leave(NOW + 0.05) == 0.0
    assert disk.let_command_leave(NOW + 0.5) == pytest.approx(1.5)


def test_what_is_told_is_not_undone() -> None:
    disk = Disk()
    disk.commit(fact(Fact.QUARANTINE, "ra1", "mesa"), NOW)
    disk.commit(fact(Fact.QUARANTINE, None, "mesa"), NOW)
    disk.commit(said("a"), NOW)
    disk.sync()
    disk.cut_power(0, NOW)
    assert disk.facts[Fact.QUARANTINE] == {}
    assert disk.found().tasks["a"].state is TaskState.QUEUED


def test_what_is_committed_after_a_power_cut_is_kept_as_before() -> None:
    disk = Disk()
    disk.commit(said("a"), NOW)
    disk.cut_power(1, NOW)
    disk.commit(replace(said("a"), state=TaskState.RUNNING), 2.0)
    disk.cut_power(1, 2.0)
    assert disk.tasks["a"].started_at == 2.0


def test_a_power_cut_leaves_effectors_of_the_envelope_unsettled() -> None:
    disk = Disk()
    begun = '[[3,"",{},{},["ra1"]],["",{},null,{},[],[],{},{},{},null,false,false,null,[],{},[]]]'
    for message in (said("a"), fact(Fact.STEP, begun, "a"), said("a", TaskState.RUNNING)):
        disk.commit(message, NOW)
    disk.sync()
    disk.commit(fact(Fact.EFFECTOR, "switching"), NOW, precedes_commands=False)
    disk.commit(fact(Fact.EFFECTOR, "on"), NOW, precedes_commands=False)
    disk.cut_power(0, NOW)
    assert disk.facts[Fact.EFFECTOR] == {"ra1": "on"}
