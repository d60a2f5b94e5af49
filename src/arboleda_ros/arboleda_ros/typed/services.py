"""Services `plant/submit_task` and `plant/cell_command`."""

from __future__ import annotations

import logging

from arboleda_interfaces.msg import Task
from arboleda_interfaces.srv import CellCommand, SubmitTask
from rclpy.node import Node

from arboleda.drivers import quoted
from arboleda.model.advice import BY_HAND
from arboleda.model.messages import TaskState, Verb
from arboleda.views import view
from arboleda_ros.plant_queries import Asker, NoAnswer

from . import values

LOG = logging.getLogger("arboleda.ros")
_VERBS = {verb.value: verb for verb in Verb}


class Services:
    """Services; each call is answered within asking.ANSWER_S, a refusal with a sentence."""

    def __init__(self, node: Node, asker: Asker) -> None:
        self._asker = asker
        node.create_service(SubmitTask, "plant/submit_task", self._submit)
        node.create_service(CellCommand, "plant/cell_command", self._command)

    def _submit(self, request: SubmitTask.Request, response: SubmitTask.Response) -> SubmitTask.Response:
        text = values.text_of(request)
        try:
            answer = self._asker.submit(text)
        except NoAnswer as error:
            response.task = Task(text=text, sentence=str(error))
            return response
        response.accepted = answer.state is not TaskState.REFUSED
        response.task = values.task_message(view.change(answer))
        return response

    def _command(self, request: CellCommand.Request, response: CellCommand.Response) -> CellCommand.Response:
        response.success, response.message = self._operated(request)
        return response

    def _operated(self, request: CellCommand.Request) -> tuple[bool, str]:
        verb = _VERBS.get(request.verb.strip().lower())
        if verb is None:
            return False, f"{quoted(request.verb)} is no verb; there are {', '.join(_VERBS)}"
        if request.by_hand and verb not in BY_HAND:
            return False, f"by_hand is for home and release only, not for {verb.value}"
        return self._asker.operate(verb, request.scope, by_hand=request.by_hand)
