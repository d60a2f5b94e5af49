"""A task that was at work when the plant was killed: what the devices prove, and what a person is asked."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import pytest
from tests.cells import with_poses
from tests.scenario.restarts import ENDED, Mortal, restart

from arboleda.core import reasons
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Command, Stop
from arboleda.model.messages import Fact, Reason, Remember, Shutdown, TaskState, Verb
from arboleda.model.plant_model import Evidence, PlantModel
from arboleda.resume import fingerprint
from arboleda.rig import faults
from arboleda.runtime.parts.earlier_tasks import EarlierTasks
from arboleda.testing import Rig, shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire.payloads import EffectorGoal, encode
from arboleda.wire.transport import Publication
from arboleda_proofs.testing import Witness

Stage = Callable[..., tuple[Rig, Witness]]
CELL, ID = "sis_a", "lot-1"
TASK = f"{CELL} 0B 7 #{ID}"
AT = 'task lot-1 was at work when the plant stopped, at its step "{step}"'
STEPS = (
    "system start/dwell",
    "drive path 0B",
    "move to pick-up",
    "effector on/switch",
    "effector on/dwell",
    "move to station 7",
    "effector off/switch",
    "effector off/dwell",
    "move to home",
)


def stands_at(step: str) -> str:
    """That the task stands there; to switch the effector on is a part of gripping."""
    name = step.split("/")[0]
    return AT.format(step="grip" if name == "effector on" else name)


def run(rig: Rig) -> Any:
    return rig.plant.cells[CELL]


def at(rig: Rig, leaf: str) -> None:
    """A task runs, and this step of it."""
    rig.submit(TASK)
    rig.wait_for(CELL, leaf)


def commands(rig: Rig) -> list[str]:
    """Commands that were sent to devices, but for stops."""
    return [
        f"{type(each).__name__} {each.robot}"
        for each in rig.sent
        if isinstance(each, Command) and not isinstance(each, Stop)
    ]


def held(rig: Rig) -> str:
    assert run(rig).state is CellState.HELD
    return str(reasons.of_hold(run(rig)))


def full(rig: Rig) -> list[str]:
    """The stations of the cell with a part."""
    counts = run(rig).context.places.counts
    return [place for place, parts in counts.items() if parts]


def outcome(rig: Rig) -> TaskState:
    assert rig.wait(120.0, until=lambda: rig.outcomes()[ID].state in ENDED)
    return rig.outcomes()[ID].state


def ways(rig: Rig) -> list[str]:
    return [each.do.value for each in rig.plant.advice(CELL)]


@pytest.mark.sampled(9)
@pytest.mark.parametrize("after_s", [0.0, 0.4, 4.0])
@pytest.mark.parametrize("step", STEPS)
def test_it_stands_at_its_step_moves_nothing_and_goes_on_after_resume(
    stage: Stage, step: str, after_s: float
) -> None:
    rig, witness = stage(goes_on=True)
    at(rig, step)
    restart(rig, after_s=after_s)
    before = len(commands(rig))
    rig.wait(5.0)
    assert held(rig) == f"sis_a is held ({stands_at(step)}); resume sis_a or abandon sis_a"
    assert len(commands(rig)) == before
    assert rig.operate(Verb.RESUME, CELL) is None
    assert outcome(rig) is TaskState.DONE
    assert full(rig) == ["station_7"]
    assert [switch.on for switch in witness.switches] == [True, False], "it picks once and places once"
    assert not witness.illegal and not witness.false_successes


def test_what_the_board_did_while_the_plant_was_away_is_not_done_again(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    body = rig.boards["ra_1"].body
    assert rig.wait(5.0, until=lambda: (body.next_change_us or 0) / 1e6 < rig.now + 0.3)
    restart(rig, after_s=3.0)
    rig.wait(1.0)
    before = len(commands(rig))
    assert rig.operate(Verb.RESUME, CELL) is None
    rig.wait(0.1)
    assert commands(rig)[before:] == ["SetEffector ra1"]


def test_a_command_that_never_reached_its_board_is_given_again_as_it_was(stage: Stage) -> None:
    rig, _ = stage()
    topic = f"{rig.model.robots['rm_sis_a'].mqtt}/camino"
    rig.lost = faults.nth(topic, 1)
    at(rig, "drive path 0B")
    rig.wait(0.1)
    restart(rig, after_s=0.3)
    rig.wait(1.0)
    assert rig.operate(Verb.RESUME, CELL) is None
    path = json.loads([each.payload for _, each in rig.to_boards if each.topic == topic][-1])
    assert path["nodos"][0] == StorageLayout(rig.model.cells[0]).paths[0].nodes[0], "the whole path"
    assert outcome(rig) is TaskState.DONE


@pytest.mark.sampled(2)
@pytest.mark.parametrize("evidence", [Evidence.JOINTS, Evidence.STATE])
def test_who_numbers_no_commands_proves_nothing_and_a_person_decides(
    stage: Stage, evidence: Evidence
) -> None:
    rig, _ = stage(evidence)
    at(rig, "move to pick-up")
    restart(rig)
    rig.wait(8.0)
    assert "does not number its commands" in held(rig)
    assert held(rig).endswith("retry sis_a or abandon sis_a")
    assert "does not number its commands" in str(rig.operate(Verb.RESUME, CELL))
    assert rig.operate(Verb.RETRY, CELL) is None
    assert outcome(rig) is TaskState.DONE


@pytest.mark.parametrize("evidence", [Evidence.IDS, Evidence.STATE])
def test_log_and_waiting_task_say_what_screens_say_once_devices_are_heard(
    stage: Stage, evidence: Evidence, caplog: pytest.LogCaptureFixture
) -> None:
    rig, _ = stage(evidence)
    at(rig, "move to pick-up")
    restart(rig)
    log = EarlierTasks(rig.plant)
    log.stepped(rig.plant)
    waits = held(rig)
    assert not caplog.messages and waits.endswith(" or abandon sis_a")
    assert "resume" not in waits and "retry" not in waits, "nobody knows yet which of them it will be"
    for _ in range(20):
        rig.wait(0.5)
        log.stepped(rig.plant)
    assert caplog.messages == [held(rig)] == [str(reasons.of_waiting(run(rig)))]
    assert ("retry does the step again" in held(rig)) == (evidence is Evidence.STATE)


def test_a_board_that_has_booted_meanwhile_leaves_only_the_recovery(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to station 7")
    restart(rig)
    rig.crash("ra_1")
    rig.wait(2.0)
    assert rig.operate(Verb.RESUME, CELL) is not None
    assert ways(rig)[0] == "home"
    assert rig.operate(Verb.HOME, "ra1") is None
    rig.wait(30.0)
    assert "was homed meanwhile" in held(rig) or "has booted since then" in held(rig)
    assert ways(rig) == ["abandon"]
    assert rig.operate(Verb.RETRY, CELL) is not None
    assert rig.operate(Verb.ABANDON, CELL) is None
    assert outcome(rig) is TaskState.FAILED


def test_who_cannot_say_that_it_booted_is_put_right_by_hand_once(stage: Stage) -> None:
    rig, _ = stage(arm={"assume_homed": True})
    at(rig, "effector off/switch")
    restart(rig)
    rig.crash("ra_1")
    rig.wait(5.0)
    assert ways(rig) == ["home", "abandon"]
    assert rig.operate(Verb.HOME, "ra1", by_hand=True) is None
    rig.wait(5.0)
    assert ways(rig) == ["abandon"]
    restart(rig)
    rig.wait(5.0)
    assert ways(rig) == ["abandon"]
    assert rig.operate(Verb.ABANDON, CELL) is None
    assert outcome(rig) is TaskState.FAILED
    assert rig.outcomes()[ID].reason is Reason.REBOOTED


def test_a_part_that_was_lost_meanwhile_is_not_delivered(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to station 7")
    rig.wait(0.5)
    rig.manual.open_effector("ra_1")
    restart(rig, after_s=1.0)
    rig.wait(1.0)
    assert held(rig).endswith("ra1 has no part to go on with: abandon sis_a")
    assert ways(rig) == ["abandon"]
    assert rig.operate(Verb.RESUME, CELL) is not None
    assert rig.operate(Verb.RETRY, CELL) is not None
    restart(rig)
    rig.wait(1.0)
    assert ways(rig) == ["abandon"], "what it said since is no proof that it never held any"
    assert rig.operate(Verb.ABANDON, CELL) is None
    assert outcome(rig) is TaskState.FAILED
    assert rig.outcomes()[ID].reason is Reason.PART_LOST
    assert full(rig) == []


def test_a_part_that_was_lost_stays_lost_though_the_effector_is_closed_again(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to station 7")
    rig.wait(0.5)
    rig.manual.open_effector("ra_1")
    restart(rig, after_s=1.0)
    rig.wait(1.0)
    rig.boards["ra_1"].body.switch_effector(True)
    rig.wait(1.0)
    restart(rig)
    rig.wait(1.0)
    assert ways(rig) == ["abandon"]


def test_an_effector_that_was_closed_meanwhile_is_for_a_person_to_judge(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    rig.wait(0.5)
    rig.boards["ra_1"].body.switch_effector(True)
    restart(rig, after_s=1.0)
    rig.wait(8.0)
    assert "ra1 held nothing then, and says that it holds something" in held(rig)
    assert rig.operate(Verb.ABANDON, CELL) is None
    assert outcome(rig) is TaskState.FAILED
    assert rig.outcomes()[ID].reason is Reason.INTERRUPTED


def test_a_part_in_the_hand_is_carried_on_or_brought_back(stage: Stage) -> None:
    rig, witness = stage()
    at(rig, "move to station 7")
    rig.wait(0.5)
    restart(rig, after_s=2.0)
    rig.wait(1.0)
    assert rig.boards["ra_1"].body.effector, "nothing lets go of it"
    assert rig.operate(Verb.ABANDON, CELL) is None
    assert outcome(rig) is TaskState.FAILED
    assert str(rig.outcomes()[ID].sentence) == "abandoned by the operator"
    assert [switch.on for switch in witness.switches] == [True, False] and not witness.illegal


def test_commands_of_others_meanwhile_leave_only_the_recovery(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    restart(rig, after_s=2.0)
    board = rig.boards["ra_1"]
    for number in (1, 2, 3):
        goal = EffectorGoal(on=False, seq=number, epoch=2_000_000_000)
        rig.inject(Publication(topic="ra_1/efector", payload=encode(goal)))
    assert board.refusals == 0
    rig.wait(1.0)
    assert "ra1 has taken commands of which this plant knows nothing" in held(rig)
    assert ways(rig) == ["abandon"]


def test_a_second_restart_finds_it_at_the_same_step(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to station 7")
    rig.wait(0.3)
    for _ in range(3):
        restart(rig, after_s=1.0)
        rig.wait(1.0)
    assert AT.format(step="move to station 7") in held(rig)
    assert rig.operate(Verb.RESUME, CELL) is None
    rig.wait(0.3)
    restart(rig, after_s=1.0)
    rig.wait(1.0)
    assert rig.operate(Verb.RESUME, CELL) is None
    assert outcome(rig) is TaskState.DONE


def test_a_task_that_was_held_is_held_at_its_step(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to station 7")
    rig.wait(0.3)
    assert rig.operate(Verb.HOLD, CELL) is None
    rig.wait(2.0)
    restart(rig, after_s=1.0)
    rig.wait(1.0)
    assert rig.operate(Verb.RESUME, CELL) is None
    assert outcome(rig) is TaskState.DONE


def test_a_hold_that_was_not_confirmed_yet_is_no_command_of_others(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to station 7")
    rig.wait(0.3)
    assert rig.operate(Verb.HOLD, CELL) is None
    restart(rig, after_s=1.0)
    rig.wait(1.0)
    assert rig.operate(Verb.RESUME, CELL) is None
    assert outcome(rig) is TaskState.DONE


def test_a_part_that_was_released_while_it_was_held_stays_gone(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to station 7")
    assert rig.operate(Verb.HOLD, CELL) is None
    rig.wait(2.0)
    assert rig.operate(Verb.RELEASE, "ra1") is None
    rig.wait(2.0)
    restart(rig)
    rig.wait(1.0)
    assert ways(rig) == ["abandon"]


def test_a_recovery_that_was_cut_off_is_only_done_anew(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to station 7")
    rig.wait(0.3)
    assert rig.operate(Verb.CANCEL, CELL) is None
    rig.wait(0.5)
    restart(rig)
    rig.wait(1.0)
    assert "its work has failed, and the recovery was cut off: abandon sis_a" in held(rig)
    assert rig.operate(Verb.RESUME, CELL) is not None
    assert rig.operate(Verb.ABANDON, CELL) is None
    assert outcome(rig) is TaskState.CANCELLED
    assert not rig.boards["ra_1"].body.effector


def moved(model: PlantModel) -> PlantModel:
    """The plant, whose pick-up lies elsewhere."""
    (cell,) = model.cells
    layout = StorageLayout(cell)
    pickup = replace(layout.pickup, q=tuple(value + 0.05 for value in layout.pickup.q))
    return replace(model, cells=(with_poses(cell, pickup=pickup, pickup_a=pickup, pickup_c=pickup),))


@pytest.fixture
def by_code() -> Iterator[Callable[[], None]]:
    """The fingerprints of a version that hashed the code of functions, until this is called."""
    patch = pytest.MonkeyPatch()
    patch.setattr(fingerprint, "of_cell", partial(fingerprint.of_cell, by_code=True))
    patch.setattr(fingerprint, "of_tree", partial(fingerprint.of_tree, by_code=True))
    patch.setattr(fingerprint, "BY_SOURCE", "")
    yield patch.undo
    patch.undo()


def test_a_task_kept_by_a_version_that_hashed_code_goes_on(stage: Stage, by_code: Callable[[], None]) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    by_code()
    assert fingerprint.BY_SOURCE not in rig.disk.facts[Fact.STEP][ID]
    restart(rig)
    rig.wait(5.0)
    assert rig.operate(Verb.RESUME, CELL) is None
    assert outcome(rig) is TaskState.DONE


def test_a_task_kept_by_such_a_version_is_not_walked_into_another_plant_file(
    stage: Stage, by_code: Callable[[], None]
) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    by_code()
    restart(rig, moved(rig.model))
    rig.wait(1.0)
    assert "its recipe or the plant file has changed since it began: abandon sis_a" in held(rig)


def test_another_pose_in_the_plant_file_leaves_only_the_recovery(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    model = rig.model
    restart(rig, moved(model))
    rig.wait(1.0)
    assert "its recipe or the plant file has changed since it began: abandon sis_a" in held(rig)
    assert rig.operate(Verb.RESUME, CELL) is not None and rig.operate(Verb.RETRY, CELL) is not None
    assert ways(rig) == ["abandon"]
    restart(rig, model)
    rig.wait(1.0)
    assert rig.operate(Verb.RESUME, CELL) is None, "as it was when the task began"
    assert outcome(rig) is TaskState.DONE


def test_after_a_change_of_the_plant_file_the_part_is_brought_back(stage: Stage) -> None:
    rig, witness = stage()
    at(rig, "move to station 7")
    rig.wait(0.5)
    model = replace(rig.model, timing=replace(rig.model.timing, dwell_s=0.5))
    restart(rig, model, after_s=1.0)
    rig.wait(1.0)
    assert rig.operate(Verb.ABANDON, CELL) is None
    assert outcome(rig) is TaskState.FAILED
    assert rig.outcomes()[ID].reason is Reason.INTERRUPTED
    assert [switch.on for switch in witness.switches] == [True, False] and not witness.illegal


def test_what_a_plant_file_says_of_the_queue_is_no_change(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    (cell,) = rig.model.cells
    restart(rig, replace(rig.model, cells=(replace(cell, queue_limit=7, goes_on=True),)))
    rig.wait(5.0)
    assert rig.operate(Verb.RESUME, CELL) is None


@pytest.mark.parametrize("kept", ["", "{}", "[1]", '{"version": 99}', "no JSON"])
def test_a_trail_that_cannot_be_read_leaves_only_the_recovery(stage: Stage, kept: str) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    rig.disk.facts[Fact.STEP][ID] = kept
    restart(rig)
    rig.wait(1.0)
    assert "what was kept of it cannot be read: abandon sis_a" in held(rig)
    assert rig.operate(Verb.ABANDON, CELL) is None
    assert outcome(rig) is TaskState.FAILED


def test_nobody_can_resume_before_the_devices_are_heard(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    rig.lost = faults.from_board("ra_1")
    restart(rig, after_s=2.0)
    rig.wait(2.0)
    refusal = rig.operate(Verb.RESUME, CELL)
    assert refusal == "ra1 was not heard yet; until then nobody can tell what became of the step of sis_a"
    rig.lost = lambda publication: False
    rig.wait(1.0)
    assert rig.operate(Verb.RESUME, CELL) is None


def test_who_resumes_in_the_very_step_in_which_the_plant_starts_is_told_to_wait(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    rig.plant_process.stop()
    rig.plant_process.start()
    refusal = rig.operate(Verb.RESUME, CELL)
    assert refusal == "ra1 was not heard yet; until then nobody can tell what became of the step of sis_a"


def test_a_cell_that_goes_on_by_itself_waits_for_a_word_on_its_task(stage: Stage) -> None:
    rig, _ = stage(goes_on=True)
    at(rig, "move to pick-up")
    rig.submit(f"{CELL} 0B 3 #lot-2")
    restart(rig)
    before = len(commands(rig))
    rig.wait(20.0)
    assert len(commands(rig)) == before
    assert rig.operate(Verb.RESUME, CELL) is None
    assert outcome(rig) is TaskState.DONE
    assert rig.wait(120.0, until=lambda: rig.outcomes()["lot-2"].state is TaskState.DONE)


def test_a_stop_that_was_kept_ends_the_task(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    rig.disk.facts.setdefault(Fact.LATCH, {})["ra1"] = "on"
    restart(rig)
    assert run(rig).state is CellState.ABORTED
    assert rig.outcomes()[ID].state is TaskState.FAILED


def test_where_a_task_stands_is_forgotten_with_its_end(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "system start/dwell")
    assert ID in rig.disk.facts[Fact.STEP]
    assert outcome(rig) is TaskState.DONE
    assert not rig.disk.facts[Fact.STEP]


def test_each_command_leaves_after_the_step_that_it_is_of_was_kept(stage: Stage) -> None:
    rig, _ = stage()
    kept = ""
    rig.submit(TASK)
    assert outcome(rig) is TaskState.DONE
    seen = 0
    for message in rig.sent:
        if isinstance(message, Remember) and message.fact is Fact.STEP and message.value:
            kept = message.value
        elif isinstance(message, Command) and not isinstance(message, Stop):
            assert f'"robot":"{message.robot}"' in kept, "the step that gives it was kept before"
            seen += 1
    assert seen == 6
    steps = [each for each in rig.sent if isinstance(each, Remember) and each.fact is Fact.STEP]
    assert len(steps) < 2 * seen + 5, "once a step"


def served(rig: Rig) -> TaskState:
    """The end of the task, with somebody who does what is advised first."""
    for _ in range(20):
        if rig.wait(15.0, until=lambda: rig.outcomes()[ID].state in ENDED):
            break
        first = next((each for each in rig.plant.advice(CELL) if each.refusal is None), None)
        if first is not None and isinstance(first.do, Verb):
            rig.operate(first.do, first.scope, by_hand=first.by_hand)
    return rig.outcomes()[ID].state


@pytest.mark.long
@pytest.mark.parametrize("bridge", [True, False], ids=["bridge_too", "plant_alone"])
def test_killed_between_any_two_messages_it_picks_once_and_places_once(bridge: bool) -> None:
    number, ended = 1, False
    while not ended:
        rig = Rig(shipped(CELL))
        witness = Witness(rig)
        rig.wait(0.5)
        plant = Mortal(rig, number)
        rig.submit(TASK)
        ended = not rig.wait(60.0, until=lambda: plant.is_dead)  # noqa: B023 - called at once
        restart(rig, bridge=bridge, after_s=1.5)
        assert served(rig) is TaskState.DONE, number
        assert [switch.on for switch in witness.switches] == [True, False], number
        assert full(rig) == ["station_7"], number
        assert not witness.illegal and not witness.false_successes, number
        number += 1
    assert number > 20


@pytest.mark.parametrize("step", ["drive path 0B", "effector on/switch", "move to station 7"])
def test_a_plant_that_is_asked_to_end_halts_and_leaves_its_task_for_the_next_start(
    stage: Stage, step: str
) -> None:
    rig, witness = stage()
    at(rig, step)
    rig.tell(Shutdown(at=rig.now))
    assert rig.wait(5.0, until=lambda: rig.plant.at_rest)
    assert not any(board.body.moving for board in rig.boards.values())
    assert rig.outcomes()[ID].state is TaskState.RUNNING
    restart(rig, after_s=2.0)
    rig.wait(1.0)
    assert stands_at(step) in held(rig)
    assert rig.operate(Verb.RESUME, CELL) is None
    assert outcome(rig) is TaskState.DONE
    assert [switch.on for switch in witness.switches] == [True, False]


def test_what_a_run_that_ends_has_begun_ends_with_it(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    rig.tell(Shutdown(at=rig.now, drops_waiting=True))
    assert rig.outcomes()[ID].state is TaskState.FAILED
    assert not rig.disk.facts[Fact.STEP]


def test_what_an_earlier_start_had_accepted_does_not_end_with_a_run(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to pick-up")
    restart(rig)
    rig.wait(3.0)
    rig.tell(Shutdown(at=rig.now, drops_waiting=True))
    assert rig.outcomes()[ID].state is TaskState.RUNNING
    assert ID in rig.disk.facts[Fact.STEP]
