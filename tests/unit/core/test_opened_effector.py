"""What an arm is taken to do: an effector that opens, a start of its own cycle, zones while it moves."""

from collections.abc import Callable
from importlib.resources import as_file, files
from typing import Any

import pytest

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.messages import MotionState, OperatorRequest, Reason, TaskState, Verb
from arboleda.model.plant_model import Evidence
from arboleda.plant_file.loader import load
from arboleda.testing.storage_layout import StorageLayout

from .conftest import Hand

MOVING, STILL = MotionState.MOVING, MotionState.STOPPED


@pytest.mark.parametrize("level", list(Evidence), ids=lambda level: level.value)
def test_whatever_the_evidence_a_reported_opening_counts(
    hand: Callable[[Evidence], Any], level: Evidence
) -> None:
    plant = hand(level)
    plant.awake()
    plant.submit("sis_a palletizing")
    carries(plant, level)
    plant.tell("ra1", state=MOVING, effector=True)
    plant.tell("ra1", state=MOVING, effector=False)
    assert plant.plant.cells["sis_a"].context.failures.first.reason is Reason.PART_LOST


def carries(plant: Any, level: Evidence) -> None:
    """Play the arm until it is on its way with the part."""
    for _ in range(60):
        entry = plant.plant.dispatcher.ledger.last_sent.get("ra1")
        command = entry.command if entry else None
        closed = bool(plant.commands(SetEffector))
        if closed and isinstance(command, MoveJoints):
            return
        ids = {"accepted": command.id, "done": command.id} if level is Evidence.IDS and command else {}
        where = {"q": command.q} if isinstance(command, MoveJoints) and level is not Evidence.STATE else {}
        plant.tell("ra1", after=1.2, state=MOVING, effector=closed)
        for _ in range(3):
            plant.tell("ra1", after=0.3, state=STILL, effector=closed, **where, **ids)
    raise AssertionError("it never carried anything")


CYCLE = "ra1 palletizing"


@pytest.mark.parametrize(
    ("trigger", "queues", "state"),
    [(True, False, TaskState.REFUSED), (True, True, TaskState.QUEUED), (False, False, TaskState.QUEUED)],
    ids=["refused", "queued by the plant file", "of a person"],
)
def test_a_second_request_for_the_cycle(
    hand: Callable[..., Hand], trigger: bool, queues: bool, state: TaskState
) -> None:
    plant = hand(Evidence.IDS, queue_triggers=queues)
    plant.awake()
    plant.submit(CYCLE)
    told = plant.submit(CYCLE, trigger=trigger, request="second")
    (answer,) = [each for each in told if getattr(each, "request", None) == "second"]
    assert answer.state is state and answer.for_now is (state is TaskState.REFUSED)


@pytest.fixture
def sharing() -> Hand:
    """The plant of shared zones, whose robots stand still at home; arm_right tells joints, and no ids."""
    with as_file(files("arboleda") / "plants" / "shared.yaml") as path:
        sharing = Hand(load(path))
    sharing.awake()
    return sharing


def test_an_arm_that_is_stopped_before_it_says_that_it_moves_keeps_its_zones(sharing: Hand) -> None:
    sharing.submit("right palletizing")
    while not [each for each in sharing.commands(MoveJoints) if each.robot == "arm_right"]:
        sharing.wait(0.05)
    assert sharing.plant.zones.holder("table") == "arm_right"
    sharing.plant.step(sharing.now, [OperatorRequest(at=sharing.now, verb=Verb.STOP, scope="arm_right")])
    sharing.wait(0.05)
    assert sharing.plant.zones.holder("table") == "arm_right"


def test_an_arm_whose_move_failed_at_once_may_be_anywhere_until_it_could_have_answered(sharing: Hand) -> None:
    sharing.submit("right palletizing")
    while not [each for each in sharing.commands(MoveJoints) if each.robot == "arm_right"]:
        sharing.wait(0.05)
    sharing.tell("arm_right", after=0.0, state=MotionState.NO_LINK, epoch=1, plant=7)
    cell = sharing.plant.model.cell("right")
    layout = StorageLayout(cell)
    places = []
    for _ in range(3):
        sharing.tell("arm_right", after=0.15, state=MotionState.STOPPED, epoch=1, plant=7, q=layout.home.q)
        places.append(sharing.plant.dispatcher.whereabouts.place(cell.workspaces["arm_right"]))
    assert places == [None, None, layout.home]
