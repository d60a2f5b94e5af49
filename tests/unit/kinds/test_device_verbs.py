"""Verbs of devices on an operator's word: done where the cell rests and nobody is in the way."""

from __future__ import annotations

import pytest
from tests.following import advised, works
from tests.readying import make_ready

from arboleda.model.messages import Outcome, Verb
from arboleda.rig.hands import do

from .example_trials import load
from .lab import Bench

TASK = "tending mill slot_2 1002"


@pytest.fixture
def here() -> Bench:
    bench = Bench(load("machine_tending"))
    bench.wait(1.0)
    return bench


def told(here: Bench, device: str, work: str) -> str | None:
    return here.operate(Verb.DO, device, work=work)


def door(here: Bench) -> object:
    return here.plant.dispatcher.beliefs["mill"].fact("door")


def shut(here: Bench) -> None:
    assert told(here, "mill", "close") is None
    here.wait(5.0)
    assert door(here) == "closed"


def test_a_device_does_one_of_its_verbs_and_the_act_has_an_end(here: Bench) -> None:
    shut(here)
    assert told(here, "mill", "Open") is None
    act = here.plant.acts[-1]
    assert (act.outcome, str(act.sentence)) == (Outcome.UNDER_WAY, "do mill open")
    assert told(here, "mill", "close") == "mill is still doing 'open' on the operator's word"
    here.wait(5.0)
    assert (here.plant.acts[-1].outcome, door(here)) == (Outcome.DONE, "open")


@pytest.mark.parametrize(
    ("device", "work", "why"),
    [
        ("mill", "fly", "mill does not do 'fly'; it does open, close, run 1001, run 1002"),
        ("mill", "clamp true", "mill does not do 'clamp true'; it does open, close, run 1001, run 1002"),
        ("mill", "run 1001", "mill needs door to be closed, and says open"),
        ("camera", "inspect", "camera does nothing by itself"),
        ("loader", "home", "loader does nothing by itself"),
        ("tending", "open", "'tending' is neither a cell nor a robot of this plant"),
    ],
)
def test_what_it_cannot_do_is_refused(here: Bench, device: str, work: str, why: str) -> None:
    assert str(told(here, device, work)).startswith(why)


def test_it_waits_for_no_task_and_shuts_no_door_on_an_arm(here: Bench) -> None:
    here.submit(TASK)
    assert here.wait(60.0, lambda: here.plant.zones.holder("inside_the_mill") == "loader")
    assert "this needs a cell that is idle or held" in str(told(here, "mill", "close"))
    here.operate(Verb.HOLD, "tending")
    here.wait(3.0)
    assert told(here, "mill", "close") == "mill may get into zone inside_the_mill, which loader holds"


def test_a_door_in_the_way_of_an_arm_is_opened_by_a_button(here: Bench) -> None:
    shut(here)
    here.crash("loader")
    here.wait(5.0)
    assert advised(here, "tending")[:2] == ["do mill open", "home loader"]
    (first, *_) = here.plant.advice("tending")
    assert (first.moves, first.refusal) == (("mill",), None)
    assert make_ready(here) == ["do mill open", "home loader"]
    assert works(here, "tending")


def test_where_it_has_failed_the_way_out_is_by_its_own_controls(here: Bench) -> None:
    shut(here)
    here.crash("loader")
    here.wait(5.0)
    here.machines["mill"].fails = lambda goal: "atasco"
    assert told(here, "mill", "open") is None
    here.wait(60.0)
    assert here.plant.acts[-1].outcome is Outcome.FAILED
    ways = here.plant.advice("tending")
    assert advised(here, "tending")[0] == "get mill out of the way by its own controls"
    do(here, ways[0])
    here.wait(2.0)
    assert advised(here, "tending")[0] == "home loader"
