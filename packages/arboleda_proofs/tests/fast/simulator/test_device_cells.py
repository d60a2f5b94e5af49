"""Findings in the plant by simulations of cells of devices."""

from __future__ import annotations

from tests.unit.kinds.lab import bake
from tests.unit.kinds.lab import model as bench
from tests.unit.kinds.tending import plant

from arboleda.model.advice import in_words
from arboleda.model.messages import OperatorRequest, Verb
from arboleda.recipes import Kit, parallel, recipe, work
from arboleda.rig.world import BRIDGE, World
from arboleda_proofs.simulator.faults import KINDS, Fault
from arboleda_proofs.simulator.judged_world import JudgedWorld
from arboleda_proofs.simulator.people import Attendant
from arboleda_proofs.simulator.truth.truth import Truth


@recipe("apart")
def apart(cell: Kit):  # type: ignore[no-untyped-def]
    """One arm reaches into the vise, the other one goes where no zone is."""
    left, right = cell.devices("left", "right")
    return parallel(
        left.visit("vise", cell.wait(8.0)), work(cell.wait(1.0), right.visit("feed"), right.visit("feed_2"))
    )


def test_who_stands_in_the_zone_that_a_homing_may_cross_is_homed_first() -> None:
    watched = JudgedWorld(plant(apart))
    world = watched.world
    world.request_task("tending apart")
    assert world.advance(30.0, lambda: world.plant.zones.holder("vise") == "left")
    world.advance(2.5)
    world.crash("right")
    world.advance(10.0)
    ways = [str(in_words(each)) for each in world.plant.advice("tending")]
    assert ways[:2] == ["home left", "home right"]
    Attendant(world, 1)
    watched.come_to_rest()


def test_what_work_needs_is_not_let_go_while_its_machine_says_that_it_works() -> None:
    world = JudgedWorld(bench(bake)).world
    world.boards["eye"].body.answer = lambda goal: "good"
    world.request_task("bench bake 5")
    assert world.advance(30.0, lambda: getattr(world.obeyed.get("oven"), "verb", None) == "bake")
    world.crash(BRIDGE)  # with it goes what the plant knows of the work
    world.advance(5.0)
    assert world.boards["oven"].body.moving
    release = OperatorRequest(at=world.now, verb=Verb.RELEASE, scope="oven")
    assert "oven is still moving" in str(world.plant.refusal(release))
    world.advance(20.0)
    assert world.plant.refusal(release) is None


def test_a_machine_that_says_it_stands_still_while_it_moves_misleads_until_its_next_work() -> None:
    world = World(bench(bake))
    truth = Truth(world)
    world.watchers.append(truth.look)
    oven = truth.robots["oven"]
    world.boards["eye"].body.answer = lambda goal: "good"
    lie = Fault(kind="stuck_bit", at=0.0, target="oven", word="estado", seconds=10.0)
    tells_the_truth_again = KINDS["stuck_bit"].begin(world, lie)
    world.request_task("bench bake 5")
    assert world.advance(9.0, lambda: oven.work is not None)
    tells_the_truth_again()
    world.advance(20.0)
    assert not world.deceptions
    assert truth.mistaken(oven)
    for verb, scope in ((Verb.RELEASE, "oven"), (Verb.ABANDON, "bench"), (Verb.RESUME, "bench")):
        world.request_verb(verb, scope)
        world.advance(5.0)
    world.request_task("bench bake 5")
    assert world.advance(30.0, lambda: not truth.mistaken(oven))
