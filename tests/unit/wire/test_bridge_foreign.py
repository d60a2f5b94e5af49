"""Commands of others while a plant is heard, copies of the plant's own, and what is said of refusals."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath, Mobile
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.messages import MotionState
from arboleda.model.plant_model import Evidence, ForeignCommands
from arboleda.wire.bridge import PLANT_GONE_S, UNSURE_S, Bridge
from arboleda.wire.copies import COPY_S
from arboleda.wire.hop import FromPlant, without_id
from arboleda.wire.payloads import StopGoal
from arboleda.wire.rejections import ForeignCommand, Rejection
from arboleda.wire.transport import Publication

from .conftest import EPOCH, Bench, link

MOVE = MoveJoints(id="", robot="ra1", q=(0.5, 0.1, 0.05))
GRIP = SetEffector(id="", robot="ra1", on=True)
HALT = Stop(id="", robot="ra1", mode=StopMode.HALT)
LATCH = Stop(id="", robot="ra1", mode=StopMode.LATCH)
CLEAR = Stop(id="", robot="ra1", mode=StopMode.CLEAR)
HOME = Home(id="", robot="ra1")


@pytest.fixture
def beaten(linked: Bench) -> Bench:
    linked.heartbeat()
    return linked


def obeying() -> Bench:
    bench = Bench()
    model = replace(bench.model, foreign_commands=ForeignCommands.OBEY)
    bench.bridge = Bridge(model, epoch=EPOCH, now=bench.now)
    bench.step()
    link(bench).heartbeat()
    return bench


def others(bench: Bench, command: Command, sender: str = "/teleop") -> list[object]:
    return list(bench.step(FromPlant(at=bench.now, message=command, sender=sender)))


def copied(bench: Bench, command: Command) -> list[object]:
    return list(bench.step(FromPlant(at=bench.now, message=command, copied=True)))


def copy(bench: Bench, command: Command) -> list[object]:
    return list(bench.step(FromPlant(at=bench.now, message=without_id(command))))


def news(messages: list[object]) -> list[str]:
    return [str(each.sentence) for each in messages if isinstance(each, Rejection | ForeignCommand)]


@pytest.mark.parametrize("command", [MOVE, GRIP, HOME, CLEAR], ids=lambda each: type(each).__name__)
def test_a_plants_robot_takes_no_command_of_another_node(beaten, sent, command: Command) -> None:
    out = others(beaten, command)
    assert sent(out) == []
    (rejection,) = [each for each in out if isinstance(each, Rejection)]
    assert (rejection.robot, rejection.id, rejection.reason) == ("ra1", "", "foreign")
    assert "/teleop was refused (foreign): a plant commands this robot" in str(rejection.sentence)


def test_the_plant_hears_of_it_who_and_how_often(beaten, reports) -> None:
    (report,) = reports(others(beaten, MOVE))
    assert (report.foreign_refused, report.foreign_obeyed, report.state) == (1, None, None)
    others(beaten, GRIP, "/panel")
    (telemetry,) = reports(beaten.tell())
    assert telemetry.foreign_refused == 2
    assert str(telemetry.foreign).startswith("ra1: effector_cmd 1 of /panel was refused")


def test_a_burst_of_them_makes_no_burst_of_reports(beaten, reports) -> None:
    out = [each for _ in range(100) for each in others(beaten, MOVE)]
    assert len(reports(out)) == 1
    assert len(news(out)) == 100


@pytest.mark.parametrize("command", [HALT, LATCH], ids=lambda each: each.mode.name)
def test_stops_are_obeyed_whoever_gives_them(beaten, sent, reports, command: Stop) -> None:
    out = others(beaten, command)
    assert sent(out) == [("ra_1/paro", StopGoal(mode=command.mode, seq=1, epoch=EPOCH))]
    assert news(out) == [f"ra1: stop_cmd {command.mode.value} of /teleop was obeyed"]
    assert reports(out)[0].foreign_obeyed == 1


def test_a_bridge_without_a_plant_obeys_and_finds_nothing_foreign(linked, sent, reports) -> None:
    out = others(linked, GRIP)
    assert [address for address, _ in sent(out)] == ["ra_1/efector"]
    assert news(out) == []
    assert reports(linked.tell())[0].foreign is None


def test_a_plant_that_is_gone_commands_nothing_any_more(beaten, sent) -> None:
    beaten.wait(PLANT_GONE_S - 0.2)
    beaten.tell()
    assert sent(others(beaten, GRIP)) == []
    beaten.wait(0.2)
    assert [address for address, _ in sent(others(beaten, GRIP))] == ["ra_1/efector"]


def test_the_plant_file_may_let_others_command(sent, reports) -> None:
    bench = obeying()
    out = others(bench, GRIP)
    assert [address for address, _ in sent(out)] == ["ra_1/efector"]
    assert news(out) == ["ra1: effector_cmd 1 of /teleop was obeyed"]
    assert reports(out)[0].foreign_obeyed == 1


def test_what_is_let_and_cannot_be_done_is_no_command_that_was_obeyed(reports) -> None:
    bench = obeying()
    out = others(bench, replace(MOVE, q=(900.0, 0.0, 0.0)))
    assert news(out) == [
        "ra1: joint_goals_q of /teleop was refused (limite): number 1 is 900; allowed: -2.618 to 2.618 rad"
    ]
    assert reports(out) == []


def test_a_copy_of_what_the_plant_said_is_nothing_of_its_own(beaten, sent) -> None:
    assert sent(copied(beaten, replace(GRIP, id="7-1")))
    assert copy(beaten, GRIP) == []


@pytest.mark.parametrize("command", [HALT, LATCH, GRIP, HOME], ids=lambda each: type(each).__name__)
def test_each_command_has_one_copy(beaten, command: Command) -> None:
    copied(beaten, replace(command, id="7-1"))
    copy(beaten, command)
    beaten.wait(UNSURE_S / 2)
    assert news(others(beaten, command)) == []
    assert len(news(list(beaten.wait(UNSURE_S)))) == 1


def test_a_late_copy_of_a_halt_does_not_end_the_next_move(beaten, sent) -> None:
    copied(beaten, replace(HALT, id="7-1"))
    beaten.wait(0.5)
    assert sent(beaten.order(replace(MOVE, id="7-2")))
    assert copy(beaten, HALT) == []


def test_a_copy_that_overtakes_is_told_of_by_nobody(beaten) -> None:
    copied(beaten, replace(CLEAR, id="7-1"))
    copy(beaten, CLEAR)
    assert news(copy(beaten, GRIP)) == []
    copied(beaten, replace(GRIP, id="7-2"))
    assert news(list(beaten.wait(1.0))) == []
    assert copy(beaten, GRIP) != [] or news(list(beaten.wait(1.0))) != []


def copy_before_its_original(bench: Bench) -> None:
    copy(bench, LATCH)
    copied(bench, replace(LATCH, id="7-3"))


def test_a_stop_of_another_node_is_obeyed_after_a_copy_that_came_before_its_original(beaten, sent) -> None:
    copied(beaten, replace(CLEAR, id="7-1"))
    copy(beaten, CLEAR)
    beaten.order(replace(MOVE, id="7-2"))
    copy_before_its_original(beaten)
    assert [address for address, _ in sent(others(beaten, LATCH))] == ["ra_1/paro"]
    assert news(list(beaten.wait(UNSURE_S))) == ["ra1: stop_cmd 1 of /teleop was obeyed"]


def test_neither_a_lost_link_nor_a_bridge_that_has_just_started_takes_that_stop_for_a_copy(
    beaten, sent
) -> None:
    beaten.presence(False)
    copy_before_its_original(beaten)
    link(beaten)
    assert [address for address, _ in sent(others(beaten, LATCH))] == ["ra_1/paro"]


def test_a_stop_is_obeyed_at_once_though_it_may_be_a_copy(beaten, sent) -> None:
    copied(beaten, replace(GRIP, id="7-1"))
    copy(beaten, GRIP)
    assert [address for address, _ in sent(others(beaten, HALT))] == ["ra_1/paro"]
    assert news(list(beaten.wait(UNSURE_S))) == ["ra1: stop_cmd 2 of /teleop was obeyed"]


def test_a_refusal_by_the_board_names_the_command(linked) -> None:
    linked.order(FollowPath(id="", robot="rm_sis_a", nodes=(5, 6)))
    out = linked.tell("rm_sis_a", ack_epoch=EPOCH, ack=0, refusal="limite", refused_seq=1)
    (rejection,) = [each for each in out if isinstance(each, Rejection)]
    assert (rejection.command, rejection.id, rejection.reason) == ("path_cmd", "", "limite")
    assert "begins at the robot's node or next to it" in str(rejection.sentence)
    again = linked.tell("rm_sis_a")
    assert news(list(again)) == []
    assert linked.bridge.counters["rm_sis_a"].refused == 1


def test_a_refused_command_of_the_plant_is_told_with_its_id(linked) -> None:
    out = linked.order(replace(MOVE, id="7-1", q=(9.0, 0.0, 0.0)))
    (rejection,) = [each for each in out if isinstance(each, Rejection)]
    assert (rejection.id, rejection.reason) == ("7-1", "limite")


def test_a_board_that_took_another_clients_command_betrays_it(linked, reports) -> None:
    linked.order(replace(MOVE, id="7-1"))
    linked.tell(ack_epoch=EPOCH, ack=1, state=MotionState.MOVING)
    out = linked.tell(ack_epoch=EPOCH + 50, ack=3, state=MotionState.MOVING)
    sentence = f"ra1: its board took a command of another MQTT client (epoca {EPOCH + 50}, seq 3)"
    assert news(list(out)) == [sentence]
    (report,) = reports(out)
    assert (report.foreign_obeyed, str(report.foreign)) == (1, sentence)
    assert news(list(linked.tell())) == []


def test_numbers_of_an_earlier_bridge_are_nobody_elses(bench) -> None:
    bench.connect()
    assert news(list(bench.tell(ack_epoch=EPOCH + 5, ack=9))) == []
    bench.order(replace(GRIP, id="7-1"))
    assert news(list(bench.tell())) == []


@pytest.mark.parametrize("evidence", [Evidence.JOINTS, Evidence.STATE])
def test_a_path_that_does_not_begin_where_its_robot_stands_is_said_once(evidence: Evidence) -> None:
    """A board without ids passes it over and tells nobody."""
    bench = Bench(evidence=evidence)
    bench.connect()
    mobile = bench.model.robots["rm_sis_a"]
    assert isinstance(mobile, Mobile)
    bench.tell(mobile.mqtt, node=4)
    near = sorted((4, *mobile.grid.neighbours(4)))
    far = next(node for node in range(mobile.grid.size) if node not in near)
    path = FollowPath(id="", robot="rm_sis_a", nodes=(far,))
    first = others(bench, path, "/original")
    (sentence,) = news(first)
    assert sentence.startswith("rm_sis_a: its board passes over path_cmd: ")
    assert sentence.endswith(
        f"it stands at node 4, where a path may begin at one of {', '.join(map(str, near))}"
    )
    assert any(isinstance(each, Publication) for each in first), "it is sent all the same"
    assert [each.reason for each in first if isinstance(each, Rejection)] == ["limite"]
    assert bench.bridge.counters["rm_sis_a"].refused == 1
    bench.tell(mobile.mqtt, node=4)
    assert news(others(bench, path, "/original")) == []


@pytest.mark.parametrize("begins", [4, 3])
def test_a_path_that_begins_where_its_robot_stands_or_next_to_it_is_no_news(begins: int) -> None:
    bench = Bench(evidence=Evidence.JOINTS)
    bench.connect()
    mobile = bench.model.robots["rm_sis_a"]
    bench.tell(mobile.mqtt, node=4)
    assert news(others(bench, FollowPath(id="", robot="rm_sis_a", nodes=(begins,)))) == []


@pytest.mark.parametrize("commanded_before", [False, True])
def test_a_number_that_the_plant_never_gave_halts_the_robot_and_the_next_one_is_above_it(
    beaten, sent, reports, commanded_before: bool
) -> None:
    if commanded_before:
        beaten.order(replace(MOVE, id="7-1"))
    out = beaten.tell(ack_epoch=EPOCH, ack=9999, state=MotionState.MOVING)
    assert news(out) == [f"ra1: its board took a command of another MQTT client (epoca {EPOCH}, seq 9999)"]
    assert reports(out)[-1].foreign_obeyed == 1
    (halt,) = [payload for address, payload in sent(beaten.heartbeat()) if address == "ra_1/paro"]
    assert isinstance(halt, StopGoal)
    assert (halt.mode, halt.epoch) == (StopMode.HALT, EPOCH + 1)
    again = dict(sent(beaten.order(replace(MOVE, id="7-2"))))
    assert again["ra_1/juntas"].epoch == EPOCH + 1


def test_without_a_plant_nobody_is_halted_for_what_a_board_took(linked, sent) -> None:
    linked.tell(ack_epoch=EPOCH, ack=9999, state=MotionState.MOVING)
    assert sent(linked.wait(1.0)) == []


def test_a_copy_that_came_too_early_hides_no_command_of_another_node_later(beaten) -> None:
    ours = [replace(HALT, id=f"7-{number}") for number in range(3)]
    copied(beaten, ours[0])
    copy(beaten, ours[0])
    copy(beaten, ours[1])
    assert news(beaten.wait(UNSURE_S))
    copied(beaten, ours[1])  # waits for a copy that has been
    beaten.wait(COPY_S - 1.0)
    copied(beaten, ours[2])
    copy(beaten, ours[2])
    beaten.wait(1.5)
    beaten.heartbeat()
    beaten.tell()
    told = others(beaten, HALT) + beaten.wait(UNSURE_S)
    assert news(told) == ["ra1: stop_cmd 2 of /teleop was obeyed"]


@pytest.mark.parametrize("is_heard", [True, False])
def test_a_copy_that_came_long_before_its_original_hides_no_command_of_another_node(
    beaten, sent, *, is_heard: bool
) -> None:
    ours = replace(HALT, id="7-1")
    beaten.presence(is_heard)
    copy(beaten, ours)
    beaten.wait(COPY_S / 2)
    copied(beaten, ours)
    beaten.heartbeat()
    beaten.wait(COPY_S / 2)
    link(beaten)
    assert [address for address, _ in sent(others(beaten, HALT))] == ["ra_1/paro"]
    assert news(list(beaten.wait(UNSURE_S))) == ["ra1: stop_cmd 2 of /teleop was obeyed"]


def test_a_command_of_another_node_is_not_taken_for_a_copy_of_what_the_plant_gives_after_it(beaten) -> None:
    assert len(news(others(beaten, HALT) + beaten.wait(UNSURE_S))) == 1
    beaten.wait(1.0)
    ours = replace(HALT, id="7-1")
    copied(beaten, ours)
    assert copy(beaten, ours) == []


def test_the_original_of_a_copy_that_waited_too_long_brings_no_other_copy(beaten, sent) -> None:
    ours, came_at = replace(GRIP, id="7-1"), beaten.now
    beaten.wait(3.0)
    beaten.step(FromPlant(at=came_at, message=without_id(ours)))
    copied(beaten, ours)
    link(beaten).heartbeat()
    assert sent(others(beaten, GRIP)) == []
    assert news(list(beaten.wait(UNSURE_S))) == [
        "ra1: effector_cmd 1 of /teleop was refused (foreign): a plant commands this robot "
        "(foreign_commands: refuse)"
    ]
