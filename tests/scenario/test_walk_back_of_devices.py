"""A recipe of one's own that was at work when the plant was killed goes on at its step, with what it knew."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from shutil import copytree

import pytest

from arboleda.core import reasons
from arboleda.model.advice import in_words
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Command, Stop
from arboleda.model.messages import Check, TaskState, Verb
from arboleda.model.plant_model import PlantModel, Retry
from arboleda.plant_file.loader import load
from arboleda.recipes import Kit, parallel, recipe, work
from arboleda.rig import hands
from arboleda.testing import Rig
from arboleda.views import view
from arboleda.wire.transport import Publication

from ..lengths import sample
from ..plants import made
from ..unit.kinds.example_trials import EXAMPLES
from ..unit.kinds.lab import model as bench
from ..unit.kinds.tending import plant
from ..unit.kinds.test_interlocks import with_mill
from ..unit.kinds.test_numbers_as_answers import BY_WEIGHT, line
from ..unit.kinds.test_people import attended
from .restarts import ENDED, restart


@recipe("refill")
def refill(cell: Kit):  # type: ignore[no-untyped-def]
    left, ana = cell.devices("left", "ana")
    asked = ana.ask("Is the pallet full?", ["yes", "no"])
    again = ana.ask("Is it really?", ["yes", "no"])
    ways = {"yes": work(left.go("feed_2"), again, left.go("feed")), "no": cell.fail("it is empty")}
    return work(asked, cell.choose(asked, ways))


@recipe("both")
def both(cell: Kit):  # type: ignore[no-untyped-def]
    left, right, shuttle = cell.devices("left", "right", "shuttle")
    return work(parallel(left.go("feed_2"), work(right.go("feed"), right.home()), shuttle.go("store")))


thrice = made("thrice", lambda cell, left: cell.repeat(work(left.go("feed_2"), left.home()), 3))


@recipe("carry")
def carry(cell: Kit):  # type: ignore[no-untyped-def]
    left, jaw = cell.devices("left", "jaw")
    return work(left.visit("feed_2", jaw.close()), left.visit("vise", jaw.open()), left.home())


@recipe("late")
def late(cell: Kit):  # type: ignore[no-untyped-def]
    left = cell.device("left")
    return cell.timeout(work(left.go("feed_2"), cell.wait(4.0), left.home()), 6.0)


wave = made("wave", lambda cell, left, jaw: work(jaw.open(), left.go("feed_2"), left.home()))


@recipe("behind_a_door")
def behind_a_door(cell: Kit):  # type: ignore[no-untyped-def]
    left, mill = cell.devices("left", "mill")
    return work(mill.close(), mill.open(), left.visit("vise"), left.home())


def sent(rig: Rig) -> list[str]:
    """What was sent to devices, but for stops: who, and where to or which verb."""
    found = []
    for each in (message for message in rig.sent if isinstance(message, Command)):
        what = getattr(each, "q", None) or getattr(each, "nodes", None) or getattr(each, "verb", None)
        if not isinstance(each, Stop):
            found.append(f"{each.robot} {what}")
    return found


def begin(model: PlantModel, task: str) -> Rig:
    rig = Rig(model)
    rig.wait(0.5)
    rig.submit(f"{task} #one")
    return rig


def state(rig: Rig) -> TaskState:
    return rig.outcomes()["one"].state


def asked(rig: Rig) -> str | None:
    rows = {row["name"]: row for row in view.snapshot(rig.plant)["robots"]}
    question = rows["ana"]["question"]
    return None if question is None else question["text"]


def resumed(rig: Rig, cell: str, after_s: float = 3.0) -> None:
    rig.wait(after_s)
    assert rig.operate(Verb.RESUME, cell) is None


def test_a_switch_that_was_done_before_its_board_took_it_is_known_to_have_been_on_its_way() -> None:
    rig = Rig(plant(wave))
    rig.wait(0.5)
    late: list[Publication] = []

    def held_up(each: Publication) -> bool:
        if each.topic == "jaw/orden" and not late:
            late.append(each)
            return True
        return False

    rig.lost = held_up
    rig.submit("tending wave #one")
    assert rig.wait(5.0, until=lambda: rig.plant.cells["tending"].context.robots.belief("left").moves)
    rig.inject(late[0])
    rig.wait(0.3)
    restart(rig)
    resumed(rig, "tending")
    assert rig.wait(20.0, until=lambda: state(rig) is TaskState.DONE)


def test_an_answer_stays_given_and_an_open_question_is_asked_again() -> None:
    rig = begin(attended(refill), "tending refill")
    assert rig.wait(10.0, until=lambda: asked(rig) == "Is the pallet full?")
    assert rig.operate(Verb.ANSWER, "ana", answer="yes") is None
    restart(rig)
    assert asked(rig) is None
    resumed(rig, "tending")
    assert rig.wait(10.0, until=lambda: asked(rig) == "Is it really?")
    restart(rig)
    assert asked(rig) is None, "nobody is asked before somebody resumes"
    assert rig.operate(Verb.ANSWER, "ana", answer="yes") is not None
    resumed(rig, "tending")
    assert asked(rig) == "Is it really?"
    assert rig.operate(Verb.ANSWER, "ana", answer="yes") is None
    assert rig.wait(20.0, until=lambda: state(rig) is TaskState.DONE)
    answers = view.task_by_id(rig.plant, "one")["answers"]  # type: ignore[index]
    assert [each["asked"] for each in answers] == ["Is the pallet full?", "Is it really?"]


@pytest.mark.parametrize("after_s", [number / 10 for number in range(1, 24, 3)])
def test_of_parallel_steps_each_goes_on_by_itself(after_s: float) -> None:
    rig = begin(plant(both), "tending both")
    rig.wait(after_s)
    restart(rig, after_s=2.0)
    resumed(rig, "tending")
    assert rig.wait(30.0, until=lambda: state(rig) is TaskState.DONE)
    assert rig.boards["left"].body.true_place == pytest.approx((0.5, 0.4), abs=0.01)
    assert rig.boards["right"].body.true_place == pytest.approx((0.0, 0.0), abs=0.01)


def test_the_turns_of_a_repetition_are_counted_on() -> None:
    rig = begin(plant(thrice), "tending thrice")
    feeds = "left (0.5, 0.4)"
    assert rig.wait(20.0, until=lambda: sent(rig).count(feeds) == 3)
    rig.wait(0.2)
    restart(rig, after_s=2.0)
    resumed(rig, "tending")
    assert rig.wait(20.0, until=lambda: state(rig) is TaskState.DONE)
    assert sent(rig).count(feeds) == 3


@pytest.mark.sampled(2)
@pytest.mark.parametrize("after_s", [number / 10 for number in range(1, 27, 2)])
def test_a_gripper_that_is_carried_grips_once_and_lets_go_once(after_s: float) -> None:
    rig = begin(plant(carry), "tending carry")
    rig.wait(after_s)
    restart(rig, after_s=2.0)
    resumed(rig, "tending")
    assert rig.wait(30.0, until=lambda: state(rig) is TaskState.DONE)
    assert [each for each in sent(rig) if each.startswith("jaw")] == ["jaw close", "jaw open"]
    assert rig.plant.zones.holder("vise") is None


def let_go_after_a_restart(*, boots: bool) -> Rig:
    """The plant is killed while a gripper lets go, and the gripper's board boots meanwhile, or not."""
    rig = begin(plant(carry), "tending carry")
    assert rig.wait(30.0, until=lambda: "jaw open" in sent(rig))
    restart(rig)
    if boots:
        rig.crash("jaw")
    rig.wait(8.0)
    verb = rig.plant.advice("tending")[0].do
    assert verb is (Verb.RETRY if boots else Verb.RESUME)
    assert rig.operate(verb, "tending") is None
    assert rig.wait(60.0, until=lambda: state(rig) in ENDED)
    return rig


def test_a_release_that_a_boot_may_have_done_is_told_as_not_checked() -> None:
    rig = let_go_after_a_restart(boots=True)
    change = rig.outcomes()["one"]
    assert (change.state, change.unchecked) == (TaskState.DONE, (Check.RELEASE,))
    said = "not checked: whether the part was let go of"
    assert str(change.sentence) == said
    assert view.task_by_id(rig.plant, "one")["unchecked"] == ["release"]  # type: ignore[index]
    assert view.change(change)["unchecked"] == ["release"]
    assert rig.disk.tasks["one"].unchecked == (Check.RELEASE,)


def test_a_release_in_the_boot_of_the_grip_is_checked() -> None:
    change = let_go_after_a_restart(boots=False).outcomes()["one"]
    assert (change.state, change.unchecked, str(change.sentence)) == (TaskState.DONE, (), "")


def test_the_zone_of_an_arm_stays_its_own() -> None:
    rig = begin(plant(carry), "tending carry")
    assert rig.wait(20.0, until=lambda: rig.plant.zones.holder("vise") == "left")
    restart(rig, after_s=2.0)
    rig.wait(20.0)
    assert rig.plant.zones.holder("vise") == "left"
    resumed(rig, "tending")
    assert rig.wait(30.0, until=lambda: state(rig) is TaskState.DONE)


@pytest.mark.parametrize("verb", ["close", "open"])
def test_the_zone_of_a_machine_is_given_back_once_its_door_is_open(verb: str) -> None:
    rig = begin(with_mill(behind_a_door), "tending behind_a_door")
    assert rig.wait(20.0, until=lambda: f"mill {verb}" in sent(rig))
    assert rig.plant.zones.holder("vise") == "mill"
    restart(rig, bridge=False)
    resumed(rig, "tending")
    assert rig.wait(30.0, until=lambda: state(rig) is TaskState.DONE)
    assert rig.plant.zones.holder("vise") is None


def test_a_time_out_counts_from_the_word_to_go_on() -> None:
    rig = begin(plant(late), "tending late")
    rig.wait(4.0)
    restart(rig, after_s=1.0)
    rig.wait(60.0)
    resumed(rig, "tending")
    assert rig.wait(30.0, until=lambda: state(rig) is not TaskState.RUNNING)
    assert state(rig) is TaskState.DONE


def test_a_task_goes_on_with_the_range_of_the_number_that_was_answered() -> None:
    rig = Rig(line(BY_WEIGHT))
    rig.boards["scale"].body.answer = lambda goal: 120.5  # type: ignore[union-attr]
    rig.wait(0.5)
    rig.submit("line sort #one")
    assert rig.wait(30.0, until=lambda: "gate right" in sent(rig))
    restart(rig, after_s=1.0)
    resumed(rig, "line")
    assert rig.wait(30.0, until=lambda: state(rig) is TaskState.DONE)
    assert sent(rig).count("scale weigh") == 1
    assert {"gate left", "gate middle"}.isdisjoint(sent(rig))


def test_work_that_a_machine_finishes_by_itself_is_not_begun_again() -> None:
    rig = begin(bench(), "bench bake 5")
    assert rig.wait(30.0, until=lambda: "oven bake" in sent(rig))
    rig.wait(3.0)
    restart(rig, after_s=1.0)
    rig.wait(5.0)
    refusal = rig.operate(Verb.RESUME, "bench")
    assert refusal == "oven is still moving; until then nobody can tell what became of the step of bench"
    resumed(rig, "bench", after_s=20.0)
    assert rig.wait(30.0, until=lambda: state(rig) is TaskState.DONE)
    assert sent(rig).count("oven bake") == 1


@pytest.mark.parametrize("reached", [0, 1])
def test_what_a_power_cut_made_the_plant_forget_is_not_begun_again(reached: int) -> None:
    rig = begin(load(EXAMPLES / "lab_bench" / "plant.yaml"), "bench weigh 20")
    assert rig.wait(10.0, until=lambda: "pump dispense" in sent(rig))
    rig.plant_process.cut_power(reached)
    rig.stop_bridge()
    rig.wait(10.0)
    rig.start_bridge()
    rig.plant_process.start()
    rig.wait(10.0)
    if rig.operate(Verb.RESUME, "bench") is not None:
        held = str(reasons.of_hold(rig.plant.cells["bench"]))
        assert "pump proves neither that it has done this nor that it has not" in held
    rig.wait(20.0)
    assert sent(rig).count("pump dispense") == 1


def test_work_that_ended_behind_a_lost_link_is_not_begun_again_by_a_retry_that_never_left() -> None:
    model = bench()
    (cell,) = model.cells
    rig = begin(replace(model, cells=(replace(cell, retry=Retry(times=8, backoff_s=4.0)),)), "bench bake 5")
    assert rig.wait(30.0, until=lambda: "oven bake" in sent(rig))
    rig.wait(1.0)
    rig.lost = lambda each: each.topic.startswith("oven/")
    steps = rig.plant.cells["bench"].context.commands
    before = steps.sent
    assert rig.wait(30.0, until=lambda: steps.sent >= before + 2), "a retry was due, and refused"
    rig.wait(15.0)
    restart(rig)
    rig.lost = lambda each: False
    resumed(rig, "bench", after_s=10.0)
    assert rig.wait(30.0, until=lambda: state(rig) is TaskState.DONE)
    assert sent(rig).count("oven bake") == 1


def test_another_recipe_of_that_name_is_not_walked_into() -> None:
    rig = begin(plant(thrice), "tending thrice")
    rig.wait(0.5)
    twice = made("thrice", lambda cell, left: cell.repeat(work(left.go("feed_2"), left.home()), 2))
    restart(rig, plant(twice), after_s=1.0)
    rig.wait(1.0)
    said = "its recipe or the plant file has changed since it began: abandon tending"
    assert str(reasons.of_hold(rig.plant.cells["tending"])).endswith(said)
    assert rig.operate(Verb.RESUME, "tending") is not None
    assert rig.operate(Verb.ABANDON, "tending") is None
    assert rig.wait(30.0, until=lambda: state(rig) is TaskState.FAILED)


EXAMPLE = Path(__file__).parents[2] / "examples" / "machine_tending" / "plant.yaml"
EMPTIED = "take_out tending vise"  # a person is asked whether a part is still there


def attended_to(rig: Rig) -> list[str]:
    """What somebody did who answers, and does what is advised first, until the task has ended."""
    did: list[str] = []
    for _ in range(40):
        if rig.wait(5.0, until=lambda: state(rig) in ENDED):
            break
        if rig.plant.dispatcher.ledger.question("operator") is not None:
            rig.operate(Verb.ANSWER, "operator", answer="good")
        for first in rig.plant.advice("tending")[:1]:
            assert isinstance(first.do, Verb)
            if rig.operate(first.do, first.scope) is None:
                did.append(first.do.value)
    return did


def led_out(rig: Rig) -> list[str]:
    """What somebody did who goes by the first advice until the cell works again."""
    did: list[str] = []
    cell = rig.plant.cells["tending"]
    while not rig.wait(6.0, until=lambda: cell.state is CellState.IDLE and cell.not_ready is None):
        for first in rig.plant.advice("tending")[:1]:
            assert first.refusal is None
            did.append(f"{first.do.value} {first.scope}")
            hands.do(rig, first)
        assert len(did) < 10
    return did


@pytest.mark.sampled(6)
@pytest.mark.parametrize(
    ("boots", "at_s", "lead"),
    [
        ("loader", 4.5, ["home loader", "abandon tending"]),
        ("loader", 9.3, ["release jaw", "home loader", "abandon tending", "release mill"]),
        ("loader", 12.3, ["home loader", "abandon tending", "release mill", EMPTIED]),
        ("loader", 14.1, ["do mill", "home loader", "abandon tending", "release mill", EMPTIED]),
        (
            "tender",
            9.3,
            ["release jaw", "home loader", "home tender", "abandon tending", "release mill", EMPTIED],
        ),
        ("tender", 34.0, ["do mill", "home tender", "abandon tending", "release mill", EMPTIED]),
    ],
)
def test_an_arm_that_boots_before_its_cut_off_task_goes_on_is_led_out_by_advice(
    boots: str, at_s: float, lead: list[str]
) -> None:
    rig = begin(load(EXAMPLE), "tending mill slot_1 1001")
    rig.wait(at_s)
    restart(rig, after_s=1.5)
    rig.wait(1.0)
    rig.power_off(boots)
    rig.wait(2.0)
    rig.power_on(boots)
    assert led_out(rig) == [*lead, "resume tending"]
    assert state(rig) is TaskState.FAILED
    rig.submit("tending mill slot_2 1002 #two")
    assert rig.wait(5.0, until=lambda: rig.outcomes()["two"].state is TaskState.RUNNING)


def test_nobody_is_sent_to_the_door_of_a_machine_at_work(tmp_path: Path) -> None:
    copytree(EXAMPLE.parent, tmp_path, dirs_exist_ok=True)
    file = tmp_path / EXAMPLE.name
    file.write_text(file.read_text().replace("takes_s: 20\n", "takes_s: 20\n        on_stop: finish\n"))
    rig = begin(load(file), "tending mill slot_1 1001")
    rig.wait_for("tending", "mill run 1001")
    restart(rig, after_s=0.5)
    rig.power_off("loader")
    rig.wait(2.0)
    rig.power_on("loader")
    rig.wait(2.0)
    assert rig.plant.dispatcher.beliefs["mill"].moves
    assert rig.plant.advice("tending") == ()
    rig.wait(20.0)
    assert str(in_words(rig.plant.advice("tending")[0])) == "do mill open"


KILLED_AT_S = (0.5, 12.6, 36.5, 3.0, 20.0, 39.0, 7.5, 34.0, 42.0, 12.2, 45.0)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("at_s", sample(KILLED_AT_S, every=3))
def test_the_cell_that_tends_a_mill_finishes_its_part_whenever_it_is_killed(at_s: float) -> None:
    rig = begin(load(EXAMPLE), "tending mill slot_1 1001")
    rig.wait(at_s)
    assert state(rig) is TaskState.RUNNING
    cut_off = rig.runs("tending", "mill run 1001")
    restart(rig, after_s=1.5)
    assert attended_to(rig) == (["retry"] if cut_off else ["resume"])
    assert state(rig) is TaskState.DONE
    assert sent(rig).count("mill run") == (2 if cut_off else 1)
    assert [each for each in sent(rig) if each.startswith("jaw")] == ["jaw close", "jaw open"]


def test_while_only_time_is_needed_nothing_is_advised() -> None:
    rig = begin(bench(), "bench bake 5")
    assert rig.wait(30.0, until=lambda: "oven bake" in sent(rig))
    restart(rig, after_s=1.0)
    rig.wait(2.0)
    assert rig.plant.advice("bench") == ()
    assert str(reasons.of_hold(rig.plant.cells["bench"])).endswith("; wait")
