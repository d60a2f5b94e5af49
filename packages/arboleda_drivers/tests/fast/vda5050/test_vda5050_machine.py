"""The driver of VDA 5050 against a virtual vehicle: what counts as proof, and what each fault becomes."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.drivers import MotionState, NotSent, Report, Stop, StopMode
from arboleda.kinds.mobile import FollowPath
from arboleda_drivers.connections.link import LogLine
from arboleda_drivers.vda5050.messages import Headers
from arboleda_drivers.vda5050.settings import EdgeAction, Settings
from arboleda_drivers.vda5050.stops import AGAIN_S
from arboleda_drivers.vda5050.virtual.faults import FAULTS
from arboleda_drivers.vda5050.virtual.machine import VirtualAgv
from arboleda_drivers.vda5050.virtual.words import state_of

from .vda5050_rig import Rig, devices

WAY_S = 4.0  # three edges of 0.4 m at 0.5 m/s


@pytest.fixture
def rig() -> Rig:
    rig = Rig()
    rig.run(0.5)
    return rig


@pytest.fixture(params=["2.0", "2.1", "3.0"])
def horned(request: pytest.FixtureRequest) -> Rig:
    """A horn is sounded between the nodes 3 and 6."""
    horn = EdgeAction(between=("3", "6"), action="sound_horn", values={"loudness_db": 60})
    rig = Rig(request.param, edges=(horn,))
    rig.run(0.5)
    return rig


@pytest.mark.parametrize("version", ["2.0", "2.1", "3.0"])
def test_a_way_is_driven_and_proven_by_its_ids(version: str) -> None:
    rig = Rig(version)
    rig.run(0.5)
    rig.drive(0, 3, 6, 7)
    rig.run(1.0)
    assert (rig.reports["cart"].accepted, rig.reports["cart"].state) == ("1-1", MotionState.MOVING)
    assert rig.reports["cart"].done is None
    rig.run(WAY_S)
    said = rig.reports["cart"]
    assert (said.done, said.state, said.node, said.homed) == ("1-1", MotionState.STOPPED, 7, True)


def test_the_base_goes_two_nodes_ahead_and_grows_by_updates(rig: Rig) -> None:
    rig.drive(0, 3, 6, 7, 8)
    rig.run(WAY_S)
    orders = [said for topic, said in rig.received if topic == "order"]
    assert [said["orderUpdateId"] for said in orders] == [0, 1, 2]
    assert [[node["released"] for node in said["nodes"]] for said in orders] == [
        [True, True, True, False, False],
        [True, True, False],
        [True, True],
    ]
    assert [said["nodes"][0]["sequenceId"] for said in orders] == [0, 4, 6]


def test_without_a_plant_the_vehicle_stops_at_the_end_of_its_base(rig: Rig) -> None:
    rig.drive(0, 3, 6, 7, 8)
    rig.faults.switch("vanish", on=True)
    rig.run(10)
    assert (rig.agv.node, rig.agv.driving) == ("6", False)


def test_a_base_of_0_releases_all(rig: Rig) -> None:
    rig = Rig(base=0)
    rig.run(0.5)
    rig.drive(0, 3, 6, 7, 8)
    assert all(node["released"] for node in rig.received[-1][1]["nodes"])


def test_a_way_begins_where_the_vehicle_stands(rig: Rig) -> None:
    rig.drive(6, 7)
    assert [node["nodeId"] for node in rig.received[-1][1]["nodes"]] == ["0", "3", "6", "7"]


def test_a_way_that_comes_by_its_goal_is_driven_to_its_end(rig: Rig) -> None:
    rig.drive(0, 3, 0)
    rig.run(0.4)
    assert rig.reports["cart"].done is None
    rig.run(WAY_S)
    assert rig.reports["cart"].done == "1-1"


def test_nodes_have_the_names_and_places_of_the_vehicle() -> None:
    rig = Rig(nodes=tuple("abcdefghi"), map="hall")
    rig.agv.node = "a"
    rig.run(0.5)
    rig.drive(0, 1)
    node = rig.received[-1][1]["nodes"][1]
    assert node["nodeId"] == "b"
    assert node["nodePosition"] == {"x": pytest.approx(0.4), "y": 0.0, "mapId": "hall"}


def test_a_verb_is_an_action_at_the_node_where_the_vehicle_stands(rig: Rig) -> None:
    rig.do("pick", height=0.4)
    assert rig.received[-1][1]["nodes"][0]["actions"][0]["actionParameters"] == [
        {"key": "height", "value": 0.4}
    ]
    rig.run(2)
    said = rig.reports["forks"]
    assert (said.done, said.fact("loaded")) == ("1-2", True)


def test_an_instant_verb_is_done_on_the_way() -> None:
    rig = Rig(instant=("drop",))
    rig.run(0.5)
    rig.drive(0, 3, 6)
    rig.do("drop")
    rig.run(1.3)
    assert (rig.reports["forks"].done, rig.reports["cart"].done) == ("1-2", None)


def test_an_edge_has_its_action_in_both_directions_and_counts_for_the_end(horned: Rig) -> None:
    rig = horned
    rig.drive(0, 3, 6, 3)
    edges = next(said["edges"] for topic, said in rig.received if topic == "order")
    assert [[each["actionType"] for each in edge["actions"]] for edge in edges] == [
        [],
        ["soundHorn"],
        ["soundHorn"],
    ]
    assert edges[1]["actions"][0]["actionParameters"] == [{"key": "loudnessDb", "value": 60}]
    assert edges[1]["actions"][0]["blockingType"] == "NONE"
    rig.run(2.5)
    assert (rig.agv.node, rig.reports["cart"].done) == ("3", None)  # the horn of the way back is still heard
    rig.run(1.0)
    assert rig.reports["cart"].done == "1-1"


def test_an_action_of_an_edge_that_fails_fails_the_way(horned: Rig) -> None:
    rig = horned
    rig.faults.switch("action_fails", on=True)
    rig.drive(0, 3, 6, 7, 8)
    rig.run(WAY_S)
    assert (rig.reports["cart"].failed, rig.reports["cart"].failure) == ("1-1", "actionError")


def test_an_action_that_blocks_holds_the_vehicle_on_its_edge() -> None:
    rig = Rig(edges=(EdgeAction(between=("0", "3"), action="wait", blocking="HARD"),))
    rig.run(0.5)
    rig.drive(0, 3)
    rig.run(0.9)
    assert (rig.agv.node, rig.reports["cart"].state) == ("0", MotionState.MOVING)
    rig.run(1.5)
    assert rig.reports["cart"].done == "1-1"


@pytest.mark.parametrize(
    ("between", "why"),
    [
        (("0", "9"), "no node '9'; there are 0, 1, 2, 3, 4, 5, 6, 7, 8"),
        (("0", "8"), "0 and 8 are no neighbours on the grid"),
    ],
)
def test_an_edge_that_is_none_is_named_in_the_plant_file(between: tuple[str, str], why: str) -> None:
    edges = (EdgeAction(between=("0", "1"), action="a"), EdgeAction(between=between, action="b"))
    settings = Settings(broker="nowhere", manufacturer="arboleda", serial="agv1", edges=edges)
    cart = devices()[0]
    assert list(settings.problems(cart)) == [(("edges", 1, "between"), why)]


def test_a_question_is_answered_by_the_result_of_its_action(rig: Rig) -> None:
    rig.do("detect_object")
    rig.run(0.1)
    assert [action.type for action in rig.agv.actions.values()] == ["detectObject"]
    rig.run(2)
    assert (rig.reports["forks"].answered, rig.reports["forks"].answer) == ("1-2", "empty")


def test_nothing_is_said_of_its_motion_until_it_has_named_what_it_was_told(rig: Rig) -> None:
    rig.faults.switch("hush", on=True)
    rig.drive(0, 3)
    rig.run(2)
    assert rig.reports["cart"].state is None
    assert rig.reports["cart"].accepted is None


def test_a_halt_counts_once_the_cancel_is_over(rig: Rig) -> None:
    rig.drive(0, 3, 6)
    rig.run(0.5)
    rig.faults.switch("deaf", on=True)
    rig.stop(StopMode.HALT)
    rig.run(WAY_S)
    assert rig.reports["cart"].state is not MotionState.STOPPED
    rig.faults.switch("deaf", on=False)
    rig.run(AGAIN_S)  # it is said again
    assert (rig.reports["cart"].state, rig.reports["cart"].done) == (MotionState.STOPPED, None)


def test_a_halted_vehicle_stands_short_of_its_goal(rig: Rig) -> None:
    rig.drive(0, 3, 6)
    rig.run(0.5)
    rig.stop(StopMode.HALT)
    rig.run(0.5)
    assert (rig.reports["cart"].state, rig.reports["cart"].done) == (MotionState.STOPPED, None)
    rig.drive(0, 3, id="1-3")
    rig.run(WAY_S)
    assert rig.reports["cart"].done == "1-3"


def test_a_latch_pauses_and_cancels_and_its_clear_ends_the_pause(rig: Rig) -> None:
    rig.drive(0, 3, 6)
    rig.run(0.5)
    rig.stop(StopMode.LATCH)
    rig.run(0.5)
    assert rig.reports["cart"].state is MotionState.STOP_LATCHED
    rig.stop(StopMode.CLEAR)
    rig.run(0.5)
    assert rig.reports["cart"].state is MotionState.STOPPED


@pytest.mark.parametrize("modes", [[StopMode.LATCH], [StopMode.LATCH, StopMode.HALT]])
def test_a_vehicle_that_has_ended_a_pause_and_is_not_paused_is_told_so_again(
    rig: Rig, modes: list[StopMode]
) -> None:
    rig.drive(0, 3, 6)
    rig.run(0.5)
    for mode in modes:
        rig.stop(mode)
    rig.run(0.5)
    rig.agv.paused = False  # a cancelled order has ended the pause, too
    rig.run(AGAIN_S + 0.5)
    assert rig.reports["cart"].state is MotionState.STOP_LATCHED
    rig.run(AGAIN_S)
    rig.agv.paused = False  # once it was, somebody at the vehicle may end that
    rig.run(AGAIN_S + 0.5)
    assert rig.reports["cart"].state is MotionState.STOPPED


def test_instant_actions_of_2_0_are_under_both_keys_that_its_vehicles_read() -> None:
    rig = Rig("2.0")
    rig.run(0.5)
    rig.stop(StopMode.CLEAR)
    assert rig.received[-1][1]["instantActions"] == rig.received[-1][1]["actions"]


def test_a_second_order_while_driving_is_not_sent(rig: Rig) -> None:
    rig.drive(0, 3)
    with pytest.raises(NotSent, match="still at its order"):
        rig.drive(0, 1, id="1-2")


def test_an_order_of_somebody_else_is_left_alone_and_named(rig: Rig) -> None:
    rig.agv.course.id, rig.agv.course.steps = "other", [{"nodeId": "9", "sequenceId": 4, "released": False}]
    rig.run(1.5)
    assert rig.reports["cart"].state is MotionState.MOVING
    with pytest.raises(NotSent, match="at the order other of somebody else"):
        rig.drive(0, 3)


def test_what_is_left_of_an_order_is_cancelled_when_the_vehicle_is_back(rig: Rig) -> None:
    rig.drive(0, 3, 6, 7, 8)
    rig.run(0.5)
    rig.faults.switch("vanish", on=True)
    rig.run(0.5)
    assert "the connection of arboleda/agv1 broke" in str(rig.reports["cart"].lost)
    rig.faults.switch("vanish", on=False)
    rig.run(1)
    assert [each["actionType"] for each in rig.received[-1][1]["actions"]] == ["cancelOrder"]
    assert (rig.reports["cart"].state, rig.agv.course.steps) == (MotionState.STOPPED, [])


def test_no_vehicle_of_that_name_is_told_with_those_that_there_are() -> None:
    rig = Rig()
    rig.faults.switch("vanish", on=True)
    rig.vehicle.link.neighbour("arboleda/agv2 (v2)")
    rig.run(1)
    assert "no vehicle arboleda/agv1 has said" in str(rig.reports["cart"].lost)
    assert "those that have: arboleda/agv2 (v2)" in str(rig.reports["cart"].lost)
    with pytest.raises(NotSent, match="no vehicle"):
        rig.drive(0, 3)


def test_a_boot_is_a_new_boot_id_and_forgets_the_order(rig: Rig) -> None:
    rig.drive(0, 3, 6)
    rig.run(0.5)
    before = rig.reports["cart"].boot_id
    rig.faults.switch("power_cycle", on=True)
    rig.run(0.5)
    assert rig.reports["cart"].state is MotionState.NO_LINK
    rig.faults.switch("power_cycle", on=False)
    rig.run(0.5)
    said = rig.reports["cart"]
    assert (said.state, said.done, said.accepted) == (MotionState.STOPPED, None, None)
    assert before is not None


# What becomes of a way with a fault half a second after it began: a field of the report, its value.
BECOMES = {
    "vanish": ("state", MotionState.NO_LINK),
    "power_cycle": ("state", MotionState.NO_LINK),
    "hush": ("done", None),
    "frozen": ("done", None),
    "late": ("done", "1-1"),
    "double": ("done", "1-1"),
    "garbled": ("done", None),
    "no_route": ("done", "1-1"),  # it has its order already
    "no_update": ("failure", "orderUpdateError"),
    "forget": ("failure", "order_lost"),
    "short": ("node", 6),
    "lie": ("failure", "ended_at_its_base"),
    "obstacle": ("state", MotionState.MOVING),
    "e_stop": ("failure", "stop_MANUAL"),
    "manual": ("failure", "mode_MANUAL"),
    "fatal": ("failure", "driveError"),
    "deaf": ("done", "1-1"),
    "action_fails": ("done", "1-1"),
    "action_stalls": ("done", "1-1"),
    "lost": ("homed", False),
    "slow": ("state", MotionState.MOVING),
}


@pytest.mark.parametrize("fault", BECOMES)
def test_what_becomes_of_a_way(rig: Rig, fault: str) -> None:
    rig.drive(0, 3, 6, 7)
    rig.run(0.5)
    rig.faults.switch(fault, on=True)
    rig.run(WAY_S)
    name, value = BECOMES[fault]
    assert getattr(rig.reports["cart"], name) == value


def test_a_vehicle_that_lies_says_done_at_a_node_that_is_not_the_goal() -> None:
    rig = Rig(base=0)
    rig.run(0.5)
    rig.faults.switch("lie", on=True)
    rig.drive(0, 3, 6, 7)
    rig.run(1)
    assert (rig.reports["cart"].done, rig.reports["cart"].node) == ("1-1", 0)  # so the plant sees it


def test_every_fault_has_a_row_but_the_one_that_the_connection_refuses() -> None:
    assert {*FAULTS} - {*BECOMES} == {"wrong_serial"}


def test_an_order_that_is_refused_is_rejected_with_the_vehicle_s_word(rig: Rig) -> None:
    rig.faults.switch("no_route", on=True)
    rig.drive(0, 3)
    rig.run(0.5)
    assert (rig.reports["cart"].rejected, rig.reports["cart"].refusal) == ("1-1", "noRouteError")
    assert rig.reports["cart"].state is MotionState.STOPPED


def test_an_action_that_fails_is_failed_with_the_vehicle_s_word(rig: Rig) -> None:
    rig.faults.switch("action_fails", on=True)
    rig.do("pick", height=0.0)
    rig.run(2)
    assert (rig.reports["forks"].failed, rig.reports["forks"].failure) == ("1-2", "actionError")


def test_a_vehicle_that_is_silent_for_too_long_is_lost() -> None:
    rig = Rig(silent_after_s=2.0)
    rig.run(0.5)
    rig.faults.switch("hush", on=True)
    rig.run(1.5)
    assert rig.reports["cart"].state is MotionState.STOPPED
    rig.run(1)
    assert "has told no state for 2 s" in str(rig.reports["cart"].lost)
    rig.faults.switch("hush", on=False)
    rig.run(1)
    assert rig.reports["cart"].state is MotionState.STOPPED


def test_a_vehicle_that_does_not_count_its_headers_is_heard_by_its_timestamps(rig: Rig) -> None:
    boots = rig.reports["cart"].boot_id
    for second in range(3):
        said = state(headerId=7, timestamp=f"2100-01-01T00:00:0{second}.000Z", driving=second == 2)
        rig.vehicle.state(rig.now, said)
        rig.run(0.5)
    assert (rig.reports["cart"].state, rig.reports["cart"].boot_id) == (MotionState.MOVING, boots)


def test_states_that_never_become_newer_are_named_where_the_vehicle_counts_as_silent() -> None:
    rig = Rig(silent_after_s=5.0)
    rig.run(0.5)
    rig.vehicle.state(rig.now, state(headerId=2**32 - 1, timestamp="1970-01-01T00:00:00.000Z"))
    said = [each for each in rig.vehicle.step(rig.now + 6.0) if isinstance(each, Report)]
    assert str(said[0].lost).startswith(
        "arboleda/agv1 has told no state that counts for 5 s: the last one has headerId 4294967295"
    )


def test_a_state_that_is_refused_is_named_while_there_is_no_other() -> None:
    rig = Rig()
    rig.vehicle.connection(0.0, {"connectionState": "ONLINE"})
    rig.vehicle.link.refuse("lastNodeSequenceId must be integer; it is 'two'")
    (report, *_) = (
        each
        for each in rig.vehicle.connection(0.0, {"connectionState": "ONLINE"})
        if isinstance(each, Report)
    )
    assert str(report.lost).endswith(
        "no state yet that could be read: lastNodeSequenceId must be integer; it is 'two'"
    )


def test_what_was_open_is_over_once_the_vehicle_has_said_what_breaks_the_machine(rig: Rig) -> None:
    rig.drive(0, 3, 6, 7)
    rig.run(0.5)
    lost = [each for each in rig.vehicle.lose(rig.now, "it has said [[]]") if isinstance(each, Report)]
    assert {str(each.lost) for each in lost} == {
        "arboleda/agv1 is there, and has told no state yet that could be read: it has said [[]]"
    }
    rig.run(60)
    assert rig.reports["cart"].state is MotionState.STOPPED and rig.reports["cart"].done is None


def state(**news: Any) -> dict[str, Any]:
    """A state as it is read, with changes."""
    headers = Headers("2.1", "arboleda", "agv1")
    return {**headers("state"), **state_of(VirtualAgv(version="2.1"), (), "2.1"), **news}


def motion_told(rig: Rig, number: int, refused: str, **news: Any) -> MotionState | None:
    """The motion of the cart by a numbered state that refuses an action by an error alone."""
    about = [{"referenceKey": "actionId", "referenceValue": refused}]
    error = {"errorType": "noOrderToCancel", "errorLevel": "WARNING", "errorReferences": about}
    said = rig.vehicle.state(rig.now, state(headerId=2**20 + number, errors=[error], **news))
    return next(each.state for each in said if isinstance(each, Report) and each.robot == "cart")


def test_a_cancel_that_is_refused_by_an_error_alone_is_over(rig: Rig) -> None:
    rig.faults.switch("deaf", on=True)
    rig.stop(StopMode.HALT)
    (cancel,) = rig.received[-1][1]["actions"]
    assert motion_told(rig, 1, "another") is not MotionState.STOPPED
    assert motion_told(rig, 2, cancel["actionId"]) is MotionState.STOPPED


def test_a_second_cancel_that_is_refused_ends_no_cancel_under_way(rig: Rig) -> None:
    rig.faults.switch("deaf", on=True)
    rig.stop(StopMode.HALT)
    rig.stop(StopMode.HALT)
    first, second = (message["actions"][0]["actionId"] for _, message in rig.received[-2:])
    under_way = {"actionId": first, "actionType": "cancelOrder", "actionStatus": "RUNNING"}
    assert motion_told(rig, 1, second, actionStates=[under_way]) is not MotionState.STOPPED


def test_states_that_come_late_are_named_in_the_log(rig: Rig) -> None:
    def told(number: int, second: int, at: float, day: str = "2100-01-01T00:00") -> list[str]:
        said = state(headerId=2**20 + number, timestamp=f"{day}:{second:02}.000Z")
        return [each.text for each in rig.vehicle.state(at, said) if isinstance(each, LogLine)]

    rig.vehicle.connection(0.0, {"connectionState": "ONLINE"})
    assert not told(1, 0, 100.0) and not told(2, 1, 102.5)
    assert told(3, 2, 111.0) == ["the states of arboleda/agv1 come 9 s late, or its clock was set back"]
    assert not told(4, 12, 112.0)
    assert not told(5, 59, 86_499.0, day="2100-01-01T23:59")
    assert not told(6, 1, 86_501.0, day="2100-01-02T00:00")


def test_what_was_not_sent_is_not_open(rig: Rig) -> None:
    command = FollowPath(id="1-1", robot="cart", nodes=(0, 3))
    rig.vehicle.command(rig.now, command)
    rig.vehicle.unsent(command)
    rig.drive(0, 3, id="1-2")
    rig.run(WAY_S)
    assert rig.reports["cart"].done == "1-2"


def test_a_stop_without_a_link_is_not_sent() -> None:
    rig = Rig()
    with pytest.raises(NotSent):
        rig.vehicle.command(0.0, Stop(id="", robot="cart", mode=StopMode.HALT))
