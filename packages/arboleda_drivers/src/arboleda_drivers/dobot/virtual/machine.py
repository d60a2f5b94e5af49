"""Virtual controller of a Dobot: dashboard, queue of moves, feedback frames. No sockets, no clock."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

from arboleda_drivers.dobot.frames import SIZE, TEST_AT, Feedback
from arboleda_drivers.virtual.joint_path import Joints

from .arm import Arm
from .dashboard import Dashboard, lines

FAULTS = {
    "stop_button": "the button at the robot is pressed: it brakes and is disabled, and alarm 116 stays",
    "collision": "whenever the arm moves it hits something: it brakes, mode 11 until that is cleared",
    "alarm": "whenever the arm moves it brakes with alarm 17, in mode 9, until that is cleared",
    "power_off": "the arm has no power: mode 3, and commands are answered -4",
    "power_cycle": "the controller is off while this is on; then it boots: disabled, and its ids begin anew",
    "script": "a script runs in the controller: mode 7, and moves are answered -5",
    "not_tcp": "the controller is not in TCP mode: commands are answered with that sentence",
    "second_client": "whenever the arm moves, another client's move takes the place of it",
    "refuse": "moves are answered -1",
    "no_replies": "what the dashboard is told is done and not answered",
    "late_replies": "the dashboard answers a second late",
    "nonsense_replies": "the dashboard answers what is no reply",
    "no_brace": "GetErrorID is answered as in an example of the maker's document, without its last brace",
    "wrong_number": "a move is answered with the number of the one before",
    "hang_up": "the connections end whenever a move is told, which is begun nevertheless",
    "mute": "the feedback port sends nothing",
    "frozen": "the feedback port sends the same frame again and again",
    "garbled": "the feedback has a wrong test value",
    "torn": "every second frame lacks its last hundred bytes",
    "late_start": "a move is named as the current one at once, and begins 0.2 s later",
    "lie": "a move is said to be over at once, and the arm stays where it is",
    "short": "moves end two degrees before their goal",
    "stall": "a move stands still half way, and the controller says that it runs",
    "deaf": "a stop is answered, and the arm moves on",
    "stuck_output": "tool outputs do not switch",
    "slow": "the arm moves at a tenth of its speed",
}
FRAME_S = 0.008
LATE_S = 1.0


@dataclass(frozen=True, kw_only=True)
class ClientText:
    """Event: a client sent the dashboard this; one line, or several that each end with a bracket."""

    client: int
    text: str


@dataclass(frozen=True, kw_only=True)
class Answer:
    """Line to one client of the dashboard."""

    client: int
    text: str


@dataclass(frozen=True, kw_only=True)
class Frame:
    """Frame to every client of the feedback port."""

    data: bytes


@dataclass(frozen=True, kw_only=True)
class Disconnect:
    """Message: end every connection."""


Message = Answer | Frame | Disconnect


class VirtualDobot:
    """Virtual arm with its controller; `faults` are looked up when they matter. Times in s of any clock."""

    def __init__(
        self,
        faults: Collection[str] = (),
        *,
        joints_deg: Joints = (0.0,) * 6,
        enabled: bool = False,
        unix_s: float = 0.0,
        frame_s: float = FRAME_S,
    ) -> None:
        self.faults = faults
        self.arm = Arm(faults, joints_deg=joints_deg, enabled=enabled)
        self._dashboard = Dashboard(self.arm, faults)
        self._unix_s = unix_s  # Unix time at which `now` is 0
        self._frame_s = frame_s
        self._booted_at: float | None = None
        self._off = False
        self._frame_at = -math.inf
        self._frames = 0
        self._late: deque[tuple[float, Answer]] = deque()
        self._last: Feedback | None = None

    @property
    def next_deadline(self) -> float:
        late = self._late[0][0] if self._late else math.inf
        return min(self._frame_at, late, self.arm.drive.next_deadline)

    @property
    def is_off(self) -> bool:
        """True while nobody can connect."""
        return "power_cycle" in self.faults

    def step(self, now: float, events: Sequence[ClientText]) -> list[Message]:
        """Let time pass, take events, and return messages."""
        out: list[Message] = []
        self._booted_at = now if self._booted_at is None else self._booted_at
        if self.is_off or self._off:
            if self.is_off:
                self._off = True
                self._frame_at = now + self._frame_s
                return [Disconnect()]
            self.arm.boot()
            self._off, self._booted_at, self._last = False, now, None
            self._late.clear()
        self.arm.pass_time(now)
        for event in events:
            for line in lines(event.text):
                out += self._answer(now, event.client, line)
        while self._late and self._late[0][0] <= now:
            out.append(self._late.popleft()[1])
        if self._frame_at <= now:
            self._frame_at = now + self._frame_s
            out += self._frame(now)
        return out

    def _answer(self, now: float, client: int, line: str) -> list[Message]:
        text, hang_up = self._dashboard.reply(now, line)
        answer = Answer(client=client, text=text)
        if hang_up:
            return [Disconnect()]
        if "no_replies" in self.faults:
            return []
        if "nonsense_replies" in self.faults:
            return [replace(answer, text="0,{oops;")]
        if "late_replies" in self.faults:
            self._late.append((now + LATE_S, answer))
            return []
        return [answer]

    # Feedback, sent without a request.

    def _frame(self, now: float) -> list[Message]:
        self._frames += 1
        if "mute" in self.faults:
            return []
        if "frozen" not in self.faults or self._last is None:
            self._last = self._feedback(now)
        data = self._last.packed()
        if "garbled" in self.faults:
            data = data[:TEST_AT] + bytes(8) + data[TEST_AT + 8 :]
        if "torn" in self.faults and self._frames % 2:
            data = data[: SIZE - 100]
        return [Frame(data=data)]

    def _feedback(self, now: float) -> Feedback:
        assert self._booted_at is not None
        return Feedback(
            mode=self.arm.mode,
            command=self.arm.command,
            joints_deg=self.arm.drive.joints,
            time_ms=int((self._unix_s + now) * 1000),
            run_ms=int((now - self._booted_at) * 1000),
        )
