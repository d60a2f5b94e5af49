"""Stop of an arm: a program that takes the place of any other, and what becomes of it."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda_drivers.connections.receipts import Receipts
from arboleda_drivers.connections.tcp_arm import Braking

from . import programs
from .arm_state import Runtime, hindrance
from .dashboard import LOCAL, Dashboard
from .programs import ProgramPort
from .rtde import Frame
from .settings import Settings

ECHO_S = 0.5  # a stop that names itself later than this is said to the dashboard, too


@dataclass(frozen=True, kw_only=True)
class Sent:
    """Program of a stop that has not named itself yet."""

    id: str
    number: int
    at: float


@dataclass
class StopProgram:
    """Stops over one connection."""

    settings: Settings
    port: ProgramPort
    dashboard: Dashboard
    braking: Braking
    receipts: Receipts
    sent: Sent | None = None

    def run(self, now: float, id: str, frame: Frame | None) -> None:
        """Brake by a program that takes the place of any other; what cannot move has stopped."""
        if frame is not None and hindrance(frame):
            if frame.runtime != Runtime.STOPPED:  # a paused program would go on once that is over
                self.dashboard.say(now, "stop")
            self.braking.begin(now)
            self.receipts.tell(accepted=id)
            return
        self.braking.begin()
        self.sent = Sent(id=id, number=self.port.next_number(frame), at=now)
        deceleration, register = self.settings.stop_rad_s2, self.settings.registers_from
        self.port.run(programs.stop(self.sent.number, acceleration=deceleration, register=register))

    def see(self, now: float, frame: Frame) -> None:
        """Find in a frame whether the program runs."""
        sent = self.sent
        if sent is None:
            return
        if frame.begun == sent.number or hindrance(frame):
            self.sent = None
            self.braking.begin(now)
            self.receipts.tell(accepted=sent.id)
        elif now - sent.at > ECHO_S:
            self.sent = None
            self.dashboard.say(now, "stop", lambda now, reply: self._take(now, sent.id, reply))

    def _take(self, now: float, id: str, reply: str) -> None:
        self.braking.begin(now)
        if reply.lower().startswith("stopped"):
            self.receipts.tell(accepted=id)
        else:
            self.receipts.reject(id, LOCAL if self.dashboard.is_local else f"stop_refused {reply[:60]}")
