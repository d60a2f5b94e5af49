"""Receivers of alarms: they belong to an installation, not to a plant, and are partly secret; so the
environment names them."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass

from arboleda.adapters.webhook import Hook, hook
from arboleda.model.errors import StartError
from arboleda.model.outside import quoted
from arboleda.model.plant_model import PlantModel

TOPIC = "ARBOLEDA_ALARM_TOPIC"
TOPICS = re.compile(r"[A-Za-z0-9_-]+(/[A-Za-z0-9_-]+)*", re.ASCII)
LONGEST = 200


@dataclass(frozen=True, kw_only=True)
class AlarmOptions:
    """A webhook, a topic on the plant's broker, both, or neither."""

    hook: Hook | None = None
    topic: str | None = None

    def check(self, model: PlantModel, *, has_broker: bool) -> None:
        """Raise StartError if there is no broker to publish on, or the topic may be one of a board."""
        if self.topic is None:
            return
        if not has_broker:
            raise StartError(f"${TOPIC}: this plant speaks to no MQTT broker; name one with --broker")
        if self.topic.split("/")[0] in {robot.mqtt for robot in model.robots.values()}:
            raise StartError(f"${TOPIC}: {self.topic} is a topic of a board; choose one like arboleda/alarms")


def alarm_options() -> AlarmOptions:
    """The receivers that the environment names; StartError if a variable means nothing."""
    topic = os.environ.get(TOPIC) or None
    if topic is not None and not (len(topic) <= LONGEST and TOPICS.fullmatch(topic)):
        raise StartError(f"${TOPIC}: {quoted(topic)} is no topic for alarms; write one like arboleda/alarms")
    return AlarmOptions(hook=hook(), topic=topic)
