"""A shared device is free for other cells until a recipe tells it something, however long it asks before."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from arboleda.kinds.person import person
from arboleda.model.messages import TaskState, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.recipes import Kit, parallel, recipe, work

from ...plants import made
from .lab import Bench
from .tending import plant as tending
from .test_shared_devices import ended, holder, plant, state_of

Build = Callable[[Kit, Any, Any], Any]


@recipe("errand")
def errand(cell: Kit):  # type: ignore[no-untyped-def]
    """The lift up, a wait and down, as a step of another recipe."""
    lift, ana = cell.devices("lift", "ana")
    return work(ana.ask("Ready?"), lift.up(), cell.wait(1.0), lift.down())


def chosen(cell: Kit, lift: Any, ana: Any) -> Any:
    asked = ana.ask("Lift?", ["yes", "no"])
    way = [ana.ask("Ready?", ["yes"]), lift.up(), lift.down()]
    return work(asked, cell.choose(asked, {"yes": way, "no": []}))


ASKS_FIRST: dict[str, Build] = {
    "work": lambda cell, lift, ana: work(ana.ask("Ready?"), lift.up(), lift.down()),
    "work in work": lambda cell, lift, ana: work(work(ana.ask("Ready?"), work(lift.up())), lift.down()),
    "choose": chosen,
    "retry": lambda cell, lift, ana: cell.retry(work(ana.ask("Ready?"), lift.up()), times=1),
    "repeat": lambda cell, lift, ana: cell.repeat(work(ana.ask("Ready?"), lift.up(), lift.down()), 2),
    "timeout": lambda cell, lift, ana: cell.timeout(work(ana.ask("Ready?"), lift.up()), 4000.0),
    "fallback": lambda cell, lift, ana: cell.fallback(work(ana.ask("Ready?"), lift.up()), lift.down()),
    "parallel": lambda cell, lift, ana: parallel(work(ana.ask("Ready?"), lift.up()), cell.wait(1.0)),
    "sub-recipe": lambda cell, lift, ana: work(cell.run(errand)),
    "retry in parallel": lambda cell, lift, ana: parallel(
        cell.device("lamp").light(on=True), cell.retry(work(ana.ask("Ready?"), lift.up()))
    ),
}


def asking(build: Build, *, shared: bool = False) -> Bench:
    """The cell below carries out a recipe, and asks; ana may be shared, too."""
    asks = made("asks", lambda cell: build(cell, cell.device("lift"), cell.device("ana")))
    model: PlantModel = plant()
    below, above = model.cells
    ana = ("ana", person("ana"))
    below = replace(below, members=(*below.members, ana), recipes=(asks, errand))
    if shared:
        below = replace(below, shared=("lift", "ana"))
        above = replace(above, members=(*above.members, ana), shared=("lift", "ana"))
    here = Bench(replace(model, cells=(below, above)))
    here.submit("below asks")
    assert here.wait(10.0, lambda: asked(here) is not None)
    if asked(here) == "Lift?":  # that way has a question of its own
        assert here.operate(Verb.ANSWER, "ana", answer="yes") is None
        assert here.wait(10.0, lambda: asked(here) == "Ready?")
    return here


def asked(here: Bench) -> str | None:
    entry = here.plant.dispatcher.ledger.question("ana")
    return None if entry is None else entry.command.text  # type: ignore[attr-defined]


def answer(here: Bench) -> None:
    """Answer whatever is asked, as soon as it is, until the task ends."""
    for _ in range(200):
        if ended(here, "below")():
            return
        entry = here.plant.dispatcher.ledger.question("ana")
        if entry is not None:
            word = entry.command.answers[0]  # type: ignore[attr-defined]
            assert here.operate(Verb.ANSWER, "ana", answer=word) is None
        here.wait(0.5)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("build", ASKS_FIRST.values(), ids=ASKS_FIRST)
def test_another_cell_may_have_it_while_a_person_is_asked_before(build: Build) -> None:
    here = asking(build)
    here.submit("above ride")
    assert here.wait(60.0, ended(here, "above"))
    assert state_of(here, "above") is TaskState.DONE
    answer(here)
    assert state_of(here, "below") is TaskState.DONE
    assert "lift up" in here.told[here.told.index("above_lamp light") :]
    here.wait(1.0)
    assert holder(here) is None


@pytest.mark.parametrize("name", ["work", "sub-recipe"])
def test_the_same_where_the_person_is_shared(name: str) -> None:
    here = asking(ASKS_FIRST[name], shared=True)
    assert here.plant.zones.holder("ana") == "below"
    assert holder(here) is None
    answer(here)
    assert state_of(here, "below") is TaskState.DONE


BETWEEN: dict[str, Build] = {
    "work": lambda cell, lift, ana: work(lift.up(), ana.ask("Loaded?"), lift.down()),
    "repeat": lambda cell, lift, ana: cell.repeat(work(lift.up(), lift.down(), ana.ask("Loaded?")), 2),
    "parallel": lambda cell, lift, ana: work(parallel(lift.up(), cell.wait(1.0)), ana.ask("?"), lift.down()),
}


@pytest.mark.sampled(3)
@pytest.mark.parametrize("build", BETWEEN.values(), ids=BETWEEN)
def test_it_stays_with_the_cell_from_the_first_that_it_is_told_to_the_last(build: Build) -> None:
    here = asking(build)
    here.submit("above ride")
    here.wait(20.0)
    assert holder(here) == "below"
    answer(here)
    assert state_of(here, "below") is TaskState.DONE
    assert here.wait(60.0, ended(here, "above"))


def test_after_its_last_step_it_is_free_while_a_person_is_asked() -> None:
    here = asking(lambda cell, lift, ana: work(lift.up(), lift.down(), ana.ask("All well?")))
    assert holder(here) is None


def test_who_may_fail_in_a_zone_takes_it_before() -> None:
    """A visit that failed may leave its robot in a zone, and who holds a zone asks for no device."""

    @recipe("risky")
    def risky(cell: Kit):  # type: ignore[no-untyped-def]
        left, lamp, ana = cell.devices("left", "lamp", "ana")
        tries = cell.fallback(left.visit("vise"), cell.wait(1.0))
        return work(ana.ask("Ready?"), tries, ana.ask("And now?"), lamp.light(on=True))

    model = tending(risky)
    (cell,) = model.cells
    cell = replace(cell, members=(*cell.members, ("ana", person("ana"))), shared=("lamp",))
    here = Bench(replace(model, cells=(cell,)))
    here.submit("tending risky")
    assert here.wait(10.0, lambda: here.plant.dispatcher.ledger.question("ana") is not None)
    assert here.plant.zones.holder("lamp") is None
    names = [type(node).__name__ for node in here.plant.cells["tending"].tree.iterate()]  # type: ignore[union-attr]
    assert names.index("TakeDevices") < names.index("TakeZones")
