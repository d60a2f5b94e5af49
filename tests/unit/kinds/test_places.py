"""The books of parts: what lies where by what grips have done, and what is refused for that."""

from __future__ import annotations

from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from arboleda.cli import screen
from arboleda.dispatch.belief import Belief
from arboleda.model.advice import in_words
from arboleda.model.cell_states import CellState
from arboleda.model.commands import FRESH_S
from arboleda.model.messages import Reason, TaskState
from arboleda.model.verbs import Verb
from arboleda.rig.world import PLANT as PLANT_PROCESS
from arboleda.views import view
from arboleda.wire.transport import Publication

from ...plants import plant_text, read, refused
from .lab import Bench

PLANT = plant_text(__file__, "places")


def recipe_of(body: str) -> str:
    return f"""
from arboleda.recipes import recipe, work

@recipe("try")
def attempt(cell):
    mover, hand, oven = cell.devices("mover", "hand", "oven")
    take, put = lambda at: mover.visit(at, hand.close()), lambda at: mover.visit(at, hand.open())
    return work({body})
"""


class Lab:
    """Bench with a recipe whose steps a test writes."""

    def __init__(self, folder: Path, body: str, plant: str = PLANT) -> None:
        self.bench = Bench(read(folder, plant, recipe_of(body)))
        self.bench.wait(1.0)
        self.places = self.bench.plant.cells["lab"].context.places

    def run(self) -> str | None:
        """The sentence for which the task failed; None where it is done."""
        self.bench.submit("lab try")
        end = self.bench.outcome(300.0)
        assert end.reason in (None, Reason.PRECONDITION), end
        return None if end.sentence is None or end.reason is None else str(end.sentence)


def test_parts_are_where_grips_have_put_them(tmp_path: Path) -> None:
    lab = Lab(tmp_path, 'take("rack_1"), put("nest"), take("rack_2"), put("bin")')
    assert lab.run() is None
    assert lab.places.counts == {"rack_1": 0, "rack_2": 0, "nest": 1, "inside": 0, "bin": 1}


def test_an_arm_that_tells_no_position_is_where_its_last_move_ended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Belief, "known_position", None)
    plant = PLANT.replace("model: scara}", "model: scara, evidence: state}")
    lab = Lab(tmp_path, 'take("rack_1"), put("inside"), oven.bake(), take("inside"), put("nest")', plant)
    assert lab.run() is None
    assert lab.places.counts == {"rack_1": 0, "rack_2": 1, "nest": 1, "inside": 0, "bin": 0}


def test_people_fill_supplies_and_empty_outputs_before_a_task(tmp_path: Path) -> None:
    lab = Lab(tmp_path, 'take("rack_1"), put("bin")')
    assert [lab.run(), lab.run(), lab.run()] == [None, None, None]
    assert lab.places.counts["rack_1"] == 0 and lab.places.counts["bin"] == 1


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ('take("nest"), put("bin")', "hand: no part is known to be at nest"),
        ('take("rack_1"), put("bin"), take("rack_1")', "hand: no part is known to be at rack_1"),
        ('take("rack_1"), put("nest"), take("rack_2"), put("nest")', "hand: nest has 1 already"),
        ('take("rack_1"), take("rack_2"), put("bin")', "hand holds a part already, taken at rack_1"),
        ("oven.bake()", "oven has no part to work on: none is known to be at inside"),
        ("oven.clamp(on=True)", "oven has no part to work on: none is known to be at inside"),
        (
            'take("rack_1"), mover.visit("inside", oven.clamp(on=True)), mover.home()',
            "mover stays at inside: oven still holds the part there",
        ),
    ],
)
def test_what_cannot_be_is_refused(tmp_path: Path, body: str, sentence: str) -> None:
    why = Lab(tmp_path, body).run()
    assert why is not None and sentence in why


def test_advice_opens_a_device_first_that_holds_what_a_hand_holds(tmp_path: Path) -> None:
    lab = Lab(tmp_path, 'take("rack_1"), mover.visit("inside", oven.clamp(on=True)), mover.home()')
    lab.run()
    lab.bench.wait(10.0)  # its recovery cannot bring the part back either

    def first() -> str:
        (advice, *_) = lab.bench.plant.advice("lab")
        lab.bench.operate(advice.do, advice.scope)
        lab.bench.wait(30.0)
        return str(in_words(advice))

    assert [first(), first()] == ["release oven", "retry lab"]
    assert lab.bench.plant.cells["lab"].state is CellState.IDLE
    assert lab.places.counts["rack_1"] == 1


def test_a_part_that_a_hand_holds_in_a_device_is_there_for_it(tmp_path: Path) -> None:
    body = (
        'take("rack_1"), mover.visit("inside", oven.clamp(on=True), hand.open()), oven.bake(),'
        ' mover.visit("inside", hand.close(), oven.clamp(on=False)), put("bin")'
    )
    lab = Lab(tmp_path, body)
    assert lab.run() is None
    assert lab.places.counts == {"rack_1": 0, "rack_2": 1, "nest": 0, "inside": 0, "bin": 1}


CARTED = plant_text(__file__, "places_carted")


@pytest.mark.parametrize(("at", "sentence"), [("platform", None), ("bay", "none is known to be at platform")])
def test_a_cart_has_brought_a_part_where_it_stands_only(
    tmp_path: Path, at: str, sentence: str | None
) -> None:
    body = f'mover.visit("{at}", oven.roll_in())'
    bench = Bench(read(tmp_path, CARTED, recipe_of(body)))
    bench.wait(1.0)
    bench.submit("lab try")
    end = bench.outcome(300.0)
    assert (end.state is TaskState.DONE) is (sentence is None)
    assert sentence is None or sentence in str(end.sentence)


def test_a_part_is_brought_back_where_it_was_taken(tmp_path: Path) -> None:
    lab = Lab(tmp_path, 'take("rack_1"), mover.visit("nest", cell.fail("not today"))')
    lab.bench.submit("lab try")
    assert lab.bench.outcome(300.0).state.value == "failed"
    assert lab.places.counts["rack_1"] == 1 and lab.places.counts["nest"] == 0


def test_a_hand_that_closes_after_it_was_given_up_has_taken_the_part(tmp_path: Path) -> None:
    lab = Lab(tmp_path, 'take("rack_1")')
    late: list[Publication] = []

    def is_held_up(publication: Publication) -> bool:
        if publication.topic == "hand/orden":
            late.append(publication)
        return publication.topic == "hand/orden"

    lab.bench.lost = is_held_up
    lab.bench.submit("lab try")
    assert lab.bench.wait(60.0, lambda: bool(late))
    lab.bench.stall(PLANT_PROCESS, 1.2)  # then it gives up what was under way
    assert lab.bench.wait(FRESH_S, lambda: lab.places.counts["rack_1"] == 1)
    lab.bench.lost = lambda _: False
    lab.bench.inject(late[0])
    lab.bench.wait(1.0)
    assert lab.bench.machines["hand"].facts["closed"]
    assert lab.places.counts["rack_1"] == 0


@pytest.mark.parametrize("restarts", [False, True])
def test_a_part_lies_where_the_hand_was_told_to_let_go_if_its_robot_is_not_heard(
    tmp_path: Path, restarts: bool
) -> None:
    lab = Lab(tmp_path, 'take("rack_1"), put("nest")')
    lab.bench.submit("lab try")
    assert lab.bench.wait(60.0, lambda: lab.bench.told[-1:] == ["hand open"])
    lab.bench.lost = lambda publication: publication.topic.startswith(("hand/", "mover/"))
    assert lab.bench.outcome().reason is Reason.LINK_LOST
    if restarts:
        lab.bench.crash()
    lab.bench.lost = lambda publication: publication.topic.startswith("mover/")
    lab.bench.wait(1.0)
    assert lab.bench.plant.cells["lab"].context.places.counts["nest"] == 1


def test_a_person_says_what_lies_where(tmp_path: Path) -> None:
    lab = Lab(tmp_path, 'take("nest"), put("bin")')
    assert lab.bench.operate(Verb.LOAD, "lab", place="nest") is None
    assert lab.run() is None
    assert lab.places.counts["nest"] == 0
    assert lab.bench.operate(Verb.LOAD, "lab", place="bin", parts=2) is None
    assert lab.bench.operate(Verb.UNLOAD, "lab", place="bin") is None
    assert lab.places.counts["bin"] == 0
    shown = {place["name"]: place["parts"] for place in lab.bench.snapshot()["cells"][0]["places"]}
    assert shown == lab.places.counts


@pytest.mark.parametrize(
    ("verb", "told", "refusal"),
    [
        (
            Verb.LOAD,
            {"place": "nst"},
            "'nst' is no place of lab; there are rack_1, rack_2, nest, inside, bin",
        ),
        (Verb.LOAD, {"place": "bin", "parts": 3}, "bin of lab holds 1 to 2 parts, not 3"),
        (Verb.LOAD, {"place": "bin", "parts": "x"}, "bin of lab holds 1 to 2 parts, not 'x'"),
        (Verb.UNLOAD, {"place": "nest"}, "no part is known to be at nest of lab"),
        (Verb.LOAD, {}, "'' is no place of lab; there are rack_1, rack_2, nest, inside, bin"),
    ],
)
def test_what_a_person_says_wrongly_is_refused(
    tmp_path: Path, verb: Verb, told: dict[str, int | str], refusal: str
) -> None:
    lab = Lab(tmp_path, "mover.home()")
    before = lab.places.counts
    assert lab.bench.operate(verb, "lab", **told) == refusal
    assert lab.places.counts == before


def test_parts_outlive_the_plant(tmp_path: Path) -> None:
    lab = Lab(tmp_path, 'take("rack_1"), put("nest")')
    assert lab.run() is None
    lab.bench.crash()
    lab.bench.wait(1.0)
    assert lab.bench.plant.cells["lab"].context.places.counts["nest"] == 1


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("nest: {}", "nst: {}", "cells.lab.places.nst: must be bin, inside, nest, rack_1, rack_2 or racks"),
        ("nest: {}", "home: {}", "home is where robots wait; no part lies there"),
        ("of: oven", "of: ovn", 'cells.lab.places.inside.of: must be hand or oven, is "ovn"'),
        ("supply: true", "supply: true, output: true", "people fill a supply and empty an output"),
        ("holds: 2", "holds: 0", "cells.lab.places.bin.holds: must be at least 1"),
    ],
)
def test_a_wrong_place_is_named_with_what_is_allowed(
    tmp_path: Path, old: str, new: str, problem: str
) -> None:
    assert PLANT.count(old) >= 1
    head, mark, tail = PLANT.partition("    places:\n")
    found = refused(tmp_path, head + mark + tail.replace(old, new, 1), recipe_of("mover.home()"))
    assert any(problem in each for each in found), found


SHARE_A_LAMP = plant_text(__file__, "places_share_a_lamp")


def test_a_cell_that_shares_a_device_has_places_of_its_own(tmp_path: Path) -> None:
    head = "from arboleda.recipes import recipe\n\n"
    recipe = '@recipe("look")\ndef look(cell):\n    return cell.device("arm").go("nest")\n'
    bench = Bench(read(tmp_path, SHARE_A_LAMP, head + recipe))
    bench.wait(1.0)

    def parts() -> dict[str, int]:
        return {name: cell.context.places.parts("nest") for name, cell in bench.plant.cells.items()}

    assert bench.operate(Verb.LOAD, "right", place="nest") is None
    assert parts() == {"left": 0, "right": 1}
    assert bench.operate(Verb.LOAD, "left", place="nest") is None
    assert bench.operate(Verb.UNLOAD, "right") is None
    assert parts() == {"left": 1, "right": 0}


SHARE_AN_ARM = plant_text(__file__, "places_share_an_arm")


def test_a_person_who_sees_to_a_place_that_cells_share_has_seen_to_it_for_all_of_them(tmp_path: Path) -> None:
    head = "from arboleda.recipes import recipe, work\n\n"
    steps = 'arm.visit("nest", hand.close()), arm.visit("bin", hand.open())'
    body = f'    arm, hand = cell.devices("arm", "hand")\n    return work({steps})\n'
    bench = Bench(read(tmp_path, SHARE_AN_ARM, f'{head}@recipe("clear")\ndef clear(cell):\n{body}'))
    bench.wait(1.0)

    def parts() -> dict[str, int]:
        return {name: cell.context.places.parts("nest") for name, cell in bench.plant.cells.items()}

    bench.submit("left clear")
    assert "no part is known to be at nest" in str(bench.outcome().sentence)
    assert "load left nest" in str(in_words(bench.plant.advice("left")[0]))
    assert bench.operate(Verb.LOAD, "right", place="nest") is None
    assert parts() == {"left": 1, "right": 1}
    assert bench.operate(Verb.UNLOAD, "right", place="nest") is None
    assert parts() == {"left": 0, "right": 0}
    assert not bench.plant.advice("left")


def test_a_place_is_loaded_with_no_more_than_each_cell_that_shares_it_has_room_for(tmp_path: Path) -> None:
    bench = Bench(read(tmp_path, SUPPLIED_ON_THE_RIGHT, HANDED_OVER))
    bench.wait(1.0)
    too_many = bench.operate(Verb.LOAD, "left", place="bin", parts=2)
    assert too_many == "bin of left holds 1 to 1 parts, not 2"
    assert bench.operate(Verb.LOAD, "left", place="bin") is None
    assert [cell.context.places.parts("bin") for cell in bench.plant.cells.values()] == [1, 1]


FULL = 'take("rack_1"), put("nest"), take("rack_2"), put("nest")'
SEE = "see that lab nest is empty and say so (unload lab nest)"
PUT = "put a part at lab nest and say so (load lab nest)"
LEAVE = "say that a part is still at lab nest (load lab nest)"


def advice(lab: Lab) -> list[str]:
    return [str(in_words(each)) for each in lab.bench.plant.advice("lab")]


@pytest.mark.parametrize(
    ("body", "said", "verb"),
    [(FULL, [SEE, LEAVE], Verb.UNLOAD), ('take("nest"), put("bin")', [PUT], Verb.LOAD)],
    ids=["full", "empty"],
)
def test_the_verb_and_the_place_that_a_task_failed_for_are_advised(
    tmp_path: Path, body: str, said: list[str], verb: Verb
) -> None:
    lab = Lab(tmp_path, body)
    assert advice(lab) == []
    assert lab.run() is not None
    assert advice(lab) == said
    console = Console(width=200, file=StringIO())
    console.print(screen.table(view.snapshot(lab.bench.plant)))
    assert said[0] in console.file.getvalue()
    assert lab.bench.operate(verb, "lab", place="nest") is None
    assert advice(lab) == []


def test_a_place_that_people_see_to_between_tasks_is_not_advised(tmp_path: Path) -> None:
    lab = Lab(tmp_path, 'take("rack_1"), put("bin"), take("rack_1")')
    assert "no part is known to be at rack_1" in str(lab.run())
    assert advice(lab) == []


def test_who_says_that_a_part_is_out_is_told_what_leads_on_where_that_is_known(tmp_path: Path) -> None:
    lab = Lab(tmp_path, 'take("rack_1"), cell.wait(100.0)')
    lab.bench.submit("lab try")
    assert lab.bench.wait(60.0, lambda: bool(lab.bench.plant.cells["lab"].context.parts.holding))
    assert lab.bench.operate(Verb.HOLD, "lab") is None
    lab.bench.wait(2.0)
    lab.bench.manual.set_facts("hand", (("closed", False),))
    lab.bench.wait(2.0)
    told = str(lab.bench.operate(Verb.RELEASE, "hand", by_hand=True))
    assert told == "no part is known to be in hand, so nothing has to be said of it; go on with abandon lab"


def failed_with_a_part_in_the_oven(folder: Path, plant: str = PLANT) -> Lab:
    """The lab after a task that has put a part into its oven, and failed there."""
    steps = 'mover.visit("inside", oven.clamp(on=True), hand.open()), cell.fail("not today")'
    lab = Lab(folder, f'take("rack_1"), {steps}', plant)
    lab.bench.submit("lab try")
    assert lab.bench.outcome(300.0).state is TaskState.FAILED
    return lab


ASKED = "Is a part still in inside? The last task failed, and may have left one there"
OUTPUT = PLANT.replace("{of: oven}", "{of: oven, output: true}")


@pytest.mark.parametrize("restarts", [False, True])
@pytest.mark.parametrize("plant", [PLANT, OUTPUT], ids=["kept", "output"])
def test_no_task_begins_until_somebody_says_what_a_failed_task_has_left(
    tmp_path: Path, plant: str, restarts: bool
) -> None:
    lab = failed_with_a_part_in_the_oven(tmp_path, plant)
    assert lab.bench.operate(Verb.RELEASE, "oven") is None  # opens its clamp, and the part stays there
    lab.bench.wait(2.0)
    if restarts:
        lab.bench.crash()
        lab.bench.wait(2.0)
    cell = lab.bench.plant.cells["lab"]
    assert str(cell.not_ready) == ASKED and cell.context.places.asked.targets == ("inside",)
    lab.bench.submit("lab try")
    lab.bench.wait(5.0)
    assert cell.task is None and cell.queue
    (row,) = (each for each in lab.bench.snapshot()["cells"][0]["places"] if each["asked"])
    assert row["name"] == "inside"
    assert lab.bench.operate(Verb.UNLOAD, "lab", place="inside") is None
    assert lab.bench.operate(Verb.RESUME, "lab") is None or not cell.queue.paused
    assert lab.bench.wait(5.0, lambda: cell.task is not None)
    assert cell.context.places.asked.targets == () and cell.context.places.counts["inside"] == 0


def test_a_task_that_an_earlier_start_began_leaves_the_same_question(tmp_path: Path) -> None:
    steps = 'mover.visit("inside", oven.clamp(on=True), hand.open()), mover.home(), cell.wait(100)'
    lab = Lab(tmp_path, f'take("rack_1"), {steps}')
    lab.bench.submit("lab try")
    assert lab.bench.wait(60.0, lambda: lab.places.counts["inside"] == 1)
    lab.bench.wait(10.0)
    lab.bench.crash()
    lab.bench.wait(2.0)
    assert lab.bench.operate(Verb.ABANDON, "lab") is None
    cell = lab.bench.plant.cells["lab"]
    assert lab.bench.wait(30.0, lambda: cell.task is None)
    assert cell.context.places.asked.targets == ("inside",)


def test_a_part_from_before_the_task_is_no_question_though_the_plant_has_started_anew(tmp_path: Path) -> None:
    lab = Lab(tmp_path, "cell.wait(100)")
    assert lab.bench.operate(Verb.LOAD, "lab", place="nest") is None
    lab.bench.submit("lab try")
    lab.bench.wait(2.0)
    lab.bench.crash()
    lab.bench.wait(2.0)
    assert lab.bench.operate(Verb.ABANDON, "lab") is None
    cell = lab.bench.plant.cells["lab"]
    assert lab.bench.wait(30.0, lambda: cell.task is None)
    assert cell.context.places.counts["nest"] == 1 and cell.context.places.asked.targets == ()


def test_a_part_that_is_still_there_is_known_to_be_there(tmp_path: Path) -> None:
    lab = failed_with_a_part_in_the_oven(tmp_path)
    assert lab.bench.operate(Verb.RELEASE, "oven") is None
    lab.bench.wait(2.0)
    assert lab.bench.operate(Verb.LOAD, "lab", place="inside") is None
    assert lab.places.asked.targets == () and lab.places.counts["inside"] == 1


def test_an_output_with_a_part_in_it_is_not_ready_for_the_next_task(tmp_path: Path) -> None:
    lab = failed_with_a_part_in_the_oven(tmp_path, OUTPUT)
    assert lab.bench.operate(Verb.RELEASE, "oven") is None
    lab.bench.wait(2.0)
    assert lab.bench.operate(Verb.LOAD, "lab", place="inside") is None
    assert lab.places.asked.targets == ("inside",)
    assert advice(lab)[0] == "see that lab inside is empty and say so (unload lab inside)"


def test_who_takes_a_part_out_of_a_device_empties_its_place(tmp_path: Path) -> None:
    lab = failed_with_a_part_in_the_oven(tmp_path)
    assert lab.places.counts["inside"] == 1
    lab.bench.manual.take_out("oven")
    assert lab.bench.operate(Verb.RELEASE, "oven", by_hand=True) is None
    assert lab.places.counts["inside"] == 0 and lab.places.asked.targets == ()


def test_a_place_with_room_for_more_is_no_question(tmp_path: Path) -> None:
    lab = Lab(tmp_path, 'take("rack_1"), put("bin"), cell.fail("not today")')
    lab.bench.submit("lab try")
    assert lab.bench.outcome(300.0).state is TaskState.FAILED
    assert lab.places.counts["bin"] == 1 and lab.places.asked.targets == ()


SUPPLIED_ON_THE_RIGHT = SHARE_AN_ARM.replace("places: {nest: {}}", "places: {nest: {}, bin: {supply: true}}")
HANDED_OVER = """
from arboleda.recipes import recipe, work

@recipe("fail")
def give_up(cell):
    return work(cell.wait(0.5), cell.fail("not today"))

@recipe("bring")
def bring(cell):
    arm, hand = cell.devices("arm", "hand")
    return work(arm.visit("bin", hand.close()), arm.visit("nest", hand.open()), arm.home())

@recipe("rest")
def rest(cell):
    return work(cell.wait(0.5))
"""


def test_what_another_cell_puts_at_a_place_of_both_is_no_question_to_this_one(tmp_path: Path) -> None:
    bench = Bench(read(tmp_path, SUPPLIED_ON_THE_RIGHT, HANDED_OVER))
    bench.wait(1.0)
    ends = []
    for task in ("left fail", "right bring"):
        bench.submit(task)
        ends.append(bench.outcome().state)
    left = bench.plant.cells["left"]
    assert ends == [TaskState.FAILED, TaskState.DONE] and left.context.places.counts["nest"] == 1
    assert left.not_ready is None and left.context.places.asked.targets == ()
