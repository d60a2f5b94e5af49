"""Answers of people to what a task asks them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from arboleda.dispatch.zones import NONE
from arboleda.model.commands import Question
from arboleda.model.messages import OperatorRequest
from arboleda.model.outside import quoted
from arboleda.model.plant_model import Link
from arboleda.model.recipe import matching
from arboleda.model.sentence import Phrase

from ..plant_state import PlantState
from .scopes import VerbRefusal

NO_PERSON = Phrase("refusal.no_person", "{person} is no person of this plant; people: {known}")
NOT_ASKED = Phrase("refusal.not_asked", "nobody asks {person} anything now")
NO_ANSWER = Phrase("refusal.no_answer", "{word} is no answer to what {person} is asked; answers: {known}")
OTHER_QUESTION = Phrase(
    "refusal.other_question", "question {question} to {person} is over; now it is asked: {text}"
)
QUESTION_OVER = Phrase(
    "refusal.question_over", "question {question} to {person} is over; nobody asks {person} anything now"
)


class Answering:
    def __init__(self, state: PlantState) -> None:
        self._state = state

    def plan(self, request: OperatorRequest, person: str) -> Callable[[], None]:
        """Plan an answer to the open question of a person; one that names another question is refused."""
        id, word = request.argument("question"), str(request.argument("answer") or "")
        people = [
            name for name, robot in self._state.dispatcher.model.robots.items() if robot.link is Link.SCREEN
        ]
        if person not in people:
            raise VerbRefusal(NO_PERSON(person=quoted(person), known=tuple(people) or NONE()))
        entry = self._state.dispatcher.ledger.question(person)
        if entry is None and id is not None:
            raise VerbRefusal(QUESTION_OVER(question=id, person=person))
        if entry is None:
            raise VerbRefusal(NOT_ASKED(person=person))
        assert isinstance(entry.command, Question)
        if id not in (None, entry.command.id):
            raise VerbRefusal(OTHER_QUESTION(question=str(id), person=person, text=entry.command.text))
        answer = matching(word, entry.command.answers)
        if answer is None:
            raise VerbRefusal(NO_ANSWER(word=quoted(word), person=person, known=entry.command.answers))
        return partial(self._answer, person, answer)

    def _answer(self, person: str, answer: str) -> None:
        self._state.dispatcher.answer(person, answer, self._state.clock.now)
