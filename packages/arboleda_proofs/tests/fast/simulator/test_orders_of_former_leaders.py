"""Orders of a leader of before that come late: an effector may obey them only where its board cannot tell."""

from __future__ import annotations

from collections.abc import Iterable

import pytest

from arboleda.model.messages import TaskChanged, TaskState, Verb
from arboleda.model.plant_model import Evidence
from arboleda.rig.network import Client
from arboleda.rig.world import BRIDGE, PLANT
from arboleda.sim.arm import ArmBody
from arboleda.testing import shipped
from arboleda.wire.payloads import EffectorGoal, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Publication
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.invariants import Invariant
from arboleda_proofs.simulator.invariants.grips import GRIPS
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld

ARM = "ra_1"
OFF = "effector_off_only_where_legal"
PALLETIZING = "sis_a palletizing"
GRIPS_AT, OPENS_AT = 3.179, 5.466  # when the leader tells the effector so, as nothing goes wrong
NEWEST = 65_000
LATE_S = 9.15  # how much later that reaches the board: the next leader's arm is half way to the place then


class Change:
    """A plant on two hosts whose leader is frozen as it gives one last order; the other host leads then."""

    def __init__(
        self, *, ordered_at: float = OPENS_AT, invariants: Iterable[Invariant] | None = None
    ) -> None:
        model = shipped("sis_a", evidence=Evidence.JOINTS, assume_homed=True)
        self.watched = JudgedWorld(model, standby=True, invariants=invariants)
        self.world = self.watched.world
        self.obeyed: list[tuple[float, bool]] = []  # when the effector was told to grip (True) or let go
        self.done: list[str] = []
        self.world.watchers.append(self._listen)
        self.wait_until(2.0)
        self.world.request_task(f"{PALLETIZING} #first")
        self.wait_until(ordered_at - 0.066)
        self.leader = self.world.broker.clients[BRIDGE]
        fields = {"target": PLANT, "seconds": LATE_S - 0.15, "amount": 0.1, "word": "last packets late"}
        self.watched.begin(Fault(kind="leader_frozen", at=0.0, **fields))  # type: ignore[arg-type]

    @property
    def body(self) -> ArmBody:
        body = self.world.boards[ARM].body
        assert isinstance(body, ArmBody)
        return body

    def wait_until(self, at: float) -> None:
        """Let time pass until `at`, s since the beginning."""
        self.world.advance(self.watched.start + at - self.world.now)

    def lead(self) -> None:
        """Let the other host lead, and a person have the cell work on."""
        world = self.world
        self.wait_until(9.25)
        assert world.hosts is not None and world.hosts.leader.host.name == "host_b"
        world.request_verb(Verb.RETRY, "sis_a")
        world.advance(0.5)
        world.request_verb(Verb.RESUME, "sis_a")
        world.advance(0.1)

    def carry(self) -> None:
        """Let the next leader's arm carry a part, and be half way to the place."""
        self.lead()
        self.world.request_task(f"{PALLETIZING} #second")
        self.wait_until(14.5)
        assert self.body.holding and self.body.moving

    def tell_to_let_go(self, sender: Client, late_s: float = 0.0, epoch: int | None = None) -> None:
        """Tell the effector to let go, over a line that takes `late_s` for that alone."""
        goal = EffectorGoal(on=False, seq=None if epoch is None else NEWEST, epoch=epoch)
        sender.up.troubles.append(lambda _: (late_s,))
        self.world.publish(Publication(topic=topic(ARM, Channel.EFFECTOR), payload=encode(goal)), sender)
        sender.up.troubles.pop()

    def _listen(self) -> None:
        moment, now = self.world.moment, self.world.now - self.watched.start
        goals = [goal for _, goal in moment.executed if isinstance(goal, EffectorGoal)]
        self.obeyed += [(now, goal.on) for goal in goals]
        ends = [each for each in moment.sent if isinstance(each, TaskChanged)]
        self.done += [each.task for each in ends if each.state is TaskState.DONE]


def test_a_late_order_without_numbers_opens_the_effector_of_the_next_leader_and_nobody_is_blamed() -> None:
    change = Change()
    change.carry()
    change.world.advance(0.2)
    assert change.obeyed[-1] == (pytest.approx(OPENS_AT + LATE_S, abs=0.01), False)
    assert change.body.moving and not change.body.holding
    change.world.advance(10.0)
    assert change.done == ["first", "second"]  # nobody can tell: "not checked" is what it says


def test_one_that_grips_where_no_task_runs_is_nobodys_fault_either() -> None:
    change = Change(ordered_at=GRIPS_AT)
    change.lead()
    change.world.advance(10.0)
    assert (pytest.approx(GRIPS_AT + LATE_S, abs=0.01), True) in change.obeyed


def test_the_same_order_of_who_leads_is_one_too_many() -> None:
    change = Change(invariants=GRIPS)
    change.carry()
    change.tell_to_let_go(change.world.broker.clients[BRIDGE])
    with pytest.raises(BrokenInvariant, match=OFF):
        change.world.advance(0.05)


def test_one_that_comes_late_from_who_leads_still_is_one_too_many() -> None:
    change = Change(invariants=GRIPS)
    change.carry()
    change.tell_to_let_go(change.world.broker.clients[BRIDGE], late_s=0.05)
    with pytest.raises(BrokenInvariant, match=OFF):
        change.world.advance(0.1)


def test_one_with_a_number_could_have_been_refused() -> None:
    change = Change(invariants=GRIPS)
    change.tell_to_let_go(change.leader, epoch=1001)  # among its last packets
    change.carry()
    with pytest.raises(BrokenInvariant, match=OFF):
        change.world.advance(0.1)
