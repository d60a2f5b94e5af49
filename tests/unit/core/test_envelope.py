"""What an effector of a running task holds is not known after a power cut before its device says so."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.core.envelope import unsettled
from arboleda.model.messages import Fact, KeptTask, Remember, TaskChanged, TaskState
from arboleda.resume.trail import Trail
from arboleda.testing import Rig, shipped

AT_WORK = KeptTask(id="a", text="sis_a 0B 7", cell="sis_a", state=TaskState.RUNNING)
SWITCHING = Remember(fact=Fact.EFFECTOR, name="ra1", value="switching")


@pytest.fixture(scope="module")
def rig() -> Rig:
    """A plant whose arm, which reports what it holds, is about to grip for a task."""
    made = Rig(shipped("sis_a"))
    made.wait(1.0)
    made.submit("sis_a 0B 7 #a")
    made.wait_for("sis_a", "drive path 0B")
    return made


@pytest.fixture
def trail(rig: Rig) -> str:
    return str(rig.disk.facts[Fact.STEP]["a"])


@pytest.mark.parametrize("grip", [{}, {"ra1": "off"}, {"ra1": "switching"}])
def test_an_effector_that_was_off_at_the_step_may_have_gripped_since(
    trail: str, grip: dict[str, str]
) -> None:
    memory = {Fact.STEP: {"a": trail}, Fact.EFFECTOR: grip}
    assert [*unsettled(memory, [AT_WORK])] == [replace(SWITCHING, value="on")]


def test_another_power_cut_changes_nothing_of_that(trail: str) -> None:
    memory = {Fact.STEP: {"a": trail}, Fact.EFFECTOR: {"ra1": "on"}}
    assert [*unsettled(memory, [AT_WORK])] == []


@pytest.mark.parametrize("grip", [{}, {"ra1": "off"}, {"ra1": "on"}])
def test_an_effector_that_held_a_part_at_the_step_may_have_let_go_since(
    trail: str, grip: dict[str, str]
) -> None:
    holding = Trail.read(trail)._replace(grips={"ra1": "on"}).text()
    memory = {Fact.STEP: {"a": holding}, Fact.EFFECTOR: grip}
    assert [*unsettled(memory, [AT_WORK])] == [SWITCHING]


def test_what_counts_as_switching_does_so_already(trail: str) -> None:
    switching = Trail.read(trail)._replace(grips={"ra1": "switching"}).text()
    memory = {Fact.STEP: {"a": switching}, Fact.EFFECTOR: {"ra1": "switching"}}
    assert [*unsettled(memory, [AT_WORK])] == []


@pytest.mark.parametrize("state", [TaskState.QUEUED, TaskState.DONE, TaskState.FAILED])
def test_a_task_that_does_not_run_switches_nothing(trail: str, state: TaskState) -> None:
    assert [*unsettled({Fact.STEP: {"a": trail}}, [replace(AT_WORK, state=state)])] == []


def test_what_an_earlier_version_kept_had_no_envelope() -> None:
    assert [*unsettled({Fact.STEP: {"a": "[]"}}, [AT_WORK])] == []
    assert [*unsettled({}, [AT_WORK])] == []


def test_a_command_does_not_wait_for_the_effector_of_a_running_task(rig: Rig) -> None:
    assert not rig.plant.precedes_commands(SWITCHING)
    assert not rig.plant.precedes_commands(replace(SWITCHING, value="on"))
    assert rig.plant.precedes_commands(replace(SWITCHING, name="rb1"))
    assert rig.plant.precedes_commands(Remember(fact=Fact.QUARANTINE, name="mesa", value="ra1"))


@pytest.mark.parametrize("state", TaskState)
def test_of_a_task_a_command_waits_for_the_begin_alone(rig: Rig, state: TaskState) -> None:
    change = TaskChanged(task="a", text="sis_a 0B 7 #a", cell="sis_a", state=state)
    assert rig.plant.precedes_commands(change) is (state is TaskState.RUNNING)


def test_a_command_waits_for_an_effector_that_a_person_switches() -> None:
    rig = Rig(shipped("sis_a"))
    rig.wait(1.0)
    assert rig.plant.precedes_commands(SWITCHING)
