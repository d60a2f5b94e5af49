"""A link that is lost for a reason: who asks why a device is offline is told it, until it is heard again."""

from __future__ import annotations

from tests.following import follow

from arboleda.dispatch.belief import Belief
from arboleda.model.messages import MotionState, Reason, Report, TaskState
from arboleda.model.sentence import OWN
from arboleda.recipes import recipe

from ..kinds.lab import Bench, model
from ..kinds.station import plant

WHY = OWN(text="its driver plc has said nothing for 1.5 s")


@recipe("shut")
def shut(cell):  # type: ignore[no-untyped-def]
    return cell.device("oven").close()


def lost(robot: str, at: float) -> Report:
    return Report(at=at, robot=robot, state=MotionState.NO_LINK, lost=WHY)


def test_a_device_that_is_offline_says_why_until_it_is_heard() -> None:
    (station,) = plant().robots.values()
    belief = Belief(station, stale_after_s=1.5, plant_epoch=1)
    belief.merge(lost("station", 1.0))
    now, before = belief.obstacle(was=False), belief.obstacle(was=True)
    assert now is not None and before is not None
    assert str(now.sentence) == f"station is offline: {WHY}" and now.reason is Reason.LINK_LOST
    assert str(before.sentence) == f"station was offline: {WHY}"
    belief.merge(Report(at=2.0, robot="station", state=MotionState.STOPPED))
    assert belief.obstacle(was=False) is None
    belief.merge(Report(at=3.0, robot="station", state=MotionState.NO_LINK))
    told = belief.obstacle(was=False)
    assert told is not None and str(told.sentence) == "station is offline"


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
