"""A record goes on with virtual devices: as it was, and otherwise where something is other."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from itertools import product
from typing import Any

import pytest
from tests.lengths import sample

from arboleda.model.messages import Verb
from arboleda.model.plant_model import PlantModel
from arboleda.recorder.record_text import sentence_of
from arboleda.rig.world import World
from arboleda.testing.plants import shipped
from arboleda_proofs.campaigns.simulated_recorder import TapedPlant, recorded
from arboleda_proofs.commands.fork import compared
from arboleda_proofs.playback.fork.device_replay import befall
from arboleda_proofs.playback.fork.plant_events import Pair
from arboleda_proofs.playback.fork.run import ForkRequest, ForkResult, forked
from arboleda_proofs.playback.troubles import SILENCE, Trouble
from arboleda_proofs.simulator.faults import KINDS, Fault

Act = Callable[[World], None]
RECORDED = shipped()
START_S = 100.0


def mute(world: World, board: str, seconds: float) -> None:
    end = KINDS["mute"].begin(world, Fault(kind="mute", at=0.0, target=board))
    assert end is not None
    world.at(world.now + seconds, lambda _: end())


def taped(acts: dict[float, Act], *, model: PlantModel | None = None, s: float = 40.0) -> TapedPlant:
    """A plant that did two tasks, with what else happened at these seconds."""
    world = World(model or shipped(), now=START_S, make_plant=TapedPlant)
    world.request_task("sis_a 0B 7 #a")
    world.request_task("sis_b 1C 3 #b")
    for at, act in acts.items():
        world.at(START_S + at, lambda _, act=act: act(world))
    world.advance(s)
    assert isinstance(world.plant, TapedPlant)
    return world.plant


def fork(plant: TapedPlant, at: float, **changes: Any) -> ForkResult:
    at_ns = round((START_S + at) * 1e9)
    asked = ForkRequest(**{"at_ns": at_ns, "model": RECORDED, "recorded": RECORDED, **changes})
    found = forked(plant.beginning, recorded(plant.tape), asked, sentence_of)
    assert found.difference is None
    return found


def differences(found: ForkResult) -> list[Pair]:
    return [pair for pair in compared(found, None) if not pair.same]


def end_of(found: ForkResult, task: str) -> str:
    return [each.text for each in found.fork if each.stream == f"task {task}"][-1]


def ended(found: ForkResult) -> Iterator[tuple[float, float]]:
    """Times at which each task ended, in the record and in the fork."""
    for pair in compared(found, None):
        if pair.either.stream.startswith("task ") and pair.recorded and pair.fork:
            yield pair.recorded.at, pair.fork.at


def hold(world: World) -> None:
    world.request_verb(Verb.HOLD, "sis_b")
    world.at(world.now + 3.0, lambda _: world.request_verb(Verb.RESUME, "sis_b"))


RUNS: dict[str, dict[float, Act]] = {
    "undisturbed": {},
    "held and resumed": {6.0: hold},
    "silent arm": {5.0: lambda world: mute(world, "ra_1", 4.0)},
    "silent mobile": {2.0: lambda world: mute(world, "rm_sis_a", 2.0)},
    "short silence": {5.0: lambda world: mute(world, "ra_1", 1.2)},
    "lost power": {5.5: lambda world: world.power_off("ra_2")},
    "reboot": {5.5: lambda world: world.crash("ra_2")},
    "alarm": {5.5: lambda world: world.boards["ra_1"].fail(round(world.now * 1e6))},
    "bridge restart": {5.5: lambda world: world.crash("bridge")},
}


@cache
def run_of(name: str) -> TapedPlant:
    return taped(RUNS[name])


@pytest.mark.sampled(8)
@pytest.mark.parametrize(("run", "at"), sample(product(RUNS, (0.5, 3.2, 5.2, 8.0)), every=5))
def test_a_fork_of_nothing_else_happens_as_recorded(run: str, at: float) -> None:
    found = fork(run_of(run), at)
    assert differences(found) == []
    late_s = 1.5 if run.startswith("silent") else 0.5  # who is silent goes on from where it was heard last
    assert all(abs(fork - recorded) < late_s for recorded, fork in ended(found))


def test_without_what_befell_devices_the_task_is_done() -> None:
    found = fork(run_of("silent arm"), 4.0, healthy=True)
    assert "failed" in [each.text for each in found.recorded if each.stream == "task a"][-1]
    assert end_of(found, "a") == "done sis_a 0B 7 (id a)"
    assert differences(found)[0].either.text.startswith("ra1 ")


def test_a_plant_that_waits_longer_outlasts_a_silence() -> None:
    patient = replace(shipped(), timing=replace(shipped().timing, stale_after_s=6.0))
    found = fork(run_of("silent arm"), 4.0, model=patient)
    assert not found.early
    assert end_of(found, "a") == "done sis_a 0B 7 (id a)" and end_of(found, "b") == "done sis_b 1C 3 (id b)"


def test_a_changed_plant_that_does_otherwise_before_forks_there() -> None:
    hasty = replace(shipped(), timing=replace(shipped().timing, dwell_s=0.7))
    found = fork(run_of("undisturbed"), 8.0, model=hasty)
    assert found.early and found.at == pytest.approx(START_S + 0.2)
    assert end_of(found, "a") == "done sis_a 0B 7 (id a)"
    assert differences(found) == []
    assert all(fork - recorded == pytest.approx(3 * 0.5, abs=0.3) for recorded, fork in ended(found))


def test_a_changed_plant_that_does_the_same_says_so() -> None:
    patient = replace(shipped(), timing=replace(shipped().timing, stale_after_s=6.0))
    found = fork(run_of("undisturbed"), 99.0, model=patient)
    assert not found.early and found.recorded == found.fork == []


def test_an_arm_that_stood_still_goes_on_from_where_it_was_heard() -> None:
    plant = taped({5.5: lambda world: world.stall("ra_1", 30.0)}, s=6.8)
    found = fork(plant, 6.7, healthy=True)
    assert end_of(found, "a") == "done sis_a 0B 7 (id a)"


def test_a_plant_of_other_bits_is_not_forked() -> None:
    other = replace(shipped(), timing=replace(shipped().timing, effector_timeout_s=9.0))
    asked = ForkRequest(at_ns=round((START_S + 8.0) * 1e9), model=other, recorded=other)
    found = forked(run_of("undisturbed").beginning, recorded(run_of("undisturbed").tape), asked, sentence_of)
    assert found.difference is not None and found.world is None


def test_a_fork_for_a_task_is_over_with_the_task() -> None:
    plant = run_of("undisturbed")
    whole, found = fork(plant, 3.2), fork(plant, 3.2, task="a")
    assert end_of(found, "a") == end_of(whole, "a")
    assert found.world is not None and whole.world is not None
    assert found.world.now < whole.world.now


def test_a_silence_shorter_than_its_margins_is_over_where_it_began() -> None:
    world = fork(run_of("undisturbed"), 3.2).world
    assert world is not None
    befall(world, [Trouble(kind=SILENCE, robot="ra1", at=world.now + 1.0, seconds=0.0015)])
    world.advance(2.0)
    assert world.broker.clients["ra_1"].up.troubles == []
