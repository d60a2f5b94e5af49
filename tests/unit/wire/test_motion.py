"""For how long a motion needs beats."""

from __future__ import annotations

from arboleda.kinds.joints import MoveJoints
from arboleda.model.messages import MotionState
from arboleda.model.plant_model import Evidence
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire.motion import LINGER_S, OpenMotion
from arboleda.wire.values import Telemetry

ELSEWHERE, GOAL = (0.5, 0.5, 0.5), (0.1, 0.2, 0.05)


def said(state: MotionState) -> Telemetry:
    return Telemetry(state=state, q=ELSEWHERE, node=None)


def test_a_board_that_names_no_command_has_stood_still_for_as_long_as_it_drives_on() -> None:
    arm = StorageLayout(shipped("sis_a", evidence=Evidence.JOINTS).cells[0]).arm
    motion = OpenMotion(robot=arm, command=MoveJoints(id="1-1", robot=arm.name, q=GOAL), seq=1)
    heard = [
        (10.0, MotionState.STOPPED, False),  # it has not begun
        (30.0, MotionState.MOVING, False),
        (31.0, MotionState.STOPPED, False),
        (31.0 + LINGER_S / 2, MotionState.STOPPED, False),
        (31.0 + LINGER_S, MotionState.STOPPED, True),
    ]
    for at, state, ended in heard:
        assert motion.ended(at, said(state), ELSEWHERE, frozenset()) is ended, at
