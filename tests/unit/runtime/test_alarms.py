"""What people are told who do not look: each task that failed, each cell that needs somebody, and its end."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from arboleda.adapters.mqtt_broker.limits import PACKET_BYTES
from arboleda.adapters.webhook import TOKEN, URL
from arboleda.core.plant import Plant
from arboleda.kinds.person import person
from arboleda.model.cell_states import CellState
from arboleda.model.errors import StartError
from arboleda.model.messages import Reason, Shutdown, TaskChanged, TaskState, Verb
from arboleda.model.plant_model import Evidence
from arboleda.model.sentence import OWN
from arboleda.recipes import Kit, parallel, recipe, work
from arboleda.rig.rig import Rig
from arboleda.rig.world import PLANT
from arboleda.runtime.alarm_options import TOPIC, alarm_options
from arboleda.runtime.build import Options, build
from arboleda.runtime.parts.alarms import AlarmsPart
from arboleda.runtime.parts.commit_pace import Pace
from arboleda.testing import shipped
from arboleda.views import alarms as view

from ..kinds.lab import Bench
from ..kinds.test_people import attended, question, refill


class Told:
    """Outboxes that keep what is put into them, in the place of those that deliver it."""

    def __init__(self) -> None:
        self.alarms: list[dict[str, Any]] = []
        self.put = self.alarms.append

    @property
    def kinds(self) -> list[str]:
        return [alarm["kind"] for alarm in self.alarms]


@pytest.fixture
def told() -> Told:
    return Told()


@pytest.fixture
def rig(told: Told) -> Rig:
    """A plant at work whose every step is looked at as the orchestrator has it looked at."""
    return heard(Rig(shipped("sis_a")), told)


def heard(rig: Rig, told: Told) -> Any:
    part = AlarmsPart([], lambda cell, task: f"page of {cell} {task}")
    part._outboxes = [told]  # type: ignore[list-item]

    def look() -> None:
        for message in rig.moment.sent:
            if isinstance(message, TaskChanged):
                part.changed(message)
        part.stepped(rig.plant)

    rig.watchers.append(look)
    rig.alarms = part  # type: ignore[attr-defined]
    return rig


def test_a_plant_at_work_tells_nobody(rig: Rig, told: Told) -> None:
    rig.submit("sis_a 0B 7 #t1")
    assert rig.wait(300.0, lambda: rig.outcomes()["t1"].state is TaskState.DONE)
    assert told.alarms == []


def test_a_held_cell_is_told_once_with_what_to_do_and_again_when_it_is_over(rig: Rig, told: Told) -> None:
    rig.submit("sis_a 0B 7 #t1")
    rig.wait(2.0)
    rig.operate(Verb.HOLD, "sis_a")
    assert rig.wait(30.0, lambda: rig.plant.cells["sis_a"].state is CellState.HELD)
    rig.wait(5.0)
    (held,) = told.alarms
    assert held["kind"] == "cell_held" and held["state"] == "held" and held["cell"] == "sis_a"
    assert held["task"] == {"id": "t1", "text": "sis_a 0B 7"}
    assert "resume sis_a" in held["advice"] and "resume sis_a" in held["sentence"]
    assert held["page"] == "page of sis_a None" and held["alarm"] == held["id"]
    rig.operate(Verb.RESUME, "sis_a")
    assert told.kinds == ["cell_held", "cell_cleared"]
    assert told.alarms[1]["alarm"] == held["id"] != told.alarms[1]["id"]
    assert told.alarms[1]["sentence"] == "sis_a needs nobody any more: it is in execute"


def test_a_task_that_waits_for_boards_that_are_gone_is_told_after_a_while_and_once(
    rig: Rig, told: Told
) -> None:
    rig.wait(2.0)
    rig.power_off("ra_1")
    rig.wait(30.0)
    assert told.alarms == [], "no task waits"
    rig.submit("sis_a 0B 7 #t1")
    rig.wait(view.BLOCKED_S - 1.0)
    assert told.alarms == []
    rig.wait(30.0)
    (blocked,) = told.alarms
    assert (blocked["kind"], blocked["state"], blocked["task"]["id"]) == ("cell_blocked", "idle", "t1")
    assert "ra1" in blocked["sentence"] and blocked["reason"] is None
    assert view.needs_in(rig.snapshot()) == {"sis_a": "blocked"}
    rig.power_on("ra_1")
    rig.wait(5.0)
    rig.operate(Verb.HOME, "ra1")
    assert rig.wait(120.0, lambda: rig.plant.cells["sis_a"].state is CellState.EXECUTE)
    assert told.kinds == ["cell_blocked", "cell_cleared"]
    assert told.alarms[1]["alarm"] == blocked["id"]
    assert view.needs_in(rig.snapshot()) == {}


def test_a_board_that_is_back_at_once_is_no_alarm(rig: Rig, told: Told) -> None:
    rig.submit("sis_a 0B 7 #t1")  # before any board was heard
    assert rig.wait(300.0, lambda: rig.outcomes()["t1"].state is TaskState.DONE)
    assert told.alarms == []


def test_a_person_who_is_asked_is_told_with_the_question(told: Told) -> None:
    rig = heard(Bench(attended(refill)), told)
    rig.submit("tending refill")
    assert rig.wait(10.0, lambda: question(rig) is not None)
    (asked,) = told.alarms
    assert (asked["kind"], asked["state"]) == ("person_asked", "execute")
    assert asked["task"]["text"] == "tending refill"
    assert asked["sentence"] == "ana is asked in tending: Is the pallet full again?"
    assert view.needs_in(rig.snapshot()) == {"tending": "asked"}
    assert rig.operate(Verb.ANSWER, "ana", question=question(rig)["id"], answer="yes") is None
    rig.wait(1.0)
    assert told.kinds == ["person_asked", "cell_cleared"]


@pytest.mark.parametrize("at_work", [True, False])
def test_that_the_plant_was_away_is_told_whether_it_held_a_cell_or_not(
    rig: Rig, told: Told, at_work: bool
) -> None:
    rig.wait(2.0)
    if at_work:
        rig.submit("sis_a 0B 7 #t1")
        rig.wait_for("sis_a", "main/drive path 0B")
    rig.stall(PLANT, 1.8)
    rig.wait(5.0)
    away = next(alarm for alarm in told.alarms if alarm["kind"] == "plant_away")
    what = "what was at work is held: sis_a" if at_work else "no cell was at work, so that all go on"
    assert "the plant was away for 1." in away["sentence"] and away["sentence"].endswith(what)
    assert (away["cell"], away["state"], away["advice"]) == ("", None, [])
    assert told.kinds == ["plant_away", *(["cell_held"] if at_work else [])]


@recipe("both")
def both(cell: Kit):  # type: ignore[no-untyped-def]
    ana, ben = cell.devices("ana", "ben")
    return work(parallel(ana.ask("A?", ["yes"]), work(cell.wait(3.0), ben.ask("B?", ["yes"]))))


def test_each_person_who_is_asked_at_the_same_time_is_told(told: Told) -> None:
    model = attended(both)
    cells = [replace(each, members=(*each.members, ("ben", person("ben")))) for each in model.cells]
    rig = heard(Bench(replace(model, cells=tuple(cells))), told)
    rig.submit("tending both")
    rig.wait(10.0)
    assert told.kinds == ["person_asked", "person_asked"]
    assert [each["sentence"] for each in told.alarms] == [
        "ana is asked in tending: A?",
        "ana is asked in tending: A?; ben is asked in tending: B?",
    ]
    assert told.alarms[1]["alarm"] == told.alarms[0]["id"]
    for person_asked in ("ana", "ben"):
        assert rig.operate(Verb.ANSWER, person_asked, answer="yes") is None
        rig.wait(1.0)
    assert told.kinds[-1] == "cell_cleared"


def test_a_stop_is_one_hold_from_its_first_state_to_its_last(rig: Rig, told: Told) -> None:
    rig.wait(2.0)
    rig.operate(Verb.STOP)
    rig.wait(5.0)
    rig.operate(Verb.CLEAR)
    rig.wait(5.0)
    rig.operate(Verb.RESET)
    rig.wait(60.0, lambda: rig.plant.cells["sis_a"].state is CellState.IDLE)
    assert [alarm["state"] for alarm in told.alarms] == ["aborted", "stopped", "idle"]
    assert len({alarm["alarm"] for alarm in told.alarms}) == 1
    assert len({alarm["id"] for alarm in told.alarms}) == 3


def test_a_task_that_fails_is_told_with_its_reason_and_its_page(rig: Rig, told: Told) -> None:
    rig.submit("sis_a 0B 7 #t1")
    rig.wait(2.0)
    rig.operate(Verb.STOP)
    rig.wait(5.0)
    failed = next(alarm for alarm in told.alarms if alarm["kind"] == "task_failed")
    assert failed["task"]["id"] == "t1" and failed["reason"] == "stopped" and failed["sentence"]
    assert failed["page"] == "page of sis_a t1"


def test_who_asks_again_for_a_task_that_failed_makes_no_second_alarm(rig: Rig, told: Told) -> None:
    rig.submit("sis_a 0B 7 #t1")
    rig.wait(2.0)
    rig.operate(Verb.STOP)
    rig.wait(5.0)
    rig.submit("sis_a 0B 7 #t1")
    assert told.kinds.count("task_failed") == 1


def test_the_end_of_a_plant_is_no_alarm(rig: Rig, told: Told) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait(2.0)
    rig.tell(Shutdown(at=rig.now))
    rig.wait(5.0)
    assert rig.plant.cells["sis_a"].state is CellState.HELD
    assert told.alarms == []


def test_a_task_of_a_cell_that_is_no_more_is_told_without_its_state() -> None:
    gone = TaskChanged(task="t", text="old 0B 7", cell="old", state=TaskState.FAILED, sentence=OWN(text="x"))
    told = view.of_task(Plant(shipped("sis_a"), epoch=1, now=0.0), gone)
    assert (told["cell"], told["state"], told["advice"]) == ("old", None, [])


def test_an_alarm_fits_the_longest_packet_of_the_plants_own_broker(rig: Rig, told: Told) -> None:
    rig.submit("sis_a 0B 7 #t1")
    long = OWN(text="\U0001f916" * 2000)
    failed = TaskChanged(
        task="t" * 200,
        text="x" * 4000,
        cell="sis_a",
        state=TaskState.FAILED,
        sentence=long,
        reason=Reason.INTERNAL,
    )
    alarm = view.of_task(rig.plant, failed)
    assert len(json.dumps(alarm, ensure_ascii=False).encode()) < PACKET_BYTES - 800
    assert alarm["sentence"].endswith("...")


def test_nobody_wants_alarms_where_the_environment_says_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in (URL, TOKEN, TOPIC):
        monkeypatch.delenv(name, raising=False)
    options = alarm_options()
    assert options.hook is None and options.topic is None


@pytest.mark.parametrize(
    ("name", "value", "why"),
    [
        (URL, "alarms.example", "is no address to post to; write one like https://"),
        (URL, "ftp://alarms.example", "is no address to post to"),
        (URL, "https://alarms.example/a b", "is no address to post to"),
        (TOKEN, "abc", "names no address to show it to"),
        (TOPIC, "arboleda/#", "is no topic for alarms"),
        (TOPIC, "/arboleda", "is no topic for alarms"),
    ],
)
def test_what_means_nothing_is_refused_at_the_start(
    monkeypatch: pytest.MonkeyPatch, name: str, value: str, why: str
) -> None:
    for each in (URL, TOKEN, TOPIC):
        monkeypatch.setenv(each, value if each == name else "")
    with pytest.raises(StartError, match=why):
        alarm_options()


def test_a_secret_of_the_address_is_never_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(URL, "https://me:SECRET@alarms.example:8443/SECRET?SECRET")
    monkeypatch.setenv(TOKEN, "SECRET")
    hook = alarm_options().hook
    assert str(hook) == "https://alarms.example:8443" and "SECRET" not in repr(hook)
    monkeypatch.setenv(URL, "SECRET")
    with pytest.raises(StartError) as refused:
        alarm_options()
    assert "SECRET" not in str(refused.value)


def test_a_topic_of_a_board_is_refused(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Any, options: Callable[..., Options]
) -> None:
    monkeypatch.setenv(TOPIC, "ra_1/juntas")
    with pytest.raises(StartError, match="ra_1/juntas is a topic of a board"):
        build(shipped(), {"orchestrator"}, options())
    assert not (tmp_path / "state").exists()


@pytest.fixture
def options(tmp_path: Any) -> Callable[..., Options]:
    return lambda: Options(state_dir=tmp_path / "state", page=False, of_parts=(alarm_options(),))


def test_that_the_plant_was_away_names_the_cells_that_go_on_by_themselves(told: Told) -> None:
    plant = shipped("sis_a", "sis_b", evidence=Evidence.IDS)
    first, second = plant.cells
    rig = heard(Rig(replace(plant, cells=(replace(first, goes_on_after_absence=True), second))), told)
    rig.wait(2.0)
    for cell in ("sis_a", "sis_b"):
        rig.submit(f"{cell} 0B 7")
        rig.wait_for(cell, "main/drive path 0B")
    rig.stop_broker()  # else what waited in the inbox proves it in the very step in which the plant is back
    rig.stall(PLANT, 5.0)
    rig.wait(6.0)
    away = next(alarm for alarm in told.alarms if alarm["kind"] == "plant_away")
    goes_on = "what was at work goes on once its devices prove what they did: sis_a"
    assert away["sentence"].endswith(f"{goes_on}; what was at work is held: sis_b")


def test_a_slow_memory_is_told_with_the_next_step_and_so_is_its_end(rig: Any, told: Told) -> None:
    rig.alarms.paced(Pace(typical_s=0.35, worst_s=0.4, is_slow=True))
    rig.wait(1.0)
    rig.alarms.paced(Pace(typical_s=0.002))
    rig.wait(1.0)
    slow, fast = told.alarms
    assert told.kinds == ["memory_slow", "memory_fast"] and fast["alarm"] == slow["id"]
    assert (
        "waits 0.35 s for it now as a rule" in slow["sentence"]
        and slow["cell"] == ""
        and slow["state"] is None
    )
