"""Bench of an arm's board: keeps its reports, and makes the goals that a check may ask for."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from arboleda.drivers import Arm
from arboleda.wire import payloads, strict
from arboleda.wire.topics import Channel
from arboleda.wire.transport import Delivery
from arboleda.wire.units import to_wire

from .bench import Bench, BoardTelemetry, Send


@dataclass(frozen=True, kw_only=True)
class ArmTelemetry(BoardTelemetry):
    """One telemetry message, angles in degrees; None for missing fields."""

    q: tuple[float, ...] | None
    homed: bool | None
    effector: bool | None

    @property
    def place(self) -> tuple[float, ...] | None:
        return self.q


class ArmBench(Bench[ArmTelemetry]):
    """An arm's board on trial."""

    def __init__(self, arm: Arm, epoch: int) -> None:
        super().__init__(arm.mqtt, epoch)
        self.arm = arm
        self.step_deg = tuple(to_wire(joint, joint.step) for joint in arm.joints)

    @property
    def says_where(self) -> bool:
        return self.last.q is not None

    @property
    def place(self) -> tuple[int, ...]:
        return self.steps

    def goal(
        self, steps: Sequence[float], *, seq: int | None = None, epoch: int | None = None, **body: int | str
    ) -> Send:
        """A target in motor steps."""
        degrees = [count * step for count, step in zip(steps, self.step_deg, strict=True)]
        return self.goal_deg(degrees, seq=seq, epoch=epoch, **body)

    def goal_deg(
        self, degrees: Iterable[float], *, seq: int | None = None, epoch: int | None = None, **body: int | str
    ) -> Send:
        """A target as the wire has it, in degrees."""
        q = {f"q{at + 1}": round(angle, 4) for at, angle in enumerate(degrees)}
        return self.send(Channel.JOINTS, seq=seq, epoch=epoch, **q, **body)

    @property
    def steps(self) -> tuple[int, ...]:
        """The joint angles of its last report, in motor steps."""
        rows = zip(self.last.q or (), self.step_deg, strict=False)
        return tuple(round(angle / step) for angle, step in rows)

    def away(self, part: float) -> tuple[int, ...]:
        """A place at this share of each joint's whole way from here."""
        rows = zip(self.arm.joints, self.steps or self._middle(), strict=True)
        return tuple(
            _away(joint.steps(joint.lower), joint.steps(joint.upper), here, part) for joint, here in rows
        )

    def at(self, steps: tuple[int, ...]) -> bool:
        """True if its last report is of these steps."""
        return self.steps == steps

    def _middle(self) -> tuple[int, ...]:
        return tuple(joint.steps((joint.lower + joint.upper) / 2) for joint in self.arm.joints)

    def _read(self, delivery: Delivery) -> ArmTelemetry:
        fields = strict.read(delivery.payload)
        keys = [f"q{at + 1}_mov" for at in range(len(self.arm.joints))]
        spoken = any(key in fields for key in keys)
        return ArmTelemetry(
            at=delivery.at,
            state=fields.integer("estado", 4),
            q=tuple(fields.number(key, payloads.MAX_ANGLE_DEG) for key in keys) if spoken else None,
            number=fields.optional("seq"),
            epoch=fields.optional("epoca_ack"),
            least_epoch=fields.optional("epoca_min"),
            ack=fields.optional("ack"),
            done=fields.optional("hecho"),
            refusal=fields.word("rechazo", payloads.REFUSALS) if "rechazo" in fields else None,
            refused=fields.optional("rechazo_seq"),
            boot_id=fields.optional("arranque"),
            ack_token=fields.token("ficha_ack"),
            done_token=fields.token("ficha_hecho"),
            homed=fields.flag("ref"),
            effector=fields.flag("efector"),
        )


def _away(lower: int, upper: int, here: int, part: float) -> int:
    way = max(2, int((upper - lower) * part))
    there = here + way if upper - here >= here - lower else here - way
    return min(max(there, lower), upper)
