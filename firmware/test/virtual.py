"""A virtual board of the plant under a script: what the core has to say, word for word and when."""

from __future__ import annotations

from arboleda.model.plant_model import Robot
from arboleda.sim.board import Board
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Delivery


class Virtual:
    """One virtual board, told the lines of a script; `channels` as the script counts them."""

    def __init__(self, robot: Robot, board: Board, now_us: int, channels: tuple[str, ...]) -> None:
        self.board = board
        self.now_us = now_us
        self.said: list[str] = []
        self._topics = [topic(robot.mqtt, Channel(channel)) for channel in channels]

    def run(self, lines: list[str]) -> list[str]:
        """What the board said, a line each: time, kind, payload."""
        for line in lines:
            at_us, _, event = line.partition(" ")
            if at_us.isdigit():
                self._until(int(at_us))
                self._event(*event.split())
                self._until(int(at_us))
        return self.said

    def _until(self, until_us: int) -> None:
        while (due_us := self.board.next_deadline_us) is not None and due_us <= until_us:
            self._advance(max(due_us, self.now_us))
        self._advance(until_us)

    def _advance(self, now_us: int) -> None:
        self.now_us = now_us
        self.board.advance(now_us)
        self._collect()

    def _collect(self) -> None:
        for sent in self.board.take():
            kind = "P" if sent.retain else "S"
            self.said.append(f"{self.now_us} {kind} {sent.payload.decode()}")

    def _event(self, what: str, *words: str) -> None:
        getattr(self, f"_{what}")(*words)
        self._collect()

    def _message(self, channel: str, retained: str, raw: str = "") -> None:
        where, payload = self._topics[int(channel)], bytes.fromhex(raw)
        delivery = Delivery(at=0.0, topic=where, payload=payload, retain=retained == "1")
        self.board.receive(self.now_us, delivery)

    def _connect(self, up: str) -> None:
        self.board.connect(self.now_us, up == "1")

    def _reboot(self, boot_id: str) -> None:
        self.board.reboot(self.now_us, int(boot_id))

    def _fail(self) -> None:
        self.board.fail(self.now_us)

    def _repair(self) -> None:
        self.board.repair(self.now_us)
