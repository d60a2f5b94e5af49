"""What the plant wants remembered is kept before anything after it leaves; answers find who asked."""

from __future__ import annotations

import time
from contextlib import nullcontext
from dataclasses import replace
from types import SimpleNamespace

import pytest

from arboleda.adapters import clock
from arboleda.adapters.broker_login import address
from arboleda.core.plant import Plant
from arboleda.dispatch.ledger import Entry
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.model.commands import Home, Stop, StopMode
from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.messages import (
    Absence,
    Fact,
    Heartbeat,
    InternalError,
    Journal,
    LateDeparture,
    OperatorAnswer,
    OperatorRequest,
    Remember,
    Report,
    SystemStart,
    TaskAnswer,
    TaskChanged,
    TaskState,
    Undelivered,
    Verb,
)
from arboleda.model.sentence import OWN
from arboleda.model.task import Order, Task
from arboleda.runtime.build import Options, build
from arboleda.runtime.parts import orchestrator, screens
from arboleda.runtime.parts.bridge import BridgePart
from arboleda.runtime.parts.broker import OtherBroker
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.runtime.parts.slices import PAUSE_S, SLICE_S
from arboleda.store.lead import Superseded
from arboleda.store.sqlite import Store
from arboleda.store.task_rows import TaskQuery, answers_of
from arboleda.testing.plants import shipped
from arboleda.wire import status

GRIP = Remember(fact=Fact.EFFECTOR, name="ra1", value="switching")
ON, OFF = (SetEffector(id=id, robot="ra1", on=on) for id, on in (("7-1", True), ("7-9", False)))
ACT = Journal(verb=Verb.STOP, scope="", cell=None, sentence=OWN(text="everything stopped"))


class Script(Plant):
    """A plant that says what it is told to, and notes what it hears."""

    def __init__(self, model, *, memory, **options):
        super().__init__(model, memory=memory, **options)
        self.memory = memory

    def step(self, now, events):
        self.heard = list(events)
        return self.says(events)


class Robots:
    """The port: every message that left, with what was remembered by then."""

    def __init__(self, store: Store) -> None:
        self.store = store
        self.seen: list[tuple[object, dict[str, str]]] = []

    @property
    def messages(self) -> list[object]:
        return [message for message, _ in self.seen]

    def send(self, message) -> None:
        self.seen.append((message, self.store.facts(Fact.EFFECTOR)))


@pytest.fixture
def crashes():
    return []


@pytest.fixture
def store(tmp_path):
    with Store(tmp_path / "plant.sqlite") as opened:
        yield opened


@pytest.fixture
def plant(monkeypatch, store, crashes):
    monkeypatch.setattr(orchestrator, "Plant", Script)
    made = Orchestrator(shipped("sis_a"), 7, lambda name, error: crashes.append(error), store)
    made.robots = Robots(store)
    made.connect(made.robots)
    return made


def turn(plant: Orchestrator, *messages: object) -> list[object]:
    """One step of the loop in which the plant says `messages`; the events it heard."""
    plant.plant.says = lambda events: list(messages)
    plant.loop.turn()
    return plant.plant.heard


def break_disk(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_):
        raise ArboledaError("The disk is full.")

    monkeypatch.setattr(store, "keep", fail)
    monkeypatch.setattr(store.acts, "keep", fail)
    monkeypatch.setattr(store.tasks, "keep", fail)


def test_a_fact_is_kept_before_the_next_message_leaves(plant):
    turn(plant, Heartbeat(epoch=7), GRIP, ON)
    assert plant.robots.seen == [(Heartbeat(epoch=7), {}), (ON, {"ra1": "switching"})]


def test_a_reaction_is_timed_from_the_last_event_to_the_command_that_left(plant, monkeypatch):
    monkeypatch.setattr(orchestrator.clock, "seconds", lambda: 100.25)
    reactions = []
    plant.reacted = reactions.append
    for at, messages in ((99.0, [ON]), (99.5, [Heartbeat(epoch=7)])):
        for event_at in (at - 0.5, at):
            plant.loop.post(Report(at=event_at, robot="ra1"))
        turn(plant, *messages)
    turn(plant, ON)
    assert reactions == [1.25]


def test_a_plant_is_told_what_the_one_before_it_kept(plant, store):
    turn(plant, GRIP)
    turn(plant, Remember(fact=Fact.LATCH, name="ra1", value="on"))
    after = Orchestrator(shipped("sis_a"), 8, pytest.fail, store)
    kept = {fact: values for fact, values in after.plant.memory.items() if values}
    assert kept == {Fact.LATCH: {"ra1": "on"}, Fact.EFFECTOR: {"ra1": "switching"}}


def test_an_operators_act_is_journalled_with_the_time_of_day(plant, store, monkeypatch):
    monkeypatch.setattr(plant.calendar, "unix_s", lambda: 1_700_000_000.5)
    turn(plant, ACT)
    [entry] = store.acts.last()
    assert (entry.unix_s, entry.verb, entry.sentence) == (1_700_000_000.5, "stop", "everything stopped")


class Clocks:
    """A wall clock, and a steady one, which no setting of the other moves."""

    def __init__(self, monkeypatch):
        self.steady_s, self.ahead_s = 5000.0, 1_700_000_000.0
        monkeypatch.setattr(clock, "seconds", lambda: self.steady_s)

    def calendar(self):
        return clock.Calendar(lambda: self.steady_s + self.ahead_s, lambda: self.steady_s)


def do(plant, clocks, *tasks, takes_s=3.0):
    for id in tasks:
        told = replace(TASK, task=id)
        turn(plant, told, replace(told, state=TaskState.RUNNING))
        clocks.steady_s += takes_s
        turn(plant, replace(told, state=TaskState.DONE))


@pytest.fixture
def clocks(monkeypatch):
    monkeypatch.setattr(orchestrator, "Plant", Script)
    return Clocks(monkeypatch)


def start(store, clocks, crash=pytest.fail):
    return Orchestrator(shipped("sis_a"), 7, crash, store, calendar=clocks.calendar())


def ids(store):
    return {row.id for row in store.tasks.select(TaskQuery(limit=None))}


@pytest.mark.parametrize("days", [91, 100, 400, -400])
def test_a_wall_clock_that_is_wrong_has_no_task_forgotten(store, clocks, days):
    plant = start(store, clocks)
    do(plant, clocks, *"abc")
    clocks.ahead_s += days * 86_400.0
    do(plant, clocks, *"de")
    do(start(store, clocks), clocks, *"fg")  # one that knows no other time
    clocks.ahead_s -= days * 86_400.0
    do(start(store, clocks), clocks, "h")
    assert ids(store) == {*"abcdefgh"}


def test_tasks_are_forgotten_once_the_plant_has_run_for_so_long(store, clocks):
    do(start(store, clocks), clocks, "a")
    for task in "bc":
        do(start(store, clocks), clocks, task, takes_s=50 * 86_400.0)
    assert ids(store) == {"b", "c"}


def test_a_task_takes_what_it_takes_while_the_clock_is_set(store, clocks):
    plant = start(store, clocks)
    heard = []
    for id, by_s in zip("abcd", (86_400.0, -86_400.0, -86_400.0, 86_400.0), strict=True):
        told = replace(TASK, task=id)
        turn(plant, told, replace(told, state=TaskState.RUNNING))
        clocks.steady_s += 1.0
        clocks.ahead_s += by_s
        turn(plant)
        clocks.steady_s += 2.0
        heard += turn(plant, replace(told, state=TaskState.DONE))
    rows = store.tasks.select(TaskQuery())
    assert [row.ended_s - row.started_s for row in rows] == [3.0] * 4
    assert [row.started_s - 1_700_005_000.0 for row in rows] == [9.0, 6.0, 3.0, 0.0]
    assert [event.seconds for event in heard] == [86_400.0, -86_400.0, -86_400.0, 86_400.0]


def test_a_memory_that_cannot_follow_the_clock_ends_the_plant(store, clocks, crashes, monkeypatch):
    plant = start(store, clocks, lambda _, error: crashes.append(error))

    def fail(*_):
        raise ArboledaError("The disk is full.")

    monkeypatch.setattr(store, "move_times", fail)
    clocks.ahead_s += 60.0
    turn(plant)
    assert [str(error) for error in crashes] == ["The disk is full."]


TASK = TaskChanged(task="a", text="sis_a 0B 1", cell="sis_a", state=TaskState.QUEUED)


def latched(robot: str, value: str = "on") -> tuple[Remember, Stop]:
    mode = StopMode.LATCH if value == "on" else StopMode.CLEAR
    return Remember(fact=Fact.LATCH, name=robot, value=value), Stop(id="", robot=robot, mode=mode)


def commits(store: Store, monkeypatch: pytest.MonkeyPatch) -> list[tuple[Remember, ...]]:
    """The facts that are committed together, from now on."""
    keep, told = store.keep, []
    monkeypatch.setattr(store, "keep", lambda *facts: (told.append(facts), keep(*facts)))
    return told


def test_stops_leave_before_any_commit_and_their_latches_are_kept_by_one(plant, store, monkeypatch):
    (first, stop_one), (second, stop_two) = latched("ra1"), latched("rm_sis_a")
    keep, told = store.keep, []
    monkeypatch.setattr(
        store, "keep", lambda *facts: (told.append((facts, plant.robots.messages)), keep(*facts))
    )
    turn(plant, GRIP, first, stop_one, second, stop_two)
    assert told == [((GRIP, first, second), [stop_one, stop_two])]


def test_what_came_before_a_stop_of_its_robot_does_not_leave_after_it(plant):
    clear, latch = latched("ra1", "cleared"), latched("ra1")
    drive = Home(id="7-3", robot="rm_sis_a")
    later = replace(OFF, id="7-4")
    turn(plant, GRIP, ON, *clear, drive, *latch, later)
    assert plant.robots.messages == [latch[1], drive, later]
    heard = turn(plant)
    assert {event.id: str(event.sentence) for event in heard} == dict.fromkeys(
        ["7-1", ""], "a stop of ra1 left before this could be sent"
    )


def test_facts_that_stand_side_by_side_are_kept_by_one_commit(plant, store, monkeypatch):
    step, over = Remember(fact=Fact.STEP, name="sis_a", value="1"), replace(GRIP, value="off")
    told = commits(store, monkeypatch)
    turn(plant, GRIP, step, ON, over, OFF, GRIP)
    assert told == [(GRIP, step), (over,), (GRIP,)]
    assert plant.robots.messages == [ON, OFF]


def test_of_two_latches_of_the_same_robot_the_last_is_kept(plant, store, monkeypatch):
    (on, stop), (off, clear) = latched("ra1"), latched("ra1", "cleared")
    told = commits(store, monkeypatch)
    turn(plant, on, stop, off, clear)
    assert plant.robots.messages == [stop, clear]
    assert told == [(on, off)]
    assert store.facts(Fact.LATCH) == {"ra1": "cleared"}


def test_stops_leave_a_plant_whose_latches_cannot_be_kept(plant, store, crashes, monkeypatch):
    break_disk(store, monkeypatch)
    (first, stop_one), (second, stop_two) = latched("ra1"), latched("rm_sis_a")
    turn(plant, first, stop_one, second, stop_two)
    assert plant.robots.messages == [stop_one, stop_two]
    assert [str(crash) for crash in crashes] == ["The disk is full."]


@pytest.mark.parametrize("lost", [GRIP, ACT, TASK], ids=["fact", "journal", "task"])
def test_once_something_cannot_be_kept_robots_are_only_told_to_stop(plant, store, crashes, monkeypatch, lost):
    break_disk(store, monkeypatch)
    halt = Stop(id="7-2", robot="ra1", mode=StopMode.HALT)
    latch = Stop(id="7-3", robot="ra1", mode=StopMode.LATCH)
    clear = Stop(id="7-4", robot="ra1", mode=StopMode.CLEAR)
    home = Home(id="7-5", robot="ra1")
    turn(plant, halt, latch, lost, ON, GRIP, clear)
    turn(plant, home, Heartbeat(epoch=7))
    assert plant.robots.messages == [halt, latch, Heartbeat(epoch=7)]
    assert [str(crash) for crash in crashes] == ["The disk is full."]
    assert plant.plant.heard == [
        Undelivered(at=event.at, id=command.id, robot="ra1", sentence=OWN(text="The disk is full."))
        for event, command in zip(plant.plant.heard, (ON, clear), strict=True)
    ]


def answer(event: OperatorRequest, refusal: str | None = None) -> OperatorAnswer:
    return OperatorAnswer(verb=event.verb, scope=event.scope, refusal=refusal, request=event.request)


class Shown(dict):
    """A snapshot of which only what it is made of matters."""

    def __init__(self, of):
        super().__init__(cells=[], robots=[], tasks=[])
        self.of = of

    def __eq__(self, other):
        return self.of == other

    __hash__ = None


def at_once(plant, part_of):
    """A snapshot without parts, of which only the version matters."""
    yield from ()
    return Shown(plant.version)


@pytest.fixture
def shows(plant, monkeypatch):
    """The versions that were shown, while the plant's clock says what `now[0]` is.

    Making them takes no processor time here, so no slice of it comes later on a busy machine.
    """
    now, shown = [100.0], []
    monkeypatch.setattr(time, "thread_time", lambda: 0.0)
    monkeypatch.setattr(plant.loop, "_clock", lambda: now[0])
    monkeypatch.setattr(screens.view, "in_parts", at_once)
    monkeypatch.setattr(Script, "version", 1, raising=False)
    plant.screens.watchers.append(shown.append)
    return now, shown


def test_a_change_is_shown_a_little_later_with_what_followed_at_once(plant, shows, monkeypatch):
    now, shown = shows
    turn(plant, ON)
    now[0] += screens.SETTLE_S / 2
    monkeypatch.setattr(Script, "version", 2)
    turn(plant)
    assert shown == []
    now[0] += screens.SETTLE_S
    turn(plant)
    assert shown == [2]
    turn(plant)
    assert shown == [2]


def test_without_a_change_it_is_shown_now_and_then(plant, shows):
    now, shown = shows
    for _ in range(2):
        now[0] += screens.VIEW_S
        turn(plant)
        now[0] += screens.SETTLE_S
        turn(plant)
    assert shown == [1, 1]


class Topics(Robots):
    """The port on ROS 2, and whether anybody listens there."""

    def __init__(self, store: Store, *, watched: bool, diagnosed: bool) -> None:
        super().__init__(store)
        self.watched, self.diagnosed = watched, diagnosed
        self.told: list[str] = []

    def publish_view(self, snapshot):
        self.told.append("view")
        yield

    def publish_diagnostics(self, statuses):
        self.told.append("diagnostics")
        yield


@pytest.mark.parametrize(
    ("watched", "diagnosed", "changed", "unchanged"),
    [
        (False, False, ["view"], []),
        (True, False, ["view"], ["view"]),
        (True, True, ["view", "diagnostics"], ["view", "diagnostics"]),
    ],
    ids=["nobody", "view", "diagnostics"],
)
def test_topics_on_which_nobody_listens_are_told_changes_only(
    plant, store, shows, monkeypatch, watched, diagnosed, changed, unchanged
):
    now, _ = shows
    plant.screens.watchers.clear()
    topics = Topics(store, watched=watched, diagnosed=diagnosed)
    plant.connect(topics)
    plant.connect_ros(topics)
    monkeypatch.setattr(screens.diagnostics, "diagnostics", lambda snapshot: [])
    for told in (changed, unchanged):
        now[0] += screens.VIEW_S
        turn(plant)
        now[0] += screens.SETTLE_S
        turn(plant)
        assert topics.told == told
        topics.told.clear()


def test_a_record_that_has_stopped_is_diagnosed(plant, store, shows):
    now, _ = shows
    topics = Topics(store, watched=True, diagnosed=True)
    rows = []
    topics.publish_diagnostics = lambda statuses: iter(rows.extend(statuses) or ())
    plant.connect(topics)
    plant.connect_ros(topics)
    plant.screens.recorder = SimpleNamespace(trouble="", stepped=lambda *_: None, saw=lambda *_: None)
    told = []
    for trouble in ("", "the disk is full"):
        plant.screens.recorder.trouble = trouble
        rows.clear()
        now[0] += screens.VIEW_S
        turn(plant)
        now[0] += screens.SETTLE_S
        turn(plant)
        told += [row[2:4] for row in rows if row[0] == "arboleda: record"]
    assert told == [(status.OK, "written"), (status.WARN, "the disk is full")]


def test_snapshots_that_take_long_come_seldom_and_none_is_owed_in_the_end(plant, shows, monkeypatch):
    now, shown = shows
    spent = [0.0]
    monkeypatch.setattr(time, "thread_time", lambda: spent[0])
    plant.screens.watchers.append(lambda snapshot: spent.append(spent.pop() + 0.05))
    for version in range(1, 201):  # 2 s in which something changes all the time
        monkeypatch.setattr(Script, "version", version)
        turn(plant)
        now[0] += 0.01
    assert spent[0] <= 1.2 * screens.SHARE * 2.0
    assert len(shown) >= 4
    now[0] += 1.0
    turn(plant)
    assert shown[-1] == 200


@pytest.fixture
def slow_parts(plant, shows, monkeypatch):
    """As `shows`, but a snapshot has 10 parts of a slice each; `made` are the versions that its parts saw."""
    spent, made = [0.0], []
    monkeypatch.setattr(time, "thread_time", lambda: spent[0])

    def in_parts(plant, part_of):
        for _ in range(10):
            made.append(plant.version)
            spent[0] += 1.01 * SLICE_S
            yield
        return Shown(made[-10:])

    monkeypatch.setattr(screens.view, "in_parts", in_parts)
    return *shows, made


def test_a_snapshot_that_takes_long_is_made_between_steps(plant, slow_parts, monkeypatch):
    now, shown, made = slow_parts
    heard = 0
    turn(plant, ON)
    now[0] += screens.SETTLE_S
    for step in range(10):
        assert shown == [], "it is shown once it is whole"
        plant.loop.post("an event")
        before = len(made)
        heard += len(turn(plant))
        assert len(made) == before + 1, "a slice follows each step"
        monkeypatch.setattr(Script, "version", step + 2)
        turn(plant)
        assert len(made) == before + 1, "and is followed by a pause"
        now[0] += 1.01 * (SLICE_S + PAUSE_S)
    turn(plant)
    assert heard == 10 and shown == [list(range(1, 11))]
    now[0] += 1.0
    for _ in range(12):
        now[0] += 1.01 * (SLICE_S + PAUSE_S)
        turn(plant)
    assert shown[1:] == [[11] * 10], "what changed meanwhile is shown with the next one"


def test_a_snapshot_that_is_being_made_is_shown_whole_at_the_end(plant, slow_parts):
    now, shown, made = slow_parts
    turn(plant, ON)
    now[0] += screens.SETTLE_S
    turn(plant)
    assert (shown, len(made)) == ([], 1)
    plant.plant.intake.closed = True
    turn(plant)
    assert shown == [[1] * 10]


def test_the_last_change_is_shown_before_the_end(plant, shows):
    _, shown = shows
    turn(plant, ON)
    assert shown == []
    plant.plant.intake.closed = True  # as a Shutdown does
    turn(plant)
    assert shown == [1]


def test_once_something_cannot_be_kept_nobody_hears_of_the_end_of_a_task(plant, store, crashes, monkeypatch):
    heard = []
    plant.listeners.append(heard.append)
    turn(plant, TASK)
    break_disk(store, monkeypatch)
    turn(plant, GRIP, replace(TASK, state=TaskState.FAILED))
    assert crashes
    assert heard == plant.robots.messages == [TASK]


def test_a_listener_that_breaks_neither_ends_the_plant_nor_keeps_others_from_being_told(
    plant, crashes, caplog
):
    heard = []
    plant.listeners += [{}.__getitem__, heard.append]
    turn(plant, TASK)
    assert heard == plant.robots.messages == [TASK] and not crashes
    assert "internal error in what is told of the plant" in caplog.text


def test_an_operators_request_is_answered(plant):
    future = plant.operate(Verb.HOME, "ra1", by_hand=True)
    plant.plant.says = lambda events: [answer(events[0], "ra1 moves")]
    plant.loop.turn()
    assert plant.plant.heard[0].by_hand
    result = future.result(timeout=0)
    assert (result.verb, result.scope, result.refusal) == (Verb.HOME, "ra1", "ra1 moves")
    assert plant.robots.messages == [result]


def test_an_act_that_could_not_be_kept_is_not_said_to_be_done(plant, store, monkeypatch):
    break_disk(store, monkeypatch)
    future = plant.operate(Verb.OVERRIDE, "mesa")
    plant.plant.says = lambda events: [ACT, answer(events[0])]
    plant.loop.turn()
    with pytest.raises(ArboledaError, match="The disk is full"):
        future.result(timeout=0)
    (said,) = plant.robots.messages  # to whoever asked by ROS 2
    assert (said.verb, str(said.refusal)) == (Verb.OVERRIDE, "The disk is full.")


def test_what_waited_too_long_for_the_disk_is_not_sent_and_a_stop_is(plant, store, monkeypatch):
    now, keep = [100.0], store.keep

    def slowly(fact):
        keep(fact)
        now[0] += 1.0

    monkeypatch.setattr(store, "keep", slowly)
    monkeypatch.setattr(orchestrator.clock, "seconds", lambda: now[0])
    monkeypatch.setattr(plant.loop, "_clock", lambda: now[0])
    plant.plant.now = now[0]
    halt = Stop(id="7-2", robot="ra1", mode=StopMode.HALT)
    turn(plant, halt, GRIP, ON, GRIP, replace(ON, id="7-3"))
    assert plant.robots.messages == [halt, ON]
    (undelivered,) = turn(plant)
    assert undelivered.id == "7-3"
    assert str(undelivered.sentence) == "the plant was away for 2.0 s before it could send this"


def test_nothing_is_announced_once_something_cannot_be_kept(plant, store, monkeypatch):
    break_disk(store, monkeypatch)
    turn(plant, GRIP, SystemStart(cell="sis_a"), Heartbeat(epoch=7))
    assert plant.robots.messages == [Heartbeat(epoch=7)]


def test_a_memory_that_cannot_be_read_keeps_the_plant_from_starting(tmp_path):
    file = tmp_path / "plant.sqlite"
    file.write_text("not a database " * 100)
    for _ in range(2):  # the second finds the state directory free
        with pytest.raises(StartError, match="cannot be used"):
            build(shipped("sis_a"), {"orchestrator"}, Options(state_dir=tmp_path))
    file.unlink()
    build(shipped("sis_a"), {"orchestrator"}, Options(state_dir=tmp_path)).stop()
    assert file.read_bytes().startswith(b"SQLite format 3")


@pytest.mark.parametrize("notice", [GRIP, ACT, OperatorAnswer(verb=Verb.STOP, scope="")])
def test_the_bridge_gets_only_what_is_for_robots(notice):
    part = BridgePart(shipped("sis_a"), 7, OtherBroker(address("127.0.0.1:1883"), None), pytest.fail)
    part.loop.post = pytest.fail
    part.send(notice)


def test_a_bridge_whose_robots_another_process_leads_does_not_halt_them_when_it_leaves():
    part = BridgePart(shipped("sis_a"), 7, OtherBroker(address("127.0.0.1:1883"), None), pytest.fail)
    part.loop.post = pytest.fail
    part.leave_robots()
    part.stop()


def test_an_error_in_a_cell_is_one_line_for_people_and_whole_in_the_log(plant, caplog):
    try:
        raise ZeroDivisionError("by design")
    except ZeroDivisionError as error:
        defect = InternalError(cell="sis_a", error=error)
    plant.plant.says = lambda events: [defect, Heartbeat(epoch=7)]
    with caplog.at_level("DEBUG", logger="arboleda"):
        plant.loop.turn()
    said = [record for record in caplog.records if record.levelname == "ERROR"]
    assert [record.getMessage() for record in said] == [
        "internal error in sis_a (ZeroDivisionError: by design)"
    ]
    assert said[0].exc_info is None and "Traceback" in caplog.text
    assert plant.robots.messages == [Heartbeat(epoch=7)]


def test_a_view_that_cannot_be_made_is_logged_once_and_does_not_end_the_plant(plant, caplog, monkeypatch):
    def broken(each, part_of):
        raise KeyError("by design")

    monkeypatch.setattr(screens.view, "in_parts", broken)
    plant.screens.watchers.append(lambda snapshot: None)
    plant.plant.intake.closed = True
    plant.plant.says = lambda events: [Heartbeat(epoch=7)]
    for version in range(3):
        plant.plant.dispatcher.ledger.version = version + 1
        plant.loop.turn()
    assert sum("internal error in the screens" in line for line in caplog.messages) == 1
    assert len(plant.robots.messages) == 3


def test_what_a_stopped_process_had_decided_is_not_sent_when_it_goes_on(plant, monkeypatch):
    move = MoveJoints(id="7-2", robot="ra1", q=(0.0, 0.0, 0.0))
    halt = Stop(id="7-3", robot="ra1", mode=StopMode.HALT)
    plant.plant.says = lambda events: [] if events else [halt, ON, move]
    stepped_at = plant.plant.now
    monkeypatch.setattr(orchestrator.clock, "seconds", lambda: stepped_at + 20.0)
    plant.loop.turn()
    assert plant.robots.messages == [halt]
    plant.loop.turn()
    undelivered = [event for event in plant.plant.heard if isinstance(event, Undelivered)]
    assert [event.id for event in undelivered] == [ON.id, move.id]
    assert "away for 20.0 s" in str(undelivered[0].sentence)


def test_an_absence_is_one_line_in_the_log(plant, caplog):
    plant.plant.says = lambda events: [Absence(seconds=20.04)]
    plant.loop.turn()
    assert [line for line in caplog.messages if "away for 20.0 s" in line]
    assert plant.robots.messages == []


def test_a_task_is_kept_before_whoever_asked_hears_that_it_is_queued(plant, store):
    kept = []
    answer = plant.submit("sis_a 0B 1")
    answer.add_done_callback(lambda _: kept.extend(row.id for row in store.tasks.select(TaskQuery())))
    plant.plant.says = lambda events: [replace(TASK, request=events[0].request)]
    plant.loop.turn()
    assert kept == ["a"]


def test_it_is_kept_by_which_way_a_task_came(plant, store):
    ways = {"a": ("page",), "b": ()}
    for id, way in ways.items():
        plant.submit(f"sis_a 0B 1 #{id}", *way)
        plant.plant.says = lambda events, id=id: [replace(TASK, task=id, request=events[0].request)]
        plant.loop.turn()
    turn(plant, replace(TASK, task="c"))  # of a topic, where nobody waits for an answer
    kept = {row.id: row.asked_by for row in store.tasks.select(TaskQuery())}
    assert kept == {"a": "page", "b": "command", "c": "ros2"}


@pytest.mark.parametrize("cell", ["sis_a", None], ids=["cell", "plant"])
def test_a_retry_is_an_attempt_that_is_kept(plant, store, cell):
    turn(plant, TASK)
    task = Task("a", Order(text="sis_a 0B 1", cell="sis_a", recipe="storage"))
    task.attempts = 2
    plant.plant.cells["sis_a"].task = task
    turn(plant, replace(ACT, verb=Verb.RETRY, cell=cell))
    assert [row.attempts for row in store.tasks.select(TaskQuery())] == [2]


def test_the_end_of_a_task_is_kept_with_what_was_answered(plant, store):
    turn(plant, TASK)
    task = Task("a", Order(text="sis_a 0B 1", cell="sis_a", recipe="storage"))
    task.answers = [TaskAnswer(by="eye", asked="look", answer="good")]
    plant.plant.intake.tasks["a"] = task
    turn(plant, replace(TASK, state=TaskState.DONE))
    (row,) = store.tasks.select(TaskQuery())
    assert answers_of(row) == (TaskAnswer(by="eye", asked="look", answer="good"),)


def test_a_task_that_cannot_be_kept_is_not_acknowledged(plant, store, monkeypatch):
    break_disk(store, monkeypatch)
    answer = plant.submit("sis_a 0B 1")
    plant.plant.says = lambda events: [replace(TASK, request=events[0].request)]
    plant.loop.turn()
    with pytest.raises(ArboledaError, match=r"The disk is full\. The task may have been kept all the same"):
        answer.result(timeout=0)


def test_a_task_that_came_after_the_memory_was_lost_was_not_kept(plant, store, monkeypatch):
    break_disk(store, monkeypatch)
    turn(plant, GRIP)
    answer = plant.submit("sis_a 0B 1")
    plant.plant.says = lambda events: [replace(TASK, request=events[0].request)]
    plant.loop.turn()
    with pytest.raises(ArboledaError, match=r"^The disk is full\.$"):
        answer.result(timeout=0)


@pytest.mark.parametrize("message", [ON, Stop(id="", robot="ra1", mode=StopMode.HALT), Heartbeat(epoch=7)])
def test_a_plant_that_another_process_leads_sends_nothing_not_even_a_stop(
    plant, store, monkeypatch, crashes, message
):
    def superseded():
        raise Superseded("Another process leads.")

    monkeypatch.setattr(store, "confirm", superseded)
    monkeypatch.setattr(type(store.lead), "is_certain", False)
    turn(plant, message, message)
    turn(plant, Heartbeat(epoch=7), Stop(id="", robot="ra1", mode=StopMode.HALT))
    assert plant.robots.messages == []
    assert {str(error) for error in crashes} == {"Another process leads."}


def test_a_plant_that_cannot_find_out_whether_it_leads_stops_robots_and_nothing_else(
    plant, store, monkeypatch, crashes
):
    asked = []

    def away():
        asked.append(1)
        raise ArboledaError("The server is away.")

    monkeypatch.setattr(store, "confirm", away)
    monkeypatch.setattr(type(store.lead), "is_certain", False)
    stop = Stop(id="", robot="ra1", mode=StopMode.HALT)
    turn(plant, ON, stop, Heartbeat(epoch=7))
    assert plant.robots.messages == [stop, Heartbeat(epoch=7)]
    assert [str(error) for error in crashes] == ["The server is away."]
    assert asked == [1]  # who waits for a server that is away for each message stops late
    heard = turn(plant)
    assert [type(event) for event in heard] == [Undelivered]


def test_a_stop_of_a_plant_that_leads_looks_at_no_file(plant, store, monkeypatch):
    monkeypatch.setattr(store, "confirm", lambda: pytest.fail("the memory was asked"))
    stops = [Stop(id="", robot=name, mode=StopMode.LATCH) for name in ("ra1", "rm1")]
    turn(plant, *stops)
    assert plant.robots.messages == stops


def test_what_settles_and_leaves_late_is_told_to_the_plant(plant, monkeypatch):
    now = plant.plant.now
    entry = Entry(ON, cell="sis_a", doing=OWN(text="switching"), sent_at=now, deadline=now + 5.0)
    entry.settles_at = now + 0.2
    plant.plant.dispatcher.ledger.open(entry)
    monkeypatch.setattr(orchestrator.clock, "seconds", lambda: now + 0.5)
    turn(plant, ON, OFF)
    (late,) = turn(plant)
    assert (type(late), late.id, late.late_s) == (LateDeparture, ON.id, pytest.approx(0.5))


@pytest.mark.parametrize(("renew_s", "begins"), [(None, False), (0.5, True)], ids=["a file", "a database"])
def test_a_leader_before_that_is_still_on_ros_keeps_no_other_from_leading(
    plant, store, monkeypatch, renew_s, begins
):
    topics, started = Topics(store, watched=False, diagnosed=False), []
    monkeypatch.setattr(topics, "check_alone", lambda: refuse("another node already commands"), raising=False)
    monkeypatch.setattr(store.lead, "renew_s", renew_s, raising=False)
    monkeypatch.setattr(plant.loop, "start", lambda: started.append(plant))
    monkeypatch.setattr(plant.stops.loop, "start", lambda: None)
    monkeypatch.setattr(plant.keeping.durability, "start", lambda: None)
    plant.connect_ros(topics)
    with nullcontext() if begins else pytest.raises(StartError, match="already commands"):
        plant.start()
    assert started == ([plant] if begins else [])


def refuse(sentence: str) -> None:
    raise StartError(sentence)


@pytest.fixture
def syncs(plant, store, monkeypatch):
    """The number of messages that had left by each sync."""
    found, sync = [], store.sync
    monkeypatch.setattr(store, "sync", lambda: (found.append(len(plant.robots.seen)), sync())[1])
    return found


def test_a_command_leaves_once_what_was_kept_for_it_is_durable(plant, syncs):
    turn(plant, Heartbeat(epoch=7), GRIP, ACT, ON)
    assert syncs == [1]


def test_a_command_does_not_wait_until_it_is_durable_where_a_task_stands(plant, syncs):
    turn(plant, Remember(fact=Fact.STEP, name="a", value="[]"), ON)
    assert plant.robots.messages == [ON] and syncs == []


STEP = Remember(fact=Fact.STEP, name="a", value="[]")


class Sent:
    """A port that keeps what left, and asks nothing of the store."""

    def __init__(self) -> None:
        self.messages: list[object] = []

    def send(self, message: object) -> None:
        self.messages.append(message)


def test_where_a_task_stands_is_committed_once_its_command_has_left(plant, store, monkeypatch):
    port, keep, had_left = Sent(), store.keep, []
    plant.connect(port)
    monkeypatch.setattr(store, "keep", lambda *facts: (had_left.append(len(port.messages)), keep(*facts)))
    turn(plant, STEP, ON)
    assert port.messages == [ON] and had_left == [1]
    assert store.facts(Fact.STEP) == {"a": "[]"}


def test_the_files_of_a_memory_are_looked_at_right_after_a_command_and_at_each_heartbeat(
    plant, store, monkeypatch
):
    port, had_left = Sent(), []
    plant.connect(port)
    monkeypatch.setattr(store, "confirm", lambda: had_left.append(len(port.messages)))
    turn(plant, STEP, ON)
    turn(plant, Heartbeat(epoch=7))
    assert had_left == [1, 1]


def test_once_a_memory_is_not_in_its_place_no_further_command_leaves(plant, store, crashes):
    port = Sent()
    plant.connect(port)
    store.path.unlink()
    turn(plant, STEP, ON)
    turn(plant, OFF)
    assert port.messages == [ON]
    assert "was deleted or moved away" in str(crashes[0])


def test_a_plant_that_cannot_commit_what_left_its_commands_behind_ends(plant, store, crashes, monkeypatch):
    port = Sent()
    plant.connect(port)
    break_disk(store, monkeypatch)
    turn(plant, STEP, ON)
    assert port.messages == [ON] and [str(each) for each in crashes] == ["The disk is full."]


def test_a_stop_and_a_heartbeat_leave_whatever_is_not_durable(plant, syncs):
    halt = Stop(id="7-2", robot="ra1", mode=StopMode.HALT)
    turn(plant, GRIP, halt, Heartbeat(epoch=7))
    assert plant.robots.messages == [halt, Heartbeat(epoch=7)] and syncs == []


def test_a_sync_that_fails_ends_the_plant_and_nobody_is_told_what_it_was_for(
    plant, store, crashes, monkeypatch
):
    monkeypatch.setattr(store, "sync", lambda: refuse("The disk is broken."))
    told = plant.submit("sis_a 0B 1")
    plant.plant.says = lambda events: [GRIP, ON, replace(TASK, request=events[0].request)]
    plant.loop.turn()
    with pytest.raises(StartError, match="The disk is broken"):
        told.result(timeout=0)
    assert plant.robots.messages == [] and [str(each) for each in crashes] == ["The disk is broken."]
    (undelivered,) = turn(plant)
    assert undelivered.id == ON.id
