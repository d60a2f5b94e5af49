"""Words of a bridge on robots at rest are judged by their bytes alone, and nothing wrong in them passes."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace

import pytest

from arboleda.model.messages import Heartbeat, MotionState, Report
from arboleda.rig.moment import BridgeStep
from arboleda.rig.world import World
from arboleda.wire.board import Message
from arboleda.wire.hop import FromPlant
from arboleda.wire.transport import Delivery, Publication
from arboleda_proofs.campaigns.request import Request
from arboleda_proofs.simulator.recorded.bridge import Bridges
from arboleda_proofs.simulator.recorded.reported_telemetry import REPORTS

SETTLED_S = 3.0


@pytest.fixture
def world() -> World:
    return World(Request(cycles=1).setting.plant(1))


@pytest.fixture
def bridges(world: World) -> Bridges:
    """The judge of the bridge of a plant that has been at rest for some time."""
    judge = Bridges(world.model)
    judge.take_over(world.bridge, world.now, world.plant.dispatcher.beliefs)
    wrong: list[str] = []

    def look() -> None:
        if world.moment.bridged:
            judge.look(world.moment.bridged)
            wrong.extend(sentence for each in judge.wrong.values() for sentence in each)

    world.watchers.append(look)
    world.advance(SETTLED_S)
    assert not wrong
    world.watchers.remove(look)
    return judge


@pytest.fixture
def step(world: World, bridges: Bridges) -> BridgeStep:
    """The next step of the bridge in which telemetry came."""
    steps: list[BridgeStep] = []
    world.watchers.append(lambda: steps.extend(world.moment.bridged))
    assert world.advance(1.0, lambda: any(reports(each) for each in steps))
    return next(each for each in steps if reports(each))


def reports(step: BridgeStep) -> list[Report]:
    return [each for each in step.out if isinstance(each, Report)]


def test_what_is_as_it_was_is_right(bridges: Bridges, step: BridgeStep) -> None:
    bridges.look([step])
    assert not any(bridges.wrong.values())


ALTERED: dict[str, Callable[[Report], list[Report]]] = {
    "not reported": lambda report: [],
    "reported twice": lambda report: [report, report],
    "of another time": lambda report: [replace(report, at=report.at - 0.05)],
    "of another state": lambda report: [replace(report, state=MotionState.MOVING)],
    "of no link": lambda report: [replace(report, state=MotionState.NO_LINK)],
    "of another place": lambda report: [replace(report, q=report.q and (9.0, *report.q[1:]), node=99)],
    "of another boot": lambda report: [replace(report, homed=not report.homed)],
    "of a command": lambda report: [replace(report, done="1-1")],
    "of commands of others": lambda report: [replace(report, foreign_refused=1)],
    "of another plant": lambda report: [replace(report, plant=1)],
}


@pytest.mark.parametrize("altered", ALTERED.values(), ids=ALTERED)
def test_a_report_that_differs_is_found(
    bridges: Bridges, step: BridgeStep, altered: Callable[[Report], list[Report]]
) -> None:
    step.out = [*altered(reports(step)[0]), *step.out[1:]]
    bridges.look([step])
    assert any(bridges.wrong.values())


def test_telemetry_that_came_before_is_found_if_it_is_reported(bridges: Bridges, step: BridgeStep) -> None:
    bridges.look([step])
    bridges.look([step])
    assert bridges.wrong[REPORTS]


def test_retained_telemetry_is_found_if_it_is_reported(bridges: Bridges, step: BridgeStep) -> None:
    first = next(each for each in step.events if isinstance(each, Delivery))
    step.events = [each._replace(retain=each is first) for each in step.events]
    bridges.look([step])
    assert bridges.wrong[REPORTS]


@pytest.mark.parametrize("plant", [0, 1])
def test_a_report_names_any_plant_that_was_heard_in_its_step(
    bridges: Bridges, step: BridgeStep, plant: int
) -> None:
    report = reports(step)[0]
    assert report.plant is not None
    heard = [report.plant, report.plant + 1]
    beats = [FromPlant(at=step.now, message=Heartbeat(epoch=epoch)) for epoch in heard]
    step.events = [*step.events, *beats]
    step.out = [replace(each, plant=heard[plant]) if each is report else each for each in step.out]
    bridges.look([step])
    assert not bridges.wrong[REPORTS]


def test_a_board_whose_numbers_began_anew_unseen_is_fenced_in_the_step_in_which_they_count(
    world: World, bridges: Bridges
) -> None:
    steps: list[BridgeStep] = []
    world.watchers.append(lambda: steps.extend(world.moment.bridged))
    world.advance(1.0)
    bridges.look(steps)
    assert not any(bridges.wrong.values())
    heard = (event for step in steps for event in step.events if isinstance(event, Delivery))
    telemetry = next(event for event in heard if b'"epoca_min"' in event.payload)

    def take(now: float, *events: Delivery | FromPlant) -> list[Message]:
        out = world.bridge.step(now, events)
        bridges.look([BridgeStep(bridge=world.bridge, now=now, events=list(events), out=out)])
        assert not any(bridges.wrong.values())
        return out

    def begun_anew(at: float, number: int) -> Delivery:
        fields = {**json.loads(telemetry.payload), "epoca_min": 0, "seq": number}
        return telemetry._replace(at=at, payload=json.dumps(fields).encode())

    lost_at = world.now + world.model.timing.stale_after_s + 1.0
    take(lost_at, begun_anew(lost_at, 1))
    take(lost_at, begun_anew(lost_at, 2))
    now = lost_at + world.model.timing.stale_after_s
    beat = FromPlant(at=now, message=Heartbeat(epoch=world.plant.epoch))
    out = take(now, begun_anew(now, 3), beat)
    assert f"{telemetry.topic.split('/')[0]}/latido" in [
        each.topic for each in out if isinstance(each, Publication)
    ]
