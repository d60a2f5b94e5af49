"""The people around a simulated plant ask for as much as they need, and say only what is so."""

from __future__ import annotations

from arboleda.simulator.people import WAITING, Customers
from arboleda.simulator.world import World
from arboleda.testing import shipped


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
    world = World(shipped("sis_a"))
    customers = Customers(world, seed=1)
    limit = world.model.cells[0].queue_limit
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
