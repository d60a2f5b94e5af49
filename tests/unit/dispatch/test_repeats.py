"""A report that repeats the one before is only counted and timed: nothing else comes of it, ever."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Home
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import Evidence
from arboleda.testing import shipped

EPOCH = 7
HERE, THERE = (0.0, 0.0, 0.0), (0.5, 0.1, 0.0)
MAKES: list[Callable[..., Any]] = [
    partial(MoveJoints, robot="ra1", q=THERE),
    partial(FollowPath, robot="rm_sis_a", nodes=(0, 3)),
    partial(SetEffector, robot="ra1", on=True),
    partial(Home, robot="ra1"),
]
IDS = st.none() | st.sampled_from([f"{EPOCH}-{number}" for number in range(1, 5)])
SAID = st.fixed_dictionaries(
    {
        "robot": st.sampled_from(["ra1", "rm_sis_a"]),
        "state": st.none() | st.sampled_from(MotionState),
        "epoch": st.none() | st.integers(1, 2),
        "plant": st.sampled_from([None, EPOCH]),
        "boot_id": st.none() | st.integers(1, 2),
        "accepted": IDS,
        "done": IDS,
        "rejected": IDS,
        "homed": st.none() | st.booleans(),
    }
)
WHERE = st.fixed_dictionaries(
    {"q": st.sampled_from([None, HERE, THERE]), "effector": st.none() | st.booleans(), "piece": st.booleans()}
)
HAPPENINGS = st.one_of(
    st.tuples(st.just("tell"), SAID, WHERE),
    st.tuples(st.just("tell again"), st.integers(1, 4)),
    st.tuples(st.just("send"), st.sampled_from(MAKES)),
    st.tuples(st.just("cancel")),
    st.tuples(st.sampled_from(["latch", "unlatch", "declare_homed"])),
    st.tuples(st.just("wait"), st.sampled_from([0.0, 0.3, 2.0])),
)


class Desk:
    """A dispatcher and the time; `knows` whether it knows repeats for what they are."""

    def __init__(self, evidence: Evidence, *, knows: bool) -> None:
        self.now = 100.0
        self.dispatcher = Dispatcher(shipped("sis_a", evidence=evidence), EPOCH, {})
        self.knows = knows
        self.last: dict[str, Any] = {"robot": "ra1"}

    def tell(self, said: dict[str, Any], where: dict[str, Any]) -> None:
        arm = said["robot"] == "ra1"
        self.last = {**said, **where} if arm else {**said, "node": 0 if where["q"] == HERE else 3}
        self._report()

    def tell_again(self, times: int) -> None:
        for _ in range(times):
            self._report()

    def send(self, make: Callable[..., Any]) -> None:
        self.dispatcher.send(make, "sis_a", "doing", self.now)

    def cancel(self) -> None:
        self.dispatcher.cancel_all("sis_a", self.now)

    def wait(self, seconds: float) -> None:
        self.now += seconds
        self.dispatcher.expire(self.now, self.now)

    def do(self, verb: str, *rest: Any) -> None:
        getattr(self, verb.replace(" ", "_"))(*rest)

    def latch(self) -> None:
        self.dispatcher.latches.latch("ra1")

    def unlatch(self) -> None:
        self.dispatcher.latches.unlatch("ra1")

    def declare_homed(self) -> None:
        self.dispatcher.declare_homed("ra1")

    def _report(self) -> None:
        self.now += 0.1
        if not self.knows:
            for belief in self.dispatcher.beliefs.values():
                belief._last = None
        self.dispatcher.report(Report(at=self.now, **self.last), self.now)

    def shown(self) -> list[Any]:
        """All that came of it."""
        desk, ledger = self.dispatcher, self.dispatcher.ledger
        beliefs = [
            {**vars(belief), "robot": None, "_last": None, "repeats": 0}
            | {"stillness": vars(belief.stillness) | {"_robot": None}, "rate": vars(belief.rate)}
            | {"pauses": vars(belief.pauses)}
            for belief in desk.beliefs.values()
        ]
        entries = [
            (id, entry.state, entry.deadline, vars(entry.observations))
            for id, entry in ledger.entries.items()
        ]
        return [desk.outbox, beliefs, entries, ledger.changed, desk.whereabouts.reached, desk.next_deadline]


@pytest.mark.parametrize("evidence", Evidence, ids=lambda level: level.value)
@given(happenings=st.lists(HAPPENINGS, max_size=25))
def test_who_knows_repeats_believes_and_sends_what_one_that_merges_all_does(
    evidence: Evidence, happenings: list[tuple[Any, ...]]
) -> None:
    quick, thorough = Desk(evidence, knows=True), Desk(evidence, knows=False)
    for verb, *rest in happenings:
        quick.do(verb, *rest)
        thorough.do(verb, *rest)
        assert quick.shown() == thorough.shown()
