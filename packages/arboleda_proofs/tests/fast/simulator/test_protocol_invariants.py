"""Invariants of commands, tasks, wire, liveness and books hold for a plant that works, and find
more than their mutants in tools/tests/mutants.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from tests.cells import with_poses
from tests.lengths import sample

from arboleda.core import cell, people, plant, zone_watch
from arboleda.dispatch import belief, evidence, latches, ledger, obstacles, time_limits
from arboleda.dispatch.ledger import TABLE, Feed, State
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.messages import Fact, Heartbeat, TaskState, Verb
from arboleda.model.plant_model import Evidence, ForeignCommands, PlantModel
from arboleda.plant_file.loader import load
from arboleda.recipes import recipe, work
from arboleda.rig.world import BRIDGE, PLANT
from arboleda.sim.board import Board
from arboleda.testing.plants import shipped, slowed
from arboleda.trees import cell_commands, cell_zones, leaves
from arboleda.wire import board as wire_board
from arboleda.wire.bridge import PLANT_GONE_S
from arboleda.wire.hop import FromPlant
from arboleda.wire.transport import Publication
from arboleda_proofs.simulator.invariants.commands import COMMANDS
from arboleda_proofs.simulator.invariants.liveness import LIVENESS, ready
from arboleda_proofs.simulator.invariants.memory_bounds import BOOKS
from arboleda_proofs.simulator.invariants.tasks import TASKS
from arboleda_proofs.simulator.invariants.wire import WIRE
from arboleda_trees.bt_xml import reading
from arboleda_trees.bt_xml.findings import Findings
from arboleda_trees.bt_xml.recipe import tree_recipe

from .watch import Watched

INVARIANTS = (*COMMANDS, *TASKS, *WIRE, *LIVENESS, *BOOKS)
TASK = "sis_a 0B 7"


class Watch(Watched):
    """Judges by these invariants, and looks at once."""

    def __init__(self, model: PlantModel | None = None, **world: Any) -> None:
        super().__init__(INVARIANTS, model, **world)

    def task(self, text: str = TASK, wait_s: float = 0.01) -> None:
        super().task(text, wait_s)

    def verb(self, verb: Verb, scope: str = "", wait_s: float = 0.01) -> None:
        super().verb(verb, scope, wait_s)


@pytest.fixture
def bites(request: pytest.FixtureRequest) -> Callable[[Watch], None]:
    """Assert that the invariant which the test is named after has found something."""
    name = request.node.originalname.removeprefix("test_").partition("__")[0]
    assert name in {each.name for each in INVARIANTS}

    def bites(watch: Watch) -> None:
        assert name in watch.found, watch.found

    return bites


def arm_of(watch: Watch) -> Board:
    return watch.world.boards["ra_1"]


def cut(watch: Watch, client: str) -> None:
    """Nothing of what a client says arrives any more."""
    watch.world.broker.clients[client].up.troubles.append(lambda message: [])


# What a plant does that works.


@pytest.mark.long
def test_nothing_is_found_in_three_cells_at_work():
    watch = Watch(shipped())
    for number in range(6):
        for name in ("sis_a", "sis_b", "sis_c"):
            watch.task(f"{name} 0B {number}" if number % 2 else f"{name} palletizing")
    watch.wait(120)
    watch.end()
    assert watch.found == {}
    assert sum(task.state is TaskState.DONE for task in watch.record.tasks.ended.values()) == 18


SEQUENCES = (
    (Verb.STOP, Verb.CLEAR, Verb.RESET, Verb.RESUME),
    (Verb.HOLD, Verb.RESUME),
    (Verb.HOLD, Verb.ABANDON, Verb.RESUME),
    (Verb.CANCEL,),
    (Verb.HOLD, Verb.STOP, Verb.CLEAR, Verb.RESET, Verb.RELEASE, Verb.RESUME, Verb.RESET),
)


@pytest.mark.sampled(5)
@pytest.mark.parametrize(
    ("at_s", "verbs"),
    sample(product([0.1, 1.5, 4.2, 5.6], SEQUENCES), every=2),
    ids=lambda value: "-".join(verb.value for verb in value) if isinstance(value, tuple) else str(value),
)
def test_nothing_is_found_with_operators(verbs, at_s):
    watch = Watch()
    watch.task()
    watch.task("sis_a palletizing #second")
    watch.wait(at_s)
    for verb in verbs:
        watch.verb(verb, "sis_a", wait_s=2.0)
    watch.wait(1)
    for verb in (Verb.RELEASE, Verb.RESUME):
        watch.verb(verb, "sis_a", wait_s=1.0)
    watch.wait(30)
    watch.end()
    assert watch.found == {}


def other(watch: Watch, command: Command) -> None:
    """A node of somebody else commands the bridge, which takes it for another's than the plant's."""
    said = FromPlant(at=watch.world.now, message=command)
    watch.world.broker.clients[BRIDGE].inbox.append(said)
    watch.wait(0.01)


@pytest.mark.parametrize(
    "command",
    [
        MoveJoints(id="", robot="ra1", q=(0.1, 0.0, 0.0)),
        SetEffector(id="", robot="ra1", on=True),
        Home(id="", robot="ra1"),
        Stop(id="", robot="ra1", mode=StopMode.CLEAR),
        FollowPath(id="", robot="rm_sis_a", nodes=(0, 3)),
    ],
    ids=lambda command: type(command).__name__,
)
def test_bridge_obeys_only_its_plant(bites, command):
    watch = Watch(replace(shipped("sis_a"), foreign_commands=ForeignCommands.OBEY))
    other(watch, command)
    bites(watch)


def test_bridge_obeys_only_its_plant__in_stops():
    watch = Watch()
    other(watch, Stop(id="", robot="ra1", mode=StopMode.HALT))
    assert watch.found == {}


def silence(watch: Watch) -> None:
    """No beat of the plant reaches the bridge for longer than it takes it to be there."""
    watch.world.to_bridge.troubles.append(lambda message: () if isinstance(message, Heartbeat) else (0.0,))
    watch.wait(PLANT_GONE_S)


@pytest.mark.parametrize("on", [True, False])
def test_nothing_is_found_where_a_bridge_without_a_plant_obeys_a_copy_before_its_original(on):
    watch = Watch()
    silence(watch)
    other(watch, SetEffector(id="", robot="ra1", on=on))
    original = SetEffector(id=f"{watch.world.plant.epoch}-901", robot="ra1", on=on)
    said = FromPlant(at=watch.world.now, message=original, copied=True)
    watch.world.broker.clients[BRIDGE].inbox.append(said)
    watch.wait(0.01)
    assert watch.world.boards["ra_1"].body.effector is on
    assert watch.found == {}


def test_no_move_after_its_halt(bites):
    watch = Watch()
    for command in (
        Stop(id=f"{watch.world.plant.epoch}-902", robot="ra1", mode=StopMode.HALT),
        MoveJoints(id=f"{watch.world.plant.epoch}-901", robot="ra1", q=(0.1, 0.0, 0.0)),
    ):
        other(watch, command)
    bites(watch)


def test_no_move_after_its_halt__by_the_numbers_that_the_plant_gave():
    watch = Watch()
    superseded = watch.world.plant.epoch - 1
    other(watch, Stop(id=f"{superseded}-902", robot="ra1", mode=StopMode.HALT))
    other(watch, MoveJoints(id=f"{superseded}-901", robot="ra1", q=(0.1, 0.0, 0.0)))
    assert watch.found == {}


@pytest.mark.sampled(5)
@pytest.mark.parametrize(
    ("at_s", "process"), sample(product([0.1, 1.5, 4.2, 5.6], [PLANT, BRIDGE, "ra_1", "rm_sis_a"]), every=3)
)
def test_nothing_is_found_with_crashes(process, at_s):
    watch = Watch()
    watch.task()
    watch.wait(at_s)
    watch.world.crash(process)
    watch.wait(15)
    for verb, scope in (
        (Verb.RELEASE, "ra1"),
        (Verb.HOME, "ra1"),
        (Verb.HOME, "rm_sis_a"),
        (Verb.ABANDON, "sis_a"),
        (Verb.RESUME, "sis_a"),
    ):
        watch.verb(verb, scope, wait_s=15.0)
    watch.end()
    assert watch.found == {}


@pytest.mark.parametrize("process", [PLANT, BRIDGE, "ra_1"])
def test_nothing_is_found_with_stalls_and_a_slow_line(process):
    watch = Watch()
    watch.world.to_plant.troubles.append(lambda report: [0.3, 0.7])
    watch.task()
    for _ in range(4):
        watch.world.stall(process, 1.2)
        watch.wait(3)
    watch.world.to_plant.troubles.clear()
    watch.wait(5)
    watch.verb(Verb.RESUME, "sis_a", wait_s=30)
    assert watch.found == {}


# Commands.


@pytest.mark.parametrize(("code", "word"), [(2, "faulted"), (4, "latched")])
def test_no_command_to_unfit__by_its_code(monkeypatch, bites, code, word):
    monkeypatch.setattr(belief.Belief, "obstacle", lambda self, was=False: None)
    watch = Watch()
    board = watch.world.boards["rm_sis_a"]
    board.faulted, board.latched = code == 2, code == 4
    watch.wait(0.5)
    watch.task(wait_s=1)
    bites(watch)
    assert word in watch.found["no_command_to_unfit"][0]


def test_no_command_to_unfit__offline(monkeypatch, bites):
    monkeypatch.setattr(belief.Belief, "obstacle", lambda self, was=False: None)
    watch = Watch()
    cut(watch, "rm_sis_a")
    watch.wait(3)
    watch.task(wait_s=1)
    bites(watch)


def test_no_command_to_unfit__after_a_stop(monkeypatch, bites):
    monkeypatch.setattr(obstacles.Obstacles, "of", lambda self, robot, was=False: None)
    monkeypatch.setattr(cell.CellRun, "stop", lambda self: None)
    watch = Watch()
    watch.task(wait_s=1)
    watch.verb(Verb.STOP, "sis_a", wait_s=5)
    bites(watch)


def test_stops_are_cleared_by_operators(monkeypatch, bites):
    monkeypatch.setattr(latches.Latches, "forget", latches.Latches.unlatch)
    watch = Watch()
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET):
        watch.verb(verb, "sis_a", wait_s=1)
    bites(watch)


def test_only_legal_command_states(monkeypatch, bites):
    monkeypatch.setitem(TABLE, (State.RUNNING, Feed.ACCEPTED), State.SENT)
    watch = Watch()
    watch.task(wait_s=1)
    for _ in range(2):
        open_ids = list(watch.world.plant.dispatcher.ledger.entries)
        watch.world.at(watch.world.now, lambda _, ids=open_ids: feed(watch, ids))
        watch.wait(0.3)
    bites(watch)


def feed(watch: Watch, ids: list[str]) -> None:
    for id in ids:
        watch.world.plant.dispatcher.ledger.feed(id, Feed.ACCEPTED, watch.world.now)


def test_no_deadline_overrun(monkeypatch, bites):
    monkeypatch.setattr(ledger.Entry, "next_deadline", property(lambda self: self.deadline + 0.5))
    watch = Watch()
    arm_of(watch).body.stuck = True
    watch.task(wait_s=20)
    bites(watch)


def test_no_deadline_overrun__of_a_deadline_without_end(monkeypatch, bites):
    monkeypatch.setattr(time_limits.TimeLimits, "allowed_s", lambda self, command, timing: 1e6)
    watch = Watch()
    watch.task(wait_s=1)
    bites(watch)


def test_no_deadline_overrun__of_a_wait(monkeypatch, bites):
    monkeypatch.setattr(leaves.Dwell, "update", lambda self: leaves.Status.RUNNING)
    watch = Watch()
    watch.task(wait_s=3)
    bites(watch)


def test_halted_moves_sent_halt__by_a_step_left_early(monkeypatch, bites):
    monkeypatch.setattr(leaves.Act, "terminate", lambda self, status: None)
    monkeypatch.setattr(cell_commands.CellCommands, "cancel_all", lambda self: None)
    watch = Watch()
    watch.task(wait_s=1)
    watch.verb(Verb.STOP, "sis_a")
    bites(watch)


# Tasks and cells.


def test_no_task_fails_without_a_fault(monkeypatch, bites):
    monkeypatch.setattr(evidence, "reached", lambda entry, belief: False)
    watch = Watch()
    watch.task(wait_s=20)
    bites(watch)


@pytest.mark.parametrize("disturb", ["an operator", "a fault"])
def test_a_task_may_fail_after_somebody_or_something_disturbed_it(monkeypatch, disturb):
    monkeypatch.setattr(evidence, "reached", lambda entry, belief: False)
    watch = Watch()
    if disturb == "a fault":
        watch.world.crash(BRIDGE)
    else:
        watch.verb(Verb.RESUME, "sis_a")
    watch.task(wait_s=30)
    assert watch.world.plant.intake.tasks.popitem()[1].failure is not None
    assert "no_task_fails_without_a_fault" not in watch.found


def test_only_legal_cell_states__of_a_stop_that_was_forgotten(bites):
    watch = Watch()
    watch.verb(Verb.STOP, "sis_a", wait_s=1)
    watch.world.disk.facts.pop(Fact.LATCH)
    watch.world.crash(PLANT)
    watch.wait(0.5)
    bites(watch)


def test_rejected_input_changes_nothing(monkeypatch, bites):
    parse = plant.Intake.task

    def with_effect(self: Any, words: str) -> Any:
        watch.world.plant.cells["sis_a"].queue.paused = True
        return parse(self, words)

    watch = Watch()
    monkeypatch.setattr(plant.Intake, "task", with_effect)
    watch.wait(0.031)
    watch.task("nonsense")
    bites(watch)


def test_rejected_input_changes_nothing__of_what_a_start_finds_in_a_hand(bites):
    watch = Watch(shipped("sis_a", evidence=Evidence.JOINTS, assume_homed=True))
    watch.world.disk.facts[Fact.EFFECTOR] = {"ra1": "switching"}
    watch.world.to_plant.troubles.append(lambda each: ())
    watch.world.crash(PLANT)
    watch.world.stall(PLANT, 0.2)
    watch.task("nonsense", wait_s=0.3)
    assert watch.world.plant.cells["sis_a"].state is CellState.HELD
    assert watch.found == {}


def test_every_request_is_answered(monkeypatch, bites):
    monkeypatch.setattr(people.People, "operate", lambda self, request: None)
    watch = Watch()
    watch.verb(Verb.HOLD)
    bites(watch)


@pytest.mark.parametrize("verb", [Verb.RETRY, Verb.ABANDON, Verb.CANCEL])
def test_nothing_moves_after_an_absence__unless_an_operator_says_so(verb):
    watch = Watch()
    watch.task("sis_a palletizing", wait_s=1.0)
    watch.world.stall("plant", 3.0)
    watch.wait(10.0)
    assert watch.world.plant.cells["sis_a"].state.value == "held"
    watch.verb(verb, "sis_a", wait_s=10.0)
    assert watch.found == {}


# The wire.


@pytest.mark.parametrize(
    ("topic", "payload", "words"),
    [
        ("ra_1/juntas", b'{"q1":0.0,"q2":0.0,"q3":NaN,"seq":1,"epoca":1}', "ra_1/juntas is"),
        ("ra_1/juntas", b'{"q1":0.0,"q2":0.0,"q3":0.0}', "ra_1/juntas is"),
        ("ra_1/juntas", b'{"q1":0.01,"q2":0.0,"q3":0.0,"seq":1,"epoca":1}', "no whole motor step"),
        ("ra_1/juntas", b'{"q1":0.0,"q2":-180.0,"q3":0.0,"seq":1,"epoca":1}', "beyond"),
        ("ra_1/juntas", b'{"q1":0.0,"q2":0.9,"q3":0.0,"seq":1,"epoca":1}', "has not commanded"),
        ("rm_sis_a/camino", b'{"nodos":[0,4],"seq":1,"epoca":1}', "edges"),
        ("rm_sis_a/camino", b'{"nodos":[6,9],"seq":1,"epoca":1}', "the grid"),
        ("rm_sis_a/camino", b'{"nodos":[0,1],"seq":1,"epoca":1}', "has not commanded"),
        ("rm_sis_a/camino", b'{"nodos":[true],"seq":1,"epoca":1}', "rm_sis_a/camino is"),
    ],
)
def test_wire_targets_legal__on_the_wire(bites, topic, payload, words):
    watch = Watch()
    watch.world.publish(Publication(topic=topic, payload=payload), watch.world.broker.clients[BRIDGE])
    watch.wait(0.1)
    bites(watch)
    assert any(words in sentence for sentence in watch.found["wire_targets_legal"])


@pytest.mark.parametrize("q", [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)])
def test_published_joints_are_reported(monkeypatch, bites, q):
    watch = Watch(slowed(shipped("sis_a"), 4))
    monkeypatch.setattr(wire_board.Board, "_in_si", lambda self, angles: q)
    watch.task(wait_s=10)
    bites(watch)


# Liveness and books.


def test_running_tree_has_waker__in_a_cell_whose_time_stands_still(bites):
    watch = Watch()
    watch.world.plant.cells["sis_a"].context.time.pause()
    watch.task()
    bites(watch)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("evidence", [Evidence.IDS, Evidence.JOINTS])
def test_no_starvation__of_a_cell_whose_effector_is_being_opened(evidence):
    watch = Watch(shipped("sis_a", evidence=evidence, assume_homed=evidence is Evidence.JOINTS))
    watch.world.to_bridge.troubles.append(lambda each: (0.1,))
    watch.wait(1)
    watch.verb(Verb.RELEASE, "ra1")
    watch.task(wait_s=20)
    assert watch.found == {}
    assert [task.state for task in watch.record.tasks.ended.values()] == [TaskState.DONE]


def zoned() -> PlantModel:
    """Two cells whose pick-up poses lie in one zone, for which an arm waits at most 3 s."""
    model = shipped("sis_a", "sis_b")
    zone = frozenset({"table"})
    cells = []
    for each in model.cells:
        pickup = replace(each.taker.targets["pickup"], zones=zone)
        cells.append(replace(with_poses(each, pickup=pickup), zone_wait_s=3.0))
    return replace(model, cells=tuple(cells), zones=("table",))


def test_no_starvation__of_an_arm_that_may_still_be_told_something():
    watch = Watch(zoned())
    watch.world.to_bridge.troubles.append(lambda each: (0.0,) if isinstance(each, Heartbeat) else ())
    watch.verb(Verb.RELEASE, "ra1", wait_s=7)
    watch.task("sis_a palletizing", wait_s=3)
    watch.world.to_bridge.troubles.clear()
    watch.wait(30)
    watch.end()
    assert watch.found == {}


CART = """
name: carts
uses: [recipes.py]
cells:
  cell:
    devices: {cart: {kind: mobile, grid: {origin_m: [0, 0]}, evidence: state}}
    targets: {home: {cart: {node: 6}}, store: {cart: {node: 2}}}
zones: {inside: {poses: [cell store]}}
"""
STORE = """
from arboleda.recipes import recipe


@recipe("store")
def store(cell):
    return cell.device("cart").visit("store", cell.wait(5))
"""


def test_no_starvation__of_a_cell_whose_cart_proves_no_place_and_was_led_into_a_zone(tmp_path):
    """Seed 60502 of drawn plants: at `state` its word on its place is no evidence, where it was led is."""
    (tmp_path / "plant.yaml").write_text(CART)
    (tmp_path / "recipes.py").write_text(STORE)
    watch = Watch(load(tmp_path / "plant.yaml"))
    watch.wait(2.0)
    cell, reached = watch.record.cells["cell"], watch.world.plant.dispatcher.whereabouts.reached
    assert watch.record.robots["cart"].node == 6
    assert ready(watch.look, cell), "nobody knows where it was led"
    reached["cart"] = 2
    assert not ready(watch.look, cell), "it was led into the zone, whatever it says"
    reached["cart"] = 6
    assert ready(watch.look, cell)


def sharing(tmp_path: Path) -> PlantModel:
    """Two cells that share an arm, and no zone."""
    shared = Path(__file__).parents[1] / "scenario/shared_arm"
    (tmp_path / "recipes.py").write_text((shared / "recipes.py").read_text())
    (tmp_path / "plant.yaml").write_text((shared / "plant.yaml").read_text().partition("zones:")[0])
    return load(tmp_path / "plant.yaml")


def test_no_starvation__of_a_cell_whose_shared_arm_has_not_been_seen_at_home_since_the_start(tmp_path):
    """Seed 51087 of drawn plants: what is heard just after a start may be older than its last move."""
    watch = Watch(sharing(tmp_path))
    watch.world.disk.facts[Fact.QUARANTINE] = {"arm": "left"}
    watch.world.crash(PLANT)
    watch.task("left press", wait_s=0.5)
    assert [task.state for task in watch.record.tasks.open.values()] == [TaskState.QUEUED]
    watch.wait(2)
    assert watch.found == {}
    assert [task.state for task in watch.record.tasks.open.values()] == [TaskState.RUNNING]


def test_no_starvation__of_a_cell_whose_shared_arm_may_still_be_told_something(tmp_path):
    """Seed 110 of drawn plants: it shares no zone, and has to be seen at home after its last command."""
    watch = Watch(sharing(tmp_path))
    watch.world.to_bridge.troubles.append(lambda each: (0.0,) if isinstance(each, Heartbeat) else ())
    watch.verb(Verb.HOME, "arm", wait_s=1)
    watch.world.to_plant.troubles.append(lambda each: ())
    watch.wait(2)
    watch.world.to_plant.troubles.clear()
    watch.task("left press", wait_s=1)
    assert watch.found == {}
    assert [task.state for task in watch.record.tasks.open.values()] == [TaskState.QUEUED]


MACHINE_RECIPES = """
from arboleda.recipes import recipe, work

@recipe("shut")
def shut(cell):
    gate = cell.device("gate")
    return work(gate.shut(), cell.wait(20), gate.open())

@recipe("tour")
def tour(cell):
    return work(cell.device("cart").visit("pickup"), cell.device("cart").home())
"""
MACHINE_IN_A_ZONE = """
name: gates
uses: [recipes.py]
kinds:
  gate:
    facts: {is_open: bool}
    verbs:
      shut: {effect: process, sets: {is_open: false}, takes_s: 0.5}
      open: {effect: process, sets: {is_open: true}, takes_s: 0.5}
cells:
  left: {devices: {gate: {kind: gate}}}
  right:
    devices: {cart: {kind: mobile, evidence: state, stop: none}}
    targets: {home: {cart: {node: 6}}, pickup: {cart: {node: 4}}}
    zone_wait_s: 3
zones:
  way: {moves: [[right home, right pickup]], free_while: {gate: {is_open: true}}}
"""


def test_zone_requests_end(monkeypatch, bites):
    watch = Watch(zoned())
    assert watch.world.plant.zones.acquire("ra2", frozenset({"table"}))
    monkeypatch.setattr(zone_watch.ZoneWatch, "look", lambda self: None)
    monkeypatch.setattr(leaves.TakeZones, "update", lambda self: self.arrived() or leaves.Status.RUNNING)
    watch.task("sis_a palletizing", wait_s=2.9)
    assert "zone_requests_end" not in watch.found
    watch.wait(1)
    bites(watch)


def test_zone_requests_end__of_a_recovery_where_who_has_the_zone_does_not_work(monkeypatch, bites):
    watch = Watch(zoned())
    assert watch.world.plant.zones.acquire("ra2", frozenset({"table"}))
    monkeypatch.setattr(zone_watch.ZoneWatch, "look", lambda self: None)
    monkeypatch.setattr(cell_zones.CellZones, "will_come_free", lambda self, robot: True)
    watch.task("sis_a palletizing", wait_s=6.1)
    assert watch.found == {}
    watch.wait(1)
    bites(watch)


def test_zone_requests_end__of_a_recovery_unless_who_has_the_zone_works():
    watch = Watch(slowed(zoned(), 5.0))
    watch.task("sis_b palletizing", wait_s=1)
    assert watch.world.plant.zones.holder("table") == "ra2"
    watch.task("sis_a palletizing", wait_s=8)
    assert [user.cell for user in watch.record.waiting.users] == ["sis_a"]
    assert watch.world.plant.cells["sis_a"].run.recovering
    watch.wait(40)
    assert watch.found == {} and watch.record.waiting.users == []


def test_zone_requests_end__of_a_recovery_unless_a_machine_has_the_zone_and_its_cell_works(tmp_path):
    (tmp_path / "recipes.py").write_text(MACHINE_RECIPES)
    (tmp_path / "plant.yaml").write_text(MACHINE_IN_A_ZONE)
    watch = Watch(load(tmp_path / "plant.yaml"))
    watch.task("left shut", wait_s=2)
    watch.task("right tour", wait_s=10)
    assert watch.world.plant.zones.holder("way") == "gate"
    assert watch.world.plant.cells["right"].run.recovering
    watch.wait(30)
    assert watch.found == {} and watch.record.waiting.users == []


def behind_a_held_cell(folder: Path) -> Watch:
    """A recovery that waits for a zone, which a machine has whose cell a person has held."""
    (folder / "recipes.py").write_text(MACHINE_RECIPES)
    (folder / "plant.yaml").write_text(MACHINE_IN_A_ZONE)
    watch = Watch(load(folder / "plant.yaml"))
    watch.task("left shut", wait_s=2)
    watch.task("right tour", wait_s=8)
    assert watch.world.plant.cells["right"].run.recovering
    watch.world.request_verb(Verb.HOLD, "left")
    watch.wait(8)
    return watch


def test_zone_requests_end__of_a_recovery_behind_a_held_cell(tmp_path):
    watch = behind_a_held_cell(tmp_path)
    assert watch.found == {} and not watch.world.plant.cells["right"].run.recovering


def test_zone_requests_end__where_the_plant_takes_a_held_cell_for_one_at_work(tmp_path, monkeypatch, bites):
    monkeypatch.setattr(plant.Plant, "at_work", lambda self, holder: True)
    bites(behind_a_held_cell(tmp_path))


def test_zone_requests_end__in_the_cells_own_time(monkeypatch):
    watch = Watch(zoned())
    assert watch.world.plant.zones.acquire("ra2", frozenset({"table"}))
    monkeypatch.setattr(zone_watch.ZoneWatch, "look", lambda self: None)
    watch.task("sis_a palletizing", wait_s=1)
    watch.verb(Verb.HOLD, "sis_a", wait_s=10)
    watch.verb(Verb.RESUME, "sis_a", wait_s=5)
    watch.wait(10)
    assert watch.found == {}


def test_zone_requests_end__anew_after_the_pause_of_a_retry(monkeypatch):
    @recipe("look")
    def look(cell):
        return work(cell.retry(cell.device("arm").visit("pickup", cell.wait(1.0)), times=3))

    model = zoned()
    cells = tuple(replace(each, recipes=(*each.recipes, look)) for each in model.cells)
    watch = Watch(replace(model, cells=cells))
    assert watch.world.plant.zones.acquire("ra2", frozenset({"table"}))
    monkeypatch.setattr(zone_watch.ZoneWatch, "look", lambda self: None)
    watch.task("sis_a look", wait_s=7.0)
    assert [user.cell for user in watch.record.waiting.users] == ["sis_a"]
    watch.wait(10)
    assert watch.found == {}


def in_a_tree(model: PlantModel, node: str) -> PlantModel:
    """The plant, each cell with a recipe `look` that is a tree of this node."""
    text = f'<root BTCPP_format="4"><BehaviorTree ID="Look">{node}</BehaviorTree></root>'.encode()
    look = tree_recipe("look", "look.xml", text, reading.read("look.xml", text, Findings()), {})
    return replace(model, cells=tuple(replace(each, recipes=(*each.recipes, look)) for each in model.cells))


VISIT = '<arm_visit target="pickup"><Sleep msec="1000"/></arm_visit>'
PAUSE = '<Inverter><Sleep msec="500"/></Inverter>'


@pytest.mark.parametrize("node", [VISIT, f"<Fallback>{VISIT}{PAUSE}</Fallback>"])
def test_zone_requests_end__anew_at_each_try_of_a_tree(monkeypatch, node):
    watch = Watch(in_a_tree(zoned(), f'<RetryUntilSuccessful num_attempts="4">{node}</RetryUntilSuccessful>'))
    assert watch.world.plant.zones.acquire("ra2", frozenset({"table"}))
    monkeypatch.setattr(zone_watch.ZoneWatch, "look", lambda self: None)
    watch.task("sis_a look", wait_s=5.0)
    assert [user.cell for user in watch.record.waiting.users] == ["sis_a"]
    watch.wait(12)
    assert watch.found == {}


def test_zone_requests_end__at_a_later_try_of_a_tree(monkeypatch, bites):
    watch = Watch(
        in_a_tree(zoned(), f'<RetryUntilSuccessful num_attempts="4">{VISIT}</RetryUntilSuccessful>')
    )
    assert watch.world.plant.zones.acquire("ra2", frozenset({"table"}))
    monkeypatch.setattr(zone_watch.ZoneWatch, "look", lambda self: None)
    watch.task("sis_a look", wait_s=4)
    assert watch.found == {}
    monkeypatch.setattr(leaves.TakeZones, "update", lambda self: self.arrived() or leaves.Status.RUNNING)
    watch.wait(4)
    bites(watch)


def test_zone_requests_end__once_a_cell_that_was_held_at_that_moment_goes_on(monkeypatch):
    watch = Watch(zoned())
    assert watch.world.plant.zones.acquire("ra2", frozenset({"table"}))
    monkeypatch.setattr(zone_watch.ZoneWatch, "look", lambda self: None)
    watch.task("sis_a palletizing", wait_s=3.1)
    watch.world.stall(PLANT, 0.3)
    watch.verb(Verb.HOLD, "sis_a", wait_s=5)
    assert watch.world.plant.cells["sis_a"].state is CellState.HELD
    watch.verb(Verb.RESUME, "sis_a", wait_s=1)
    assert watch.found == {} and watch.world.plant.cells["sis_a"].run.recovering


@pytest.mark.parametrize("act", [lambda watch: watch.task(wait_s=1), lambda watch: watch.world.crash("ra_1")])
def test_at_rest_at_end(bites, act):
    watch = Watch()
    watch.end()
    assert watch.found == {}
    act(watch)
    watch.wait(0.5)
    watch.end()
    bites(watch)


def test_bounded_books(bites):
    watch = Watch()
    watch.world.plant.cells["sis_a"].context.time.wakes += [1e9] * 200
    watch.wait(10)
    bites(watch)
