"""What a plant must not believe just because it started anew."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from py_trees.common import Status

from arboleda.core.plant import SHORTEST_ABSENCE_S, Plant
from arboleda.model.messages import Fact, MotionState, Notice, Remember, Report, Verb
from arboleda.model.plant_model import Evidence, PlantModel
from arboleda.rig.rig import Rig
from arboleda.testing import shipped
from arboleda.testing.plants import shared
from arboleda.testing.storage_layout import StorageLayout
from arboleda.trees.leaves import Act

MOBILE = "rm_sis_a"


def mute() -> PlantModel:
    """A mobile robot that tells its boots, and nothing of its homing."""
    return shipped("sis_a", assume_homed=True)


def hear(plant: Plant, at: float, robot: str, **said: object) -> list[object]:
    """A robot stands still and says so; what leaves then."""
    report = Report(at=at, robot=robot, state=MotionState.STOPPED, epoch=1, plant=plant.epoch, **said)  # type: ignore[arg-type]
    return list(plant.step(at, [report]))


def facts(messages: list[Notice], memory: dict[Fact, dict[str, str]]) -> None:
    for each in messages:
        if isinstance(each, Remember) and each.value is not None:
            memory.setdefault(each.fact, {})[each.name] = each.value
        elif isinstance(each, Remember):
            memory.setdefault(each.fact, {}).pop(each.name, None)


def test_a_boot_while_nobody_listened_is_seen_by_who_kept_the_last_one() -> None:
    model, memory = mute(), dict[Fact, dict[str, str]]()
    first = Plant(model, epoch=1, now=0.0, memory=memory)
    facts(hear(first, 0.1, MOBILE, node=0, boot_id=7), memory)  # type: ignore[arg-type]
    assert memory[Fact.BOOT] == {MOBILE: "7"}
    for boot, displaced in ((7, False), (8, True)):
        again = Plant(model, epoch=2, now=1.0, memory=memory)
        hear(again, 1.1, MOBILE, node=0, boot_id=boot)
        assert again.dispatcher.beliefs[MOBILE].displaced is displaced


def test_who_was_not_put_right_since_its_boot_is_not_after_a_restart_either() -> None:
    model, memory = mute(), dict[Fact, dict[str, str]]()
    first = Plant(model, epoch=1, now=0.0, memory=memory)
    for at, boot in ((0.1, 7), (0.2, 8)):
        facts(hear(first, at, MOBILE, node=0, boot_id=boot), memory)  # type: ignore[arg-type]
    assert memory[Fact.DISPLACED] == {MOBILE: "true"}
    again = Plant(model, epoch=2, now=1.0, memory=memory)
    hear(again, 1.1, MOBILE, node=0, boot_id=8)
    assert again.dispatcher.beliefs[MOBILE].displaced
    again.dispatcher.declare_homed(MOBILE)
    facts(again.step(1.2, ()), memory)
    assert not memory[Fact.DISPLACED]


@pytest.mark.parametrize("evidence", [Evidence.IDS, Evidence.JOINTS])
def test_what_an_arm_said_just_after_a_start_does_not_free_the_zone_that_it_held(evidence: Evidence) -> None:
    model = shared()
    layouts = map(StorageLayout, model.cells)
    layout = next(each for each in layouts if each.space.zones and each.arm.evidence is evidence)
    zone = min(layout.space.zones)
    memory = {Fact.QUARANTINE: {zone: layout.arm.name}}
    plant = Plant(model, epoch=2, now=0.0, memory=memory)
    said = {"q": layout.home.q, "boot_id": 1, **({"homed": True} if layout.arm.says_homed else {})}
    for number in range(1, 10):
        hear(plant, number * SHORTEST_ABSENCE_S / 10, layout.arm.name, **said)
        assert plant.zones.holder(zone) == layout.arm.name
    for number in range(10, 15):
        hear(plant, number * SHORTEST_ABSENCE_S / 10, layout.arm.name, **said)
    assert plant.zones.holder(zone) is None


def test_what_is_kept_of_a_step_that_was_proven_done_stays_kept_until_the_task_has_gone_on() -> None:
    """Else a plant that dies just after `resume` would give it again: a program of a mill ran twice."""
    last = {"robot": "mill", "effect": "process", "goal": None, "sets": [], "done": False}
    context = SimpleNamespace(time=None, failures=None)
    step = Act("run", context, lambda id: None, "running")  # type: ignore[arg-type, return-value]
    step.restore({"tries": 0, "left": False, "last": {**last, "before": [1, 5, 5], "number": [1, 6]}})
    step.status, step.proven = Status.RUNNING, True
    assert step.kept() == {"tries": 0, "left": False, "last": step.last, "given": 0}


def test_a_stop_is_kept_until_its_cell_is_reset_and_no_longer() -> None:
    rig = Rig(shipped("sis_a"))
    rig.wait(1.0)
    kept = []
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET):
        assert rig.operate(verb, "sis_a") is None
        rig.wait(2.0)
        kept.append(rig.plant.dispatcher.memory.value(Fact.LATCH, "ra1") is not None)
    assert kept == [True, True, False]
