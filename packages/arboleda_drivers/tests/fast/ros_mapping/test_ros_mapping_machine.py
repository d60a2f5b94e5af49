"""The driver `ros` without ROS 2: a test plays the action server, the services and the topics."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

from arboleda.drivers import Evidence, MotionState, Report, Stop, StopMode
from arboleda_drivers.connections.link import CommandNotSent
from arboleda_drivers.ros_action.events import Status
from arboleda_drivers.ros_action.presence import End
from arboleda_drivers.ros_mapping.events import CancelGoals, MessageHeard, Response, Send

from .rover import GO, GRIP, LOOK, PLANT, POSE, Rig, rover

STOP = "{publish: /halt, type: std_msgs/msg/Empty}"
HALT = Stop(id="9-9", robot="rover", mode=StopMode.HALT)
MAPPED_STOP = ("            namespace: /rover\n", "            namespace: /rover\n            halt: {}\n")


@pytest.fixture
def rig(tmp_path: Path) -> Rig:
    return Rig(rover(tmp_path))


def test_a_goal_is_done_once_the_topic_shows_what_the_verb_sets(rig: Rig) -> None:
    rig.begin("9-1")
    assert rig.last.accepted == "9-1" and rig.last.state is MotionState.MOVING
    rig.end("9-1")
    rig.wait(0.3)
    assert rig.last.done is None
    rig.x = 2.04
    rig.wait(0.2)
    assert rig.last.done == "9-1" and rig.last.fact("x") == 2.0 and rig.last.state is MotionState.STOPPED


def test_an_end_elsewhere_is_told_with_where_that_is(rig: Rig) -> None:
    rig.begin("9-1")
    rig.x = 1.2
    rig.end("9-1")
    rig.wait(1.3)
    assert rig.last.done == "9-1" and rig.last.fact("x") == pytest.approx(1.2)


@pytest.mark.parametrize(
    ("status", "code", "word"),
    [
        (Status.ABORTED, 3, "blocked"),
        (Status.ABORTED, 4, "code 4"),
        (Status.SUCCEEDED, 3, "blocked"),
        (Status.CANCELED, 0, "cancelled_by_another_client"),
    ],
)
def test_a_failure_has_the_word_of_its_field(rig: Rig, status: Status, code: int, word: str) -> None:
    rig.begin("9-1")
    rig.end("9-1", status, code)
    assert (rig.last.failed, rig.last.failure) == ("9-1", word)


def test_a_goal_that_is_never_accepted_has_failed_and_is_cancelled_where_it_comes_late(rig: Rig) -> None:
    rig.ask(rig.told("9-1", "go", x=2.0))
    rig.wait(2.1)
    assert (rig.last.failed, rig.last.failure) == ("9-1", "goal_not_answered")
    assert rig.count(CancelGoals) == 1 and rig.last.state is MotionState.MOVING
    rig.cancelled()
    rig.accept("9-1")
    assert rig.count(CancelGoals) == 2
    rig.cancelled()
    rig.end("9-1", Status.CANCELED)
    rig.wait(0.2)
    assert rig.last.state is MotionState.STOPPED


def test_what_never_is_accepted_holds_nothing_up_for_ever(rig: Rig) -> None:
    rig.ask(rig.told("9-1", "go", x=2.0))
    rig.wait(2.1)
    rig.cancelled()
    rig.wait(2.1)
    assert rig.last.state is MotionState.STOPPED


def test_a_halt_before_acceptance_cancels_again_once_the_goal_is_accepted(rig: Rig) -> None:
    rig.ask(rig.told("9-1", "go", x=2.0))
    rig.ask(HALT)
    rig.cancelled()
    assert rig.last.accepted == "9-9"
    rig.accept("9-1")
    assert rig.count(CancelGoals) == 2 and rig.last.accepted == "9-9"
    rig.end("9-1")
    rig.x = 2.0
    rig.wait(0.3)
    assert rig.last.done is None and rig.last.state is not MotionState.STOPPED
    rig.cancelled()
    assert rig.last.done is None and rig.last.state is MotionState.STOPPED


def test_a_halted_goal_that_its_server_forgets_is_over(rig: Rig) -> None:
    rig.begin("9-1")
    uuid = next(each.uuid for each in rig.said if isinstance(each, Send))
    rig.ask(HALT)
    rig.cancelled()
    rig.list(uuid)
    rig.wait(0.2)
    assert rig.last.state is MotionState.MOVING
    rig.list()
    rig.wait(0.2)
    assert rig.last.state is MotionState.STOPPED and rig.last.done is None


def test_a_goal_that_its_server_does_not_know_any_more_has_failed(rig: Rig) -> None:
    rig.begin("9-1")
    rig.end("9-1", Status.UNKNOWN)
    rig.wait(1.1)
    assert (rig.last.failed, rig.last.failure) == ("9-1", "goal_unknown_to_the_server")


def test_a_second_work_is_refused_and_a_question_beside_it_is_not(rig: Rig) -> None:
    rig.begin("9-1")
    rig.ask(rig.told("9-2", "go", x=0.0))
    assert (rig.last.rejected, rig.last.refusal) == ("9-2", "busy")
    rig.ask(rig.told("9-3", "grip", on="open"))
    assert rig.last.rejected == "9-3"
    rig.ask(rig.told("9-4", "look"))
    rig.respond("9-4", success=True, message="good")
    assert (rig.last.answered, rig.last.answer) == ("9-4", "good")


def test_a_cancel_that_is_refused_is_told_and_repeated(rig: Rig) -> None:
    rig.begin("9-1")
    rig.ask(HALT)
    rig.cancelled(refused=True)
    assert (rig.last.rejected, rig.last.refusal) == ("9-9", "cancel_refused")
    rig.wait(2.1)
    assert rig.count(CancelGoals) == 2


@pytest.mark.parametrize("end", [GO, GRIP, LOOK, POSE])
def test_what_is_gone_loses_the_link_and_open_work(rig: Rig, end: End) -> None:
    rig.begin("9-1")
    there, rig.found[end] = rig.found[end], ()
    rig.wait(1.1)
    assert rig.last.state is MotionState.NO_LINK and end.name in str(rig.last.lost)
    assert rig.count(CommandNotSent) == 0
    rig.ask(HALT)
    assert rig.count(CommandNotSent) == 1
    rig.found[end] = there
    rig.wait(0.1)
    assert rig.count(CancelGoals) == 1
    rig.end("9-1")
    rig.wait(1.5)
    assert rig.last.done is None


def test_two_servers_of_one_name_are_told(rig: Rig) -> None:
    rig.found[GO] = (7, 8)
    rig.wait(1.1)
    assert str(rig.last.lost) == "there are 2 action servers /rover/go; one is needed"


def test_a_server_that_was_started_anew_is_a_boot_and_knows_of_nothing(rig: Rig) -> None:
    rig.begin("9-1")
    before = rig.last.boot_id
    rig.found[GO] = (8,)
    rig.wait(0.2)
    assert rig.last.boot_id != before and rig.last.accepted is None
    assert rig.last.state is MotionState.STOPPED


def test_a_fact_that_only_a_verb_tells_is_unknown_until_one_ends_well(rig: Rig) -> None:
    assert set(rig.last.unknown) == {"holds", "left", "loud"}
    rig.ask(rig.told("9-1", "take", on=True))
    rig.respond("9-1", success=True, message="")
    assert rig.last.fact("holds") is True and rig.last.done == "9-1"
    rig.ask(rig.told("9-2", "take", on=False))
    rig.wait(0.2)
    assert "holds" in rig.last.unknown
    rig.tell(Response(id="9-2", message=None))
    assert rig.last.failed == "9-2" and "holds" in rig.last.unknown


def test_progress_is_that_of_the_goal(rig: Rig) -> None:
    rig.begin("9-1")
    rig.tell(MessageHeard(told=("feedback", "go"), message=SimpleNamespace(distance=1.5)))
    rig.wait(0.2)
    assert rig.last.fact("left") == 1.5
    rig.x = 2.0
    rig.end("9-1")
    rig.wait(0.1)
    rig.begin("9-2", x=0.0)
    rig.wait(0.2)
    assert "left" in rig.last.unknown


def test_a_topic_that_says_nothing_or_nonsense_loses_the_link(rig: Rig) -> None:
    rig.wait(2.1, hears=False)
    assert str(rig.last.lost) == "/rover/pose has said nothing for 2 s"
    rig.wait(0.6)
    assert rig.last.state is MotionState.STOPPED
    rig.hear("far")
    assert rig.last.state is MotionState.NO_LINK and "/rover/pose" in str(rig.last.lost)


def test_a_service_that_does_not_answer_in_time_has_failed_and_counts_as_at_work(rig: Rig) -> None:
    rig.ask(rig.told("9-1", "grip", on="closed"))
    rig.wait(9.6)
    assert (rig.last.failed, rig.last.failure) == ("9-1", "not_ended")
    assert rig.last.state is MotionState.MOVING
    rig.respond("9-1", success=True, message="")
    assert rig.last.state is MotionState.STOPPED and rig.last.done is None


def test_a_service_that_says_no_has_failed_by_its_own_words(rig: Rig) -> None:
    rig.ask(rig.told("9-1", "grip", on="closed"))
    rig.respond("9-1", success=False, message="no air")
    assert (rig.last.failed, rig.last.failure) == ("9-1", "no air")


def test_work_that_finishes_goes_on_through_a_stop(rig: Rig) -> None:
    rig.ask(rig.told("9-1", "grip", on="closed"))
    rig.ask(HALT)
    assert rig.last.accepted == "9-9" and rig.count(CancelGoals) == 0
    rig.respond("9-1", success=True, message="")
    rig.wait(0.1)
    assert rig.last.done == "9-1"


def test_a_stop_of_its_own_is_called_beside_the_cancels_until_it_says_yes(tmp_path: Path) -> None:
    call = "{service: /look, type: std_srvs/srv/Trigger, done: {success: true}, failure: {field: message}}"
    rig = Rig(rover(tmp_path, MAPPED_STOP[0], MAPPED_STOP[1].format(call)))
    rig.begin("9-1")
    rig.ask(HALT)
    rig.cancelled(refused=True)
    rig.respond("halt", success=False, message="no")
    assert (rig.last.rejected, rig.last.refusal) == ("9-9", "no")
    rig.wait(2.1)
    stops = [each for each in rig.said if isinstance(each, Send) and each.id == "halt"]
    assert len(stops) == 2


def test_what_is_published_counts_as_done_once_it_has_left_and_only_a_switch_does(rig: Rig) -> None:
    rig.ask(rig.told("9-1", "horn", loud=True))
    assert rig.last.done == "9-1" and rig.last.fact("loud") is True and rig.count(Send) == 1


def test_a_published_motion_is_seen_by_the_facts_that_change(tmp_path: Path) -> None:
    action = "action: go\n                type: rover_msgs/action/Go"
    rest = "\n                done: {code: 0}\n                failure: {field: code, words: {blocked: 3}}"
    text = PLANT.replace(action, "publish: go\n                type: rover_msgs/msg/Go").replace(rest, "")
    for each in ("      look: {effect", "              look: {service", "              left: {feedback"):
        text = "\n".join(line for line in text.split("\n") if not line.startswith(each))
    text = text.replace(", left: number", "").replace(MAPPED_STOP[0], MAPPED_STOP[1].format(STOP))
    rig = Rig(rover(tmp_path, PLANT, text))
    rig.found = {end: ids for end, ids in rig.found.items() if end != GO}
    rig.found |= {End("publish", name): (0,) for name in ("/rover/go", "/halt")}
    rig.wait(1.1)
    rig.ask(rig.told("9-1", "go", x=2.0))
    rig.x = 1.0
    rig.wait(0.2)
    assert rig.device.evidence is Evidence.JOINTS and rig.last.state is MotionState.MOVING
    rig.wait(1.0)
    assert rig.last.state is MotionState.STOPPED and rig.last.done is None


def test_goals_of_an_earlier_start_count_as_motion(rig: Rig) -> None:
    rig.list(bytes(16))
    rig.wait(0.2)
    assert rig.last.state is MotionState.MOVING
    rig.ask(HALT)
    rig.cancelled()
    rig.wait(0.2)
    assert rig.last.state is MotionState.STOPPED


def test_latched_is_told_until_it_is_cleared(rig: Rig) -> None:
    rig.ask(Stop(id="9-1", robot="rover", mode=StopMode.LATCH))
    rig.cancelled()
    rig.wait(0.1)
    assert rig.last.state is MotionState.STOP_LATCHED
    rig.ask(Stop(id="9-2", robot="rover", mode=StopMode.CLEAR))
    assert rig.last.accepted == "9-2" and rig.last.state is MotionState.STOPPED


def test_at_most_one_report_leaves_in_a_step(rig: Rig) -> None:
    for each in (rig.ask(rig.told("9-1", "go", x=2.0)), rig.ask(HALT)):
        assert sum(isinstance(message, Report) for message in each) <= 1
