"""A person is asked by a recipe, and answers as an operator does."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from arboleda.cli.screen import parting
from arboleda.core import reasons
from arboleda.kinds.person import person
from arboleda.model.messages import Reason, TaskAnswer, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.model.recipe import Recipe
from arboleda.recipes import Kit, RecipeError, recipe, work
from arboleda.trees.context import MOST_ANSWERS
from arboleda.views import view

from ...plants import made
from .lab import Bench
from .tending import plant


def attended(*recipes: Recipe) -> PlantModel:
    model = plant(*recipes)
    (cell,) = model.cells
    return replace(model, cells=(replace(cell, members=(*cell.members, ("ana", person("ana")))),))


@recipe("refill")
def refill(cell: Kit):  # type: ignore[no-untyped-def]
    left, ana = cell.devices("left", "ana")
    asked = ana.ask("Is the pallet full again?", ["yes", "no parts left"], at_most_s=60.0)
    ways = {"yes": left.go("feed_2"), "no parts left": cell.fail("there are no parts left")}
    return work(asked, cell.choose(asked, ways))


def asking(*recipes: Recipe) -> Bench:
    here = Bench(attended(*(recipes or (refill,))))
    here.submit("tending refill")
    assert here.wait(10.0, lambda: question(here) is not None)
    return here


def question(here: Bench) -> Any:
    robots = {row["name"]: row for row in view.snapshot(here.plant)["robots"]}
    return robots["ana"]["question"]


def test_screens_show_what_is_asked_and_how_long() -> None:
    here = asking()
    here.wait(10.0)
    shown = question(here)
    assert (shown["text"], shown["answers"]) == ("Is the pallet full again?", ["yes", "no parts left"])
    assert shown["left_s"] == pytest.approx(50.0)


def test_a_question_is_open_for_no_longer_than_is_left_of_it() -> None:
    here = asking()
    here.wait(60.0, lambda: question(here)["left_s"] < 0.5)
    assert 0.0 < question(here)["left_s"] < 0.5


def test_the_task_goes_on_with_the_answer() -> None:
    here = asking()
    assert here.operate(Verb.ANSWER, "ana", answer="Yes") is None
    assert question(here) is None
    assert here.outcome().state.value == "done"
    assert str(here.plant.acts[-1].sentence) == "answer ana yes"


@pytest.mark.parametrize("word", ["sí", "SÍ", "si\u0301"])
def test_an_answer_may_have_any_letters(word: str) -> None:
    full = made("full", lambda cell: cell.device("ana").ask("¿Está lleno?", ["sí", "no"], at_most_s=60.0))
    here = Bench(attended(full))
    here.submit("tending full")
    assert here.wait(10.0, lambda: question(here) is not None)
    assert here.operate(Verb.ANSWER, "ana", answer=word) is None
    assert here.outcome().state.value == "done"


def test_what_was_answered_is_kept_with_the_task() -> None:
    here = asking()
    assert view.task_by_id(here.plant, "t-1000-1")["answers"] == []  # type: ignore[index]
    assert here.operate(Verb.ANSWER, "ana", answer="Yes") is None
    answers = [{"by": "ana", "asked": "Is the pallet full again?", "answer": "yes"}]
    (cell,) = view.snapshot(here.plant)["cells"]
    assert cell["task"]["answers"] == answers
    here.outcome()
    (task,) = view.snapshot(here.plant)["tasks"]
    assert (task["state"], task["answers"]) == ("done", answers)


def test_a_task_has_the_answers_of_its_own() -> None:
    here = asking()
    assert here.operate(Verb.ANSWER, "ana", answer="yes") is None
    here.outcome()
    here.submit("tending refill")
    assert here.wait(10.0, lambda: question(here) is not None)
    first, second = view.snapshot(here.plant)["tasks"]
    assert (len(first["answers"]), second["answers"]) == (1, [])


def test_of_very_many_answers_the_last_ones_are_kept() -> None:
    here = asking()
    context = here.plant.cells["tending"].context
    for number in range(MOST_ANSWERS + 5):
        context.note(TaskAnswer(by="ana", asked="more?", answer=number))
    assert [each.answer for each in context.answers] == [*range(5, MOST_ANSWERS + 5)]


def test_who_was_asked_is_no_robot_that_was_left_moving() -> None:
    here = asking()
    assert here.operate(Verb.ANSWER, "ana", answer="yes") is None
    assert here.outcome().state.value == "done"
    lines = parting(view.snapshot(here.plant))
    assert "left: still, effector off" in lines
    assert not [line for line in lines if line.startswith("ana")]


def test_another_answer_is_another_way() -> None:
    here = asking()
    assert here.operate(Verb.ANSWER, "ana", answer="no parts left") is None
    assert str(here.outcome().sentence) == "there are no parts left"


@pytest.mark.parametrize(
    ("person", "word", "sentence"),
    [
        ("ana", "maybe", "'maybe' is no answer to what ana is asked; answers: yes, no parts left"),
        ("ana", "", "'' is no answer to what ana is asked; answers: yes, no parts left"),
        ("left", "yes", "'left' is no person of this plant; people: ana"),
    ],
)
def test_a_wrong_answer_changes_nothing_and_says_what_is_right(person: str, word: str, sentence: str) -> None:
    here = asking()
    assert here.operate(Verb.ANSWER, person, answer=word) == sentence
    assert question(here) is not None


def test_who_is_asked_nothing_answers_nothing() -> None:
    here = Bench(attended(refill))
    assert here.operate(Verb.ANSWER, "ana", answer="yes") == "nobody asks ana anything now"


def test_a_question_that_nobody_answers_ends() -> None:
    here = asking()
    assert here.outcome().reason is Reason.DEADLINE
    assert here.operate(Verb.ANSWER, "ana", answer="yes") == "nobody asks ana anything now"


def test_a_question_is_forgotten_when_its_task_is_cancelled() -> None:
    here = asking()
    assert here.operate(Verb.CANCEL, "tending") is None
    here.wait(5.0)
    assert question(here) is None


def test_a_question_stays_while_the_cell_is_held() -> None:
    here = asking()
    assert here.operate(Verb.HOLD, "tending") is None
    here.wait(1.0)
    assert question(here) is not None
    told = "tending is held (by the operator); ana has a question to answer first"
    assert str(reasons.of_hold(here.plant.cells["tending"])) == told
    assert here.operate(Verb.ANSWER, "ana", answer="yes") is None
    assert not any("ana" in each.moves for each in here.plant.advice("tending"))
    assert here.operate(Verb.RESUME, "tending") is None
    assert here.outcome().state.value == "done"


def test_a_stop_of_the_plant_counts_for_people_and_is_cleared_with_the_others() -> None:
    here = asking()
    assert here.operate(Verb.STOP) is None
    here.wait(5.0)
    assert question(here) is None
    for verb in (Verb.CLEAR, Verb.RESET, Verb.RESUME):
        assert here.operate(verb) is None, verb
        here.wait(3.0)
    here.submit("tending refill")
    assert here.wait(10.0, lambda: question(here) is not None)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("", ["yes"]), "1 to 300 characters"),
        (("Full?", []), "must be different words"),
        (("Full?", ["yes", "Yes"]), "must be different words"),
        (("Full?", ["yes", ""]), "must be different words"),
        (("Full?", ["yes", "n/a"]), "without /"),
        (("Full?", ["yes", "n" * 61]), "each 1 to 60 characters"),
    ],
)
def test_a_question_that_nobody_could_answer_is_refused(words: tuple[str, list[str]], sentence: str) -> None:
    @recipe("refill")
    def wrong(cell: Kit):  # type: ignore[no-untyped-def]
        with pytest.raises(RecipeError, match=sentence):
            cell.device("ana").ask(*words)
        return cell.wait(0.1)

    here = Bench(attended(wrong))
    here.submit("tending refill")
    assert here.outcome().state.value == "done"


@recipe("refill")
def twice(cell: Kit):  # type: ignore[no-untyped-def]
    """The same person is asked two questions, with the same answers."""
    ana = cell.device("ana")
    return work(ana.ask("Is the door shut?", ["yes", "no"]), ana.ask("Open the door?", ["yes", "no"]))


def test_an_answer_to_a_question_that_is_over_is_none_to_the_next_one() -> None:
    here = asking(twice)
    first = question(here)["id"]
    assert here.operate(Verb.ANSWER, "ana", question=first, answer="yes") is None
    assert str(here.plant.acts[-1].sentence) == "answer ana yes"
    assert here.wait(1.0, lambda: question(here) is not None)
    late = here.operate(Verb.ANSWER, "ana", question=first, answer="yes")
    assert late == f"question {first} to ana is over; now it is asked: Open the door?"
    assert question(here)["text"] == "Open the door?"
    assert here.operate(Verb.ANSWER, "ana", answer="yes") is None  # the short form is for what is asked now
    assert here.outcome().state.value == "done"
    over = here.operate(Verb.ANSWER, "ana", question=first, answer="yes")
    assert over == f"question {first} to ana is over; nobody asks ana anything now"


def test_an_answer_may_begin_with_what_is_no_id() -> None:
    @recipe("refill")
    def numbers(cell: Kit):  # type: ignore[no-untyped-def]
        return cell.device("ana").ask("Which one?", ["#1", "#1-2 x"])

    here = asking(numbers)
    asked = question(here)["id"]
    assert here.operate(Verb.ANSWER, "ana", answer="#2") is not None
    assert here.operate(Verb.ANSWER, "ana", question=asked, answer="#1-2 x") is None
    assert here.outcome().state.value == "done"


@recipe("look")
def look(cell: Kit):  # type: ignore[no-untyped-def]
    left, ana = cell.devices("left", "ana")
    return work(left.go("feed_2"), ana.ask("Is it clean?", ["yes"]), left.go("feed"), left.home())


@pytest.mark.long
def test_a_task_that_waits_long_for_an_answer_is_not_nearly_done() -> None:
    here = Bench(attended(look))
    here.submit("tending look")
    assert here.wait(30.0, lambda: question(here) is not None)
    here.wait(2.0)
    here.operate(Verb.ANSWER, "ana", answer="yes")
    here.outcome()
    (course,) = (task.course for task in here.plant.intake.tasks.values())
    assert course is not None
    after_answer_s = course.seconds - course.begun["ask ana #1"] - 2.0
    here.submit("tending look")
    assert here.wait(30.0, lambda: question(here) is not None)
    here.wait(500.0)
    (promised,) = here.plant.prospects("tending look")
    assert promised.seconds - course.seconds == pytest.approx(after_answer_s)
    asked_at = here.plant.now
    here.operate(Verb.ANSWER, "ana", answer="yes")
    here.outcome()
    assert here.plant.now - asked_at == pytest.approx(after_answer_s, abs=0.5)
