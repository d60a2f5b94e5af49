"""The people around a simulated plant ask for as much as they need, and say only what is so."""

from __future__ import annotations

from dataclasses import replace

from arboleda.kinds.mobile import FollowPath
from arboleda.model.messages import OperatorRequest, Verb
from arboleda.model.plant_model import Evidence
from arboleda.rig.world import World
from arboleda.testing import shipped
from arboleda_proofs.simulator.invariants.invariant import Look
from arboleda_proofs.simulator.invariants.motion import no_move_after_a_boot_that_was_told
from arboleda_proofs.simulator.people import WAITING, Customers
from arboleda_proofs.simulator.record import Record
from arboleda_proofs.simulator.truth.truth import Truth

MOBILE = "rm_sis_a"


def waiting(world: World) -> int:
    return len(world.plant.cells["sis_a"].queue)


def test_customers_bring_no_more_for_what_others_ask_again():
    world = World(shipped("sis_a"))
    Customers(world, seed=1)
    world.request_task("sis_a palletizing #lot7")
    world.advance(20.0)
    for _ in range(5):
        world.request_task("sis_a palletizing #lot7")
        world.advance(2.0)
    assert waiting(world) <= WAITING


def test_customers_come_again_when_a_queue_was_full():
    limit = 6
    model = shipped("sis_a")
    world = World(replace(model, cells=tuple(replace(cell, queue_limit=limit) for cell in model.cells)))
    customers = Customers(world, seed=1)
    for number in range(limit + 1):
        world.request_task(f"sis_a palletizing #lot{number}")
    world.advance(3.0)
    assert waiting(world) == limit
    world.advance(15.0 * limit)
    assert customers.cycles > limit
    assert waiting(world) in (WAITING - 1, WAITING)


def test_customers_count_what_others_asked_for():
    world = World(shipped("sis_a"))
    customers = Customers(world, seed=1)
    customers.go()
    world.request_task("sis_a palletizing")
    world.advance(20.0)
    assert (customers.cycles, customers.outcomes) == (1, {"done": 1})


def test_a_robot_that_boots_while_it_is_put_right_is_put_right_once_more():
    world = World(shipped("sis_a", evidence=Evidence.JOINTS, assume_homed=True))
    look = Look(world=world, truth=Truth(world), record=Record(world))
    driven: list[FollowPath] = []
    wrong: list[str] = []
    world.watchers.append(look.truth.look)
    world.watchers.append(lambda: driven.extend(e for e in world.moment.sent if isinstance(e, FollowPath)))
    world.watchers.append(lambda: wrong.extend(no_move_after_a_boot_that_was_told.rule(look)))
    for act in (world.crash, world.manual.home, world.crash):
        world.advance(0.5)
        act(MOBILE)
    world.advance(2.0)
    world.request_task("sis_a 0B 7")
    world.advance(1.0)
    assert driven
    assert wrong == []


def test_nobody_says_that_a_robot_is_homed_while_it_moves():
    world = World(shipped("sis_a", evidence=Evidence.JOINTS, assume_homed=True))
    told: list[OperatorRequest] = []
    world.watchers.append(
        lambda: told.extend(e for e in world.moment.requests if isinstance(e, OperatorRequest))
    )
    world.advance(1.0)
    world.manual.home(MOBILE)
    world.request_task("sis_a 0B 7")
    world.advance(3.0)
    assert told == []
    world.advance(30.0)
    world.manual.home(MOBILE)
    world.advance(1.1)
    assert [(event.verb, event.by_hand) for event in told] == [(Verb.HOME, True)]
