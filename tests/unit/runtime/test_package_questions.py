"""What packages ask people: shown, answered and journalled as what tasks ask, beside the engine."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

from arboleda.cli.screen import table
from arboleda.dashboard.page_state import PageState
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import OperatorAnswer, Verb
from arboleda.runtime.build import App, Options, build
from arboleda.runtime.extensions.questions import MOST, Questions
from arboleda.runtime.parts.local_plant import LocalPlant
from arboleda.testing import shipped
from arboleda.views import view
from arboleda.views.chronicle import Chronicle

NO_LINKS: dict[str, Any] = {"broker": None, "ros": None, "refused": {}, "standbys": []}


class Later:
    """A part's thread: what is to be called there waits here."""

    def __init__(self) -> None:
        self.waiting: list[Callable[[], object]] = []

    def each(self, listener: Callable[[Any], object]) -> Callable[[Any], None]:
        return lambda told: self.waiting.append(lambda: listener(told))


@pytest.fixture
def later() -> Later:
    return Later()


@pytest.fixture
def app(tmp_path: Path) -> Iterator[App]:
    """A plant that nobody has started: its steps are taken by hand."""
    made = build(shipped("sis_a"), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    yield made
    made.stop()


@pytest.fixture
def questions(app: App) -> Questions:
    return app.offers.need(Questions)


def answered(app: App, scope: str, answer: str, **more: str) -> OperatorAnswer:
    """What the plant says to an answer, once it has made a step."""
    arguments = tuple({**more, "answer": answer}.items())
    told = app.offers.need(LocalPlant).operate(Verb.ANSWER, scope, arguments=arguments)
    app.plant.loop.turn()
    return told.result(0)


def snapshot(app: App) -> dict[str, Any]:
    app.plant.loop.turn()
    return app.offers.need(LocalPlant).latest()


def test_a_package_gets_the_answer_that_people_give(app: App, questions: Questions, later: Later) -> None:
    future = questions.ask("orders", "Is the\n lot good?", ("good", "bad"), later.each)
    (asked,) = snapshot(app)["questions"]
    assert asked == {
        "id": asked["id"],
        "package": "orders",
        "text": "Is the lot good?",
        "answers": ["good", "bad"],
    }
    answer = answered(app, "orders", "Good", question=asked["id"])
    assert answer.refusal is None and answer.outcome == "done"
    assert future.result(0) == "good" and snapshot(app)["questions"] == []


def test_it_has_the_answer_only_once_that_is_kept(app: App, questions: Questions, later: Later) -> None:
    future = questions.ask("orders", "Is the lot good?", ("good", "bad"), later.each)
    told = questions.give("orders", (("answer", "good"),))
    assert not told.done() and not future.done()
    app.plant.loop.turn()
    (kept,) = app.plant.keeping.store.acts.last()  # type: ignore[union-attr]
    assert (kept.verb, kept.scope, kept.sentence) == (
        "answer",
        "orders",
        "answer good to orders: Is the lot good?",
    )
    assert told.done() and future.done()


def test_a_callback_is_called_in_the_thread_of_the_part_alone(
    app: App, questions: Questions, later: Later
) -> None:
    called: list[str] = []
    future = questions.ask("orders", "Is the lot good?", ("good", "bad"), later.each)
    future.add_done_callback(lambda done: called.append(done.result()))
    answered(app, "orders", "good")
    assert called == []
    for call in later.waiting:
        call()
    assert called == ["good"]


def test_packages_ask_at_the_same_time_and_the_oldest_question_is_answered_first(
    app: App, questions: Questions, later: Later
) -> None:
    first = questions.ask("orders", "Good?", ("yes", "no"), later.each)
    second = questions.ask("orders", "Sure?", ("yes", "no"), later.each)
    other = questions.ask("camera", "Sharp?", ("yes", "no"), later.each)
    answered(app, "orders", "yes")
    assert first.done() and not second.done() and not other.done()
    answered(app, "camera", "no")
    answered(app, "orders", "no")
    assert (first.result(0), second.result(0), other.result(0)) == ("yes", "no", "no")


def test_what_is_no_answer_is_refused_and_so_is_one_that_comes_late(
    app: App, questions: Questions, later: Later
) -> None:
    future = questions.ask("orders", "Good?", ("yes", "no"), later.each)
    id = questions.open[0].id
    refused = answered(app, "orders", "maybe")
    assert str(refused.refusal) == "'maybe' is no answer to what orders asks; answers: yes, no"
    answered(app, "orders", "no", question=id)
    for late in ({"question": id}, {}):
        assert str(answered(app, "orders", "yes", **late).refusal) == "'orders' asks this no more"
    assert future.result(0) == "no"


def test_a_question_of_an_earlier_start_is_not_taken_for_one_of_this(
    app: App, questions: Questions, later: Later
) -> None:
    future = questions.ask("orders", "Good?", ("yes", "no"), later.each)
    assert answered(app, "orders", "yes", question="1-7").refusal is not None
    assert not future.done()
    assert "is no person of this plant" in str(answered(app, "camera", "yes").refusal)


def test_a_question_that_is_taken_back_is_over_also_at_the_end_of_the_plant(
    app: App, questions: Questions, later: Later
) -> None:
    back = questions.ask("orders", "Good?", ("yes", "no"), later.each)
    left = questions.ask("orders", "Sure?", ("yes", "no"), later.each)
    assert back.cancel()
    assert [each["text"] for each in snapshot(app)["questions"]] == ["Sure?"]
    questions.stop()
    assert left.cancelled() and snapshot(app)["questions"] == []


@pytest.mark.parametrize(
    ("text", "answers"), [("", ("yes",)), ("Good?", ()), ("Good?", ("a", "a")), ("Good?", ("",))]
)
def test_a_question_has_a_text_and_answers(
    questions: Questions, later: Later, text: str, answers: tuple[str, ...]
) -> None:
    with pytest.raises(ValueError, match="a question needs a text"):
        questions.ask("orders", text, answers, later.each)


def test_a_package_cannot_bury_people_in_questions(questions: Questions, later: Later) -> None:
    for number in range(MOST):
        questions.ask("orders", f"Good {number}?", ("yes",), later.each)
    with pytest.raises(ArboledaError, match="orders has 20 open questions"):
        questions.ask("orders", "Another?", ("yes",), later.each)
    questions.ask("camera", "Sharp?", ("yes",), later.each)


def test_the_page_and_a_terminal_offer_the_answers(app: App, questions: Questions, later: Later) -> None:
    questions.ask("orders", "Is the lot good?", ("good", "bad"), later.each)
    seen = snapshot(app)
    story = PageState(view.layout(app.model), [])
    story.see(seen, 0.0)
    face = story.face("en", NO_LINKS)
    (id,) = face["rows/asks"]
    row = face[f"row/asks/{id}"]
    assert row["texts"] == ["orders", "Is the lot good?"]
    assert [(each["act"], each["of"], each["label"]) for each in row["acts"]] == [
        ("answer", "orders", "good"),
        ("answer", "orders", "bad"),
    ]
    assert row["acts"][0]["arguments"] == {"question": id, "answer": "good"}
    assert f"question/{id}" in face["text/needs"][0].split()
    assert "orders: Is the lot good?" in face["text/title"][0]
    console = Console(file=io.StringIO(), width=90)
    console.print(table(seen))
    printed = console.file.getvalue()  # type: ignore[attr-defined]
    assert "orders asks: Is the lot good?" in printed
    assert f"arboleda answer --question {id} orders good" in printed


def test_the_time_line_has_what_was_answered_once(app: App, questions: Questions, later: Later) -> None:
    questions.ask("orders", "Good?", ("yes", "no"), later.each)
    chronicle = Chronicle()
    chronicle.see(snapshot(app), 0.0)
    answered(app, "orders", "yes")
    for _ in range(2):
        chronicle.see(snapshot(app), 1.0)
    (event,) = (each for each in chronicle.events if each["kind"] == "operator")
    assert (event["subject"], str(event["sentence"])) == ("orders", "answer yes to orders: Good?")
