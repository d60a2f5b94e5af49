"""Operator's verbs as services, `plant/<verb>`: std_srvs/Trigger, for the whole plant."""

from __future__ import annotations

from functools import partial

from rclpy.node import Node
from std_srvs.srv import Trigger

from arboleda.model.messages import Verb
from arboleda_ros.plant_queries import Asker


class VerbServices:
    """Services of the verbs, one each."""

    def __init__(self, node: Node, asker: Asker) -> None:
        self._asker = asker
        for verb in Verb:
            node.create_service(Trigger, f"plant/{verb.value}", partial(self._serve, verb))

    def _serve(self, verb: Verb, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success, response.message = self._asker.operate(verb)
        return response
