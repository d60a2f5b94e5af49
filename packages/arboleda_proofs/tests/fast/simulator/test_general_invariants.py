"""Each invariant of devices holds, and finds a bug that was planted for it, as do those of storage."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import pytest
from tests.lengths import length, sample
from tests.unit.kinds.tending import IDS, plant
from tests.unit.kinds.test_shared_devices import LAMP
from tests.unit.kinds.test_shared_devices import plant as sharing

from arboleda.core.cell_steps import WAITS
from arboleda.core.plant import Plant
from arboleda.dispatch import evidence
from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.effectors import Effectors
from arboleda.dispatch.evidence import CommandVerdict
from arboleda.dispatch.ledger import Feed
from arboleda.dispatch.obstacles import Obstacles
from arboleda.dispatch.outlet import Outlet
from arboleda.kinds.declared import Device, DeviceKind, DeviceVerb, Effect, FactType, VerbCall, WorkCall
from arboleda.kinds.person import person
from arboleda.model.cell_states import Cause, CellState
from arboleda.model.commands import OnStop, Process, Query, StopMode
from arboleda.model.messages import Failure, MotionState, Reason, Report, Verb
from arboleda.model.plant_model import Cell, Evidence, Interlock, Need, Place, PlantModel
from arboleda.recipes import Choice, Kit, parallel, recipe, work
from arboleda.sim.board import Board
from arboleda.sim.machine import MachineBody
from arboleda.sim.receipts import Receipts
from arboleda.trees import steps
from arboleda.trees.cell_commands import CellCommands
from arboleda.trees.cell_devices import CellDevices
from arboleda.trees.cell_time import CellTime
from arboleda.trees.cell_zones import CellZones
from arboleda.trees.interlocks import Interlocks
from arboleda.trees.needs import CellNeeds
from arboleda.trees.part_places import Places
from arboleda.wire.bridge import Bridge
from arboleda.wire.payloads import VerbGoal, encode
from arboleda.wire.transport import Publication
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.faults import OF_DEVICES as FAULTS_OF_DEVICES
from arboleda_proofs.simulator.faults import ON_ONE_HOST as JUDGED
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.invariants.devices import DEVICES
from arboleda_proofs.simulator.invariants.part_places import PLACES
from arboleda_proofs.simulator.judged import INVARIANTS, judged_by
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld
from arboleda_proofs.simulator.run import Simulation

Patch = pytest.MonkeyPatch
SHARING = sharing()
Weather = str | Mapping[str, float]
Bug = Callable[[Patch], None]
DOOR = FactType(type=str, words=("open", "closed"), first="open")
SHUT = (("door", "closed"),)
MILL = DeviceKind(
    name="mill",
    facts={"door": DOOR},
    verbs={
        "open": DeviceVerb(
            name="open", effect=Effect.MOTION, sets=(("door", "open"),), takes_s=2.0, at_most_s=8.0
        ),
        "close": DeviceVerb(name="close", effect=Effect.MOTION, sets=SHUT, takes_s=2.0, at_most_s=8.0),
        "run": DeviceVerb(name="run", effect=Effect.PROCESS, needs=SHUT, takes_s=4.0, at_most_s=20.0),
        "cool": DeviceVerb(
            name="cool",
            effect=Effect.PROCESS,
            needs=SHUT,
            takes_s=6.0,
            at_most_s=20.0,
            on_stop=OnStop.FINISH,
        ),
    },
)
LOOK = DeviceVerb(name="look", effect=Effect.QUERY, takes_s=0.3, at_most_s=3.0, answers=("good", "bad"))
EYE = DeviceKind(name="eye", facts={}, verbs={"look": LOOK})


@recipe("load")
def load(cell: Kit):  # type: ignore[no-untyped-def]
    """One arm brings a blank that was looked at into the mill, which works behind its door."""
    left, jaw, mill, eye = cell.devices("left", "jaw", "mill", "eye")
    seen = eye.look()
    fetch = left.visit("feed", jaw.close())
    mills = work(mill.close(), mill.run(), mill.cool(), mill.open())
    return work(seen, fetch, left.visit("vise", jaw.open()), mills, left.home())


@recipe("both")
def both(cell: Kit):  # type: ignore[no-untyped-def]
    """Both arms want the vise, and the mill wants to shut its door."""
    left, right, mill = cell.devices("left", "right", "mill")
    return parallel(left.visit("vise"), right.visit("vise"), work(mill.close(), mill.open()))


@recipe("careless")
def careless(cell: Kit):  # type: ignore[no-untyped-def]
    """The mill is told to run with its door open, which is refused."""
    return cell.device("mill").run()


@recipe("drops")
def drops(cell: Kit):  # type: ignore[no-untyped-def]
    """A recipe whose gripper lets go on its way."""
    left, jaw = cell.devices("left", "jaw")
    return work(
        left.visit("feed_2", jaw.close()), parallel(left.visit("vise"), work(cell.wait(0.3), jaw.open()))
    )


@recipe("looks")
def looks(cell: Kit):  # type: ignore[no-untyped-def]
    """The camera is asked twice."""
    return work(cell.device("eye").look(), cell.wait(1.0), cell.device("eye").look())


@recipe("peeks")
def peeks(cell: Kit):  # type: ignore[no-untyped-def]
    """The camera is to look into the mill, whose door is closed."""
    return work(cell.device("mill").close(), cell.device("eye").look())


@recipe("consults")
def consults(cell: Kit):  # type: ignore[no-untyped-def]
    """Somebody is asked, whose answers have an accent."""
    return cell.device("ana").ask("¿Sigue?", ["sí", "no"])


RECIPES = (load, both, careless, drops, looks)


def shop(*recipes: Any) -> PlantModel:
    """Two arms at a mill whose open door is what lets them into its vise, and a camera."""
    model = plant(*recipes)
    (cell,) = model.cells
    mill = Device(name="mill", mqtt="mill", **IDS, timeout_s=5.0, kind=MILL)
    eye = Device(name="eye", mqtt="eye", **IDS, timeout_s=5.0, kind=EYE)
    lock = Interlock(device="mill", zone="vise", free_while=(("door", "open"),))
    members = (*cell.members, ("mill", mill), ("eye", eye))
    return replace(model, cells=(replace(cell, members=members, interlocks=(lock,)),))


def staffed() -> PlantModel:
    """The shop with somebody in it."""
    model = shop(consults)
    (cell,) = model.cells
    members = (*cell.members, ("ana", person("ana")))
    return replace(model, cells=(replace(cell, members=members),))


def peeping() -> PlantModel:
    """The shop with a camera that looks into the mill, so it needs the door open."""
    model = shop(peeks)
    (cell,) = model.cells
    need = Need(device="eye", word="look", other="mill", fact="door", value="open")
    return replace(model, cells=(replace(cell, needs=(need,)),))


@recipe("bring", ends_with={"vise": 1})
def bring(cell: Kit):  # type: ignore[no-untyped-def]
    """A part is put into the vise and taken out again, which is not what the recipe says of its end."""
    left, jaw = cell.devices("left", "jaw")
    put = [left.visit("feed", jaw.close()), left.visit("vise", jaw.open())]
    return work(*put, left.visit("vise", jaw.close()), left.visit("feed", jaw.open()))


@recipe("forgets")
def forgets(cell: Kit):  # type: ignore[no-untyped-def]
    """A part is left in the vise, which belongs to the mill."""
    left, jaw = cell.devices("left", "jaw")
    return work(left.visit("feed", jaw.close()), left.visit("vise", jaw.open()), left.home())


@recipe("keeps")
def keeps(cell: Kit):  # type: ignore[no-untyped-def]
    """The gripper keeps its part to the end."""
    left, jaw = cell.devices("left", "jaw")
    return work(left.visit("feed", jaw.close()), left.home())


@recipe("twice")
def twice(cell: Kit):  # type: ignore[no-untyped-def]
    """A second part is taken where there was only one."""
    left, jaw = cell.devices("left", "jaw")
    first = [left.visit("feed", jaw.close()), left.visit("vise", jaw.open())]
    return work(*first, left.visit("feed", jaw.close()), left.visit("feed", jaw.open()))


def storing() -> PlantModel:
    """The shop with a feed that people keep filled, and a vise that belongs to the mill."""
    model = shop(bring, forgets, keeps, twice)
    (cell,) = model.cells
    places = (Place(target="feed", supply=True), Place(target="vise", device="mill"))
    return replace(model, cells=(replace(cell, places=places),))


def run(
    seed: int,
    weather: Weather = "none",
    *,
    only: str = "",
    cycles: int = 4,
    seconds: float | None = None,
    model: PlantModel | None = None,
) -> BrokenInvariant | None:
    """The broken invariant; `only`: this one alone; `seconds`: so long, however many cycles that are."""
    model = model or shop(load, both, careless)
    if isinstance(weather, str):
        climate = Climate.draw(model, seed, weather)
    else:
        climate = Climate.from_file(model, seed, {"rates": weather})
    judges = tuple(each for each in judged_by() if only in ("", each.name))
    simulation = Simulation(model, seed, climate.faults, invariants=judges)
    return simulation.run(cycles=cycles, seconds=seconds).broken


@pytest.mark.long
@pytest.mark.parametrize("seed", sample(range(1, 5), every=4))
def test_all_of_them_hold_in_bad_weather(seed: int) -> None:
    assert run(seed, "normal", cycles=3) is None
    assert run(seed, "normal", cycles=6, model=SHARING) is None


@pytest.mark.sampled(5)
@pytest.mark.parametrize("kind", sample(FAULTS_OF_DEVICES, every=2))
def test_all_of_them_hold_where_devices_fail_in_this_way_alone(kind: str) -> None:
    assert kind in JUDGED
    assert run(1, {kind: 12.0}, cycles=3, seconds=length(25.0, whole=None)) is None


@pytest.mark.long
def test_a_task_of_any_recipe_that_fails_without_a_fault_is_found(monkeypatch: Patch) -> None:
    name = "no_task_fails_without_a_fault"
    assert run(1, only=name, model=shop(careless), cycles=1) is None, "the recipe fails by itself"
    monkeypatch.setattr(evidence, "reached", lambda entry, belief: False)
    broken = run(1, only=name, model=shop(load), cycles=1)
    assert broken is not None and broken.invariant == name


@pytest.mark.long
def test_a_shared_device_that_was_handed_on_need_not_be_as_the_task_left_it() -> None:
    @recipe("set")
    def set_lamp(cell: Kit, on=Choice(0, 1)):  # type: ignore[no-untyped-def]
        """The lamp that both cells have is switched, and is free while the cell waits."""
        return work(cell.device("lamp").light(on=bool(on)), cell.wait(0.1))

    lamp = Device(name="lamp", mqtt="lamp", **IDS, timeout_s=5.0, kind=LAMP)
    lamp = replace(lamp, evidence=Evidence.STATE)
    cells = [
        Cell(name=name, queue_limit=5, members=(("lamp", lamp),), shared=("lamp",), recipes=(set_lamp,))
        for name in ("left", "right")
    ]
    model = PlantModel(name="hall", cells=tuple(cells))
    assert run(1, only="what_a_task_left_is_so", model=model, cycles=60) is None


def machine_of(watched: JudgedWorld, name: str = "mill") -> MachineBody:
    body = watched.world.boards[name].body
    assert isinstance(body, MachineBody)
    return body


def test_a_device_gives_up_until_all_such_faults_have_ended() -> None:
    watched = JudgedWorld(shop(load))
    for seconds in (5.0, 10.0):
        watched.begin(Fault(kind="gives_up", at=0.0, target="mill", word="atasco", seconds=seconds))
    order = VerbGoal(verb="open", values=(), seq=1, epoch=1)
    told = []
    for _ in range(3):
        told.append(machine_of(watched).fails(order))
        watched.world.advance(6.0)
    assert told == ["atasco", "atasco", None]


def test_what_never_ends_ends_when_that_is_over() -> None:
    watched = JudgedWorld(shop(load), invariants=())  # nobody has asked for what it does
    watched.begin(Fault(kind="never_ends", at=0.0, target="mill", seconds=30.0))
    mill = machine_of(watched)
    mill.start(round(watched.world.now * 1e6), VerbGoal(verb="close", values=(), seq=1, epoch=1))
    watched.world.advance(29.0)
    assert mill.moving and mill.facts["door"] == "open"
    watched.world.advance(2.0)
    assert not mill.moving and mill.facts["door"] == "closed"


def test_no_day_passes_at_once_while_a_switch_is_late() -> None:
    watched = JudgedWorld(shop(load), invariants=())  # nobody has asked for what it does
    watched.begin(Fault(kind="never_ends", at=0.0, target="jaw", seconds=30.0))
    watched.begin(
        Fault(kind="plant_freeze", at=0.0, target="plant", word="plant", seconds=2.0, amount=80_000.0)
    )
    jaw = machine_of(watched, "jaw")
    jaw.start(round(watched.world.now * 1e6), VerbGoal(verb="close", values=(), seq=1, epoch=1))
    assert not jaw.moving
    watched.world.advance(3.0)
    assert watched.world.skipped_s == 0


def believed_at_once(patch: Patch) -> None:
    """A command counts as done when its robot has only accepted it."""
    done = CommandVerdict(feed=Feed.DONE)
    patch.setattr("arboleda.dispatch.evidence.judge", lambda *_: done)


def believed_on_its_word(patch: Patch) -> None:
    """Have the plant not look at a device's facts when the device says that it is done."""
    patch.setattr(evidence, "reached", lambda entry, belief: True)


def moves_while_its_tool_may_open(patch: Patch) -> None:
    """An arm moves although its gripper may still let go, late, as it was told to."""
    patch.setattr(Effectors, "opening_tool", lambda self, robot: None)


def zones_for_all(patch: Patch) -> None:
    """Zones are given to whoever asks, and nothing guards them."""
    patch.setattr(CellZones, "take", lambda self, robot, zones, *, inside=False: True)
    unguarded(patch)


def unguarded(patch: Patch) -> None:
    """Nothing is looked at before a command leaves, whatever the tree says."""
    patch.setattr(CellCommands, "_objection", lambda self, command: None)


def forgets_doors(patch: Patch) -> None:
    """A machine that shuts its door takes no zone."""
    patch.setattr(CellZones, "follow", lambda self, device: None)
    patch.setattr(Interlocks, "occupied_by", lambda self, device: frozenset())
    zones_for_all(patch)


def ignores_needs(patch: Patch) -> None:
    """Have the plant not look at the needs of a verb before it is sent."""
    patch.setattr(Obstacles, "_unmet", lambda self, command, *, was: None)


def ignores_needs_of_others(patch: Patch) -> None:
    """Have the plant not look at the needs of a verb that are of another device."""
    patch.setattr(CellNeeds, "objection", lambda self, command: None)


def books_no_part(patch: Patch) -> None:
    """Have the plant not book the parts that hands move."""
    patch.setattr(Places, "_move", lambda self, target, parts, hand: None)


def knows_no_place(patch: Patch) -> None:
    """Nobody looks whether a part is there, or room for one."""
    patch.setattr(Places, "objection", lambda self, command: None)


def ignores_needs_everywhere(patch: Patch) -> None:
    """Neither the plant nor the board of a device looks at what a verb needs."""
    ignores_needs(patch)
    objection = MachineBody.objection

    def lax(self: MachineBody, goal: VerbGoal, **state: bool) -> str | None:
        word = objection(self, goal, **state)
        return None if word == "condicion" else word

    patch.setattr(MachineBody, "objection", lax)


def stops_what_should_finish(patch: Patch) -> None:
    """A stop ends work that goes on through a stop."""

    def stop(self: Board, *, latch: bool) -> None:
        self.latched = self.latched or latch
        self._break_off()

    patch.setattr(Board, "_stop", stop)


def halts_what_should_finish(patch: Patch) -> None:
    """The plant takes all work for work that a stop ends."""
    patch.setattr(WorkCall, "on_stop", OnStop.HALT)


def halts_nothing_of_a_machine(patch: Patch) -> None:
    """The plant takes all work for work that goes on through a stop."""
    patch.setattr(WorkCall, "on_stop", OnStop.FINISH)


def needs_nothing(patch: Patch) -> None:
    """No command needs what its verb needs."""
    patch.setattr(VerbCall, "needs", ())


def starts_from_anywhere(patch: Patch) -> None:
    """Nobody asks where the robots of a cell stand before its task begins."""
    patch.setattr(CellZones, "astray", lambda zones: None)


def lets_time_pass(patch: Patch) -> None:
    """The time of a cell that is held goes on."""
    patch.setattr(CellTime, "pause", lambda time, at=None: None)


def lets_time_pass_in_the_end(patch: Patch) -> None:
    """The time in which a cell was held has passed for it once it goes on."""

    def go_on(time: CellTime) -> None:
        time._paused_at = None
        time._plan()

    patch.setattr(CellTime, "go_on", go_on)


def holds_what_moves(patch: Patch) -> None:
    """A cell counts as held as soon as somebody asks for it."""
    patch.setitem(WAITS, CellState.HOLDING, lambda run: run.become(Cause.HALTED) or True)


def says_halt_to_what_finishes(patch: Patch) -> None:
    """Work that is to finish stays open, and its device is told to halt."""
    cancel = Dispatcher.cancel

    def harsh(self: Dispatcher, entry: Any, now: float) -> None:
        if entry.finishes:
            self.outlet.stop(entry.command.robot, StopMode.HALT)
        cancel(self, entry, now)

    patch.setattr(Dispatcher, "cancel", harsh)


def gives_up_what_finishes(patch: Patch) -> None:
    """A stopped device is taken to have ended whatever it did."""
    device = evidence._device

    def lax(entry: Any, belief: Any, report: Report) -> Any:
        if entry.finishes and report.state is MotionState.STOP_LATCHED:
            stopped = evidence.STOPPED(robot=entry.command.robot, doing=entry.doing)
            return CommandVerdict(feed=Feed.HALTED, failure=Failure(reason=Reason.STOPPED, sentence=stopped))
        return device(entry, belief, report)

    patch.setattr(evidence, "_device", lax)


def runs_through_a_stop(patch: Patch) -> None:
    """A stopped machine finishes whatever it does."""
    patch.setattr(MachineBody, "stop", lambda self, now_us: None)


def forgets_its_latch(patch: Patch) -> None:
    """A stopped device takes orders."""
    objection = MachineBody.objection

    def lax(self: MachineBody, goal: VerbGoal, *, latched: bool, faulted: bool) -> str | None:
        return objection(self, goal, latched=False, faulted=faulted)

    patch.setattr(MachineBody, "objection", lax)


def any_answer_counts(patch: Patch) -> None:
    """Whatever a device answered last is taken for the answer to what it was asked now."""

    def answered(entry: Any, belief: Any, report: Any) -> CommandVerdict | None:
        return None if report.answer is None else CommandVerdict(feed=Feed.DONE, answer=report.answer)

    patch.setitem(evidence.RULES, (Query, Evidence.IDS), answered)


def tells_nobody(patch: Patch) -> None:
    """Commands of other nodes are refused without a word."""
    patch.setattr(Bridge, "_report", lambda self, unsure: [])


def obeys_anybody(patch: Patch) -> None:
    """Commands of other nodes are obeyed though a plant is heard."""
    patch.setattr(Bridge, "_is_commanded", lambda self, at: False)


def takes_old_orders(patch: Patch) -> None:
    """A board takes every number."""
    patch.setattr(Receipts, "objection", lambda self, goal: None)
    patch.setattr(Receipts, "repeats", lambda self, goal: False)


def halts_nothing(patch: Patch) -> None:
    """Work whose step is left is not halted."""
    patch.setattr(Outlet, "stop", lambda self, robot, mode: None)


def forgets_grips(patch: Patch) -> None:
    """Have the plant not keep the grips of devices for the next start."""
    patch.setattr(Effectors, "set", lambda self, robot, grip: self.grips.set(robot, grip))


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

    def fails(self: Obstacles, command: Any, *, was: bool) -> None:
        raise ZeroDivisionError

    patch.setattr(Obstacles, "_unmet", fails)


def knows_no_accents(patch: Patch) -> None:
    """A word with an accent is none of the answers."""
    of_ascii = lambda word, names: next((name for name in names if word.isascii() and name == word), None)  # noqa: E731
    patch.setattr("arboleda.core.verbs.answering.matching", of_ascii)


def advises_nothing(patch: Patch) -> None:
    """Nobody is told what leads a cell out of a hold."""
    patch.setattr(Plant, "advice", lambda self, cell: ())


def shared_with_all(patch: Patch) -> None:
    """Have the plant give shared devices to whoever asks, and guard them by nothing."""
    patch.setattr(CellDevices, "take", lambda self, devices: True)
    unguarded(patch)


Scenario = Callable[[JudgedWorld], None]


def at_work(watched: JudgedWorld, verb: str) -> None:
    """A task is on its way until the mill carries out this verb."""
    watched.world.request_task("tending load")
    seen = watched.world.obeyed
    assert watched.world.advance(60.0, lambda: getattr(seen.get("mill"), "verb", None) == verb)
    watched.world.advance(1.0)


def asked_at(verb: str, asked: Verb) -> Scenario:
    """A scenario: an operator asks for this while the mill carries out its verb."""

    def scenario(watched: JudgedWorld) -> None:
        at_work(watched, verb)
        watched.world.request_verb(asked, "tending")
        watched.world.advance(10.0)

    return scenario


def held_for_a_while(watched: JudgedWorld) -> None:
    """A cell is held at work for some seconds, and goes on."""
    at_work(watched, "close")
    watched.world.request_verb(Verb.HOLD, "tending")
    watched.world.advance(5.0)
    watched.world.request_verb(Verb.RESUME, "tending")
    watched.world.advance(5.0)


def ordered_while_stopped(watched: JudgedWorld) -> None:
    """Somebody tells a stopped mill to shut its door, under a number that counts."""
    watched.world.request_verb(Verb.STOP)
    watched.world.advance(1.0)
    goal = VerbGoal(verb="close", values=(), seq=1, epoch=4_000_000_000)
    watched.world.publish(Publication(topic="mill/orden", payload=encode(goal)))
    watched.world.advance(1.0)


def stopped_inside(watched: JudgedWorld) -> None:
    """An arm is stopped in a shared zone and stays there, and the next task comes."""
    watched.world.request_task("tending both")
    assert watched.world.advance(30.0, lambda: bool(watched.truth.robots["left"].zones))
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET, Verb.RESUME):
        watched.world.request_verb(verb, "tending")
        watched.world.advance(5.0)
    watched.world.request_task("tending load")
    watched.world.advance(5.0)


def told(text: str) -> Scenario:
    def scenario(watched: JudgedWorld) -> None:
        watched.world.request_task(f"tending {text}")
        watched.world.advance(60.0)

    return scenario


def says_yes(watched: JudgedWorld) -> None:
    """Somebody is asked, and says one of the words that are offered."""
    watched.world.request_task("tending consults")
    watched.world.advance(2.0)
    watched.world.request_verb(Verb.ANSWER, "ana", arguments=(("answer", "sí"),))
    watched.world.advance(2.0)


def no_bug(patch: Patch) -> None:
    """The recipe itself is wrong."""


PEEKS = told("peeks")
OF_PLACES = [each.name for each in PLACES]
BITES: list[tuple[str, Bug, Scenario | Weather]] = [
    ("what_is_done_was_so", believed_at_once, told("load")),
    ("what_is_done_was_so", believed_on_its_word, {"only_says_done": 20.0}),
    ("what_a_task_left_is_so", believed_on_its_word, {"only_says_done": 20.0}),
    ("needs_hold", ignores_needs_everywhere, told("careless")),
    ("no_command_against_a_need", ignores_needs, told("careless")),
    ("no_command_against_a_need_of_others", ignores_needs_of_others, PEEKS),
    ("recipes_end_as_they_say", no_bug, told("bring")),
    ("done_tasks_leave_nothing_behind", no_bug, told("forgets")),
    ("done_tasks_leave_nothing_behind", no_bug, told("keeps")),
    ("books_of_parts_are_true", books_no_part, told("forgets")),
    ("parts_are_taken_and_put_where_they_can_be", knows_no_place, told("twice")),
    ("parts_and_room_are_missed_where_there_are_none", books_no_part, told("bring")),
    ("finishing_work_is_finished", stops_what_should_finish, asked_at("cool", Verb.STOP)),
    ("finishing_work_is_not_halted", halts_what_should_finish, asked_at("cool", Verb.CANCEL)),
    ("finishing_work_is_not_halted", says_halt_to_what_finishes, asked_at("cool", Verb.CANCEL)),
    ("finishing_work_is_not_halted", gives_up_what_finishes, asked_at("cool", Verb.STOP)),
    ("commands_are_as_declared", needs_nothing, told("load")),
    ("nothing_is_dropped", no_bug, told("drops")),
    ("nothing_is_dropped", moves_while_its_tool_may_open, {"never_ends": 10.0}),
    ("an_answer_is_to_its_question", any_answer_counts, told("looks")),
    ("offered_answers_are_accepted", knows_no_accents, says_yes),
    ("commands_of_others_are_told", tells_nobody, {"foreign_command": 10.0}),
    ("bridge_obeys_only_its_plant", obeys_anybody, {"foreign_command": 10.0}),
    ("executed_numbers_rise", takes_old_orders, {"foreign_old": 10.0}),
    ("a_shared_device_serves_one_cell", shared_with_all, "none"),
    ("speed_never_rises_after_stop", runs_through_a_stop, asked_at("close", Verb.STOP)),
    ("latched_board_stays_still", forgets_its_latch, ordered_while_stopped),
    ("stop_holds", forgets_its_latch, ordered_while_stopped),
    ("time_stands_still_where_held", lets_time_pass, asked_at("close", Verb.HOLD)),
    ("time_stands_still_where_held", lets_time_pass_in_the_end, held_for_a_while),
    ("held_cells_stand_still", holds_what_moves, asked_at("close", Verb.HOLD)),
    ("halted_moves_sent_halt", halts_nothing, {"operator_hold": 10.0}),
    ("halted_moves_sent_halt", halts_nothing_of_a_machine, asked_at("close", Verb.CANCEL)),
    ("tasks_start_where_all_is_ready", starts_from_anywhere, stopped_inside),
    ("one_robot_per_zone", zones_for_all, told("both")),
    ("one_robot_per_zone", forgets_doors, told("both")),
    ("zone_entered_only_when_held", zones_for_all, told("both")),
    ("ends_are_proven", believed_at_once, told("load")),
    ("kept_is_what_is", forgets_grips, told("load")),
    ("each_task_ends_once", told_twice, told("load")),
    ("no_internal_failure", raises_at_a_verb, told("load")),
    ("at_rest_at_end", advises_nothing, {"operator_stop": 6.0}),
]
LIKELY = {  # seeds that found them, tried first
    ("what_a_task_left_is_so", believed_on_its_word): 9,
    ("nothing_is_dropped", moves_while_its_tool_may_open): 5,
}


@pytest.mark.sampled(22)
@pytest.mark.parametrize(("name", "bug", "how"), BITES, ids=[f"{n}: {b.__name__}" for n, b, _ in BITES])
def test_it_bites(monkeypatch: Patch, name: str, bug: Bug, how: Scenario | Weather) -> None:
    bug(monkeypatch)
    monkeypatch.setattr(
        "arboleda_proofs.simulator.run.PATIENCE", 1
    )  # a cell that is held does not wait for long
    monkeypatch.setattr("arboleda_proofs.simulator.judged_world.REST_S", 60.0)
    if callable(how):
        model = (
            peeping()
            if bug is ignores_needs_of_others
            else staffed()
            if bug is knows_no_accents
            else storing()
            if name in OF_PLACES
            else shop(*RECIPES)
        )
        watched = JudgedWorld(model, invariants=[each for each in INVARIANTS if each.name == name])
        with pytest.raises(BrokenInvariant, match=name):
            how(watched)
    else:
        model = SHARING if bug is shared_with_all else None
        seeds = sorted(range(1, 11), key=lambda seed: seed != LIKELY.get((name, bug)))
        found = (run(seed, how, only=name, cycles=3, model=model) for seed in seeds)
        assert any(broken is not None and broken.invariant == name for broken in found)


OWN_PLANT = ["nothing_is_dropped", "offered_answers_are_accepted", *OF_PLACES]
SCENARIOS = [each for name, _, each in BITES if callable(each) and name not in OWN_PLANT]


@pytest.mark.sampled(13)
@pytest.mark.parametrize("how", sample(SCENARIOS, every=2))
def test_it_finds_nothing_where_there_is_no_bug(how: Scenario) -> None:
    how(JudgedWorld(peeping() if how is PEEKS else shop(*RECIPES)))


def test_a_halt_is_none_of_the_work_that_leaves_after_it_in_the_same_step() -> None:
    """A mill that never shuts its door is halted, and told to cool instead."""

    @recipe("anyway")
    def anyway(cell: Kit):  # type: ignore[no-untyped-def]
        """The mill shuts its door, or cools as it is."""
        mill = cell.device("mill")
        return cell.fallback(mill.close(), mill.cool())

    verbs = {"close": MILL.verbs["close"], "cool": replace(MILL.verbs["cool"], needs=())}
    mill = Device(name="mill", mqtt="mill", **IDS, timeout_s=5.0, kind=replace(MILL, verbs=verbs))
    cell = Cell(name="c", queue_limit=5, members=(("mill", mill),), recipes=(anyway,))
    model = PlantModel(name="shop", cells=(cell,))
    assert run(1, {"never_ends": 10.0}, only="finishing_work_is_not_halted", model=model, cycles=5) is None


def test_a_process_that_nobody_saw_at_work_is_not_done(monkeypatch: Patch) -> None:
    """Its facts may be older than it: the door of a mill that is told to shut it once more is shut."""

    @recipe("shut")
    def shut(cell: Kit):  # type: ignore[no-untyped-def]
        """The mill is told twice to shut its door."""
        return work(cell.device("mill").close(), cell.device("mill").close())

    def lax(entry: Any, *_: object) -> CommandVerdict | None:
        return CommandVerdict(feed=Feed.DONE) if entry.observations.on_goal_since else None

    closing = replace(MILL.verbs["close"], effect=Effect.PROCESS)
    mill = Device(
        name="mill", mqtt="mill", **IDS, timeout_s=5.0, kind=replace(MILL, verbs={"close": closing})
    )
    members = (("mill", replace(mill, evidence=Evidence.JOINTS)),)
    model = PlantModel(name="shop", cells=(Cell(name="c", queue_limit=5, members=members, recipes=(shut,)),))
    assert run(1, model=model, cycles=3) is None
    monkeypatch.setitem(evidence.RULES, (Process, Evidence.JOINTS), lax)
    broken = run(1, only="ends_are_proven", model=model, cycles=3)
    assert broken is not None and broken.invariant == "ends_are_proven"


def test_an_answer_that_is_not_offered_may_be_refused() -> None:
    watched = JudgedWorld(staffed())
    watched.world.request_task("tending consults")
    watched.world.advance(2.0)
    watched.world.request_verb(Verb.ANSWER, "ana", arguments=(("answer", "quizá"),))
    says_yes(watched)


def test_a_recovery_that_leaves_a_low_place_sideways_is_found(monkeypatch: Patch) -> None:
    @recipe("rests")
    def rests(cell: Kit):  # type: ignore[no-untyped-def]
        return cell.device("left").visit("feed", cell.wait(5.0))

    monkeypatch.setattr(steps, "_rise", lambda context, robot: [])
    rule = [each for each in INVARIANTS if each.name == "low_robots_rise_first"]
    watched = JudgedWorld(shop(rests), invariants=rule)
    watched.world.request_task("tending rests")
    arm = watched.truth.robot("left")
    assert watched.world.advance(20.0, until=lambda: arm.here == {"feed"})
    watched.world.advance(1.0)
    watched.world.request_verb(Verb.CANCEL, "tending")
    with pytest.raises(BrokenInvariant, match="left leaves feed sideways"):
        watched.world.advance(5.0)


def test_every_invariant_of_devices_has_a_bug() -> None:
    elsewhere = {
        "a_shared_device_is_handed_on_empty_at_home",  # test_shared_robots.py
        "numbers_lie_within_their_limits",  # tools/tests/mutants/test_bugs_of_devices.py
    }
    assert {each.name for each in (*DEVICES, *PLACES)} <= {name for name, _, _ in BITES} | elsewhere
    assert {name for name, _, _ in BITES} <= {each.name for each in INVARIANTS}


def test_a_motion_on_an_operators_word_is_no_step_that_was_left() -> None:
    watched = JudgedWorld(staffed())
    watched.world.advance(1.0)
    watched.world.request_verb(Verb.DO, "mill", arguments=(("work", "close"),))
    told = watched.world.advance(
        10.0, lambda: getattr(watched.world.obeyed.get("mill"), "verb", "") == "close"
    )
    assert told
    watched.world.advance(10.0)
