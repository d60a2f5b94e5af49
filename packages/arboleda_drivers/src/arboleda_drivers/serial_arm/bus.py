"""Bus of an arm's servos: one question at a time, and rounds in which all are asked.

Answers have no numbers: one that comes late could be taken for the next one of its servo. So each of `MARKS`
rounds asks for another number of registers: the length of an answer says of which round it is.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from arboleda_drivers.connections.link import LinkBroken
from arboleda_drivers.connections.stream import Write

from .packets import Packet, PacketReader
from .servos import MAKERS, Reading, read
from .settings import Settings

SILENT_S = 0.4  # a servo answers in milliseconds
MARKS = 8  # rounds with a length of their own; the longest begins at registers that all servos have


@dataclass(frozen=True, kw_only=True)
class Question:
    """Question to one servo that is not answered yet."""

    id: int
    at: float
    length: int  # bytes of the answer
    mark: int = 0  # how many of them are more than what is looked at


class Bus:
    """Bus over one connection. First all servos are asked for their modes, then for their state.

    `writes` are packets that wait for the bus; `latest` are the last readings, however old. `marks` go on
    from one connection to the next, as answers may.
    """

    def __init__(
        self, out: list[Any], settings: Settings, names: Mapping[int, str], now: float, marks: Iterator[int]
    ) -> None:
        self.writes: deque[bytes] = deque()
        self.latest: dict[int, Reading] = {}
        self.last_round_at = self._round_began_at = now
        self._out, self._settings, self._names, self._marks = out, settings, names, marks
        self._mark = next(marks)
        self._maker = MAKERS[settings.protocol]
        self._packets = PacketReader(self._maker.framing, replies=True)
        self._waiting: deque[int] = deque()  # servos that are still to be asked in this round
        self._question: Question | None = None
        self._round_at = now
        self._modes: set[int] | None = set()  # None: all are known
        self._unanswered: dict[int, list[float]] = {}  # when servos were asked since they answered last
        self._readings: dict[int, Reading] = {}  # of this round

    @property
    def next_deadline(self) -> float:
        return self._round_at if self._question is None else self._question.at + self._settings.reply_s

    def use(self, now: float) -> Iterator[Mapping[int, Reading]]:
        """Write what is due, then ask the next servo, unless an answer is awaited.

        Yields the readings after each round; none where a servo has not answered, or modes were asked for.
        """
        if self._question is not None and now >= self.next_deadline:
            self._packets.clear()
            self._question = None  # the others are asked, and this one again in the next round
        while self._question is None:
            if self.writes:
                self._out.append(Write(data=self.writes.popleft()))
            elif self._waiting:
                self._ask(now, self._waiting.popleft())
            elif now >= self._round_at:
                yield self._end_round(now)
            else:
                return

    def _ask(self, now: float, id: int) -> None:
        self._unanswered.setdefault(id, []).append(now)
        mark = 0 if self._modes is not None else self._mark
        address, length = (self._maker.mode[0], 1) if self._modes is not None else self._maker.block
        self._question = Question(id=id, at=now, length=length + mark, mark=mark)
        self._out.append(Write(data=read(self._maker, id, address - mark, length + mark)))

    def _end_round(self, now: float) -> Mapping[int, Reading]:
        self._waiting.extend(self._names)
        self._mark = next(self._marks)
        self._round_at = now + self._settings.poll_s
        self.last_round_at, self._round_began_at = self._round_began_at, now
        readings, self._readings = self._readings, {}
        if self._modes is not None:
            self._modes = None if len(self._modes) == len(self._names) else self._modes
            return {}
        return readings if len(readings) == len(self._names) else {}

    def hear(self, now: float, data: bytes) -> None:
        for packet in self._packets.feed(data):
            self._take(now, packet)

    def _take(self, now: float, packet: Packet) -> None:
        question = self._question
        if question is None or packet.id != question.id or len(packet.data) != question.length:
            return  # the echo of a question, or an answer that came too late
        self._question = None
        self._unanswered.pop(packet.id, None)
        if self._modes is None:
            state = replace(packet, data=packet.data[question.mark :])
            self._readings[packet.id] = self.latest[packet.id] = self._maker.reading(question.at, state)
        elif packet.data[0] in self._maker.mode[1]:
            self._modes.add(packet.id)
        else:
            servo = f"servo {packet.id} ({self._names[packet.id]})"
            raise LinkBroken(f"{servo} is in operating mode {packet.data[0]}, which holds no position")

    def silence(self, now: float, patience_s: float) -> str:
        """The sentence on servos that have not answered for so long, or longer; "" for none.

        One question without an answer is none: this process may have been stalled since it was asked.
        """
        # Nobody is heard more often than once in a round, however long the silent ones make it.
        round_s = len(self._names) * self._settings.reply_s + self._settings.poll_s
        longest_s = max(SILENT_S, patience_s, round_s)
        asked = self._unanswered
        silent = [id for id, at in asked.items() if len(at) > 1 and now - at[0] > longest_s]
        if silent and len(asked) == len(self._names):
            return "no servo answers; is the arm powered, and the baud rate right?"
        return f"servo {silent[0]} ({self._names[silent[0]]}) does not answer" if silent else ""
