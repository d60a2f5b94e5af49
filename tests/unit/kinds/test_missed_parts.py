"""What an arm says on its way of a part that it has not, in the books of parts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from arboleda.model.messages import TaskChanged, TaskState
from arboleda.model.verbs import Verb

from ...plants import plant_text, read
from .lab import Bench

PLANT = plant_text(__file__, "missed_parts")
RECIPE = """
from arboleda.recipes import Pick, Place, recipe, work

@recipe("try")
def attempt(cell):
    mover = cell.device("mover")
    {before}
    return work({body})
"""
CHECKED = 'mover.tour(Pick("nest"), Place("vise"), "home")'
UNCHECKED = 'mover.visit("nest", mover.grip()), mover.visit("vise", mover.let_go()), mover.home()'
FAILS = 'mover.visit("nest", mover.grip()), mover.home(), cell.fail("not today")'
TO_THE_BIN = 'mover.brings_back_to("bin")'
WAITS = 'mover.visit("nest", mover.grip()), mover.visit("vise", cell.wait(5), mover.let_go()), mover.home()'
BY_HOME = 'mover.visit("nest", mover.grip()), mover.home(), mover.visit("vise", mover.let_go()), mover.home()'
BACK = 'mover.visit("nest", mover.grip()), mover.home(), mover.visit("nest", mover.let_go()), mover.home()'
THERE = {"nest": 1, "vise": 0, "bin": 0}
NOWHERE = {"nest": 0, "vise": 0, "bin": 0}
IN_THE_VISE = {"nest": 0, "vise": 1, "bin": 0}
Happens = Callable[[Bench], None]


def lab(folder: Path, body: str, before: str = "", plant: str = PLANT) -> Bench:
    """The lab with a part in its nest, and a task."""
    bench = Bench(read(folder, plant, RECIPE.format(body=body, before=before)))
    bench.wait(1.0)
    assert bench.operate(Verb.LOAD, "lab", place="nest") is None
    bench.submit("lab try")
    return bench


def ended(bench: Bench) -> TaskChanged:
    """The end of the task; the hand is empty by then, and so it is in the books."""
    end = bench.outcome(300.0)
    assert bench.wait(60.0, lambda: bench.plant.cells["lab"].task is None)
    assert bench.plant.cells["lab"].context.places.carriers == {}
    return end


def counts(bench: Bench) -> dict[str, int]:
    return bench.plant.cells["lab"].context.places.counts


def asked(bench: Bench) -> tuple[str, ...]:
    return bench.plant.cells["lab"].context.places.asked.targets


def carriers(bench: Bench) -> dict[str, bool]:
    return bench.plant.cells["lab"].context.places.carriers


def says(bench: Bench, piece: Callable[[bool | None], bool | None]) -> None:
    """Have the piece sensor say this, by what it sees."""
    body = bench.machines["mover"]
    tell = body.tell
    body.tell = lambda: tell()._replace(piece=piece(tell().piece))


def closes_beside(bench: Bench) -> None:
    bench.machines["mover"].grips = False


def loses_it(bench: Bench) -> None:
    """The part falls once the arm has carried it for a moment."""
    body = bench.machines["mover"]
    assert bench.wait(60.0, lambda: body.holding and body.moving)
    bench.wait(0.3)
    body.lose_piece()


@pytest.mark.parametrize("before", ["", TO_THE_BIN], ids=["back", "to_the_bin"])
@pytest.mark.parametrize("body", [CHECKED, FAILS], ids=["checked", "unchecked"])
def test_a_part_that_a_hand_missed_is_a_question_where_it_was(tmp_path: Path, body: str, before: str) -> None:
    bench = lab(tmp_path, body, before)
    closes_beside(bench)
    assert ended(bench).state is TaskState.FAILED
    assert (counts(bench), asked(bench)) == (THERE, ("nest",))
    assert bench.operate(Verb.UNLOAD, "lab", place="nest") is None
    assert (counts(bench), asked(bench)) == (NOWHERE, ())


@pytest.mark.parametrize(("happens", "left"), [(closes_beside, THERE), (loses_it, NOWHERE)])
def test_a_task_that_looks_at_no_sensor_puts_nothing_where_its_hand_had_none(
    tmp_path: Path, happens: Happens, left: dict[str, int]
) -> None:
    bench = lab(tmp_path, UNCHECKED)
    happens(bench)
    assert ended(bench).state is TaskState.DONE
    assert counts(bench) == left


def test_a_hand_that_says_on_its_way_that_it_is_empty_holds_no_part_in_the_books(tmp_path: Path) -> None:
    bench = lab(tmp_path, UNCHECKED)
    closes_beside(bench)
    body = bench.machines["mover"]
    assert bench.wait(60.0, lambda: body.effector and body.moving)
    assert bench.plant.cells["lab"].context.places.carriers == {"mover": True}
    assert bench.wait(1.0, lambda: not bench.plant.cells["lab"].context.places.carriers)
    assert body.effector and body.moving and counts(bench) == THERE


def test_a_sensor_that_is_late_has_the_hand_take_the_part_after_all(tmp_path: Path) -> None:
    bench = lab(tmp_path, UNCHECKED)
    body = bench.machines["mover"]
    assert bench.wait(60.0, lambda: body.holding and body.moving)
    body.holding = False
    assert bench.wait(1.0, lambda: not bench.plant.cells["lab"].context.places.carriers)
    body.holding = True
    assert ended(bench).state is TaskState.DONE
    assert counts(bench) == IN_THE_VISE


def test_where_nothing_is_checked_the_books_follow_the_effector(tmp_path: Path) -> None:
    plant = PLANT.replace("    places:", "    piece_check: false\n    places:")
    bench = lab(tmp_path, UNCHECKED, plant=plant)
    closes_beside(bench)
    assert ended(bench).state is TaskState.DONE
    assert counts(bench) == IN_THE_VISE


@pytest.mark.parametrize("seconds", [1.0, 4.0, 1000.0])
def test_what_a_slow_sensor_said_before_the_arm_left_counts_for_nothing(
    tmp_path: Path, seconds: float
) -> None:
    bench = lab(tmp_path, UNCHECKED)
    said_at = [bench.now]

    def slowly(piece: bool | None) -> bool | None:
        if bench.now - said_at[0] < seconds:
            return None
        said_at[0] = bench.now
        return piece

    says(bench, slowly)
    assert ended(bench).state is TaskState.DONE
    assert counts(bench) == IN_THE_VISE


def test_a_part_that_a_sensor_sees_lie_there_as_the_arm_leaves_was_not_in_the_hand(tmp_path: Path) -> None:
    bench = lab(tmp_path, FAILS)
    closes_beside(bench)
    body = bench.machines["mover"]
    left_at: list[float] = []

    def sees_it_for_a_moment(piece: bool | None) -> bool | None:
        if body.moving and body.effector:
            left_at.append(bench.now)
        return bool(piece) or bool(left_at and bench.now - left_at[0] < 0.05)

    says(bench, sees_it_for_a_moment)
    assert ended(bench).state is TaskState.FAILED
    assert (counts(bench), asked(bench)) == (THERE, ("nest",))


def test_a_word_of_an_earlier_boot_of_the_board_counts_for_nothing(tmp_path: Path) -> None:
    bench = lab(tmp_path, UNCHECKED)
    body = bench.machines["mover"]
    assert bench.wait(60.0, lambda: body.holding and body.moving)
    bench.wait(0.3)
    dispatcher = bench.plant.dispatcher
    belief = dispatcher.beliefs["mover"]
    belief.piece, belief.piece_boot = False, (belief.boot_id or 0) - 1
    dispatcher.effectors.feel(belief, debounce_s=0.0)
    assert carriers(bench) == {"mover": True}


@pytest.mark.parametrize(("happens", "left"), [(closes_beside, THERE), (loses_it, NOWHERE)])
def test_a_restart_leaves_a_hand_empty_that_is_closed_and_has_no_part(
    tmp_path: Path, happens: Happens, left: dict[str, int]
) -> None:
    bench = lab(tmp_path, WAITS)
    happens(bench)
    body = bench.machines["mover"]
    assert bench.wait(60.0, lambda: body.effector and body.moving)
    assert bench.wait(60.0, lambda: not body.moving)
    bench.wait(1.0)
    bench.crash()
    bench.wait(2.0)
    assert (carriers(bench), counts(bench), body.effector) == ({}, left, True)
    assert bench.operate(Verb.RESUME, "lab") is None
    assert bench.wait(60.0, lambda: bench.plant.cells["lab"].task is None)
    assert counts(bench) == left


def test_a_sensor_that_sees_the_part_only_after_a_restart_has_the_hand_take_it(tmp_path: Path) -> None:
    bench = lab(tmp_path, BY_HOME)
    body = bench.machines["mover"]
    sees = [True]
    says(bench, lambda piece: bool(piece) and sees[0])
    assert bench.wait(60.0, lambda: body.holding and body.moving)
    sees[0] = False
    assert bench.wait(1.0, lambda: not carriers(bench))
    bench.crash()
    bench.wait(2.0)
    assert (carriers(bench), counts(bench)) == ({}, THERE)
    sees[0] = True
    assert bench.operate(Verb.RESUME, "lab") is None
    assert bench.wait(60.0, lambda: bench.plant.cells["lab"].task is None)
    assert counts(bench) == IN_THE_VISE


def test_a_hand_whose_sensor_fails_for_a_moment_knows_where_it_took_its_part(tmp_path: Path) -> None:
    bench = lab(tmp_path, FAILS)
    body = bench.machines["mover"]
    sees = [True]
    says(bench, lambda piece: bool(piece) and sees[0])
    assert bench.wait(60.0, lambda: body.holding and body.moving)
    bench.wait(0.3)
    sees[0] = False
    assert bench.wait(0.4, lambda: not carriers(bench))
    sees[0] = True
    assert ended(bench).state is TaskState.FAILED
    assert counts(bench) == THERE


def test_a_dead_sensor_lets_no_hand_open_where_another_part_lies(tmp_path: Path) -> None:
    bench = lab(tmp_path, UNCHECKED)
    assert bench.operate(Verb.LOAD, "lab", place="vise") is None
    says(bench, lambda piece: False)
    assert bench.outcome(300.0).state is TaskState.FAILED
    assert "vise has 1" in str(bench.changes[-1])
    assert counts(bench) == {"nest": 1, "vise": 1, "bin": 0}


def test_a_hand_that_missed_its_part_may_open_where_that_still_lies(tmp_path: Path) -> None:
    bench = lab(tmp_path, BACK)
    closes_beside(bench)
    assert ended(bench).state is TaskState.DONE
    assert counts(bench) == THERE
