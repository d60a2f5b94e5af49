"""The world: time, processes that stall, die and come back, and what they take with them."""

from __future__ import annotations

import pytest

from arboleda.model.messages import Heartbeat, Verb
from arboleda.rig.world import BRIDGE, PLANT, World
from arboleda.testing import shipped
from arboleda.wire.transport import Publication
from arboleda_proofs.simulator.trace import Trace

TASK = "sis_a 0B 7"


@pytest.fixture
def world():
    world = World(shipped("sis_a"))
    world.advance(0.5)
    return world


class Log:
    """Messages in a world from now on: (time, ...) of each."""

    def __init__(self, world):
        self.world = world
        self.published, self.delivered, self.sent, self.executed = [], [], [], []
        world.watchers.append(self._look)

    def _look(self):
        now, moment = self.world.now, self.world.moment
        self.published += [(now, *each) for each in moment.published]
        self.delivered += [(now, *each) for each in moment.delivered]
        self.sent += [(now, each) for each in moment.sent]
        self.executed += [(now, *each) for each in moment.executed]

    def of(self, board, channel="sensores"):
        """The payloads that a board published on a channel."""
        return [each.payload for _, _, each in self.published if each.topic == f"{board}/{channel}"]


def test_a_task_is_carried_out(world):
    world.request_task(TASK)
    assert world.advance(60.0, until=lambda: world.plant.cells["sis_a"].task is not None)
    assert world.advance(60.0, until=lambda: world.plant.cells["sis_a"].task is None)
    assert world.plant.at_rest
    assert [task.state.value for task in world.plant.intake.tasks.values()] == ["done"]


def test_two_worlds_do_the_same():
    digests = set()
    for _ in range(2):
        world = World(shipped())
        trace = Trace(world)
        world.watchers.append(trace.look)
        for cell in ("sis_a", "sis_b", "sis_c"):
            world.request_task(f"{cell} 1B 4")
        world.advance(5.0)
        world.crash("ra_1")
        world.crash(BRIDGE)
        world.advance(10.0)
        digests.add(trace.digest)
    assert len(digests) == 1


def test_time_goes_as_far_as_asked_and_no_further(world):
    begin = world.now
    assert not world.advance(1.234)
    assert world.now == pytest.approx(begin + 1.234)
    assert world.advance(10.0, until=lambda: world.now > begin + 2.0)
    assert world.now < begin + 2.5


def test_the_agenda_is_worked_off_by_time_and_then_in_order(world):
    done, now = [], world.now
    for name, at in (("late", now + 0.3), ("first", now + 0.1), ("second", now + 0.1), ("overdue", now - 5)):
        world.at(at, done.append, name)
    world.advance(1.0)
    assert done == ["overdue", "first", "second", "late"]


@pytest.mark.parametrize("process", ["ra_1", BRIDGE, PLANT])
def test_who_stalls_does_nothing_and_goes_on_with_what_waited(world, process):
    log = Log(world)
    world.stall(process, 2.0)
    world.advance(1.9)
    said = {
        "ra_1": lambda: log.of("ra_1"),
        BRIDGE: lambda: [each for _, name, each in log.published if name == BRIDGE],
        PLANT: lambda: [each for _, each in log.sent if isinstance(each, Heartbeat)],
    }[process]
    assert world.is_stalled(process)
    assert said() == []
    world.request_task(TASK)
    world.advance(2.0)
    assert not world.is_stalled(process)
    assert said()


def test_stalls_that_overlap_last_as_long_as_the_longer_one(world):
    begin = world.now
    world.stall(PLANT, 2.0)
    world.advance(0.5)
    world.stall(PLANT, 0.5)
    world.advance(begin + 1.9 - world.now)
    assert world.is_stalled(PLANT)
    world.advance(0.2)
    assert not world.is_stalled(PLANT)


def test_where_everybody_stalls_time_goes_on(world):
    began = world.now
    for process in (PLANT, BRIDGE, *world.boards):
        world.stall(process, 1.0)
    world.advance(2.0)
    assert world.now == began + 2.0
    world.request_task(TASK)
    assert world.advance(60.0, until=lambda: world.plant.cells["sis_a"].task is not None)


def test_a_stall_can_end_early(world):
    world.stall("ra_1", 10.0)
    world.advance(1.0)
    log = Log(world)
    world.go_on("ra_1")
    world.advance(1.0)
    assert log.of("ra_1")


@pytest.mark.parametrize("ends_first", ["the stall", "the outage"])
@pytest.mark.parametrize("process", ["ra_1", BRIDGE])
def test_a_process_can_be_gone_while_it_stalls(world, process, ends_first):
    stalled_s, gone_s = (0.5, 2.0) if ends_first == "the stall" else (2.0, 0.5)
    world.stall(process, stalled_s)
    off, on = (
        (world.stop_bridge, world.start_bridge)
        if process == BRIDGE
        else (lambda: world.power_off("ra_1"), lambda: world.power_on("ra_1"))
    )
    off()
    assert not world.is_on(process)
    world.advance(gone_s)
    on()
    world.advance(3.0)
    assert world.plant.dispatcher.beliefs["ra1"].online


def test_the_broker_can_restart_while_the_bridge_is_gone(world):
    world.stop_bridge()
    world.stop_broker()
    world.advance(1.0)
    world.start_broker()
    world.advance(1.0)
    world.start_bridge()
    world.advance(1.0)
    assert world.plant.dispatcher.beliefs["ra1"].online


@pytest.mark.parametrize(("will_after_s", "told"), [(0.0, True), (1.0, True), (3.0, False)])
def test_the_last_will_is_told_unless_the_board_is_back_before(world, will_after_s, told):
    log = Log(world)
    world.power_off("ra_1", will_after_s=will_after_s)
    world.advance(2.0)
    world.power_on("ra_1")
    world.advance(3.0)
    assert log.of("ra_1", "conexion") == ([b"0", b"1"] if told else [b"1"])
    assert world.broker.retained["ra_1/conexion"].payload == b"1"


def test_a_board_without_power_says_and_hears_nothing(world):
    log = Log(world)
    world.power_off("ra_1")
    world.publish(Publication(topic="ra_1/paro", payload=b'{"paro":1,"seq":1,"epoca":1}'))
    world.advance(5.0)
    assert log.of("ra_1") == []
    assert not [name for _, name, _ in log.delivered if name == "ra_1"]
    assert not world.plant.dispatcher.beliefs["ra1"].online


def test_a_board_comes_back_as_another_boot_that_knows_nothing(world):
    board = world.boards["ra_1"]
    boot_id = board.boot_id
    world.crash("ra_1")
    world.advance(0.5)
    assert board.boot_id > boot_id
    assert not board.homed
    assert "ra_1" not in world.obeyed


def test_the_world_knows_what_each_board_obeyed_last(world):
    assert world.obeyed == {}
    world.request_verb(Verb.STOP, "ra1")
    world.advance(0.5)
    assert world.obeyed["ra_1"].mode.name == "LATCH"
    assert "rm_sis_a" not in world.obeyed


def test_a_broker_that_restarts_forgets_what_it_retained_and_hears_it_anew(world):
    world.stop_broker()
    assert not world.broker.retained
    world.advance(1.0)
    assert not world.plant.dispatcher.beliefs["ra1"].online
    world.start_broker()
    world.advance(1.0)
    assert world.broker.retained["ra_1/conexion"].payload == b"1"
    assert world.plant.dispatcher.beliefs["ra1"].online


def test_a_bridge_that_restarts_names_another_epoch(world):
    epoch = world.plant.dispatcher.beliefs["ra1"].epoch
    world.crash(BRIDGE)
    world.advance(1.0)
    assert world.plant.dispatcher.beliefs["ra1"].epoch > epoch


def test_a_plant_that_restarts_keeps_what_it_had_to(world):
    world.request_verb(Verb.STOP)
    world.advance(0.5)
    epoch = world.plant.epoch
    world.crash(PLANT)
    world.advance(0.5)
    assert world.plant.epoch > epoch
    assert world.plant.dispatcher.latches.stopped == {"ra1", "rm_sis_a"}


def test_carriers_alter_what_is_published(world):
    world.carriers.append(lambda each: () if each.topic == "ra_1/sensores" else (each, each))
    log = Log(world)
    world.advance(0.35)
    heard = [delivery.topic for _, name, delivery in log.delivered if name == BRIDGE]
    assert heard.count("ra_1/sensores") == 0
    assert heard.count("rm_sis_a/sensores") == 2 * len(log.of("rm_sis_a")) > 0
