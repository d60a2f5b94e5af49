"""What is believed of a robot by its reports, what keeps it from commands, and how often it reports."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.dispatch.belief import RATE_S, Belief
from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.messages import MotionState, Reason, Report
from arboleda.model.plant_model import Evidence
from arboleda.model.sentence import OWN
from arboleda.testing import shipped

from ..kinds.station import plant

EPOCH = 7
HERE, THERE = (0.0, 0.0, 0.0), (0.5, 0.1, 0.0)
WHY = OWN(text="its driver plc has said nothing for 1.5 s")


@pytest.fixture
def belief() -> Belief:
    model = shipped("sis_a")
    belief = Belief(model.robots["ra1"], model.timing.stale_after_s, EPOCH)
    belief.merge(Report(at=1.0, robot="ra1", state=MotionState.STOPPED, q=HERE))
    return belief


def test_a_repeat_counts_as_heard(belief: Belief) -> None:
    assert belief.hear_again(Report(at=2.0, robot="ra1", state=MotionState.STOPPED, q=HERE))
    assert (belief.heard_at, belief.stillness.position_at) == (2.0, 2.0)
    assert (belief.reports, belief.stillness.is_still) == (2, True)


@pytest.mark.parametrize("other", [{"q": THERE}, {"homed": True}, {"rejected": "7-1"}, {"at": 0.5}])
def test_anything_else_is_no_repeat(belief: Belief, other: dict[str, Any]) -> None:
    said = {"at": 2.0, "robot": "ra1", "state": MotionState.STOPPED, "q": HERE, **other}
    assert not belief.hear_again(Report(**said))
    assert belief.reports == 1


def test_who_fell_silent_does_not_repeat_itself_but_is_back(belief: Belief) -> None:
    belief.fall_silent()
    assert not belief.hear_again(Report(at=2.0, robot="ra1", state=MotionState.STOPPED, q=HERE))


def test_a_value_that_a_report_leaves_out_stays(belief: Belief) -> None:
    belief.merge(Report(at=2.0, robot="ra1", homed=True))
    belief.merge(Report(at=3.0, robot="ra1", state=MotionState.MOVING))
    assert (belief.state, belief.q, belief.homed) == (MotionState.MOVING, HERE, True)
    assert (belief.heard_at, belief.moves_since) == (3.0, 3.0)


def test_who_fell_silent_takes_no_command_until_it_is_heard(belief: Belief) -> None:
    belief.fall_silent()
    silent = belief.obstacle(was=False)
    assert silent is not None and str(silent.sentence) == "ra1 is offline" and belief.known_q is None
    belief.merge(Report(at=2.0, robot="ra1", state=MotionState.STOPPED, q=THERE))
    assert belief.obstacle(was=False) is None and belief.known_q == THERE


def test_a_bridge_that_restarted_has_forgotten_a_stop(belief: Belief) -> None:
    belief.merge(Report(at=2.0, robot="ra1", epoch=1, plant=EPOCH))
    belief.barred = True
    barred = belief.obstacle(was=False)
    assert barred is not None and barred.reason is Reason.STOPPED
    belief.merge(Report(at=3.0, robot="ra1", epoch=2, plant=EPOCH))
    assert belief.obstacle(was=False) is None


def test_of_what_was_said_for_a_robot_meanwhile_the_gravest_counts(belief: Belief) -> None:
    belief.merge(Report(at=2.0, robot="ra1", state=MotionState.MOVING))
    belief.merge(Report(at=3.0, robot="ra1", state=MotionState.NO_LINK))
    assert belief.find_again((MotionState.STOPPED, MotionState.FAULT)), "it may have moved"
    assert belief.state is MotionState.FAULT and belief.is_hearsay
    belief.end_hearsay()
    assert belief.state is None, "it was moving, and may have come to a stop"


def test_a_device_that_is_offline_says_why_until_it_is_heard() -> None:
    (station,) = plant().robots.values()
    belief = Belief(station, stale_after_s=1.5, plant_epoch=1)
    belief.merge(Report(at=1.0, robot="station", state=MotionState.NO_LINK, lost=WHY))
    now, before = belief.obstacle(was=False), belief.obstacle(was=True)
    assert now is not None and before is not None
    assert str(now.sentence) == f"station is offline: {WHY}" and now.reason is Reason.LINK_LOST
    assert str(before.sentence) == f"station was offline: {WHY}"
    belief.merge(Report(at=2.0, robot="station", state=MotionState.STOPPED))
    assert belief.obstacle(was=False) is None
    belief.merge(Report(at=3.0, robot="station", state=MotionState.NO_LINK))
    told = belief.obstacle(was=False)
    assert told is not None and str(told.sentence) == "station is offline"


class Arm:
    """An arm that says ten times a second that it stands still."""

    def __init__(self, dispatcher: Dispatcher) -> None:
        self.now = 100.0
        self._dispatcher = dispatcher
        self.belief = dispatcher.beliefs["ra1"]

    def reports_for(self, seconds: float, state: MotionState = MotionState.STOPPED) -> float | None:
        """The rate after it did so."""
        for _ in range(round(10 * seconds)):
            self.now += 0.1
            report = Report(at=self.now, robot="ra1", state=state, q=(0.0, 0.0, 0.0))
            self._dispatcher.report(report, self.now)
        return self.belief.rate.hz


@pytest.fixture(params=[Evidence.JOINTS, Evidence.STATE], ids=lambda evidence: evidence.value)
def arm(request: pytest.FixtureRequest) -> Arm:
    return Arm(Dispatcher(shipped("sis_a", evidence=request.param), 7, {}))


def test_a_rate_is_counted_over_two_seconds(arm: Arm) -> None:
    assert arm.reports_for(RATE_S - 0.2) is None
    assert arm.reports_for(0.5) == pytest.approx(10.0, rel=0.1)


def test_the_silence_of_one_that_is_back_does_not_count(arm: Arm) -> None:
    arm.reports_for(5.0)
    arm.reports_for(0.1, MotionState.NO_LINK)
    arm.now += 60.0
    assert arm.reports_for(1.0) is None
    assert arm.reports_for(2.0) == pytest.approx(10.0, rel=0.1)


def test_nor_does_the_time_before_it_was_heard_first(arm: Arm) -> None:
    assert arm.reports_for(0.1) is None
