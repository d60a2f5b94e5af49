"""Campaign of a plant with a Dobot under its faults: the task, and the failures that each may cause."""

from __future__ import annotations

import math
from collections.abc import Sequence

from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel, Robot
from arboleda_drivers.connections.link import Close, Closed, Open, Opened
from arboleda_drivers.dobot.dashboard import SendLine
from arboleda_drivers.dobot.machine import DashboardReply, Event, FeedbackData, Machine, Message
from arboleda_drivers.dobot.settings import Settings
from arboleda_drivers.dobot.virtual.machine import FAULTS, Answer, ClientText, Disconnect, Frame, VirtualDobot

from . import loopback
from .rig import Hear
from .storage import StorageRig

FRAME_S = 0.04  # a fifth of a real one's frames is enough to see every state

NO_WORK = {Reason.DEVICE_FAULT, Reason.REJECTED, Reason.NOT_HOMED}
NO_LINK = {Reason.LINK_LOST}
CAUSES: dict[str, set[Reason]] = {
    "stop_button": NO_WORK,
    "collision": NO_WORK,
    "alarm": NO_WORK,
    "power_off": NO_WORK,
    "power_cycle": {Reason.LINK_LOST, Reason.REBOOTED, *NO_WORK},
    "script": {Reason.REJECTED, Reason.DEADLINE, Reason.DEVICE_FAULT},
    "not_tcp": {Reason.REJECTED, Reason.STOP_UNCONFIRMED},
    "second_client": {Reason.DEVICE_FAULT, Reason.REJECTED},
    "refuse": {Reason.REJECTED},
    "no_replies": NO_LINK,
    "late_replies": NO_LINK,
    "nonsense_replies": NO_LINK,
    "no_brace": set(),
    "wrong_number": {Reason.DEVICE_FAULT},
    "hang_up": NO_LINK,
    "mute": NO_LINK,
    "frozen": NO_LINK,
    "garbled": NO_LINK,
    "torn": NO_LINK,
    "late_start": set(),
    "lie": {Reason.NOT_REACHED},
    "short": {Reason.NOT_REACHED},
    "stall": {Reason.DEADLINE},
    "deaf": {Reason.STOP_UNCONFIRMED},
    "stuck_output": {Reason.DEVICE_FAULT},
    "slow": {Reason.DEADLINE},
}


class DobotRig(StorageRig):
    """Test with parts that go from the pick to the place; it sees the arm's place and its output."""

    driver = "dobot"
    causes = CAUSES

    def __init__(self, shipped: PlantModel) -> None:
        super().__init__(shipped, FAULTS)
        self._dobot = VirtualDobot(self.faults, enabled=True, frame_s=FRAME_S)
        self._driver: Loopback | None = None

    def join(self, hear: Hear, now: float) -> Loopback:
        self._driver = Loopback(self.layout.arm, self._dobot, hear, now)
        return self._driver

    @property
    def shows(self) -> tuple[Sequence[float], bool]:
        return tuple(map(math.radians, self._dobot.arm.drive.joints)), bool(self._dobot.arm.outputs & 1)

    def moves(self) -> tuple[int, int]:
        if self._driver is None:
            return (0, 0)
        return (sum(line.startswith("MovJ") for line in self._driver.received), self._driver.given)

    def by_hand(self) -> None:
        """Clear alarms and enable the arm at its pendant."""
        assert self._driver is not None
        for line in ("ClearError()", "PowerOn()", "EnableRobot()"):
            self._driver.tell(line)


class Loopback(loopback.Loopback[Event, ClientText]):
    """Driver and virtual Dobot."""

    def __init__(self, arm: Robot, dobot: VirtualDobot, hear: Hear, now: float) -> None:
        super().__init__(Machine([arm], Settings(host="dobot")), dobot, hear, now)
        self.dobot = dobot
        self.received: list[str] = []  # lines of the dashboard
        self._client = 0  # grows with each connection; 0: there is none

    def tell(self, line: str) -> None:
        """Send a line as another client of the dashboard."""
        self.dobot.step(self.now, [ClientText(client=-1, text=line)])

    def _closed(self, why: str) -> Closed:
        return Closed(why=why)

    def _do(self, message: Message) -> None:
        if isinstance(message, Open):
            off = self.dobot.is_off
            self._connected = not off
            self._client += 1
            self._to_driver.append(Closed(why="refused") if off else Opened())
            self.line.opened(self.now)
        elif isinstance(message, Close):
            self._connected = False
            self.line.closed()
            self._to_driver.clear()
        elif isinstance(message, SendLine) and self._connected:
            self.received.append(message.text)
            self.line.asks(self.now, ClientText(client=self._client, text=message.text))

    def _step_device(self, *said: ClientText) -> None:
        for message in self.dobot.step(self.now, said):
            if not self._connected:
                continue
            if isinstance(message, Disconnect):
                self._connected = False
                self._to_driver.append(Closed(why="hung up"))
            elif isinstance(message, Frame):
                self.line.answers(self.now, FeedbackData(data=message.data))
            elif isinstance(message, Answer) and message.client == self._client:
                self.line.answers(self.now, DashboardReply(data=message.text.encode()))
