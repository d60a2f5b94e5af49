"""Campaign of an arm of Universal Robots under its faults, and the failures that each may cause."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel, Robot
from arboleda_drivers.connections.link import Close, Closed, Open, Opened
from arboleda_drivers.ur.machine import Machine, Message
from arboleda_drivers.ur.port_data import DASHBOARD, PRIMARY, RTDE, Received, Send
from arboleda_drivers.ur.settings import Settings
from arboleda_drivers.ur.virtual.faults import FAULTS
from arboleda_drivers.ur.virtual.machine import ClientData, Disconnect, Event, Joined, ToClient, VirtualUr

from . import loopback
from .rig import Hear
from .storage import StorageRig

PORTS = (DASHBOARD, RTDE, PRIMARY)
BY_HAND = -1  # the client that is another one than the driver
PERIOD_S = 0.04  # a fifth of the frames is enough to see every state

NO_WORK = {Reason.DEVICE_FAULT, Reason.REJECTED, Reason.NOT_HOMED}
NO_LINK = {Reason.LINK_LOST}
CAUSES: dict[str, set[Reason]] = {
    "protective_stop": NO_WORK,
    "safeguard": NO_WORK,
    "stop_button": NO_WORK,
    "local_control": {*NO_WORK, *NO_LINK, Reason.STOP_UNCONFIRMED},
    "slider": {Reason.DEADLINE},
    "popup": {Reason.REJECTED},
    "power_off": NO_WORK,
    "brakes_stuck": NO_WORK,
    "program_stopped": {Reason.DEVICE_FAULT},
    "other_program": {Reason.DEVICE_FAULT, Reason.DEADLINE},
    "joint_limit": {Reason.DEVICE_FAULT},
    "reboot": {Reason.REBOOTED, *NO_WORK, *NO_LINK},
    "refuse": {Reason.REJECTED, Reason.STOP_UNCONFIRMED},
    "not_begun": {Reason.REJECTED},
    "echo_lost": {Reason.REJECTED, Reason.DEVICE_FAULT},
    "wrong_number": {Reason.REJECTED, Reason.DEVICE_FAULT},
    "late_start": set(),
    "late_runtime": set(),
    "heartbeat_lost": {Reason.DEVICE_FAULT},
    "dashboard_mute": NO_LINK,
    "late_replies": NO_LINK,
    "unasked_replies": NO_LINK,
    "rate_drops": set(),
    "mute": NO_LINK,
    "frozen": NO_LINK,
    "garbled": NO_LINK,
    "torn": NO_LINK,
    "old_rtde": NO_LINK,
    "in_use": NO_LINK,
    "connections_full": NO_LINK,
    "hang_up": NO_LINK,
    "lie": {Reason.NOT_REACHED},
    "short": {Reason.NOT_REACHED},
    "stall": {Reason.DEADLINE},
    "deaf": {Reason.STOP_UNCONFIRMED},
    "stuck_output": {Reason.DEVICE_FAULT},
    "slow": {Reason.DEADLINE},
}


class UrRig(StorageRig):
    """Test with parts that go from the pick to the place; it sees the arm's place and its output."""

    driver = "ur"
    causes = CAUSES

    def __init__(self, shipped: PlantModel) -> None:
        super().__init__(shipped, FAULTS)
        self._ur = VirtualUr(self.faults, running=True, period_s=PERIOD_S)
        self._driver: Loopback | None = None

    def join(self, hear: Hear, now: float) -> Loopback:
        self._driver = Loopback(self.layout.arm, self._ur, hear, now)
        return self._driver

    @property
    def shows(self) -> tuple[Sequence[float], bool]:
        output = Settings(host="ur").output
        run = self._ur.run
        return run.drive.joints, bool(output is not None and run.outputs >> output & 1)

    def moves(self) -> tuple[int, int]:
        if self._driver is None:
            return (0, 0)
        return (sum("movej" in text for text in self._driver.programs), self._driver.given)

    def by_hand(self) -> None:
        """Unlock the arm at its pendant, power it and release its brakes."""
        assert self._driver is not None
        for line in ("stop", "unlock protective stop", "brake release"):
            self._driver.tell(line)


class Loopback(loopback.Loopback[Closed | Opened | Received, Event]):
    """Driver and virtual arm."""

    def __init__(self, arm: Robot, ur: VirtualUr, hear: Hear, now: float) -> None:
        super().__init__(Machine([arm], Settings(host="ur")), ur, hear, now)
        self.ur = ur
        self.lines: list[str] = []  # of the dashboard
        self.programs: list[str] = []
        self._first = 1  # the number of the dashboard's client; those of the other ports follow

    def tell(self, line: str) -> None:
        """Send a line as another client of the dashboard."""
        joined = Joined(client=BY_HAND, port=DASHBOARD)
        self._step_device(joined, ClientData(client=BY_HAND, port=DASHBOARD, data=line.encode() + b"\n"))
        self._settle()

    def _closed(self, why: str) -> Closed:
        return Closed(why=why)

    def _do(self, message: Message) -> None:
        if isinstance(message, Open):
            self._connect()
        elif isinstance(message, Close):
            self.line.closed()
            self._hang_up()
            self._to_driver.clear()
        elif isinstance(message, Send) and self._connected:
            if message.port != RTDE:
                said = self.lines if message.port == DASHBOARD else self.programs
                said.append(message.data.decode().strip())
            client = self._first + PORTS.index(message.port)
            self.line.asks(self.now, ClientData(client=client, port=message.port, data=message.data))

    def _connect(self) -> None:
        self._connected = not self.ur.is_off
        if not self._connected:
            self._to_driver.append(Closed(why="refused"))
            return
        self._first += len(PORTS)
        for number, port in enumerate(PORTS):
            self.line.asks(self.now, Joined(client=self._first + number, port=port))
        self.line.opened(self.now)
        self._to_driver.append(Opened())

    def _hang_up(self) -> None:
        if self._connected:
            for number, port in enumerate(PORTS):
                self.line.asks(self.now, ClientData(client=self._first + number, port=port, data=b""))
        self._connected = False

    def _step_device(self, *events: Event) -> None:
        for message in self.ur.step(self.now, events):
            if not self._connected:
                continue
            if isinstance(message, ToClient):
                if 0 <= message.client - self._first < len(PORTS):
                    port = PORTS[message.client - self._first]
                    self.line.answers(self.now, Received(port=port, data=message.data))
            elif isinstance(message, Disconnect) or message.client >= self._first:
                self._connected = False
                self._to_driver.append(Closed(why="hung up"))
