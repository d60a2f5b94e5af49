"""Requests to the plant for whose answer a ROS 2 service waits."""

from __future__ import annotations

import logging
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import TimeoutError as NotInTime
from typing import Any
from uuid import uuid4

from arboleda.extension import ArboledaError
from arboleda.model.messages import OperatorAnswer, OperatorRequest, Outcome, TaskChanged, TaskRequest, Verb
from arboleda.model.verbs import from_text

LOG = logging.getLogger("arboleda.ros")
ANSWER_S = 1.0
UNDER_WAY = "under way: `acts` of /plant/view tell the outcome of act {act}"
Question = OperatorRequest | TaskRequest
Answer = OperatorAnswer | TaskChanged


class NoAnswer(ArboledaError):
    """Error: the plant did not answer in time; the request may still be carried out."""


class Asker:
    """`post` gives the plant a request; its answer comes back by `answered`, from any thread.

    The executor waits for it, at most ANSWER_S: the EventsExecutor of the wheels cannot await a coroutine.
    The plant answers in its own thread, in its next step.
    """

    def __init__(self, post: Callable[[Question], None], clock: Callable[[], float]) -> None:
        self._post = post
        self._clock = clock
        self._waiting: dict[str, Future[Any]] = {}

    def operate(self, verb: Verb, scope: str = "", **more: bool) -> tuple[bool, str]:
        """Carry out an operator's verb; returns whether it was done or is under way, and a sentence.

        The scope of a message has the verb's arguments, as a person types them.
        """
        of, arguments = from_text(verb, scope)

        def request(token: str) -> OperatorRequest:
            return OperatorRequest(
                at=self._clock(), verb=verb, scope=of, arguments=arguments, request=token, **more
            )

        try:
            answer = self._ask(request)
        except NoAnswer as error:
            return False, str(error)
        except Exception:  # a caller must not wait for an answer that never comes
            LOG.exception("%s %s failed", verb.value, scope or "plant")
            return False, "internal error"
        if answer.refusal is not None:
            return False, str(answer.refusal)
        if answer.outcome is Outcome.UNDER_WAY:
            return True, UNDER_WAY.format(act=answer.act)
        return answer.outcome is not Outcome.FAILED, str(answer.why or "")

    def submit(self, text: str) -> TaskChanged:
        """Submit a task; returns its first state, a refusal included. Raises NoAnswer."""
        first: TaskChanged = self._ask(lambda token: TaskRequest(at=self._clock(), text=text, request=token))
        return first

    def submit_later(self, text: str, token: str) -> None:
        """Submit a task without waiting; the TaskChanged that answers carries the token."""
        self._post(TaskRequest(at=self._clock(), text=text, request=token))

    def cancellation_refusal(self, task: str) -> str | None:
        """Cancel a task for its client; returns the reason for a refusal, None if it was cancelled."""
        done, sentence = self.operate(Verb.CANCEL, task, client=True)
        return None if done else sentence

    def cancel_later(self, task: str) -> None:
        """Cancel a task for its client without waiting; its changes tell the outcome."""
        self._post(OperatorRequest(at=self._clock(), verb=Verb.CANCEL, scope=task, client=True))

    def answered(self, answer: Answer) -> None:
        """Take an answer of the plant, and pass it to whoever waits for it."""
        waiting = self._waiting.pop(answer.request or "", None)
        if waiting is not None:
            waiting.set_result(answer)

    def _ask(self, question: Callable[[str], Question]) -> Any:
        token, answer = uuid4().hex, Future[Any]()
        self._waiting[token] = answer
        try:
            self._post(question(token))
            return answer.result(ANSWER_S)
        except NotInTime:
            raise NoAnswer("the plant did not answer in time; see its state before asking again") from None
        finally:
            self._waiting.pop(token, None)
