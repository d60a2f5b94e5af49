"""Robots whose state and position come apart: each of the two in its own order."""

from __future__ import annotations

import pytest

from arboleda.model.messages import MotionState, Report
from arboleda_proofs.simulator.chance import Dice
from arboleda_proofs.simulator.split_reports import TwoTopics


def _comes(topics: TwoTopics, at: float) -> float:
    """The time at which a state that is said at `at` is heard."""
    (state,) = topics.parted(Report(at=at, robot="arm", state=MotionState.STOPPED))
    return state.at


@pytest.mark.parametrize("seed", range(10))
def test_what_is_said_later_is_heard_later(seed: int) -> None:
    topics = TwoTopics(Dice(seed, "apart"), lambda: 0.0)
    heard = [_comes(topics, 10.0 + number / 100) for number in range(50)]
    assert heard == sorted(heard)


@pytest.mark.parametrize("seed", range(10))
def test_what_was_under_way_when_time_was_skipped_is_heard_before_what_is_said_after_it(seed: int) -> None:
    skipped_s = 0.0
    topics = TwoTopics(Dice(seed, "apart"), lambda: skipped_s)
    under_way_until = _comes(topics, 10.0)
    skipped_s = 5.0
    assert _comes(topics, 15.0) >= under_way_until + skipped_s
