"""The operator's verbs as services, `plant/<verb>`: std_srvs/Trigger, for the whole plant."""

from __future__ import annotations

import logging
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import TimeoutError as NotInTime
from functools import partial
from uuid import uuid4

from rclpy.node import Node
from std_srvs.srv import Trigger

from arboleda.core.messages import OperatorAnswer, OperatorRequest, Verb

LOG = logging.getLogger("arboleda.ros")
ANSWER_S = 1.0


class VerbServices:
    """A service per verb; `ask` gives the plant a request, whose answer comes back by `answered`.

    The executor waits for the answer, at most ANSWER_S: the EventsExecutor of the wheels cannot await a
    coroutine. The plant answers in its own thread, in its next step.
    """

    def __init__(
        self, node: Node, ask: Callable[[OperatorRequest], None], clock: Callable[[], float]
    ) -> None:
        self._ask = ask
        self._clock = clock
        self._waiting: dict[str, Future[OperatorAnswer]] = {}
        for verb in Verb:
            node.create_service(Trigger, f"plant/{verb.value}", partial(self._serve, verb))

    def answered(self, answer: OperatorAnswer) -> None:
        """Take in an answer of the plant, to whomever it is; from any thread."""
        waiting = self._waiting.pop(answer.request or "", None)
        if waiting is not None:
            waiting.set_result(answer)

    def _serve(self, verb: Verb, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        try:
            refusal = self._refusal(verb)
        except NotInTime:
            refusal = "the plant did not answer in time; see its state before asking again"
        except Exception:  # a caller must not wait for an answer that never comes
            LOG.exception("the service plant/%s failed", verb.value)
            refusal = "internal error"
        response.success, response.message = refusal is None, refusal or ""
        return response

    def _refusal(self, verb: Verb) -> str | None:
        token, answer = uuid4().hex, Future[OperatorAnswer]()
        self._waiting[token] = answer
        try:
            self._ask(OperatorRequest(at=self._clock(), verb=verb, request=token))
            return answer.result(ANSWER_S).refusal
        finally:
            self._waiting.pop(token, None)
