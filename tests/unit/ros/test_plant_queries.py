"""What a service answers for the plant, which its own thread has said."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed")

from arboleda.departures.leaving import STILL_WAITS, stop_left
from arboleda.model.messages import OperatorAnswer, OperatorRequest, Outcome, Verb
from arboleda_ros import plant_queries
from arboleda_ros.plant_queries import Asker, Question

AT = 7.5


class Plant:
    """A plant that answers each request at once, with what `says` makes of it."""

    def __init__(self, says: Callable[[OperatorRequest], list[OperatorAnswer]]) -> None:
        self._says = says
        self.asked: list[OperatorRequest] = []
        self.asker = Asker(self._post, lambda: AT)

    def _post(self, question: Question) -> None:
        assert isinstance(question, OperatorRequest)
        self.asked.append(question)
        for answer in self._says(question):
            self.asker.answered(answer)


def answer(request: OperatorRequest, **told: Any) -> OperatorAnswer:
    return OperatorAnswer(verb=request.verb, scope="", request=request.request, **told)


@pytest.mark.parametrize("verb", list(Verb), ids=lambda verb: verb.value)
def test_the_plant_is_asked_for_a_verb_with_the_time_of_its_call(verb: Verb) -> None:
    plant = Plant(lambda request: [answer(request)])
    assert plant.asker.operate(verb) == (True, "")
    (asked,) = plant.asked
    assert (asked.verb, asked.scope, asked.at, asked.by_hand) == (verb, "", AT, False)


@pytest.mark.parametrize(
    ("told", "said"),
    [
        ({"refusal": "ra1 still moves"}, (False, "ra1 still moves")),
        (
            {"act": 7, "outcome": Outcome.UNDER_WAY},
            (True, "under way: `acts` of /plant/view tell the outcome of act 7"),
        ),
        ({"act": 7, "outcome": Outcome.FAILED, "why": "jaw: it is stuck"}, (False, "jaw: it is stuck")),
        ({"act": 7, "outcome": Outcome.UNCHECKED, "why": "jaw says nothing"}, (True, "jaw says nothing")),
        ({"act": 7, "outcome": Outcome.DONE}, (True, "")),
    ],
    ids=["refused", "under way", "failed", "unchecked", "done"],
)
def test_what_came_of_it_is_answered_as_it_stands(told: dict[str, Any], said: tuple[bool, str]) -> None:
    plant = Plant(lambda request: [answer(request, **told)])
    assert plant.asker.operate(Verb.RELEASE) == said


def test_a_stop_that_has_left_and_is_not_kept_says_so() -> None:
    plant = Plant(lambda request: [stop_left(request, STILL_WAITS())])
    done, sentence = plant.asker.operate(Verb.STOP)
    assert done and "left for the whole plant, and the plant has not kept it" in sentence


def test_answers_to_others_are_passed_over() -> None:
    def says(request: OperatorRequest) -> list[OperatorAnswer]:
        others = [OperatorAnswer(verb=Verb.STOP, scope="", request=of, refusal="no") for of in (None, "web")]
        return [*others, answer(request)]

    assert Plant(says).asker.operate(Verb.STOP) == (True, "")


def test_a_plant_that_does_not_answer_is_said_to_and_its_late_answer_hurts_nobody(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(plant_queries, "ANSWER_S", 0.0)
    plant = Plant(lambda request: [])
    done, sentence = plant.asker.operate(Verb.STOP)
    assert not done and "did not answer in time" in sentence
    plant.asker.answered(answer(plant.asked[0]))


def test_a_verb_that_fails_inside_is_answered_too(caplog: pytest.LogCaptureFixture) -> None:
    def says(request: OperatorRequest) -> list[OperatorAnswer]:
        raise ZeroDivisionError

    assert Plant(says).asker.operate(Verb.HOLD) == (False, "internal error")
    assert "hold plant failed" in caplog.text
