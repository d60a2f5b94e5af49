"""What a board has said so far, and what a check may ask for."""

from __future__ import annotations

import json
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Any

from arboleda.kinds.arm import Arm
from arboleda.model.errors import PayloadError
from arboleda.wire import strict
from arboleda.wire.payloads import MAX_ANGLE_DEG, REFUSALS
from arboleda.wire.topics import Channel, parse
from arboleda.wire.transport import Delivery
from arboleda.wire.units import to_wire

MOVING, NOT_HOMED = 1, 3  # codes of `estado`


@dataclass(frozen=True, kw_only=True)
class Send:
    """Publish this to the board."""

    channel: Channel
    payload: bytes
    retain: bool = False


@dataclass(frozen=True, kw_only=True)
class Jostle:
    """Have the board lose its connection for a moment, by taking its client id."""


@dataclass(frozen=True, kw_only=True)
class Wait:
    """Let time pass until something is so; the check gets whether it was."""

    seconds: float
    until: Callable[[], bool] = lambda: False


Steps = Generator[Send | Jostle | Wait, bool, Any]


class Wrong(Exception):
    """A check found the board in the wrong; the sentence says how."""


class NotTried(Exception):
    """A check cannot be made on this board; the sentence says why."""


@dataclass(frozen=True, kw_only=True)
class Said:
    """One telemetry message, angles in degrees; None for what it does not say."""

    at: float
    state: int
    q: tuple[float, ...] | None
    number: int | None
    epoch: int | None
    ack: int | None
    done: int | None
    refusal: str | None
    refused: int | None
    boot_id: int | None
    homed: bool | None
    effector: bool | None


class Bench:
    """An arm's board on trial; `seq` is the last number used in `epoch`."""

    def __init__(self, arm: Arm, epoch: int) -> None:
        self.arm = arm
        self.epoch = epoch
        self.seq = 0
        self.now = 0.0
        self.beating = False
        self.said: list[Said] = []
        self.damaged: list[str] = []
        self.arrivals = 0  # how often it said that it is there
        self.step_deg = tuple(to_wire(joint, joint.step) for joint in arm.joints)

    @property
    def last(self) -> Said:
        return self.said[-1]

    def hear(self, delivery: Delivery) -> None:
        """A message from the board."""
        self.now = max(self.now, delivery.at)
        channel = parse(delivery.topic)[1]
        if channel is Channel.PRESENCE:
            self.arrivals += delivery.payload == b"1" and not delivery.retain
            return
        try:
            self.said.append(self._read(delivery))
            if not self.seq and (self.last.epoch or 0) >= self.epoch:
                self.epoch = (self.last.epoch or 0) + 1
        except PayloadError as error:
            self.damaged.append(f"{error}: {delivery.payload[:80]!r}")

    def send(
        self, channel: Channel, *, seq: int | None = None, epoch: int | None = None, **body: Any
    ) -> Send:
        """A command with the next number, unless another is given."""
        if seq is None:
            self.seq += 1
        numbers = {"seq": self.seq if seq is None else seq, "epoca": self.epoch if epoch is None else epoch}
        return Send(channel=channel, payload=json.dumps({**body, **numbers}).encode())

    def goal(self, steps: tuple[int, ...], **numbers: int) -> Send:
        """A target in motor steps."""
        degrees = zip(steps, self.step_deg, strict=True)
        q = {f"q{at + 1}": round(count * step, 4) for at, (count, step) in enumerate(degrees)}
        return self.send(Channel.JOINTS, **q, **numbers)

    @property
    def steps(self) -> tuple[int, ...]:
        """Where it last said to be, in motor steps."""
        rows = zip(self.last.q or (), self.step_deg, strict=False)
        return tuple(round(angle / step) for angle, step in rows)

    def away(self, part: float) -> tuple[int, ...]:
        """A place so far from here on each joint, as a part of its whole way."""
        rows = zip(self.arm.joints, self.steps or self._middle(), strict=True)
        return tuple(
            _away(joint.steps(joint.lower), joint.steps(joint.upper), here, part) for joint, here in rows
        )

    def at(self, steps: tuple[int, ...]) -> bool:
        """Whether it said last that it is there."""
        return self.steps == steps

    def _middle(self) -> tuple[int, ...]:
        return tuple(joint.steps((joint.lower + joint.upper) / 2) for joint in self.arm.joints)

    def _read(self, delivery: Delivery) -> Said:
        fields = strict.read(delivery.payload)
        keys = [f"q{at + 1}_mov" for at in range(len(self.arm.joints))]
        spoken = any(key in fields for key in keys)
        return Said(
            at=delivery.at,
            state=fields.integer("estado", 4),
            q=tuple(fields.number(key, MAX_ANGLE_DEG) for key in keys) if spoken else None,
            number=fields.optional("seq"),
            epoch=fields.optional("epoca_ack"),
            ack=fields.optional("ack"),
            done=fields.optional("hecho"),
            refusal=fields.word("rechazo", REFUSALS) if "rechazo" in fields else None,
            refused=fields.optional("rechazo_seq"),
            boot_id=fields.optional("arranque"),
            homed=fields.flag("ref"),
            effector=fields.flag("efector"),
        )


def _away(lower: int, upper: int, here: int, part: float) -> int:
    way = max(2, int((upper - lower) * part))
    there = here + way if upper - here >= here - lower else here - way
    return min(max(there, lower), upper)
