"""Each invariant of plants of any devices holds by itself, and finds a bug that was planted for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from arboleda.core.context import Context
from arboleda.core.dispatcher import Dispatcher
from arboleda.core.evidence import Verdict
from arboleda.core.ledger import Feed
from arboleda.core.plant import Plant
from arboleda.recipes import Kit, parallel, recipe, work
from arboleda.sim.machine import MachineBody
from arboleda.simulator.climate import Climate
from arboleda.simulator.faults import Fault
from arboleda.simulator.general import GENERAL
from arboleda.simulator.run import Simulation
from arboleda.simulator.watched import Broken, Watched
from arboleda.wire.payloads import OrderGoal

from ..kinds.test_interlocks import with_mill

Patch = pytest.MonkeyPatch


@recipe("load")
def load(cell: Kit):  # type: ignore[no-untyped-def]
    """One arm brings a blank into the mill, which shuts its door and opens it again."""
    left, jaw, mill = cell.devices("left", "jaw", "mill")
    fetch = left.visit("feed", jaw.close())
    return work(fetch, left.visit("vise", jaw.open()), mill.close(), mill.open(), left.home())


@recipe("both")
def both(cell: Kit):  # type: ignore[no-untyped-def]
    """Both arms want the vise, and the mill wants to shut its door."""
    left, right, mill = cell.devices("left", "right", "mill")
    return parallel(left.visit("vise"), right.visit("vise"), work(mill.close(), mill.open()))


def run(seed: int, level: str = "none", cycles: int = 4) -> Broken | None:
    model = with_mill(load, both)
    climate = Climate.draw(model, seed, level)
    return Simulation(model, seed, climate.faults).run(cycles=cycles).broken


@pytest.mark.parametrize("seed", range(1, 5))
def test_all_of_them_hold_in_bad_weather(seed: int) -> None:
    assert run(seed, "normal", cycles=3) is None


def test_a_device_gives_up_until_all_such_faults_have_ended() -> None:
    watched = Watched(with_mill(load))
    for seconds in (5.0, 10.0):
        watched.begin(Fault(kind="gives_up", at=0.0, target="mill", word="atasco", seconds=seconds))
    order = OrderGoal(verb="open", values=(), seq=1, epoch=1)
    body = watched.world.boards["mill"].body
    assert isinstance(body, MachineBody)
    told = []
    for _ in range(3):
        told.append(body.fails(order))
        watched.world.advance(6.0)
    assert told == ["atasco", "atasco", None]


def believed_at_once(patch: Patch) -> None:
    """A command counts as done when its robot has only accepted it."""
    done = Verdict(feed=Feed.DONE)
    patch.setattr("arboleda.core.evidence.judge", lambda *_: done)


def zones_for_all(patch: Patch) -> None:
    """Zones are given to whoever asks, and nothing guards them."""
    patch.setattr(Context, "take_zones", lambda self, robot, zones, *, inside=False: True)
    patch.setattr(Context, "_barrier", lambda self, command: None)


def told_twice(patch: Patch) -> None:
    """The end of a task is told again at the next step."""
    step, ends = Plant.step, []

    def twice(self: Plant, now: float, events: Any) -> list[Any]:
        out = [*ends, *step(self, now, events)]
        ends[:] = [each for each in out if getattr(getattr(each, "state", None), "value", "") == "done"][:1]
        return out

    patch.setattr(Plant, "step", twice)


def raises_at_a_verb(patch: Patch) -> None:
    """A command of a device is an error of the program."""

    def fails(self: Dispatcher, command: Any, *, was: bool) -> None:
        raise ZeroDivisionError

    patch.setattr(Dispatcher, "_unmet", fails)


def advises_nothing(patch: Patch) -> None:
    """Nobody is told what leads a cell out of a hold."""
    patch.setattr(Plant, "advice", lambda self, cell: ())


def forgets_a_task(patch: Patch) -> None:
    """A task that is done is never said to have ended."""
    step = Plant.step

    def silent(self: Plant, now: float, events: Any) -> list[Any]:
        out = step(self, now, events)
        return [each for each in out if getattr(getattr(each, "state", None), "value", "") != "done"]

    patch.setattr(Plant, "step", silent)


BITES: list[tuple[str, Callable[[Patch], None]]] = [
    ("no_step_raises", raises_at_a_verb),
    ("a_task_ends_once", told_twice),
    ("what_is_done_was_so", believed_at_once),
    ("a_zone_has_one_occupant_who_holds_it", zones_for_all),
    ("everything_comes_to_rest", advises_nothing),
    ("an_accepted_task_has_ended", forgets_a_task),
]


@pytest.mark.parametrize(("name", "bug"), BITES, ids=[name for name, _ in BITES])
def test_it_bites(monkeypatch: Patch, name: str, bug: Callable[[Patch], None]) -> None:
    bug(monkeypatch)
    weather = [(seed, level) for level in ("none", "normal") for seed in range(1, 4)]
    assert any((broken := run(*each)) is not None and broken.invariant == name for each in weather)


def test_every_invariant_has_a_bug() -> None:
    assert [name for name, _ in BITES] == [each.name for each in GENERAL]
