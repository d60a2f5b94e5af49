"""Questions of packages to people: asked by any thread, answered as those of tasks are.

They are of no cell and start no robot, so the engine does not know them. They are not kept: a part asks again
at its next start.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterable
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import Any

from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Journal, OperatorAnswer, Outcome, Verb
from arboleda.model.outside import quoted
from arboleda.model.recipe import matching
from arboleda.model.sentence import OWN, Phrase, Sentence
from arboleda.model.verbs import Arguments
from arboleda.views.alarms import AlarmLevel, PackageAlarm

from ..parts.orchestrator import Orchestrator
from .alarms import in_one_line
from .telling import Answer, Tell

MOST = 20  # questions of one package that are open
TOLD = 20  # answers that screens see
ASKS = Phrase("package_question.asks", "asks: {question}")
ANSWERED = Phrase("package_question.answered", "answer {answer} to {package}: {question}")
OVER = Phrase("package_question.over", "{package} asks this no more")
NO_ANSWER = Phrase(
    "package_question.no_answer", "{word} is no answer to what {package} asks; answers: {known}"
)
TOO_MANY = Phrase("package_question.too_many", "{package} has {most} open questions; no more can be asked")


@dataclass(frozen=True, kw_only=True)
class PackageQuestion:
    """Question of a package; `answer` is where the answer goes."""

    number: int
    id: str
    package: str
    text: str
    answers: tuple[str, ...]
    answer: Answer[str]
    part: str

    @property
    def alarm(self) -> PackageAlarm:
        """The question for people who are not looking."""
        sentence = ASKS(question=OWN(text=self.text))
        return PackageAlarm(id=self.number, package=self.package, sentence=sentence, level=AlarmLevel.ERROR)

    def row(self) -> dict[str, Any]:
        """The question as plain data."""
        return {"id": self.id, "package": self.package, "text": self.text, "answers": [*self.answers]}


class Questions:
    """Questions of all packages, of one start of the plant."""

    def __init__(self, running: Orchestrator, epoch: int) -> None:
        self._running = running
        self._epoch = epoch
        self._asked: list[PackageQuestion] = []
        self._packages: set[str] = set()  # that have ever asked
        self._number = 0
        self._given: deque[tuple[PackageQuestion, Journal, OperatorAnswer]] = deque()
        self._told: deque[dict[str, Any]] = deque(maxlen=TOLD)
        self._changing = threading.Lock()

    @property
    def open(self) -> list[PackageQuestion]:
        """The questions that wait for an answer, the oldest first."""
        return [each for each in [*self._asked] if not (each.answer.running() or each.answer.done())]

    def start(self) -> None:
        """Questions are asked before, too."""

    def stop(self) -> None:
        """Take back all questions, so that nobody waits any more."""
        for each in self.open:
            each.answer.cancel()

    def take_back(self, part: str) -> None:
        """Take back the questions of a part of a package."""
        for each in self.open:
            if each.part == part:
                each.answer.cancel()

    def ask(self, package: str, text: str, answers: Iterable[str], tell: Tell, part: str = "") -> Future[str]:
        """Ask people, and return at once. ValueError without a text, or without different answers;
        ArboledaError where a package has asked too much."""
        text, choices = in_one_line(text), tuple(in_one_line(each) for each in answers)
        if not text or not all(choices) or len({*choices}) < max(1, len(choices)):
            raise ValueError("a question needs a text, and answers that differ")
        with self._changing:
            self._asked = self.open
            if sum(each.package == package for each in self._asked) >= MOST:
                raise ArboledaError(TOO_MANY(package=package, most=MOST))
            self._number += 1
            asked = PackageQuestion(
                number=self._number,
                id=f"{self._number}-{self._epoch}",
                package=package,
                text=text,
                answers=choices,
                answer=Answer(tell),
                part=part,
            )
            self._packages.add(package)
            self._asked.append(asked)
        return asked.answer

    def has(self, scope: str, arguments: Arguments) -> bool:
        """True where an answer is one to a package, and not to a person whom a task asks."""
        id = str(dict(arguments).get("question", ""))
        is_person = scope in self._running.plant.model.robots
        return id.endswith(f"-{self._epoch}") or (scope in self._packages and not is_person)

    def give(self, scope: str, arguments: Arguments) -> Future[OperatorAnswer]:
        """Answer the question that is named, else the oldest one of a package; from any thread.

        The future says what came of it, once it is kept; then the package has its answer.
        """
        given = dict(arguments)
        answer, request_id = self._running.askers.expect()
        reply = OperatorAnswer(verb=Verb.ANSWER, scope=scope, request=request_id, arguments=arguments)
        with self._changing:
            asked = self._named(scope, given.get("question"))
            word = None if asked is None else matching(str(given.get("answer", "")), asked.answers)
            if asked is None or word is None or not asked.answer.set_running_or_notify_cancel():
                refusal = _refusal(scope, asked, given)
                answer.set_result(replace(reply, refusal=refusal))
                return answer
            answer.add_done_callback(lambda told: _pass_on(told, asked.answer, word))
            did = ANSWERED(answer=word, package=asked.package, question=OWN(text=asked.text))
            journal = Journal(verb=Verb.ANSWER, scope=asked.package, cell=None, sentence=did)
            self._given.append((asked, journal, replace(reply, outcome=Outcome.DONE)))
        self._running.loop.wake()
        return answer

    def stepped(self, plant: Any) -> None:
        """Keep and tell the answers that were given; in the plant's thread."""
        while self._given:
            asked, journal, reply = self._given.popleft()
            row = {"number": asked.number, "at": plant.now, "scope": asked.package, "cell": None}
            self._told.append(row | {"sentence": journal.sentence})
            self._running.tell(journal, reply)

    def rows(self) -> dict[str, Any]:
        """The open questions, and the last answers, as a snapshot has them."""
        return {"questions": [each.row() for each in self.open], "answered": [*self._told]}

    def _named(self, scope: str, id: Any) -> PackageQuestion | None:
        mine = (each for each in self.open if id == each.id or (id is None and each.package == scope))
        return next(mine, None)


def _refusal(scope: str, asked: PackageQuestion | None, given: dict[str, Any]) -> Sentence:
    if asked is None or asked.answer.done():
        return OVER(package=quoted(scope))
    word = quoted(str(given.get("answer", "")))
    return NO_ANSWER(word=word, package=asked.package, known=asked.answers)


def _pass_on(told: Future[OperatorAnswer], answer: Answer[str], word: str) -> None:
    """Give a package its answer. One that cannot be kept is none: the plant ends."""
    if told.exception() is None and told.result().refusal is None:
        answer.set_result(word)
    else:
        answer.set_exception(ArboledaError(told.exception() or told.result().refusal))
