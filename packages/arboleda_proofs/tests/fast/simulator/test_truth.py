"""Truth of a world that the plant may be wrong about."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.cells import with_poses, with_robot

from arboleda.model.commands import StopMode
from arboleda.model.messages import Report, Verb
from arboleda.model.plant_model import APART_S, Crossing, Evidence, PlantModel
from arboleda.rig.world import PLANT, World
from arboleda.testing import shipped, slowed
from arboleda.wire.payloads import HomeGoal, JointsGoal, StopGoal, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Publication
from arboleda.wire.units import to_wire
from arboleda_proofs.simulator.invariants.grips import parts_conserved
from arboleda_proofs.simulator.invariants.invariant import Look
from arboleda_proofs.simulator.record import Record
from arboleda_proofs.simulator.truth.arm import ArmTruth
from arboleda_proofs.simulator.truth.part_places import CellPlaces
from arboleda_proofs.simulator.truth.truth import Truth

ARM, MOBILE = "ra_1", "rm_sis_a"


def zoned() -> PlantModel:
    """The shipped plant; all pick-ups lie in `centre`, and ra1 crosses `aisle` from its station 7 to home."""
    plant = shipped()
    return replace(plant, zones=("centre", "aisle"), cells=tuple(map(_zoned, plant.cells)))


def _zoned(cell):
    pickup = replace(cell.taker.targets["pickup"], zones=frozenset({"centre"}))
    crossings = (Crossing(a="home", b="station 7", zones=frozenset({"aisle"})),)
    crossings = crossings if cell.name == "sis_a" else ()
    return with_poses(cell, *crossings, pickup=pickup)


class Stage:
    """A world and its truth; `arm` is ra1's."""

    def __init__(self, model: PlantModel) -> None:
        self.world = World(model)
        self.truth = Truth(self.world)
        self.world.watchers.append(self.truth.look)
        self.zones: list[frozenset[str]] = []
        self.world.watchers.append(self._keep)
        self.world.advance(0.5)

    @property
    def arm(self) -> ArmTruth:
        return self.truth.grips.effectors["ra1"].arm

    @property
    def places(self) -> CellPlaces:
        return self.truth.places.cells["sis_a"]

    def carry(self) -> None:
        """Be in the middle of the way from the pick-up to the place of a task."""
        self.ask("sis_a 0B 7")
        self.until(lambda: self.arm.holding and self.arm.moving)

    @property
    def body(self):
        return self.world.boards[ARM].body

    def ask(self, text: str, seconds: float = 0.0) -> None:
        self.world.request_task(text)
        self.world.advance(seconds)

    def until(self, found) -> None:
        assert self.world.advance(60.0, until=found)

    def _keep(self) -> None:
        if self.arm.zones not in self.zones[-1:]:
            self.zones.append(self.arm.zones)


@pytest.fixture
def stage() -> Stage:
    return Stage(shipped("sis_a"))


def test_an_arm_is_at_the_poses_where_it_stands_and_nowhere_on_its_way(stage):
    assert stage.arm.here == {"home"}
    stage.ask("sis_a palletizing")
    stage.until(lambda: stage.arm.moving and "pick-up" in stage.arm.goal)
    assert not stage.arm.here
    stage.until(lambda: stage.arm.here == {"pick-up"})


def test_power_takes_the_counters_but_not_the_arm(stage):
    stage.ask("sis_a palletizing")
    stage.until(lambda: stage.arm.here == {"pick-up"})
    stood = stage.arm.true
    stage.world.crash(ARM)
    stage.world.advance(0.1)
    assert stage.body.motors.position == (0, 0, 0)
    assert (stage.arm.true, stage.arm.here, stage.arm.homed) == (stood, {"pick-up"}, False)


def test_lost_steps_are_told_from_those_that_a_boot_forgets_until_homing_finds_them(stage):
    stage.ask("sis_a palletizing")
    stage.until(lambda: stage.arm.here == {"pick-up"})
    stage.body.motors.lose_steps(0, 5)
    stage.world.crash(ARM)
    stage.world.advance(20.0)
    assert (stage.arm.lost, stage.arm.here) == ((5, 0, 0), {"pick-up"})
    stage.world.request_verb(Verb.HOME, "ra1")
    stage.until(lambda: stage.arm.homed)
    assert (stage.arm.lost, stage.arm.true, stage.arm.at_reference) == ((0, 0, 0), (0, 0, 0), True)


def test_an_arm_that_lost_a_few_steps_counts_as_where_it_would_be(stage):
    stage.body.motors.lose_steps(1, -2)
    stage.ask("sis_a palletizing")
    stage.until(lambda: stage.arm.here == {"pick-up"})
    assert stage.arm.true[1] == stage.arm.intended[1] - 2
    assert stage.arm.stands_at(stage.arm.cell.taker.targets["pickup"].q)


def drive_beside(stage: Stage, steps: int) -> None:
    """Have ra1 stand so many steps of its first joint beside its pick-up, by its own count."""
    joints, (first, *others) = stage.arm.arm.joints, stage.arm.cell.taker.targets["pickup"].q
    goal = (first + steps * joints[0].step, *others)
    degrees = tuple(to_wire(joint, value) for joint, value in zip(joints, goal, strict=True))
    stage.body.start(round(stage.world.now * 1e6), JointsGoal(q_deg=degrees, seq=None, epoch=None))
    stage.world.wake(ARM)
    stage.world.advance(5.0)
    assert not stage.arm.moving


@pytest.mark.parametrize(("beside", "here"), [(2, {"pick-up"}), (4, set())])
def test_an_arm_stands_at_a_pose_within_its_tolerance(beside, here):
    model = shipped("sis_a")
    (cell,) = model.cells
    arm = cell.roles["arm"]
    tolerance = (3 * arm.joints[0].step, *arm.motion.tolerances[1:])
    stage = Stage(replace(model, cells=(with_robot(cell, "arm", tolerance=tolerance),)))
    drive_beside(stage, beside)
    assert stage.arm.here == here


def found_by_parts_conserved(stage: Stage) -> list[str]:
    look = Look(world=stage.world, truth=stage.truth, record=Record(stage.world))
    return [*parts_conserved.rule(look)]


def test_a_part_is_gripped_where_the_axes_truly_are(stage):
    found = []
    stage.world.watchers.append(lambda: found.extend(found_by_parts_conserved(stage)))
    stage.body.motors.lose_steps(0, 5)
    drive_beside(stage, -5)
    stage.body.switch_effector(True)
    stage.world.advance(0.2)
    assert (stage.arm.here, stage.arm.holding, found) == (set(), True, [])


def test_a_part_is_gripped_where_an_arm_stood_that_has_moved_on_in_the_same_step(stage):
    drive_beside(stage, 0)
    stage.body.switch_effector(True)
    stage.body.start(round(stage.world.now * 1e6), JointsGoal(q_deg=(0.0, 0.0, 0.0), seq=None, epoch=None))
    stage.body.advance(round(stage.world.now * 1e6) + 100_000)
    stage.truth.look()
    assert stage.arm.holding and not stage.arm.reaches
    assert found_by_parts_conserved(stage) == []


def test_a_move_sweeps_the_zones_of_both_ends_and_those_between():
    stage = Stage(zoned())
    stage.ask("sis_a 0B 7", 20.0)
    assert stage.zones == [set(), {"centre"}, set(), {"aisle"}, set()]


def test_a_halted_arm_is_in_all_that_it_may_have_swept_until_it_stands_at_a_pose_again():
    stage = Stage(zoned())
    stage.ask("sis_a palletizing")
    stage.until(lambda: "pick-up" in stage.arm.goal)
    stage.world.advance(0.2)
    stage.world.crash(ARM)
    stage.world.advance(10.0)
    assert (stage.arm.here, stage.arm.zones) == (set(), {"centre"})
    stage.world.request_verb(Verb.HOME, "ra1")
    stage.until(lambda: bool(stage.arm.here))
    assert stage.arm.zones == set()


def test_an_arm_that_is_halted_near_a_pose_on_its_way_is_where_the_way_is():
    plant = shipped("sis_a")
    cell = plant.cells[0]
    space, arm = cell.taker, cell.roles["arm"]
    home, pickup = replace(space.home, q=(0.0, 0.0, 0.0)), replace(space.targets["pickup"], q=(1.0, 0.0, 0.0))
    between = replace(cell.stations[4], q=(0.5, 0.0, 0.0), zones=frozenset({"rack"}))
    cell = with_robot(cell, "arm", tolerance=(0.35, *arm.motion.tolerances[1:]))
    cell = with_poses(cell, home=home, pickup=pickup, station_4=between)
    stage = Stage(replace(plant, zones=("rack",), cells=(cell,)))
    stage.ask("sis_a 0B 7")
    stage.until(lambda: stage.body.motors.true_position[0] * arm.joints[0].step > 0.2)
    stage.world.request_verb(Verb.HOLD, "sis_a")
    stage.until(lambda: "station 4" in stage.arm.here)
    assert stage.arm.zones == set()
    for verb in (Verb.ABANDON, Verb.RESUME):
        stage.world.request_verb(verb, "sis_a")
        stage.world.advance(10.0)
    stage.ask("sis_a 0B 4")
    stage.until(lambda: stage.arm.zones == {"rack"})


def test_a_part_goes_from_the_pick_up_to_its_station(stage):
    switched = []
    stage.world.watchers.append(lambda: switched.extend(stage.truth.grips.switched))
    stage.ask("sis_a 0B 7")
    stage.until(lambda: bool(stage.truth.done_tasks))
    assert [(each.on, each.where, each.is_at_place) for each in switched] == [
        (True, "pick-up", True),
        (False, "station 7", True),
    ]
    assert (stage.places.as_left["station_7"], stage.places.end_is_doubtful) == (1, False)


def test_a_part_that_is_carried_back_leaves_the_places_as_they_were(stage):
    stage.carry()
    stage.world.request_verb(Verb.CANCEL, "sis_a")
    stage.until(lambda: not stage.arm.holding)
    assert (stage.arm.here, set(stage.places.parts.values())) == ({"pick-up"}, {0})
    assert not stage.places.is_doubtful


def test_what_lay_at_a_station_before_is_none_of_its_task(stage):
    stage.ask("sis_a 0B 7")
    stage.until(lambda: bool(stage.truth.done_tasks))
    stage.ask("sis_a 0B 4")
    stage.until(lambda: bool(stage.truth.done_tasks) and stage.places.as_left["station_4"] == 1)
    assert (stage.places.parts["station_7"], stage.places.as_left["station_7"]) == (1, 0)


def test_a_task_that_is_asked_for_again_does_not_begin_again(stage):
    stage.ask("sis_a 0B 7 #lot7")
    stage.until(lambda: stage.arm.holding)
    stage.ask("sis_a 0B 7 #lot7")
    assert stage.truth.begun_tasks == []
    stage.until(lambda: bool(stage.truth.done_tasks))
    assert stage.places.as_left["station_7"] == 1


def test_the_robot_that_brings_a_part_has_come_since_the_task_began(stage):
    stage.carry()
    end = stage.places.cell.paths["0B"].nodes[-1]
    assert end in stage.places.came
    stage.ask("sis_a 2A 4")
    stage.until(lambda: bool(stage.truth.begun_tasks))
    assert end in stage.places.came, "it stands there still"
    stage.until(lambda: stage.arm.holding)
    assert stage.places.cell.paths["2A"].nodes[-1] in stage.places.came


def test_a_mobile_is_where_it_is_whatever_it_counts(stage):
    mobile = stage.truth.robot("rm_sis_a")
    stage.world.boards[MOBILE].body.true_node = 1
    stage.ask("sis_a 0A 7")
    stage.until(lambda: mobile.counted == 6 and not mobile.moving)
    assert (mobile.node, mobile.strayed, mobile.stands_at(6)) == (7, True, True)


def test_a_stop_of_a_robot_lasts_until_it_was_cleared_and_its_cell_reset(stage):
    stops = stage.truth.stops
    for verb, holds in ((Verb.STOP, True), (Verb.RESET, True), (Verb.CLEAR, True), (Verb.RESET, False)):
        stage.world.request_verb(verb)
        stage.world.advance(1.0)
        assert stops.holds("ra1") is stops.holds("rm_sis_a") is holds


def test_a_board_that_was_told_to_stop_is_latched_until_it_is_cleared_or_boots(stage):
    stage.world.request_verb(Verb.STOP)
    stage.world.advance(0.5)
    assert stage.arm.latched
    stage.world.request_verb(Verb.CLEAR)
    stage.world.advance(0.5)
    assert not stage.arm.latched


@pytest.mark.sampled(3)
@pytest.mark.parametrize(("stalled_s", "at_home"), [(0.2, False), (30.0, True)])
@pytest.mark.parametrize("board", [ARM, MOBILE])
def test_who_came_home_before_its_board_hears_a_stop_is_homed(
    monkeypatch, board: str, stalled_s: float, at_home: bool
) -> None:
    monkeypatch.setattr("arboleda.sim.board.SILENCE_US", 60_000_000)  # the stranger that homes it never beats
    stage = Stage(slowed(shipped(), 4))
    world = stage.world
    stage.ask("sis_a 0B 7", 6.0)
    world.crash(board)
    world.advance(10.0)
    for channel, goal in (
        (Channel.HOME, HomeGoal(seq=1, epoch=9999)),
        (Channel.STOP, StopGoal(mode=StopMode.HALT, seq=2, epoch=9999)),
    ):
        world.publish(Publication(topic=topic(board, channel), payload=encode(goal)))
        world.advance(0.1)
        world.stall(board, stalled_s)
    world.advance(60.0)
    robot = next(each for each in stage.world.model.cell("sis_a").robots if each.mqtt == board)
    assert stage.truth.robot(robot.name).homed is at_home is world.boards[board].homed


@pytest.mark.parametrize("asks", [False, True])
def test_what_was_asked_may_have_come_before_a_boot_of_which_the_plant_hears_in_the_same_step(asks):
    stage = Stage(shipped("sis_a", evidence=Evidence.JOINTS))
    told: list[bool] = []  # after each step in which the plant heard something
    stage.world.watchers.append(
        lambda: told.append(stage.truth.boots.is_known("ra1")) if stage.world.moment.reports else None
    )
    stage.world.stall(PLANT, 1.0)
    stage.world.crash(ARM)
    if asks:
        stage.world.request_verb(Verb.RESUME)
    stage.world.advance(2.0)
    assert (told[0], told[-1]) == (not asks, True)


def test_who_was_put_right_after_a_told_boot_may_have_booted_unseen_since():
    stage = Stage(shipped("sis_a", evidence=Evidence.JOINTS))
    stage.arm.homed, stage.arm.put_right_at = False, 5.0
    told = []
    for number, at in enumerate((1.0, 4.0, 6.0), start=1):
        heard = [Report(at=at, robot="ra1", epoch=1, plant=1000, boot_id=number)]
        stage.truth.boots.look(heard, is_question=False)
        told.append(stage.truth.boots.is_known("ra1"))
    assert told == [False, False, True]


@pytest.mark.parametrize(("parted", "late"), [(False, False), (True, True)])
def test_what_a_line_brought_a_moment_ago_may_still_come_where_topics_come_apart(
    *, parted: bool, late: bool
) -> None:
    stage = Stage(shipped())
    if parted:
        stage.world.partings["ra1"] = lambda report: (report,)
    stage.world.broker.clients[ARM].up.busy_until = stage.world.now - APART_S / 2
    assert stage.truth.books.is_late("ra1") is late
    stage.world.broker.clients[ARM].up.busy_until = stage.world.now - APART_S
    assert not stage.truth.books.is_late("ra1")
