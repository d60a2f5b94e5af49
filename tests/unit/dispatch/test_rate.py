"""How often a robot reports, as screens show it."""

from __future__ import annotations

import pytest

from arboleda.dispatch.belief import RATE_S
from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import Evidence
from arboleda.testing import shipped


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
