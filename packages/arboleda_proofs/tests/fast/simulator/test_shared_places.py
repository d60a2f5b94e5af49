"""The judge of places: what two cells do at one place, and what nobody can know."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.kinds.test_places import HANDED_OVER, SUPPLIED_ON_THE_RIGHT

from arboleda.model.commands import Home
from arboleda.model.messages import Verb
from arboleda.plant_file.loader import load
from arboleda.trees.asked_places import AskedPlaces
from arboleda_proofs.simulator.invariants.liveness import no_starvation
from arboleda_proofs.simulator.invariants.part_places import PLACES, done_tasks_leave_nothing_behind
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld

from .test_general_invariants import storing

PLANT = """
name: two
uses: [recipes.py]
kinds:
  hand:
    facts: {closed: bool}
    verbs:
      close: {effect: switch, sets: {closed: true}, holds: part, takes_s: 0.2}
      open:  {effect: switch, sets: {closed: false}, holds: part, takes_s: 0.2}
  rotor: {verbs: {spin: {effect: process, takes_s: 4, works_on: part}}}
shared:
  arm: {kind: arm, model: scara}
  hand: {kind: hand, tool_of: arm}
  rotor: {kind: rotor}
cells:
  left:
    devices: {arm: {shared: arm}, hand: {shared: hand}, rotor: {shared: rotor}, ana: {kind: person}}
    targets: &targets
      home: {arm: {deg: [0, 0], mm: 0}}
      feed: {arm: {deg: [60, 20], mm: 40}}
      seat: {arm: {deg: [30, 20], mm: 40}}
      bin: {arm: {deg: [-40, 20], mm: 40}}
    places: &places {feed: {supply: true}, seat: {of: rotor}, bin: {output: true}}
  right:
    devices: {arm: {shared: arm}, hand: {shared: hand}, rotor: {shared: rotor}, bob: {kind: person}}
    targets: *targets
    places: *places
"""
RECIPE = """
from arboleda.recipes import recipe, work

@recipe("spin")
def spin(cell):
    arm, hand, rotor = cell.devices("arm", "hand", "rotor")
    take, put = lambda at: arm.visit(at, hand.close()), lambda at: arm.visit(at, hand.open())
    return work(take("feed"), put("seat"), arm.home(), rotor.spin(), take("seat"), put("bin"))

@recipe("fill", ends_with={"seat": 1})
def fill(cell):
    arm, hand = cell.devices("arm", "hand")
    return work(arm.visit("feed", hand.close()), arm.visit("seat", hand.open()), arm.home(), cell.wait(20.0))

@recipe("empty", ends_with={"seat": 0})
def empty(cell):
    arm, hand = cell.devices("arm", "hand")
    return work(arm.visit("seat", hand.close()), arm.visit("bin", hand.open()), arm.home())

@recipe("rest")
def rest(cell):
    return cell.wait(0.3)
"""


def judged(folder: Path) -> JudgedWorld:
    (folder / "recipes.py").write_text(RECIPE, "utf-8")
    (folder / "plant.yaml").write_text(PLANT, "utf-8")
    return JudgedWorld(load(folder / "plant.yaml"))


def test_a_task_that_waits_for_a_device_has_not_begun_with_the_part_that_another_cell_has_there(
    tmp_path: Path,
) -> None:
    watched = judged(tmp_path)
    seat = watched.truth.places.cells["right"]
    watched.world.request_task("left spin")
    watched.world.advance(8.0)
    assert seat.parts["seat"] == 1
    watched.world.request_task("right spin")
    watched.world.advance(40.0)
    assert [task.state.value for task in watched.world.plant.intake.tasks.values()] == ["done", "done"]
    assert seat.at_begin["seat"] == seat.at_end["seat"] == 0


def test_people_see_to_a_place_for_the_tasks_of_each_cell(tmp_path: Path) -> None:
    world = judged(tmp_path).world
    world.request_task("left spin")
    world.request_task("right spin")
    world.advance(50.0)
    assert [task.state.value for task in world.plant.intake.tasks.values()] == ["done", "done"]


def test_a_task_beside_a_shared_hand_does_not_answer_for_the_part_that_the_other_cell_has_in_it(
    tmp_path: Path,
) -> None:
    world = judged(tmp_path).world
    world.request_task("left spin")
    assert world.advance(20.0, lambda: bool(world.boards["hand"].body.facts["closed"]))
    world.request_task("right rest")
    world.advance(0.5)
    tasks = [task.state.value for task in world.plant.intake.tasks.values()]
    assert tasks == ["running", "done"] and world.boards["hand"].body.facts["closed"]


def test_a_task_ends_with_the_parts_that_it_left_whatever_another_cell_takes_afterwards(
    tmp_path: Path,
) -> None:
    watched = judged(tmp_path)
    watched.world.request_task("left fill")
    watched.world.advance(9.0)
    watched.world.request_task("right empty")
    watched.world.advance(25.0)
    assert [task.state.value for task in watched.world.plant.intake.tasks.values()] == ["done", "done"]
    places = watched.truth.places.cells["left"]
    assert (places.at_end["seat"], places.as_left["seat"]) == (0, 1)


WITHOUT_PLACES = """
  right:
    devices: {arm: {shared: arm}, hand: {shared: hand}, bob: {kind: person}}
    targets:
      home: {arm: {deg: [0, 0], mm: 0}}
      shelf: {arm: {deg: [100, 20], mm: 40}}
      bench: {arm: {deg: [-90, 20], mm: 40}}
    recipes: [move]
"""
MOVES = """
from arboleda.recipes import recipe, work

def carry(cell, source, goal):
    arm, hand = cell.devices("arm", "hand")
    return arm.visit(source, hand.close()), arm.visit(goal, hand.open()), arm.home()

@recipe("move")
def move(cell):
    return work(*carry(cell, "shelf", "bench"))

@recipe("forget", ends_with={"seat": 0})
def forget(cell):
    return work(*carry(cell, "feed", "seat"), cell.wait(15.0))
"""


def test_what_the_other_cell_puts_where_this_one_has_no_place_says_nothing_of_its_parts(
    tmp_path: Path,
) -> None:
    left = PLANT.partition("  right:")[0].replace("    places:", "    recipes: [forget]\n    places:")
    (tmp_path / "recipes.py").write_text(MOVES, "utf-8")
    (tmp_path / "plant.yaml").write_text(left + WITHOUT_PLACES.lstrip("\n"), "utf-8")
    world = JudgedWorld(load(tmp_path / "plant.yaml")).world
    world.request_task("left forget")
    world.request_task("right move")
    assert world.advance(30.0, lambda: world.plant.intake.tasks["t-1000-2"].state.value == "done")
    with pytest.raises(BrokenInvariant, match="t-1000-1 is called done, and seat is 1, not 0"):
        world.advance(15.0)


def test_what_nobody_could_know_at_the_end_of_a_task_is_not_judged_by_what_the_next_one_knows() -> None:
    watched = JudgedWorld(storing(), invariants=[done_tasks_leave_nothing_behind])
    watched.world.request_task("tending forgets")
    watched.world.request_task("tending forgets")
    watched.world.advance(1.0)
    places = watched.truth.places.cells["tending"]
    places.is_doubtful = True
    watched.world.advance(10.0)
    assert places.end_is_doubtful and not places.is_doubtful


GATES = """
name: locks
uses: [recipes.py]
kinds:
  gate:
    facts: {at: [shut, open]}
    verbs: {open: {effect: motion, sets: {at: open}}, shut: {effect: motion, sets: {at: shut}}}
shared: {gate: {kind: gate}}
cells:
  left: {devices: {gate: {shared: gate}, ana: {kind: person}}}
  right: {devices: {gate: {shared: gate}, bob: {kind: person}}}
"""
THROUGH = """
from arboleda.recipes import recipe, work

@recipe("through", ends_with={"gate.at": "shut"})
def through(cell):
    gate = cell.device("gate")
    return work(gate.open(), gate.shut(), cell.wait(3.0))

@recipe("ajar", ends_with={"gate.at": "shut"})
def ajar(cell):
    return work(cell.device("gate").open(), cell.wait(3.0))

@recipe("rest", ends_with={"gate.at": "shut"})
def rest(cell):
    return cell.wait(3.0)

@recipe("air")
def air(cell):
    return cell.device("gate").open()
"""


def gates(folder: Path) -> JudgedWorld:
    (folder / "recipes.py").write_text(THROUGH, "utf-8")
    (folder / "plant.yaml").write_text(GATES, "utf-8")
    return JudgedWorld(load(folder / "plant.yaml"), invariants=PLACES)


@pytest.mark.parametrize("first", ["left through", "left rest"])
def test_a_task_ends_with_a_shared_device_as_it_gave_that_back(tmp_path: Path, first: str) -> None:
    world = gates(tmp_path).world
    world.request_task(first)
    world.advance(2.5)
    world.request_task("right ajar")
    world.advance(2.0)
    done = next(iter(world.plant.intake.tasks.values()))
    assert done.state.value == "done" and world.boards["gate"].body.facts["at"] == "open"


@pytest.mark.parametrize("between", ["right through", ""])
def test_a_task_that_gives_a_shared_device_back_otherwise_than_it_says_is_found(
    tmp_path: Path, between: str
) -> None:
    world = gates(tmp_path).world
    world.request_task("left ajar")
    world.advance(1.0)
    if between:
        world.request_task(between)
    with pytest.raises(BrokenInvariant, match=r"t-1000-1 is called done, and gate\.at is open"):
        world.advance(6.0)


def test_a_task_that_never_takes_a_shared_device_leaves_it_as_other_cells_do(tmp_path: Path) -> None:
    world = gates(tmp_path).world
    for task in ("right air", "left rest"):
        world.request_task(task)
        world.advance(4.0)
    ended = [task.state.value for task in world.plant.intake.tasks.values()]
    assert ended == ["done", "done"] and world.boards["gate"].body.facts["at"] == "open"


WITH_A_LAMP = """
name: desk
uses: [recipes.py]
kinds:
  lamp: {facts: {lit: bool}, verbs: {light: {effect: switch, with: {on: bool}, sets: {lit: $on}}}}
cells:
  desk:
    devices: {arm: {kind: arm, model: scara}, lamp: {kind: lamp, evidence: facts}}
    targets: {home: {arm: {deg: [0, 0], mm: 0}}}
"""


def test_home_of_a_plant_is_no_matter_of_devices_that_have_no_homing(tmp_path: Path) -> None:
    code = 'from arboleda.recipes import recipe\n\n@recipe("rest")\ndef rest(cell):\n'
    (tmp_path / "recipes.py").write_text(f'{code}    return cell.device("arm").home()\n', "utf-8")
    (tmp_path / "plant.yaml").write_text(WITH_A_LAMP, "utf-8")
    world = JudgedWorld(load(tmp_path / "plant.yaml")).world
    world.advance(1.0)
    homed: list[str] = []
    world.watchers.append(lambda: homed.extend(c.robot for c in world.moment.sent if isinstance(c, Home)))
    world.request_verb(Verb.HOME, "")
    world.advance(0.05)
    assert homed == ["arm"]


def test_parts_stay_in_doubt_where_a_task_begins_in_the_middle_of_a_grip(tmp_path: Path) -> None:
    seat = judged(tmp_path).truth.places.cells["left"]
    for hands, is_doubtful in ((["hand"], True), ([], False)):
        seat.is_doubtful = True
        seat.begin("t-1", seat.cell.recipes[0], {"seat": 0}, hands)
        assert seat.is_doubtful is is_doubtful


READER = """
name: two
uses: [recipes.py]
kinds:
  reader:
    facts: {clamped: bool}
    verbs:
      clamp: {effect: switch, with: {'on': bool}, sets: {clamped: $on}, holds: part}
shared:
  reader: {kind: reader}
cells:
  left: {devices: {reader: {shared: reader}, ana: {kind: person}}}
  right: {devices: {reader: {shared: reader}, bob: {kind: person}}}
"""
CLAMPS = """
from arboleda.recipes import recipe, work

@recipe("clamp")
def clamp(cell):
    return work(cell.device("reader").clamp(on=True))

@recipe("rest")
def rest(cell):
    return work(cell.wait(1.0))
"""


def test_what_a_shared_device_holds_is_left_by_the_cell_that_commanded_it_last(tmp_path: Path) -> None:
    (tmp_path / "recipes.py").write_text(CLAMPS, "utf-8")
    (tmp_path / "plant.yaml").write_text(READER, "utf-8")
    world = JudgedWorld(load(tmp_path / "plant.yaml"), invariants=PLACES).world
    world.request_task("left clamp")
    world.advance(5.0)
    world.request_task("right rest")
    world.advance(5.0)
    assert [task.state.value for task in world.plant.intake.tasks.values()] == ["failed", "done"]


def test_a_run_comes_to_rest_once_its_boards_have_done_what_the_plant_has_given_up(tmp_path: Path) -> None:
    slow = READER.replace("holds: part", "takes_s: 25")
    (tmp_path / "recipes.py").write_text(CLAMPS, "utf-8")
    (tmp_path / "plant.yaml").write_text(slow, "utf-8")
    watched = JudgedWorld(load(tmp_path / "plant.yaml"))
    watched.world.request_task("left clamp #lot-1")
    watched.world.advance(1.0)
    watched.world.request_verb(Verb.CANCEL, "left")
    watched.come_to_rest()
    assert watched.world.boards["reader"].body.facts["clamped"] is True


def handed_over(folder: Path) -> JudgedWorld:
    """A world in which a task of the left cell has failed, and the right one has brought a part to both."""
    (folder / "recipes.py").write_text(HANDED_OVER, "utf-8")
    (folder / "plant.yaml").write_text(SUPPLIED_ON_THE_RIGHT, "utf-8")
    watched = JudgedWorld(load(folder / "plant.yaml"))
    for task in ("left fail", "right bring"):
        watched.world.request_task(task)
        watched.world.advance(10.0)
    watched.world.request_verb(Verb.RESUME, "left")
    watched.world.request_task("left rest")
    return watched


def test_a_cell_goes_on_after_a_failure_whatever_another_one_brings_meanwhile(tmp_path: Path) -> None:
    watched = handed_over(tmp_path)
    watched.world.advance(3.0)
    assert [each.state.value for each in watched.world.plant.intake.tasks.values()] == [
        "failed",
        "done",
        "done",
    ]


def test_a_question_about_what_another_cell_has_brought_excuses_no_wait(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(AskedPlaces, "moved_by_others", lambda self, target, parts: None)
    watched = handed_over(tmp_path)
    with pytest.raises(BrokenInvariant, match=f"{no_starvation.name}.*left is ready"):
        watched.world.advance(3.0)
