"""The fault table: what each fault in the middle of a task ends in, at every evidence level.

A row is one fault at one or more steps. Its columns are what each level must show: how the task ends, the
most specific reason that level can know, the cell afterwards, where the part truly is, and how long it may
take until the fault is noticed; until the outcome it may take that and what the declared deadlines allow
for the recovery. `undetectable` lists what a level cannot know by its declared evidence.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import pytest
from tests.lengths import sample

from arboleda.core import reasons
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Reason, TaskState
from arboleda.model.plant_model import Evidence
from arboleda.rig import faults
from arboleda.sim.arm import ArmBody
from arboleda.testing import Rig, shipped, slowed
from arboleda.testing.storage_layout import StorageLayout
from arboleda.trees import steps
from arboleda.wire.transport import Publication
from arboleda_proofs.testing import Witness

IDS, JOINTS, STATE = Evidence.IDS, Evidence.JOINTS, Evidence.STATE
AGAIN_S = 0.5  # into the move, when the telemetry of the one before comes again
PERIOD_S = 0.1  # between two telemetry messages
STATION, FLOOR = "station 7", "floor"
TASK = "sis_a 0B 7"


@dataclass(frozen=True)
class Spot:
    """A step of the task, the robot it moves, and which message of which topic its command is."""

    leaf: str
    robot: str
    board: str
    goal: str
    number: int = 1


DRIVING = Spot("drive path 0B", "rm_sis_a", "rm_sis_a", "rm_sis_a/camino")
FETCHING = Spot("move to pick-up", "ra1", "ra_1", "ra_1/juntas")
CARRYING = Spot("move to station 7", "ra1", "ra_1", "ra_1/juntas", 2)
GRIPPING = Spot("effector on/switch", "ra1", "ra_1", "ra_1/efector")
LETTING_GO = Spot("effector off/switch", "ra1", "ra_1", "ra_1/efector", 2)
FINDING = Spot("piece there", "ra1", "ra_1", "ra_1/juntas")
GRIPPED = Spot("piece gripped", "ra1", "ra_1", "ra_1/juntas")

Fault = Callable[[Rig, Spot], None]
Bound = Callable[[Rig, Spot], float]


@dataclass(frozen=True)
class Outcome:
    """Outcome at one level; `part`: where the part is, if it had been gripped when the fault came.

    `task` None: it may end either way. `honest` False: what is called done may not be so.
    """

    task: TaskState | None
    reason: Reason | None
    cell: CellState
    part: str
    noticed: Bound
    honest: bool = True


def at_once(rig: Rig, spot: Spot) -> float:
    return PERIOD_S


def stale(rig: Rig, spot: Spot) -> float:
    return rig.model.timing.stale_after_s + PERIOD_S


def deadline(rig: Rig, spot: Spot) -> float:
    """Of the robot's longest possible command."""
    timing, robot = rig.model.timing, rig.model.robots[spot.robot]
    layout = StorageLayout(rig.model.cell("sis_a"))
    drives_s = layout.mobile.motion.travel_s(None, layout.path("0B").nodes)
    travel_s = drives_s if robot is layout.mobile else longest_s(rig)
    return max(robot.timeout_s, travel_s * timing.deadline_factor + timing.deadline_floor_s)


def switched(rig: Rig, spot: Spot) -> float:
    return rig.model.timing.effector_timeout_s


def pieced(rig: Rig, spot: Spot) -> float:
    return rig.model.timing.piece_wait_s + PERIOD_S


def debounced(rig: Rig, spot: Spot) -> float:
    return rig.model.timing.piece_debounce_s + 2 * PERIOD_S


def after(gap_s: float) -> Bound:
    """As soon as the network is back and what was halted on the way has come to rest."""
    edge_s = 1.0  # a mobile ends the edge it is on; every arm is quicker
    return lambda rig, spot: gap_s + edge_s + PERIOD_S


def again(rig: Rig, spot: Spot) -> float:
    return AGAIN_S + PERIOD_S


def never(rig: Rig, spot: Spot) -> float:
    return float("inf")


def longest_s(rig: Rig) -> float:
    """The longest way between two poses of the arm, s."""
    layout = StorageLayout(rig.model.cell("sis_a"))
    arm, poses = layout.arm, layout.space.poses
    return max(
        arm.motion.travel_s(arm.motion.quantised(one.q), [other.q]) for one in poses for other in poses
    )


def rest_s(rig: Rig, outcome: Outcome) -> float:
    """Time that the declared deadlines allow from the notice of a fault to the end of the task."""
    timing = rig.model.timing
    settle_s = timing.stop_timeout_s + steps.SETTLE_S
    step_s = timing.effector_timeout_s + timing.dwell_s
    if outcome.task is TaskState.DONE:
        return deadline(rig, DRIVING) + 3 * deadline(rig, CARRYING) + 2 * step_s
    return settle_s + 2 * deadline(rig, CARRYING) + step_s


def done() -> Outcome:
    """It was no fault that this level has to mind."""
    return Outcome(TaskState.DONE, None, CellState.IDLE, STATION, never)


def recovered(reason: Reason, noticed: Bound, part: str = "pick-up") -> Outcome:
    """Failed, the part back where it was picked up, the arm at home, the cell ready."""
    return Outcome(TaskState.FAILED, reason, CellState.IDLE, part, noticed)


def held(reason: Reason, noticed: Bound, part: str = "effector") -> Outcome:
    """Failed, and the arm keeps what it holds until an operator acts; a mobile's fault holds no arm."""
    return Outcome(TaskState.FAILED, reason, CellState.HELD, part, noticed)


def safe() -> Outcome:
    """It may fail though nothing is wrong, but it tells no lie and lets go of nothing."""
    return Outcome(None, None, CellState.IDLE, "", never)


def undetectable() -> Outcome:
    """It goes on though it must not: nothing that this level reports tells the difference."""
    return Outcome(None, None, CellState.IDLE, "", never, honest=False)


@dataclass(frozen=True)
class Row:
    """One fault; `early`: it is there before the task; `pieces`: in a cell with a piece check.

    A level that is not named does not apply; a level at one step goes before that level.
    """

    name: str
    at: tuple[Spot, ...]
    fault: Fault
    levels: dict[Evidence | tuple[Evidence, Spot], Outcome]
    early: bool = False
    pieces: bool = False

    def expected(self, level: Evidence, spot: Spot) -> Outcome | None:
        return self.levels.get((level, spot)) or self.levels.get(level)


def every(outcome: Outcome) -> dict[Any, Outcome]:
    return dict.fromkeys(Evidence, outcome)


def broker_down(seconds: float) -> Fault:
    def fault(rig: Rig, spot: Spot) -> None:
        rig.stop_broker()
        rig.wait(seconds)
        rig.start_broker()

    return fault


def silence(seconds: float) -> Fault:
    """Nothing gets through, and nobody's connection breaks."""

    def fault(rig: Rig, spot: Spot) -> None:
        rig.lost = lambda publication: True
        rig.wait(seconds)
        rig.lost = lambda publication: False

    return fault


def losing(make: Callable[[Spot], faults.Lost]) -> Fault:
    def fault(rig: Rig, spot: Spot) -> None:
        rig.lost = make(spot)

    return fault


def carrying(make: Callable[[Spot], faults.Carry]) -> Fault:
    def fault(rig: Rig, spot: Spot) -> None:
        rig.carry = make(spot)

    return fault


def without_will(then: Fault) -> Fault:
    """The broker does not notice that the board is gone."""

    def fault(rig: Rig, spot: Spot) -> None:
        rig.lost = lambda publication: publication.topic == f"{spot.board}/conexion"
        then(rig, spot)

    return fault


def power_off(rig: Rig, spot: Spot) -> None:
    rig.power_off(spot.board)


def reboot(rig: Rig, spot: Spot) -> None:
    rig.crash(spot.board)


def latched_elsewhere(rig: Rig, spot: Spot) -> None:
    rig.inject(Publication(topic=f"{spot.board}/paro", payload=b'{"paro":1,"seq":1,"epoca":1}'))


def replayed(rig: Rig, spot: Spot) -> None:
    """Messages of the board's last move come again in the middle of this one."""
    said: list[Publication] = []
    began: list[float] = []

    def carry(publication: Publication) -> list[Publication]:
        if publication.topic != f"{spot.board}/sensores":
            return [publication]
        if rig.runs("sis_a", FETCHING.leaf):
            said.append(publication)
        if rig.runs("sis_a", spot.leaf):
            began.append(rig.now)
        if not began or rig.now < began[0] + AGAIN_S:
            return [publication]
        again, said[:] = list(said), []
        return [publication, *again]

    rig.carry = carry


def body(rig: Rig) -> ArmBody:
    found = rig.devices.boards["ra_1"].body
    assert isinstance(found, ArmBody)
    return found


def no_piece(rig: Rig, spot: Spot) -> None:
    body(rig).supplied = False


def no_grip(rig: Rig, spot: Spot) -> None:
    body(rig).grips = False


def no_grip_seen_at_once(rig: Rig, spot: Spot) -> None:
    """The sensor sits in the effector: it no longer sees the piece once the effector has closed beside it."""
    body(rig).grips = False
    now_and_then = rig.carry

    def carry(publication: Publication) -> Iterator[Publication]:
        beside = faults.says("ra_1", pieza=0) if body(rig).effector else lambda each: [each]
        for carried in now_and_then(publication):
            yield from beside(carried)

    rig.carry = carry


def lose_piece(rig: Rig, spot: Spot) -> None:
    body(rig).supplied = False  # it was the only one
    body(rig).lose_piece()


def leaf_raises(rig: Rig, spot: Spot) -> None:
    tree = rig.plant.cells["sis_a"].tree
    leaf = next(node for node in tree.iterate() if node.name == spot.leaf) if tree else None

    def update() -> None:
        raise ZeroDivisionError("in a leaf")

    leaf.update = update  # type: ignore[union-attr,method-assign,assignment]
    rig.wait(10.0, until=lambda: rig.plant.cells["sis_a"].task is None)


def flicker(rig: Rig, spot: Spot) -> None:
    truth = rig.carry
    rig.carry = faults.says("ra_1", pieza=0)
    rig.wait(rig.model.timing.piece_debounce_s / 2, until=lambda: belief(rig).piece is False)
    rig.carry = truth


def belief(rig: Rig) -> Any:
    return rig.plant.dispatcher.beliefs["ra1"]


def off_by_one_degree(said: dict[str, Any]) -> dict[str, Any]:
    return {**said, "q1_mov": said["q1_mov"] + 1.0}


def spoiled(goal: str, number: int, spoilt: dict[str, Any]) -> faults.Carry:
    """Goal `number` of a topic comes with these values, where it has such fields."""
    count = 0

    def change(said: dict[str, Any]) -> dict[str, Any]:
        nonlocal count
        count += 1
        hit = spoilt if count == number else {}
        return {key: hit.get(key, value) for key, value in said.items()}

    return faults.altered(goal, change)


def garbled(payload: bytes, every_nth: int = 1) -> Fault:
    return carrying(
        lambda spot: faults.garbled(f"{spot.board}/sensores", payload, lambda n: n % every_nth == 0)
    )


LINK_LOST, DEADLINE, SHORT = Reason.LINK_LOST, Reason.DEADLINE, Reason.STOPPED_SHORT
MOVES = (DRIVING, FETCHING, CARRYING)
ARM = (FETCHING, CARRYING)
LOST = {IDS: held(LINK_LOST, stale), JOINTS: held(LINK_LOST, stale), STATE: held(DEADLINE, deadline)}
REJECTED = {
    IDS: recovered(Reason.REJECTED, at_once),
    JOINTS: recovered(DEADLINE, deadline),
    STATE: recovered(DEADLINE, deadline),
}
GARBAGE = {
    "NaN": b'{"q1_mov":NaN,"q2_mov":0,"q3_mov":0,"nodo":NaN,"estado":0}',
    "a missing field": b'{"q1_mov":1.0,"q2_mov":0,"estado":0}',
    "no estado": b'{"q1_mov":45,"q2_mov":10,"q3_mov":0,"nodo":7}',
    "text for a number": b'{"q1_mov":"45","q2_mov":10,"q3_mov":0,"nodo":"7","estado":0}',
    "no JSON": b"\xff{",
}

TABLE = [
    *(
        Row(
            f"the broker dies for {gap_s:g} s",
            MOVES,
            broker_down(gap_s),
            every(recovered(LINK_LOST, at_once)),
        )
        for gap_s in (0.5, 2.0, 5.0)
    ),
    Row("the broker dies for 8 s", ARM, broker_down(8.0), every(held(LINK_LOST, at_once))),
    Row("silence for 0.5 s", MOVES, silence(0.5), every(done())),
    Row(
        "silence for 1.2 s, so the board halts",
        MOVES,
        silence(1.2),
        {
            IDS: recovered(SHORT, after(1.2)),
            JOINTS: recovered(SHORT, after(1.2)),
            STATE: undetectable(),
        },
    ),
    *(
        Row(
            f"silence for {gap_s:g} s",
            MOVES,
            silence(gap_s),
            {
                IDS: recovered(LINK_LOST, stale),
                JOINTS: recovered(LINK_LOST, stale),
                STATE: undetectable(),
            },
        )
        for gap_s in (2.0, 5.0)
    ),
    Row("telemetry lost for good", MOVES, losing(lambda spot: faults.from_board(spot.board)), LOST),
    Row(
        "commands lost for good",
        ARM,
        losing(lambda spot: faults.to_board(spot.board)),
        {IDS: held(SHORT, after(1.0)), JOINTS: held(SHORT, after(1.0)), STATE: held(DEADLINE, never)},
    ),
    Row("the board dies", MOVES, power_off, every(held(LINK_LOST, at_once, FLOOR))),
    Row(
        "the board dies, its last will is lost",
        MOVES,
        without_will(power_off),
        {level: replace(outcome, part=FLOOR) for level, outcome in LOST.items()},
    ),
    Row("the board reboots", MOVES, reboot, every(held(LINK_LOST, at_once, FLOOR))),
    Row(
        "the arm reboots, its last will is lost",
        ARM,
        without_will(reboot),
        {
            IDS: held(Reason.REBOOTED, at_once, FLOOR),
            JOINTS: held(Reason.REBOOTED, at_once, FLOOR),
            STATE: held(Reason.NOT_HOMED, at_once, FLOOR),
        },
    ),
    Row(
        "the mobile reboots, its last will is lost",
        (DRIVING,),
        without_will(reboot),
        {
            IDS: held(Reason.REBOOTED, at_once, FLOOR),
            JOINTS: held(Reason.NOT_HOMED, at_once, FLOOR),
            STATE: held(Reason.NOT_HOMED, at_once, FLOOR),
        },
    ),
    Row(
        "stuck at 1",
        MOVES,
        carrying(lambda spot: faults.says(spot.board, estado=1)),
        every(held(DEADLINE, deadline)),
    ),
    Row(
        "stuck at 0",
        (DRIVING, FETCHING),
        carrying(lambda spot: faults.says(spot.board, estado=0)),
        {IDS: held(SHORT, at_once), JOINTS: done(), STATE: held(DEADLINE, deadline)},
        early=True,
    ),
    Row(
        "stuck at 0 in the middle of the move",
        MOVES,
        carrying(lambda spot: faults.says(spot.board, estado=0)),
        {
            IDS: held(SHORT, at_once),
            # the bridge takes the motion for ended and beats no more, so that the arm's board stops it
            JOINTS: recovered(SHORT, after(2.0)),
            STATE: undetectable(),
            (STATE, DRIVING): done(),
        },
    ),
    Row(
        "frozen telemetry",
        MOVES,
        carrying(lambda spot: faults.frozen(spot.board)),
        {IDS: held(LINK_LOST, stale), JOINTS: held(DEADLINE, deadline), STATE: held(DEADLINE, deadline)},
    ),
    Row(
        "the goal is lost",
        MOVES,
        losing(lambda spot: faults.nth(spot.goal, spot.number)),
        every(recovered(DEADLINE, deadline)),
        early=True,
    ),
    Row(
        "the goal is rejected",
        MOVES,
        carrying(lambda spot: spoiled(spot.goal, spot.number, {"q1": 999.0, "nodos": [0, 8]})),
        REJECTED,
        early=True,
    ),
    Row(
        "the goal comes garbled",
        (CARRYING,),
        carrying(lambda spot: spoiled(spot.goal, spot.number, {"q1": "45"})),
        REJECTED,
        early=True,
    ),
    Row("everything comes twice", MOVES, carrying(lambda spot: faults.twice), every(done()), early=True),
    Row(
        "telemetry in the wrong order",
        MOVES,
        carrying(lambda spot: faults.swapped(spot.board)),
        {IDS: done(), JOINTS: safe(), STATE: safe(), (STATE, FETCHING): undetectable()},
    ),
    Row(
        "the telemetry of an earlier move again",
        (CARRYING,),
        replayed,
        {IDS: done(), JOINTS: held(Reason.REBOOTED, again), STATE: undetectable()},
        early=True,
    ),
    *(
        Row(f"telemetry with {what}, for good", (CARRYING,), garbled(raw), LOST)
        for what, raw in GARBAGE.items()
    ),
    Row(
        "telemetry with a missing field, for good",
        (DRIVING, FETCHING),
        garbled(GARBAGE["a missing field"]),
        LOST,
    ),
    *(
        Row(f"every second telemetry with {what}", (CARRYING,), garbled(raw, 2), every(done()))
        for what, raw in GARBAGE.items()
    ),
    Row(
        "the board reports a fault",
        MOVES,
        carrying(lambda spot: faults.says(spot.board, estado=2)),
        every(held(Reason.DEVICE_FAULT, at_once)),
    ),
    Row("somebody else latches the board", MOVES, latched_elsewhere, every(held(Reason.STOPPED, after(0)))),
    Row(
        "the joints are off by one degree",
        ARM,
        carrying(lambda spot: faults.altered(f"{spot.board}/sensores", off_by_one_degree)),
        {IDS: held(Reason.NOT_REACHED, deadline), JOINTS: held(SHORT, deadline), STATE: done()},
    ),
    Row(
        "the effector never reports on",
        (GRIPPING,),
        carrying(lambda spot: faults.says(spot.board, efector=0)),
        {IDS: recovered(DEADLINE, switched), JOINTS: recovered(DEADLINE, switched), STATE: done()},
        early=True,
    ),
    Row(
        "the effector goal is lost",
        (GRIPPING,),
        losing(lambda spot: faults.nth(spot.goal, spot.number)),
        {IDS: recovered(DEADLINE, switched), JOINTS: undetectable(), STATE: undetectable()},
        early=True,
    ),
    Row(
        "the effector-off goal is lost",
        (LETTING_GO,),
        losing(lambda spot: faults.nth(spot.goal, spot.number)),
        {
            IDS: recovered(DEADLINE, switched),
            JOINTS: undetectable(),
            STATE: undetectable(),
        },
        early=True,
    ),
    Row(
        "the piece never comes",
        (FINDING,),
        no_piece,
        every(recovered(Reason.NO_PIECE, pieced)),
        early=True,
        pieces=True,
    ),
    Row(
        "the effector does not grip",
        (GRIPPED,),
        no_grip_seen_at_once,
        every(recovered(Reason.NOT_GRIPPED, pieced)),
        early=True,
        pieces=True,
    ),
    Row(
        "the effector does not grip, seen when the arm leaves",
        (CARRYING,),
        no_grip,
        every(recovered(Reason.PART_LOST, debounced)),
        early=True,
        pieces=True,
    ),
    Row(
        "the part is lost in transit",
        (CARRYING,),
        lose_piece,
        every(recovered(Reason.PART_LOST, debounced, part="floor")),
        pieces=True,
    ),
    Row("the piece sensor flickers", (CARRYING,), flicker, every(done()), pieces=True),
    Row(
        "the piece sensor says nothing",
        (FINDING,),
        carrying(lambda spot: faults.says("ra_1", pieza=None)),
        every(recovered(Reason.NO_PIECE, pieced)),
        early=True,
        pieces=True,
    ),
    Row("a leaf raises", MOVES, leaf_raises, every(held(Reason.INTERNAL, deadline))),
]
CASES = [
    pytest.param(row, spot, level, id=f"{row.name}, {spot.leaf}, {level.value}")
    for row in TABLE
    for spot in row.at
    for level in Evidence
    if row.expected(level, spot)
]


def plant_with(row: Row, level: Evidence) -> Rig:
    """One cell whose arm moves for 3 s, so that much can happen meanwhile."""
    model = slowed(shipped("sis_a", evidence=level), 8)
    cells = tuple(replace(cell, piece_check=row.pieces) for cell in model.cells)
    rig = Rig(replace(model, cells=cells))
    if row.pieces and level is not IDS:
        rig.carry = faults.altered(
            "ra_1/sensores", lambda said: {**said, "pieza": int(bool(body(rig).tell().piece))}
        )
    rig.wait(0.5)
    return rig


@dataclass
class Course:
    """Course of a run: the times at which the fault came, was noticed, and the task ended, s."""

    began: float = 0.0
    noticed: float | None = None
    ended: float = 0.0


def run(rig: Rig, row: Row, spot: Spot, bound_s: float) -> Course:
    course, cell = Course(), rig.plant.cells["sis_a"]

    def watch() -> None:
        if course.noticed is None and cell.context.failures.first is not None:
            course.noticed = rig.now

    rig.watchers.append(watch)
    if row.early:
        row.fault(rig, spot)
    rig.submit(TASK)
    assert rig.wait(60, until=lambda: rig.runs("sis_a", spot.leaf) or course.noticed is not None)
    course.began = rig.now
    if not row.early:
        rig.wait(0.8)
        assert rig.runs("sis_a", spot.leaf)
        course.began = rig.now
        row.fault(rig, spot)
    assert rig.wait(bound_s, until=lambda: cell.task is None), "it hangs"
    course.ended = rig.now
    return course


@pytest.mark.sampled(36)
@pytest.mark.parametrize(("row", "spot", "level"), sample(CASES, every=2))
def test_fault(row: Row, spot: Spot, level: Evidence) -> None:
    expected = row.expected(level, spot)
    assert expected is not None
    rig = plant_with(row, level)
    witness = Witness(rig)
    notice_s, rest = expected.noticed(rig, spot), rest_s(rig, expected)
    course = run(rig, row, spot, rest if notice_s == float("inf") else notice_s + rest)
    (change,) = rig.outcomes().values()
    mark = len(rig.to_boards)
    rig.wait(3.0)
    assert witness.motions_since(mark, rig.model.robots) == [], "something moves after the task has ended"
    assert rig.plant.at_rest
    if not expected.honest:
        assert witness.false_successes or witness.illegal, "this level can tell; the table is too modest"
        return
    assert (witness.false_successes, witness.illegal) == ([], [])
    if expected.task is None:
        return
    cell = rig.plant.cells["sis_a"]
    where = CellState.IDLE if spot is DRIVING and change.reason is not Reason.INTERNAL else expected.cell
    assert (change.state, change.reason, cell.state) == (expected.task, expected.reason, where), change
    had_it = spot is CARRYING or spot is LETTING_GO or expected.task is TaskState.DONE
    assert witness.part.get("ra1", "pick-up") == (expected.part if had_it else "pick-up")
    if expected.task is TaskState.FAILED:
        assert course.noticed is not None and course.noticed - course.began <= notice_s
        assert spot.robot in str(change.sentence) or change.reason is Reason.INTERNAL
    if where is CellState.HELD:
        said = str(reasons.of_hold(cell))
        assert ("retry sis_a" in said and "abandon sis_a" in said) or "stop sis_a, then clear sis_a" in said
