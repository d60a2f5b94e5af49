"""Alarms of a plant: to a webhook, to a topic on its MQTT broker, or to both."""

from __future__ import annotations

import json
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from datetime import datetime, timezone
from typing import Any
from uuid import uuid4

from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.adapters.webhook import NotDelivered, Webhook
from arboleda.engine import Plant
from arboleda.model.messages import TaskChanged, TaskState
from arboleda.model.plant_model import PlantModel
from arboleda.views import alarms
from arboleda.views.alarms import PackageAlarm
from arboleda.wire.transport import Connection, Delivery, Publication

from ..alarm_options import AlarmOptions
from .commit_pace import Pace
from .outbox import Outbox, Receiver
from .part import BrokerAddress

TAKES_S = 5.0  # for a broker to confirm an alarm
Page = Callable[[str, "str | None"], "str | None"]  # where a browser sees a cell, or a task of it


class AlarmsPart:
    """AlarmsPart: raises the alarms of a plant, in the plant's thread, and has other threads deliver them."""

    def __init__(
        self,
        receivers: Sequence[Receiver],
        page: Page,
        of_packages: Callable[[], Sequence[PackageAlarm]] = tuple,
    ) -> None:
        self._outboxes = [Outbox(each) for each in receivers]
        self._page = page
        self._of_packages = of_packages  # those that stand
        self._told: dict[PackageAlarm, str] = {}  # those that were told, with the id of that
        self._number = 0
        self._failed: deque[TaskChanged] = deque()  # from another thread
        self._paces: deque[Pace] = deque()  # from slow to fast and back, from another thread
        self._slow: str | None = None  # the alarm that stands of the memory
        self._last_version = -1
        self._stepped_at: float | None = None
        self._open: dict[str, tuple[str, alarms.Need]] = {}  # by cell: the alarm that stands, and its cause
        self._blocked: dict[str, float] = {}  # by cell: since when, as long as nobody was told
        self.notes = [f"Alarms: to {each}" for each in receivers]

    def start(self) -> None:
        for outbox in self._outboxes:
            outbox.start()

    def stop(self) -> None:
        for outbox in self._outboxes:
            outbox.end()
        for outbox in self._outboxes:
            outbox.stop()

    def changed(self, task: TaskChanged) -> None:
        """Note a task that failed; from any thread, raised with the next step.

        A repeated request gets the failure once more, which is no news.
        """
        if task.state is TaskState.FAILED and task.request is None:
            self._failed.append(task)

    def paced(self, pace: Pace) -> None:
        """Note that commits got slow, or fast again; from any thread, raised with the next step."""
        self._paces.append(pace)

    def stepped(self, plant: Plant) -> None:
        """Raise the alarms of a step, after its commands have left."""
        before, self._stepped_at = self._stepped_at, plant.now
        if before is not None and plant.now - before > plant.away_after_s:
            self._tell(plant, alarms.of_absence(plant, plant.now - before), None)
        while self._paces:
            pace = self._paces.popleft()
            alarm = alarms.of_memory(plant, pace.sentence, is_slow=pace.is_slow)
            id = self._tell(plant, alarm, None if pace.is_slow else self._slow)
            self._slow = id if pace.is_slow else None
        while self._failed:
            self._tell(plant, alarms.of_task(plant, self._failed.popleft()), None)
        self._look_at_packages(plant)
        if plant.intake.closed or (plant.version == self._last_version and not self._blocked):
            return  # a person who ends a plant knows that it stands
        self._last_version = plant.version
        for name in plant.cells:
            self._look(plant, name)

    def _look_at_packages(self, plant: Plant) -> None:
        standing = self._of_packages()
        if not standing and not self._told:
            return
        for over in [each for each in self._told if each not in standing]:
            self._tell(plant, alarms.of_package(plant, over, over=True), self._told.pop(over))
        for new in (each for each in standing if each not in self._told):
            self._told[new] = self._tell(plant, alarms.of_package(plant, new), None)

    def _look(self, plant: Plant, name: str) -> None:
        run, open_alarm = plant.cells[name], self._open.get(name)
        need = alarms.need_of(run)
        if open_alarm is None and self._may_pass(plant, name, need):
            return
        if need is not None and (open_alarm is None or open_alarm[1] != need):
            self._open[name] = (
                self._tell(plant, alarms.of_cell(plant, name), open_alarm and open_alarm[0]),
                need,
            )
        elif need is None and open_alarm is not None and run.state in alarms.AT_WORK_AGAIN:
            del self._open[name]
            self._tell(plant, alarms.of_cell(plant, name), open_alarm[0])

    def _may_pass(self, plant: Plant, name: str, need: alarms.Need | None) -> bool:
        """True while a cell has been blocked for less than BLOCKED_S, which may pass without an alarm."""
        if need is None or need.kind != alarms.CELL_BLOCKED:
            self._blocked.pop(name, None)
            return False
        if plant.now - self._blocked.setdefault(name, plant.now) < alarms.BLOCKED_S:
            return True
        del self._blocked[name]
        return False

    def _tell(self, plant: Plant, alarm: alarms.Alarm, first: str | None) -> str:
        """Deliver an alarm; returns the id of the standing one: its own, or that of a hold's `first`."""
        self._number += 1
        id = f"{plant.model.name}-{plant.epoch}-{self._number}"
        task = alarm["task"]["id"] if alarm["kind"] == alarms.TASK_FAILED else None
        about = {
            "id": id,
            "alarm": first or id,
            **alarm,
            "time": datetime.fromtimestamp(time.time(), timezone.utc).isoformat(timespec="milliseconds"),
            "page": self._page(alarm["cell"], task),
        }
        for outbox in self._outboxes:
            outbox.put(about)
        return first or id


class OnTopic:
    """Publishes on the plant's own MQTT broker or the one that it uses, QoS 1."""

    def __init__(self, model: PlantModel, broker: BrokerAddress, topic: str) -> None:
        self._model = model
        self._broker = broker
        self._topic = topic
        self._up = threading.Event()
        self._client: MqttClient | None = None

    def __str__(self) -> str:
        return f"the MQTT topic {self._topic}"

    def post(self, what: dict[str, Any]) -> None:
        """Return once the broker has it; else raise NotDelivered."""
        if self._client is None:  # its address is known once the broker has started
            self._client = MqttClient(
                f"arboleda_alarms_{uuid4().hex[:8]}",
                self._broker.address,
                on_event=self._note_connection,
                credentials=self._broker.credentials,
                version=self._model.mqtt_version,
                announce=False,
            )
            self._client.start()
        self._up.wait(TAKES_S)
        payload = json.dumps(what, ensure_ascii=False).encode()
        try:
            self._client.deliver(Publication(topic=self._topic, payload=payload), TAKES_S)
        except NotConnected as error:
            raise NotDelivered(str(error)) from error

    def close(self) -> None:
        if self._client is not None:
            self._client.close()

    def _note_connection(self, event: Delivery | Connection) -> None:
        if isinstance(event, Connection):
            (self._up.set if event.up else self._up.clear)()


def alarms_part(
    model: PlantModel,
    options: AlarmOptions,
    broker: BrokerAddress,
    page: Page,
    of_packages: Callable[[], Sequence[PackageAlarm]] = tuple,
) -> AlarmsPart | None:
    """The alarms part, if anybody wants alarms."""
    hooks: list[Receiver] = [Webhook(options.hook)] if options.hook else []
    topics: list[Receiver] = [OnTopic(model, broker, options.topic)] if options.topic else []
    return AlarmsPart([*hooks, *topics], page, of_packages) if hooks or topics else None
