"""A record, executed again, does the same to the last bit; where it does not, the first value is named."""

from __future__ import annotations

import json
from copy import deepcopy
from dataclasses import replace
from pathlib import Path

import pytest
from tests.unit.core.test_revision import NEXT, Q, moved
from tests.unit.recorder.recorded import FILES, Site

from arboleda.engine import Plant
from arboleda.model.messages import Fact, Revision, TaskState, Verb
from arboleda.recorder import reader
from arboleda.recorder.plain_data import plain
from arboleda.recorder.steps import from_json
from arboleda.rig.world import World
from arboleda.testing.plants import shipped
from arboleda_proofs.campaigns.simulated_recorder import TapedPlant, recorded
from arboleda_proofs.playback.replay import Difference, ReplayedStep, first_difference, plant_of, replayed


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    return Site(tmp_path, monkeypatch)


def again(file: Path, **changes: object) -> list[ReplayedStep]:
    """All steps of a record, made once more."""
    record = reader.opened(file)
    model = replace(shipped(), **changes)  # type: ignore[arg-type]
    steps = list(replayed(plant_of(record.first.beginning, model), record.steps()))
    assert steps[-1].difference or (record.last is not None and record.last.whole and not record.broken)
    return steps


@pytest.mark.long
def test_tasks_done_failed_and_operated_are_the_same_again(site: Site) -> None:
    rig = site.rig
    site.work("sis_a 0B 7", "sis_b 1C 3 #lot", "nonsense", s=5.0)
    assert rig.operate(Verb.HOLD, "sis_b") is None
    rig.wait(3.0)
    assert rig.operate(Verb.RESUME, "sis_b") is None
    rig.power_off("ra_1")
    rig.wait(20.0)
    rig.power_on("ra_1")
    assert rig.operate(Verb.STOP, "") is None
    rig.wait(1.0)
    for verb in (Verb.CLEAR, Verb.RESET):
        rig.operate(verb, "")
        rig.wait(20.0)
    site.work("sis_c 2A 5", s=60.0)
    site.end()
    states = {change.state for change in rig.changes}
    assert {TaskState.DONE, TaskState.FAILED, TaskState.REFUSED} <= states
    (file,) = site.files
    steps = again(file)
    assert len(steps) > 200 and [each.number for each in steps] == list(range(1, len(steps) + 1))
    assert not any(each.difference for each in steps)


def test_a_task_walked_back_after_a_crash_is_the_same_again(site: Site) -> None:
    site.work("sis_a 0B 7 #lot-1", s=6.0)
    site.rig.crash()
    site.rig.wait(5.0)
    assert site.rig.operate(Verb.RESUME, "sis_a") is None
    site.rig.wait(60.0)
    site.end()
    assert [change.state for change in site.rig.changes][-1] is TaskState.DONE
    _, second = site.files
    beginning = reader.opened(second).first.beginning
    assert beginning.memory[Fact.STEP].keys() == {"lot-1"} and [each.id for each in beginning.kept] == [
        "lot-1"
    ]
    assert not any(each.difference for file in site.files for each in again(file))


def test_the_first_value_that_is_another_one_is_named(site: Site) -> None:
    site.work("sis_a 0B 7", s=30.0)
    site.end()
    timing = replace(shipped().timing, dwell_s=0.5)
    steps = again(site.files[0], timing=timing)
    *before, last = steps
    assert not any(each.difference for each in before)
    assert last.difference is not None
    assert last.difference.field == "messages[1] (Remember).value"  # of which recipe its tree is
    assert [type(each).__name__ for each in last.recorded.events] == ["TaskRequest"]


def test_a_step_that_raises_is_a_difference(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    site.work(s=1.0)
    site.end()
    record = reader.opened(site.files[0])
    plant = plant_of(record.first.beginning, shipped())
    monkeypatch.setattr(plant, "step", lambda now, events: 1 / 0)
    (only,) = replayed(plant, record.steps())
    assert only.difference == Difference("step", "made", "ZeroDivisionError: division by zero")


def test_the_files_of_the_plant_are_in_the_record(site: Site) -> None:
    site.end()
    assert reader.opened(site.files[0]).first.beginning.files == FILES


@pytest.mark.parametrize(
    ("recorded", "now", "found"),
    [
        ({"a": 1.0}, {"a": 1}, Difference("a", 1.0, 1)),
        ({"a": [0.0]}, {"a": [-0.0]}, Difference("a[0]", 0.0, -0.0)),
        ({"a": [1]}, {"a": [1, 2]}, Difference("a[1]", None, 2)),
        ({"a": {"b": 1}}, {"a": {"b": 1, "c": 2}}, Difference("a.c", None, 2)),
        (
            {"m": [{"type": "Stop", "mode": 1}]},
            {"m": [{"type": "Stop", "mode": 2}]},
            Difference("m[0] (Stop).mode", 1, 2),
        ),
        ({"a": 1}, {"a": 1}, Difference("hash", "another", "the same values")),
    ],
)
def test_a_difference_says_where_and_what(recorded: object, now: object, found: Difference) -> None:
    assert repr(first_difference(recorded, now)) == repr(found)


def test_a_record_with_arguments_within_scopes_is_the_same_again(site: Site) -> None:
    site.work("sis_a 0B 7", s=60.0)
    assert site.rig.operate(Verb.UNLOAD, "sis_a", station=7) is None
    site.end()
    (step,) = (
        each.recorded
        for each in again(site.files[0])
        if any(hasattr(it, "verb") for it in each.recorded.events)
    )
    rows = {"now": step.now, "events": plain(step.events), **deepcopy(step.result), "hash": "another"}
    for each in (*rows["events"], *rows["messages"]):
        if each.pop("arguments", None):
            each["scope"] = "sis_a 7"
    assert from_json(step.unix_ns, json.dumps(rows).encode()) == step


def test_a_replay_over_a_change_in_the_middle_is_the_same_to_the_last_bit() -> None:
    model = shipped("sis_a", "sis_b")
    world = World(model, make_plant=TapedPlant)
    other = moved(model)
    world.plant.versions[NEXT.digest] = other
    world.advance(2.0)
    for _ in range(2):
        world.request_task("sis_a 0B 0")
    world.advance(3.0)
    world.tell(Revision(at=world.now, version=NEXT, by="Ana", changes=("one",)))
    world.advance(120.0)
    plant = world.plant
    assert isinstance(plant, TapedPlant)
    steps = [*recorded(plant.tape)]
    again = plant_of(plant.beginning, model, {NEXT.digest: other})
    assert [each.difference for each in replayed(again, steps)] == [None] * len(steps)
    assert again.model.cell("sis_a").stations[0].q == Q
    ignorant = [*replayed(Plant(model, epoch=1, now=0.0), [])]
    assert ignorant == []
    blind = [*replayed(plant_of(plant.beginning, model), steps)]
    assert blind[-1].difference is not None
