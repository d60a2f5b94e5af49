"""A judge of boards and a virtual board joined by hand; time goes from deadline to deadline."""

from __future__ import annotations

import math

from arboleda.kinds.arm import Arm
from arboleda.kinds.declared import Device
from arboleda.sim.board import Board
from arboleda.wire.topics import topic
from arboleda.wire.transport import Delivery
from arboleda_boards.conformance.bench import Jostle, Send
from arboleda_boards.conformance.judge import Judge

LONGEST_S = 600.0


class Trial:
    """Runs the judge over the board."""

    def __init__(self, robot: Arm | Device, board: Board) -> None:
        self.robot, self.board = robot, board
        self.now = 1000.0
        self.judge = Judge(robot, epoch=50, now=self.now)
        self.kept: dict[str, bytes] = {}
        board.connect(self._us, True)

    @property
    def _us(self) -> int:
        return round(self.now * 1e6)

    def run(self) -> Judge:
        while not self.judge.over and self.now < 1000.0 + LONGEST_S:
            for message in self.judge.step(self.now, self._heard()):
                self._carry_out(message)
            times = [self.judge.next_deadline, (self.board.next_deadline_us or math.inf) / 1e6]
            self.now = max(self.now, min(time for time in times if time is not None))
            self.board.advance(self._us)
        assert self.judge.over
        return self.judge

    def _heard(self) -> list[Delivery]:
        return [Delivery(at=self.now, topic=sent.topic, payload=sent.payload) for sent in self.board.take()]

    def _carry_out(self, message: Send | Jostle) -> None:
        if isinstance(message, Jostle):
            self.board.connect(self._us, False)
            self.board.connect(self._us, True)
            for where, payload in self.kept.items():
                self._deliver(where, payload, retain=True)
            return
        where = topic(self.robot.mqtt, message.channel)
        if message.retain:
            self.kept.pop(where, None)
            self.kept.update({where: message.payload} if message.payload else {})
        self._deliver(where, message.payload, retain=False)

    def _deliver(self, where: str, payload: bytes, *, retain: bool) -> None:
        self.board.receive(self._us, Delivery(at=self.now, topic=where, payload=payload, retain=retain))


def wrong(judge: Judge) -> dict[str, str]:
    """Findings of a judge, by the name of the check."""
    return {finding.check.name: finding.wrong for finding in judge.findings if finding.wrong}
