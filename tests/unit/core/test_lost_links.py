"""A link that is lost for a reason: a task that fails for it says so, and the advice leads back to work."""

from __future__ import annotations

from tests.following import follow

from arboleda.model.messages import MotionState, Reason, Report, TaskState
from arboleda.model.sentence import OWN

from ...plants import made
from ..kinds.lab import Bench, model

WHY = OWN(text="its driver plc has said nothing for 1.5 s")


shut = made("shut", lambda cell: cell.device("oven").close())


def lost(robot: str, at: float) -> Report:
    return Report(at=at, robot=robot, state=MotionState.NO_LINK, lost=WHY)


def test_a_command_that_was_open_fails_with_the_reason_and_the_advice_leads_back() -> None:
    bench = Bench(model(shut))
    bench.submit("bench shut")
    assert bench.wait(20.0, lambda: "oven close" in bench.told)
    bench.tell(lost("oven", bench.now))
    end = bench.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.LINK_LOST)
    assert str(end.sentence) == f"oven: the link was lost while doing close: {WHY}"
    follow(bench, "bench")
    bench.submit("bench shut #again")
    assert bench.outcome().state is TaskState.DONE
