"""The virtual board of the plant under a script: what the core has to say, word for word and when."""

from __future__ import annotations

from dataclasses import replace

from arboleda.kinds.arm import Arm
from arboleda.model.plant_model import Evidence
from arboleda.sim.arm import ArmBody
from arboleda.sim.board import Board
from arboleda.testing import shipped
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Delivery

from .scripts import CHANNELS, PLACES, Setting


class Reference:
    """One virtual SCARA, told the lines of a script."""

    def __init__(self, setting: Setting, now_us: int) -> None:
        arm = shipped("sis_a").cell("sis_a").arm
        self.arm: Arm = replace(arm, evidence=Evidence.IDS if setting.ids else Evidence.JOINTS)
        self.body = ArmBody(
            self.arm, start=self._si(setting.start), pickups=[self._si(place) for place in PLACES]
        )
        self.board = Board(self.arm, self.body, boot_id=100, now_us=now_us)
        self.now_us = now_us
        self.said: list[str] = []

    def run(self, lines: list[str]) -> list[str]:
        """What the board said, a line each: time, kind, payload."""
        for line in lines:
            at_us, _, event = line.partition(" ")
            if at_us.isdigit():
                self._until(int(at_us))
                self._event(*event.split())
                self._until(int(at_us))
        return self.said

    def _si(self, steps: tuple[int, ...]) -> tuple[float, ...]:
        return tuple(count * joint.step for count, joint in zip(steps, self.arm.joints, strict=True))

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
        where = topic(self.arm.mqtt, Channel(CHANNELS[int(channel)]))
        payload = bytes.fromhex(raw)
        delivery = Delivery(at=0.0, topic=where, payload=payload, retain=retained == "1")
        self.board.receive(self.now_us, delivery)

    def _connect(self, up: str) -> None:
        self.board.connect(self.now_us, up == "1")

    def _reboot(self, boot_id: str, homed: str) -> None:
        self.board._assume_homed = homed == "1"
        self.board.reboot(self.now_us, int(boot_id))

    def _fail(self) -> None:
        self.board.fail(self.now_us)

    def _repair(self) -> None:
        self.board.repair(self.now_us)

    def _slip(self, joint: str, steps: str) -> None:
        self.body.lose_steps(int(joint), int(steps))

    def _drop(self) -> None:
        self.body.lose_piece()

    def _supplied(self, yes: str) -> None:
        self.body.supplied = yes == "1"

    def _grips(self, yes: str) -> None:
        self.body.grips = yes == "1"

    def _stuck(self, yes: str) -> None:
        self.body.stuck = yes == "1"

    def _probe(self) -> None:
        numbers = (*self.body.position, *self.body.true_position, self.board.refusals)
        self.said.append(f"{self.now_us} @ " + " ".join(str(number) for number in numbers))
