"""Campaign of a heated shaker of PyLabRobot under faults: its own front end, on a backend that breaks.

The driver's bench runs in an event loop whose time is moved by hand, so PyLabRobot itself is the peer.
"""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import Any

from pylabrobot.heating_shaking import HeaterShaker, HeaterShakerBackend
from pylabrobot.resources import Coordinate

from arboleda.model.commands import Command, Stop
from arboleda.model.messages import MotionState, Reason, Report
from arboleda.model.plant_model import PlantModel, Robot
from arboleda_drivers.connections.link import Close, CommandNotSent, CommandRequest, Open
from arboleda_drivers.pylabrobot.adapter import Bench
from arboleda_drivers.pylabrobot.machine import Machine
from arboleda_drivers.pylabrobot.messages import Event
from arboleda_drivers.pylabrobot.settings import MachineMapping
from arboleda_drivers.virtual.faults import Faults

from .rig import START_S, Causes, Hear, Rig

FAULTS = {
    "refuses": "it raises an error at the begin of a call, and does nothing",
    "breaks_off": "it raises an error in the middle of a call",
    "hangs": "a call that is begun never comes back",
    "mute": "what is read never comes back",
    "unplugged": "all that is called or read raises an error of the connection",
    "lies": "it heats nothing, and calls come back",
    "stays_cold": "it does not become warm",
    "drifts": "it shows a temperature that is 8 degrees too high",
    "nonsense": "it shows no number",
    "slow": "it answers after 2 s",
    "deaf": "a stop comes back, and it goes on",
    "stop_fails": "a stop raises an error",
}
NO_LINK = {Reason.LINK_LOST}
CAUSES: Causes = {
    "refuses": {Reason.REJECTED, Reason.DEVICE_FAULT},
    "breaks_off": {Reason.DEVICE_FAULT},
    "hangs": {Reason.DEADLINE, *NO_LINK},
    "mute": {Reason.DEVICE_FAULT, Reason.DEADLINE, *NO_LINK},
    "unplugged": {Reason.DEVICE_FAULT, *NO_LINK},
    "lies": {Reason.NOT_REACHED, Reason.DEADLINE, Reason.DEVICE_FAULT},
    "stays_cold": {Reason.NOT_REACHED, Reason.DEADLINE, Reason.DEVICE_FAULT},
    "drifts": {Reason.NOT_REACHED, Reason.DEADLINE, Reason.DEVICE_FAULT},
    "nonsense": {Reason.DEVICE_FAULT, *NO_LINK},
    "slow": {Reason.DEADLINE},
    "deaf": {Reason.STOP_UNCONFIRMED, Reason.REJECTED},
    "stop_fails": {Reason.DEVICE_FAULT, *NO_LINK},
}
ROOM, WARM, DEGREES_PER_S = 22.0, 37.0, 5.0
STEP_S, ROUNDS = 0.25, 4  # rounds of the event loop that any message needs at most


class HandLoop(asyncio.SelectorEventLoop):
    """Event loop whose time is moved by hand."""

    now = START_S

    def __init__(self) -> None:
        super().__init__()
        # Coroutines that hang are left behind, which asyncio complains of.
        self.set_exception_handler(lambda loop, context: None)

    def time(self) -> float:
        return self.now

    def settle(self) -> None:
        """Run all that is due."""
        for _ in range(ROUNDS):
            self.call_soon(self.stop)
            self.run_forever()


class HeatedShaker(HeaterShakerBackend):  # type: ignore[misc]
    """Backend with a block that becomes warm in its time, under faults."""

    def __init__(self, faults: Faults, now: Any) -> None:
        super().__init__()
        self._faults, self._now = faults, now
        self._celsius, self._goal, self._at = ROOM, ROOM, now()
        self.shakes, self.orders = False, 0

    @property
    def celsius(self) -> float:
        """The true temperature."""
        now = self._now()
        way = DEGREES_PER_S * (now - self._at)
        self._at = now
        if "stays_cold" not in self._faults:
            away = self._goal - self._celsius
            self._celsius += max(-way, min(way, away))
        return self._celsius

    @property
    def supports_active_cooling(self) -> bool:
        return True

    @property
    def supports_locking(self) -> bool:
        return False

    async def setup(self) -> None:
        await self._line()

    async def stop(self) -> None: ...

    async def lock_plate(self) -> None: ...
    async def unlock_plate(self) -> None: ...

    async def get_current_temperature(self) -> Any:
        await self._line()
        if "mute" in self._faults:
            await asyncio.Future[None]()
        if "nonsense" in self._faults:
            return float("nan")
        return self.celsius + (8.0 if "drifts" in self._faults else 0.0)

    async def set_temperature(self, temperature: float) -> None:
        self.orders += 1
        await self._begin()
        if "lies" not in self._faults:
            self._goal = self.celsius and temperature

    async def start_shaking(self, speed: float) -> None:
        self.orders += 1
        await self._begin()
        self.shakes = True

    async def stop_shaking(self) -> None:
        await self._line()
        if "stop_fails" in self._faults:
            raise RuntimeError("it does not stop")
        self.shakes = self.shakes and "deaf" in self._faults

    async def deactivate(self) -> None:
        await self._line()
        if "deaf" not in self._faults:
            self._goal = self.celsius and ROOM

    async def _begin(self) -> None:
        if "refuses" in self._faults:
            raise ValueError("not now")
        await self._line()
        if "hangs" in self._faults:
            await asyncio.Future[None]()
        if "breaks_off" in self._faults:
            raise RuntimeError("it broke off")

    async def _line(self) -> None:
        if "unplugged" in self._faults:
            raise ConnectionError("nobody answers")
        await asyncio.sleep(2.0 if "slow" in self._faults else 0.02)


class Loopback:
    """Driver and machine, connected: each gets the other's messages at once."""

    def __init__(self, rig: ShakerRig, hear: Hear, now: float) -> None:
        self._rig, self._hear = rig, hear
        self._machine = Machine(rig.robots, rig.settings)
        self._bench: Bench | None = None
        self._events: list[Event] = []
        self.next_deadline = now

    def ask(self, command: Command) -> str | None:
        """Command the device; returns the reason why the command could not leave, or None."""
        self._rig.given += not isinstance(command, Stop)
        self._events.append(CommandRequest(command=command))
        return self._step()

    def pass_time(self, now: float) -> None:
        """Let both do everything due by now."""
        self._rig.loop.now = now
        self.next_deadline = now + STEP_S
        self._step()

    def _step(self) -> str | None:
        """Run both until neither has anything left; returns why a command could not leave."""
        why = None
        while True:
            events, self._events = self._events, []
            for message in self._machine.step(self._rig.loop.now, events):
                if isinstance(message, CommandNotSent):
                    why = message.why
                else:
                    self._do(message)
            self._rig.loop.settle()
            if not self._events:
                return why

    def _do(self, message: Any) -> None:
        loop = self._rig.loop
        if isinstance(message, Report):
            self._hear(message)
        elif isinstance(message, Open):
            self._bench = Bench(self._rig.make, self._rig.settings, self._events_of(object()))
            loop.create_task(self._bench.open())
        elif isinstance(message, Close):
            if self._bench is not None:
                loop.create_task(self._bench.close())
            self._bench = None
        elif self._bench is not None:
            loop.create_task(self._bench.do(message))

    def _events_of(self, session: object) -> Any:
        """Receiver of the events of a session, as long as it is the last one."""
        self._session = session

        def take(event: Event) -> None:
            if self._session is session:
                self._events.append(event)

        return take


class ShakerRig(Rig):
    """Test with a plate that is warmed and shaken; it sees the true temperature, and whether it shakes."""

    driver = "pylabrobot"
    causes = CAUSES
    work = (("warm", True),)
    between_s = 20.0
    after_s = 75.0

    def __init__(self, example: PlantModel, *, side_by_side: bool = False) -> None:
        super().__init__(FAULTS)
        self.model = example
        self._shaker = example.robots["hotplate"]
        assert self._shaker.driver is not None and isinstance(self._shaker.driver.settings, MachineMapping)
        known = {
            **vars(self._shaker.driver.settings),
            "side_by_side": side_by_side,
            "refusals": ("ValueError",),
        }
        self.settings = MachineMapping(**known)
        self.loop = HandLoop()
        self._backend = HeatedShaker(self.faults, self.loop.time)
        self.given = 0

    @property
    def robots(self) -> Sequence[Robot]:
        return [self._shaker]

    def make(self) -> Any:
        """The machine, with PyLabRobot's own front end."""
        at = Coordinate(0.0, 0.0, 60.0)
        sizes = {"size_x": 140.0, "size_y": 100.0, "size_z": 60.0}
        return HeaterShaker(name="hotplate", backend=self._backend, child_location=at, **sizes)

    def task(self, number: int) -> str:
        return f"bench warm 37 #{number}"

    def join(self, hear: Hear, now: float) -> Loopback:
        self.loop.now = now
        return Loopback(self, hear, now)

    def place(self) -> tuple[str, bool]:
        warm = abs(self._backend.celsius - WARM) < 1
        return ("warm" if warm else "cold", self._backend.shakes)

    def moves(self) -> tuple[int, int]:
        return (self._backend.orders, self.given)

    def bystanders(self, now: float) -> list[Report]:
        tip = (("tip", "none"),)
        return [Report(at=now, robot="handler", state=MotionState.STOPPED, boot_id=1, facts=tip)]
