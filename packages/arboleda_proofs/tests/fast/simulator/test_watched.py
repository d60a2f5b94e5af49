"""A world in which every step is judged: faults begin and end, a breach leaves its step, rest is rest."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import pytest

from arboleda.model.messages import SystemStart, Verb
from arboleda.testing import shipped
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.invariants.invariant import Look, Trigger, invariant
from arboleda_proofs.simulator.judged_world import STAYS_S, BrokenInvariant, JudgedWorld


@invariant(Trigger.SENT)
def no_start(look: Look) -> Iterable[str]:
    """No cell starts a task."""
    yield from (f"{each.cell} starts" for each in look.moment.sent if isinstance(each, SystemStart))


@invariant(Trigger.END)
def nothing_muted(look: Look) -> Iterable[str]:
    """At rest, no line has troubles."""
    yield from (name for name, client in look.world.broker.clients.items() if client.up.troubles)


def test_a_fault_begins_and_ends_in_its_time() -> None:
    watched = JudgedWorld(shipped("sis_a"), keep=True)
    watched.expect(Fault(kind="mute", at=1.0, seconds=2.0, target="ra_1"))
    watched.world.advance(0.9)
    assert (watched.faults, watched.world.faults_active) == ([], 0)
    watched.world.advance(0.2)
    assert ([fault.kind for fault in watched.faults], watched.world.faults_active) == (["mute"], 1)
    watched.world.advance(2.0)
    assert watched.world.faults_active == 0
    assert watched.world.last_fault_at - watched.start == pytest.approx(3.0)
    told = [line.split(maxsplit=1)[1] for line in watched.trace.lines if "mute" in line]
    assert [line.split()[:3] for line in told] == [["FAULT", "mute", "ra_1"], ["fault", "over", "mute"]]


def test_a_breach_leaves_the_step_in_which_it_is_seen() -> None:
    watched = JudgedWorld(shipped("sis_a"), invariants=[no_start])
    watched.world.advance(1.0)
    watched.world.request_task("sis_a 0B 7")
    with pytest.raises(BrokenInvariant, match="no_start: sis_a starts"):
        watched.world.advance(1.0)
    assert watched.seconds == pytest.approx(1.0)


def test_an_invariant_looks_at_the_whole_when_its_time_has_come_and_else_after_its_steps() -> None:
    looks: list[tuple[float, bool]] = []

    @invariant(Trigger.ASKED, every_s=2.0)
    def looked(look: Look) -> Iterable[str]:
        """It looks."""
        looks.append((look.world.now, look.whole))
        return ()

    watched = JudgedWorld(shipped("sis_a"), invariants=[looked])
    watched.world.advance(7.0)
    times = [at for at, whole in looks if whole]
    assert len(times) == len(looks) == watched.checks["looked"] >= 3
    assert all(2.0 <= after - before < 2.5 for before, after in pairwise(times))
    watched.world.request_task("sis_a 0B 7")
    watched.world.advance(0.1)
    assert [whole for _, whole in looks[len(times) :]].count(False) == 1


def test_coming_to_rest_ends_what_lasts_and_judges_the_end() -> None:
    watched = JudgedWorld(shipped("sis_a"), invariants=[nothing_muted])
    watched.begin(Fault(kind="mute", at=0.0, seconds=1e9, target="ra_1"))
    watched.world.advance(5.0)
    watched.come_to_rest()
    assert watched.world.faults_active == 0


@pytest.mark.long
def test_what_never_comes_to_rest_is_a_breach() -> None:
    watched = JudgedWorld(shipped("sis_a"), invariants=[nothing_muted])
    watched.world.broker.clients["ra_1"].up.troubles.append(lambda message: (0.0,))
    with pytest.raises(BrokenInvariant, match="nothing_muted: ra_1"):
        watched.come_to_rest()
    assert watched.seconds >= 600.0


def test_nothing_is_at_rest_while_a_message_is_held_back() -> None:
    watched = JudgedWorld(shipped("sis_a"), invariants=[])
    watched.world.advance(1.0)
    watched.begin(Fault(kind="partition", at=0.0, seconds=8.0, target="ra_1", word="down, held"))
    watched.world.request_verb(Verb.STOP, "sis_a")
    watched.world.advance(1.0)
    watched.come_to_rest()
    assert watched.seconds >= 9.0 + STAYS_S


def test_a_fault_of_later_does_not_begin_at_rest() -> None:
    watched = JudgedWorld(shipped("sis_a"), invariants=[])
    watched.expect(Fault(kind="mute", at=5.0, seconds=1e9, target="ra_1"))
    watched.come_to_rest()
    assert watched.faults == []
    watched.expect(Fault(kind="mute", at=watched.seconds + 1.0, seconds=1e9, target="ra_1"))
    watched.world.advance(2.0)
    assert len(watched.faults) == 1


def test_it_is_counted_how_often_each_invariant_was_looked_at() -> None:
    watched = JudgedWorld(shipped("sis_a"), invariants=[no_start, nothing_muted])
    watched.world.advance(1.0)
    beats = watched.checks["no_start"]
    assert beats >= 4
    watched.come_to_rest()
    assert watched.checks["nothing_muted"] == 2
