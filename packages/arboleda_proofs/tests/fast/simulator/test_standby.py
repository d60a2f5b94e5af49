"""A plant on two hosts: who leads, what a leader of before may do, and what the next one goes on with."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from arboleda.departures import leading
from arboleda.departures.leading import LEASE_S, LOOK_S, Standing
from arboleda.model.messages import OperatorAnswer, TaskChanged, TaskState, Verb
from arboleda.rig.hosts.former_leader import LateMessage
from arboleda.rig.hosts.hosts import STARTS_S, Hosts
from arboleda.rig.world import PLANT
from arboleda.testing import shipped
from arboleda.wire.payloads import StopGoal
from arboleda_proofs.simulator.checks import BadFaults
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.faults import NOT_WITH_STANDBY, OF_HOSTS, Fault
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld
from arboleda_proofs.simulator.run import Simulation

SOON_S = LEASE_S + 3 * LOOK_S + STARTS_S


@contextmanager
def two_hosts(*faults: Fault) -> Iterator[tuple[JudgedWorld, Hosts, list[LateMessage]]]:
    """A plant with a task at work, judged by every invariant; and what leaves leaders of before."""
    watched = JudgedWorld(shipped("sis_a"), standby=True)
    world, said = watched.world, list[LateMessage]()
    assert world.hosts is not None
    world.watchers.append(lambda: said.extend(world.moment.former))
    world.advance(2.0)
    world.request_task("sis_a 0B 1 #lot")
    world.advance(3.0)
    for fault in faults:
        watched.begin(fault)
    yield watched, world.hosts, said


def fault(kind: str, target: str = PLANT, **fields: object) -> Fault:
    return Fault(**{"kind": kind, "at": 0.0, "target": target, **fields})  # type: ignore[arg-type]


def ends(watched: JudgedWorld) -> list[TaskState]:
    found: list[TaskState] = []
    world = watched.world
    world.watchers.append(
        lambda: found.extend(
            each.state for each in world.moment.sent if isinstance(each, TaskChanged) and each.task == "lot"
        )
    )
    return found


def test_a_standby_leads_once_the_lease_of_who_was_killed_has_ended() -> None:
    with two_hosts(fault("leader_killed")) as (watched, hosts, said):
        watched.world.advance(LEASE_S - 1.0)
        assert hosts.leader.host.name == "host_a" and not watched.world.is_on(PLANT)
        watched.world.advance(SOON_S - LEASE_S + 1.0)
        assert hosts.leader.host.name == "host_b" and watched.world.is_on(PLANT)
        assert [host for _, host in hosts.numbers] == ["host_a", "host_b"]
        assert watched.world.plant.epoch == hosts.leader.epoch > 1001
        assert "lot" in watched.world.plant.intake.tasks and said == []


def test_a_leader_that_is_frozen_for_less_than_its_lease_goes_on_leading() -> None:
    with two_hosts(fault("leader_frozen", seconds=1.5)) as (watched, hosts, _):
        watched.world.advance(6.0)
        assert hosts.leader.host.name == "host_a" and hosts.formers == []


@pytest.mark.parametrize("word", ["", "last packets late"])
def test_a_leader_that_was_frozen_for_longer_says_nothing_more(word: str) -> None:
    frozen = fault("leader_frozen", seconds=6.0, amount=0.3, word=word)
    with two_hosts(frozen) as (watched, hosts, said):
        watched.world.advance(10.0)
        assert hosts.leader.host.name == "host_b"
        assert [each for each in said if each.standing is not Standing.LEADS] == []
        assert all(each.over for each in hosts.formers)


def test_a_leader_that_is_cut_off_ends_and_the_other_one_goes_on() -> None:
    with two_hosts(fault("store_cut", "host_a", seconds=20.0, word="both ways")) as (watched, hosts, _):
        watched.world.advance(SOON_S + 6.0)
        assert hosts.leader.host.name == "host_b" and watched.world.is_on(PLANT)
        assert "lot" in watched.world.plant.intake.tasks


def test_a_standby_that_is_cut_off_changes_nothing() -> None:
    with two_hosts(fault("store_cut", "host_b", seconds=20.0, word="both ways")) as (watched, hosts, _):
        watched.world.advance(15.0)
        assert hosts.numbers == [(1001, "host_a")]


@pytest.mark.long
def test_a_planned_change_loses_no_task_and_goes_on_by_itself() -> None:
    with two_hosts() as (watched, hosts, said):
        states = ends(watched)
        watched.begin(fault("handover"))
        watched.world.advance(60.0)
        assert [host for _, host in hosts.numbers] == ["host_a", "host_b"]
        assert states[-1] is TaskState.DONE and TaskState.FAILED not in states and said == []


def test_an_answer_of_the_store_that_is_lost_changes_nothing() -> None:
    with two_hosts(*[fault("store_answer_lost", "store")] * 5) as (watched, hosts, _):
        states = ends(watched)
        watched.world.advance(60.0)
        assert states == [TaskState.DONE] and hosts.numbers == [(1001, "host_a")]


def cut_off_with_a_slow_clock() -> None:
    """And the clock of who waits is fast."""
    watched = JudgedWorld(shipped("sis_a"), standby=True)
    watched.world.advance(2.0)
    watched.begin(fault("clock_drift", "host_a", seconds=90.0, word="slower", amount=0.035))
    watched.begin(fault("clock_drift", "host_b", seconds=90.0, word="faster", amount=0.035))
    watched.world.advance(6.18)
    watched.begin(fault("store_cut", "host_a", seconds=20.0, word="to the store"))
    watched.world.advance(5.0)
    assert watched.world.hosts is not None and watched.world.hosts.leader.host.name == "host_b"


def test_a_leader_with_a_slow_clock_that_is_cut_off_is_no_second_leader(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # who waits leads in the first possible moment
    monkeypatch.setattr("arboleda.rig.hosts.hosts.LOOK_S", 0.01)
    cut_off_with_a_slow_clock()
    monkeypatch.setattr(leading, "SURE_S", LEASE_S)  # without the margin for clocks it is one
    with pytest.raises(BrokenInvariant, match="a_lead_is_over_before_the_next_begins"):
        cut_off_with_a_slow_clock()


@pytest.mark.long
def test_the_same_seed_does_the_same_on_two_hosts() -> None:
    def digest() -> str:
        model = shipped("sis_a")
        climate = Climate.draw(model, 3, "normal", standby=True)
        return Simulation(model, 3, climate.faults, standby=True).run(seconds=40.0).digest

    assert digest() == digest()


def test_what_befalls_hosts_is_drawn_with_a_standby_only() -> None:
    model = shipped("sis_a")
    alone, two = (
        {name for seed in range(8) for name in _rates(model, seed, standby=on)} for on in (False, True)
    )
    assert not alone & set(OF_HOSTS) and set(OF_HOSTS) < two and not two & NOT_WITH_STANDBY


def _rates(model, seed: int, *, standby: bool):  # type: ignore[no-untyped-def]
    return Climate.draw(model, seed, "many", standby=standby).rates


@pytest.mark.parametrize(
    ("kind", "standby", "sentence"),
    [
        ("leader_frozen", False, "leader_frozen befalls a plant with two hosts: simulate it with --standby"),
        ("power_cut", True, "power_cut befalls a plant on one host: leave out --standby"),
    ],
)
def test_what_cannot_befall_the_plant_is_refused(kind: str, standby: bool, sentence: str) -> None:
    with pytest.raises(BadFaults, match=sentence):
        Climate.from_file(shipped("sis_a"), 1, {"rates": {kind: 1.0}}, standby=standby)


def test_a_verb_that_a_next_leader_finds_at_its_first_step_is_judged_by_what_it_knows_then() -> None:
    nothing_heard = fault("hop_delay", word="to plant", amount=1.4, seconds=20.0)
    with two_hosts(nothing_heard, fault("leader_killed")) as (watched, hosts, _):
        world = watched.world
        while hosts.leader.host.name == "host_a":
            world.advance(0.05)
        refused: list[str] = []
        world.watchers.append(
            lambda: refused.extend(
                str(each.refusal) for each in world.moment.sent if isinstance(each, OperatorAnswer)
            )
        )
        world.request_verb(Verb.RESUME)
        world.advance(SOON_S)
        (why,) = refused
        assert why == "ra1 was not heard yet; until then nobody can tell what became of the step of sis_a"


def test_a_stop_that_comes_in_one_go_with_the_next_leaders_first_beat_counts_as_of_before() -> None:
    held = fault("partition", "ra_1", word="down, held", seconds=8.0)
    with two_hosts(held, fault("store_away", "store", seconds=1.6)) as (watched, hosts, _):
        carried_out: list[tuple[int, StopGoal]] = []
        watched.world.watchers.append(
            lambda: carried_out.extend(
                (len(hosts.numbers), goal)
                for board, goal in watched.world.moment.executed
                if board == "ra_1" and isinstance(goal, StopGoal)
            )
        )
        watched.world.advance(12.0)
        (numbers, stop) = carried_out[0]
        assert numbers == 2 and stop.epoch == hosts.numbers[0][0]
