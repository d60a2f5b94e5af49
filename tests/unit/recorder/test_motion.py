"""Where robots are is looked at for those that told something, and nobody misses anything by that."""

from __future__ import annotations

import random

from arboleda.model.messages import MotionState, Report
from arboleda.recorder.motion import FRESH_S, Motion

NAMES = ("ra1", "rm1", "ra2")


def test_news_and_rows_before_are_all_rows() -> None:
    """What was known and the news give what a look at every robot gives, whoever reports when."""
    dice, motion, known = random.Random(7), Motion(), {}
    for name in NAMES:
        motion.take({"name": name, "q": None, "node": None, "heard_at": None, "position_at": None})
    for look in range(300):
        at = look * 0.25
        for name in (name for name in NAMES if dice.random() < 0.2):
            lost = dice.random() < 0.1
            state = MotionState.NO_LINK if lost else MotionState.STOPPED
            motion.hear(Report(at=at, robot=name, state=state, node=dice.choice((None, 1, 2))))
        known |= dict(motion.news(at))
        assert known == dict(motion.rows(at))


def test_a_robot_that_says_nothing_is_news_until_its_times_are_old() -> None:
    motion = Motion()
    motion.take({"name": "ra1", "q": (0.1,), "node": None, "heard_at": 5.0, "position_at": 5.0})
    assert [key for key, _ in motion.news(5.0)] == ["motion/ra1"]
    assert [row["fresh"] for _, row in motion.news(5.0 + FRESH_S)] == [[]]
    assert list(motion.news(5.0 + 2 * FRESH_S)) == []
