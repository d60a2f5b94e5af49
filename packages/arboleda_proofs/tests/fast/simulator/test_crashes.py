"""A plant dies at any commit and at any message, and starts on what is left; its customers come back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from importlib.resources import as_file, files
from itertools import product
from pathlib import Path

import pytest
from tests.lengths import length, sample

from arboleda.model.cell_states import CellState
from arboleda.model.commands import Command, Stop
from arboleda.model.messages import Fact, Heartbeat, TaskChanged, TaskState, Verb
from arboleda.plant_file.loader import load
from arboleda.rig.plant_process import Fuse, Side
from arboleda.rig.world import PLANT, World
from arboleda.testing import shipped
from arboleda_proofs.simulator.chance import Dice
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.faults import KINDS, OF_CRASHES, Fault
from arboleda_proofs.simulator.faults.crashes import IN_ONE_PROCESS
from arboleda_proofs.simulator.judged_world import JudgedWorld
from arboleda_proofs.simulator.people import Customers
from arboleda_proofs.simulator.run import Simulation

LESSONS = Path(__file__).parents[5] / "examples" / "plants" / "lessons.yaml"


def dies(world: World, count: int, side: Side) -> None:
    world.plant_process.fuses.append(Fuse(count, side, world.plant_process.stop))


def sent(world: World) -> list[object]:
    """Messages that leave the plant from now on, its last words too."""
    found: list[object] = []
    world.watchers.append(lambda: found.extend((*world.moment.last_words, *world.moment.sent)))
    return found


def states(messages: list[object], id: str) -> list[TaskState]:
    return [each.state for each in messages if isinstance(each, TaskChanged) and each.task == id]


@pytest.mark.parametrize(
    ("count", "side", "on_disk", "told"),
    [
        (1, Side.BEFORE, False, False),  # the commit
        (1, Side.AFTER, True, False),
        (2, Side.BEFORE, True, False),  # the answer
        (2, Side.AFTER, True, True),
    ],
)
def test_it_dies_on_either_side_of_a_commit_and_of_a_message(count, side, on_disk, told):  # type: ignore[no-untyped-def]
    world = World(shipped("sis_a"))
    world.advance(1.0)
    words = sent(world)
    dies(world, count, side)
    world.request_task("sis_a 0B 1 #lot")
    world.advance(0.1)
    assert not world.is_on(PLANT)
    assert ("lot" in world.disk.tasks) is on_disk
    assert (states(words, "lot") == [TaskState.QUEUED]) is told
    world.plant_process.start()
    assert ("lot" in world.plant.intake.tasks) is on_disk


def test_the_rest_of_a_step_in_which_it_dies_is_nobodys() -> None:
    seen = set()
    for count in range(1, 8):
        world = World(shipped("sis_a"))
        world.advance(1.0)
        words = sent(world)
        dies(world, count, Side.AFTER)
        world.request_task("sis_a 0B 1 #lot")
        world.advance(0.01)
        on_disk = world.disk.tasks["lot"].state
        seen.add((on_disk, *states(words, "lot"), any(isinstance(each, Command) for each in words)))
    queued, running = TaskState.QUEUED, TaskState.RUNNING
    assert seen >= {(queued, False), (queued, queued, False), (running, queued, False)}
    assert seen <= {
        (queued, False),
        (queued, queued, False),
        (running, queued, False),
        (running, queued, running, False),
        (running, queued, running, True),
    }


def test_what_waited_waits_again_and_who_asks_for_its_id_gets_the_same_task() -> None:
    world = World(shipped("sis_a"))
    for id in ("a", "b", "c"):
        world.request_task(f"sis_a 0B 1 #{id}")
    world.advance(2.0)
    world.crash()
    words = sent(world)
    assert [task.id for task in world.plant.cells["sis_a"].queue] == ["b", "c"]
    world.request_task("sis_a 0B 1 #c")
    world.advance(1.0)
    assert states(words, "c") == [TaskState.QUEUED]
    assert [task.id for task in world.plant.cells["sis_a"].queue] == ["b", "c"]


def test_nobody_hears_what_is_said_while_it_is_down() -> None:
    world = World(shipped("sis_a"))
    world.advance(1.0)
    world.plant_process.stop()
    world.request_task("sis_a 0B 1 #lot")
    world.advance(2.0)
    world.plant_process.start()
    world.advance(1.0)
    assert "lot" not in world.plant.intake.tasks
    assert world.plant.dispatcher.beliefs["ra1"].online


def test_one_that_is_frozen_does_not_die() -> None:
    world = World(shipped("sis_a"))
    world.stall(PLANT, 2.0)
    epoch = world.plant.epoch
    world.crash()
    assert world.plant.epoch == epoch


def test_a_power_cut_takes_the_bridge_along_and_what_nothing_has_synced() -> None:
    watched = JudgedWorld(shipped("sis_a"))
    world = watched.world
    world.request_task("sis_a 0B 1")
    assert world.advance(60.0, lambda: world.disk.facts.get(Fact.EFFECTOR, {}).get("ra1") == "on")
    fault = Fault(kind="power_cut", at=0.0, target=PLANT, word="before", amount=1.0, seconds=5.0, seed=3)
    watched.begin(fault)
    assert world.advance(10.0, lambda: not world.is_on(PLANT))
    assert world.bridge is None
    assert world.disk.facts[Fact.EFFECTOR]["ra1"] in ("on", "switching")
    world.advance(6.0)
    assert world.bridge is not None and world.is_on(PLANT)


def test_a_power_cut_before_the_first_grip_puts_no_part_where_the_arm_stands() -> None:
    world = World(load(LESSONS))  # its arms are at home at station 0
    world.advance(2.0)
    world.request_task("sis_a palletizing #a")
    assert world.advance(5.0, lambda: "a" in world.disk.facts.get(Fact.STEP, {}))
    for _ in range(2):
        world.plant_process.cut_power(reached=99)
        world.plant_process.start()
    world.advance(5.0)
    assert world.disk.facts[Fact.EFFECTOR]["ra1"] == "off"
    assert world.plant.cells["sis_a"].context.places.counts["station_0"] == 0


def test_customers_come_back_for_their_ids_and_each_is_one_task() -> None:
    world = World(shipped("sis_a"))
    customers = Customers(world, seed=1)
    world.crash()
    asked: list[str] = []
    world.watchers.append(lambda: asked.extend(getattr(each, "text", "") for each in world.moment.requests))
    world.advance(4.0)
    ids = {text.partition("#")[2] for text in asked} - {""}
    assert ids
    customers.go()
    world.crash()
    world.request_verb(Verb.RESUME)
    del asked[:]
    world.advance(25.0)
    again = [text.partition("#")[2] for text in asked if "#" in text]
    assert again and set(again) <= ids
    assert set(world.disk.tasks) >= ids
    assert [id for id in world.disk.tasks if id in ids] == [
        id for id in world.plant.intake.tasks if id in ids
    ]


def fills_up(world: World, **fields: object) -> Callable[[], None]:
    """A full disk, from now on; how it has room again."""
    fault = Fault(kind="full_disk", at=0.0, target=PLANT, **fields)  # type: ignore[arg-type]
    end = KINDS["full_disk"].begin(world, fault)
    assert end is not None
    return end


def test_what_cannot_be_kept_is_not_accepted_and_the_plant_ends() -> None:
    world = World(shipped("sis_a"))
    world.advance(1.0)
    end = fills_up(world)
    world.advance(1.0)
    assert world.is_on(PLANT), "nothing was to be kept yet"
    words = sent(world)
    world.request_task("sis_a 0B 1 #lot")
    world.advance(10.0)
    assert not world.is_on(PLANT)
    assert states(words, "lot") == [] and "lot" not in world.disk.tasks
    world.plant_process.start()
    assert not world.is_on(PLANT), "it is refused as long as there is no room"
    end()
    world.advance(1.0)
    world.request_task("sis_a 0B 1 #lot")
    world.advance(1.0)
    assert states(words, "lot") == [TaskState.QUEUED, TaskState.RUNNING]


def test_of_a_plant_that_ends_only_stops_reach_its_robots() -> None:
    watched = JudgedWorld(shipped("sis_a"))
    world = watched.world
    world.request_task("sis_a 0B 1 #lot")
    assert world.advance(30.0, lambda: world.boards["ra_1"].body.moving)
    unkept: list[object] = []
    world.watchers.append(lambda: unkept.extend(world.moment.unkept))
    end = fills_up(world)
    world.request_task("sis_a 0B 1")
    world.advance(1.0)
    assert not any(board.body.moving for board in world.boards.values())
    assert any(isinstance(each, Stop) for each in unkept)
    end()
    assert world.advance(10.0, lambda: world.is_on(PLANT))
    assert world.plant.intake.tasks["lot"].state is TaskState.RUNNING
    world.advance(1.0)
    assert world.plant.cells["sis_a"].state is CellState.HELD


def test_it_may_die_while_it_ends() -> None:
    world = World(shipped("sis_a"))
    world.request_task("sis_a 0B 1")
    assert world.advance(30.0, lambda: world.boards["ra_1"].body.moving)
    end = fills_up(world)
    unkept: list[object] = []
    world.watchers.append(lambda: unkept.extend(world.moment.unkept))
    world.request_task("sis_a 0B 1")
    dies(world, 2, Side.BEFORE)  # the first is the commit
    world.advance(20.0)
    assert not unkept and not world.is_on(PLANT)
    end()
    world.advance(1.0)
    words = sent(world)
    world.request_task("sis_a 0B 1 #lot")
    world.advance(1.0)
    assert states(words, "lot") == [TaskState.QUEUED]


@pytest.mark.parametrize("together", [False, True])
def test_a_full_disk_takes_the_bridge_along_where_it_is_one_process(together: bool) -> None:
    world = World(shipped("sis_a"))
    seed = next(seed for seed in range(99) if Dice(seed, "bridge").chance(IN_ONE_PROCESS) is together)
    end = fills_up(world, seed=seed)
    world.request_task("sis_a 0B 1")
    world.advance(10.0)
    assert (world.bridge is None) is together
    end()
    world.advance(0.1)
    assert world.bridge is not None and world.is_on(PLANT)


def simulated(
    seed: int, rates: dict[str, float], cycles: int = length(3, whole=6), **changes: object
) -> Simulation:
    model = shipped()
    model = replace(model, cells=tuple(replace(cell, **changes) for cell in model.cells))  # type: ignore[arg-type]
    climate = Climate.from_file(model, seed, {"rates": rates})
    simulation = Simulation(model, seed, climate.faults)
    simulation.run(cycles=cycles)
    return simulation


@pytest.mark.long
@pytest.mark.parametrize(("kind", "goes_on"), sample(product(OF_CRASHES, [False, True]), every=5))
def test_everything_holds_however_it_dies(kind: str, goes_on: bool) -> None:
    found = simulated(1, {kind: 8.0}, goes_on=goes_on)
    assert found.result.broken is None
    assert found.world.plant_process.starts > 2 or kind == "slow_disk"


def slows_down(world: World, seconds: float) -> Callable[[], None]:
    """Synced commits take so long from now on; how they are fast again."""
    end = KINDS["slow_disk"].begin(world, Fault(kind="slow_disk", at=0.0, target=PLANT, amount=seconds))
    assert end is not None
    return end


def leaving(world: World) -> list[tuple[float, object]]:
    """Messages that reach the bridge from now on, each with its time."""
    found: list[tuple[float, object]] = []
    world.watchers.append(lambda: found.extend((world.now, each.message) for each in world.moment.taken))
    return found


def test_a_stop_waits_for_no_disk() -> None:
    world = World(shipped("sis_a"))
    world.advance(1.0)
    _, left, began = slows_down(world, 0.4), leaving(world), world.now
    world.request_verb(Verb.STOP)
    world.advance(5.0)
    stops = [(at, each.robot) for at, each in left if isinstance(each, Stop) and each.id]
    assert stops == [(began, "ra1"), (began, "rm_sis_a")]


def test_what_hangs_on_a_commit_that_takes_long_leaves_after_it() -> None:
    world = World(shipped("sis_a"))
    world.advance(10.0)
    _, left, began = slows_down(world, 0.4), leaving(world), world.now
    world.request_task("sis_a 0B 1")
    world.advance(5.0)
    first, *_ = [at for at, each in left if isinstance(each, Command)]
    assert first == pytest.approx(began + 0.4)
    assert not any(began < at < first for at, each in left if isinstance(each, Heartbeat))


def test_a_command_that_the_disk_made_too_late_is_not_sent_and_its_cell_is_held_as_after_an_absence() -> None:
    watched = JudgedWorld(shipped("sis_a"))
    world = watched.world
    world.request_task("sis_a palletizing #lot")
    assert world.advance(30.0, lambda: world.disk.facts.get(Fact.EFFECTOR, {}).get("ra1") == "on")
    end, left, heard = slows_down(world, 4.0), leaving(world), []
    world.watchers.append(lambda: heard.extend(world.moment.undelivered))
    assert world.advance(30.0, lambda: world.is_stalled(PLANT))
    end()
    assert world.advance(5.0, lambda: bool(heard))
    del left[:]
    world.advance(5.0)
    assert len(heard) == 1
    assert [each for _, each in left if isinstance(each, Command) and not isinstance(each, Stop)] == []
    assert world.plant.cells["sis_a"].state is CellState.HELD
    watched.world.request_verb(Verb.RETRY, "sis_a")
    world.advance(30.0)
    assert world.plant.intake.tasks["lot"].ended_at is not None


def test_a_plant_that_waits_for_its_disk_goes_on_waiting_when_nothing_else_stalls_it() -> None:
    world = World(shipped("sis_a"))
    world.advance(1.0)
    slows_down(world, 1.0)
    world.advance(9.0)
    world.request_task("sis_a 0B 1")
    world.advance(0.3)
    world.stall(PLANT, 0.2)
    world.go_on(PLANT)
    assert world.is_stalled(PLANT)
    assert world.advance(10.0, lambda: not world.is_stalled(PLANT))


@pytest.mark.long
def test_the_same_seed_dies_in_the_same_way() -> None:
    rates = dict.fromkeys(OF_CRASHES, 4.0)
    first, second = (simulated(2, rates, cycles=1).result for _ in range(2))
    assert first.digest == second.digest


def test_crashes_are_a_level_of_their_own() -> None:
    for level in ("few", "normal", "many"):
        assert not Climate.draw(shipped(), 1, level).rates.keys() & set(OF_CRASHES)
    drawn = [Climate.draw(shipped(), seed, "crashes").rates for seed in range(8)]
    assert set(OF_CRASHES) <= {name for rates in drawn for name in rates}
    assert all(KINDS[name].targets(shipped()) == (PLANT,) for name in OF_CRASHES)


def test_what_a_done_task_leaves_unchecked_is_heard_also_in_the_last_words_of_a_plant() -> None:
    with as_file(files("arboleda").joinpath("plants/shared.yaml")) as file:
        model = load(file)
    climate = Climate.draw(model, 6, "crashes")
    assert Simulation(model, 6, climate.faults).run(seconds=10.0).broken is None
