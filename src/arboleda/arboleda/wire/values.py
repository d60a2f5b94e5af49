"""Messages over MQTT: one frozen value for each, angles in degrees as on the wire.

`seq` and `epoch` of a command are both present, or both None for boards without ids. `heard` is the number of
the last telemetry that the sender of the command had heard, None where it is not given. A stop has none, as
it is never too late.
"""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.model.commands import StopMode
from arboleda.model.facts import Facts, Value
from arboleda.model.messages import MotionState


@dataclass(frozen=True, kw_only=True)
class JointsGoal:
    """Command `juntas`: absolute joint targets, in degrees of the joints or of the pinions of racks."""

    q_deg: tuple[float, ...]
    seq: int | None
    epoch: int | None
    heard: int | None = None
    token: str | None = None


@dataclass(frozen=True, kw_only=True)
class PathGoal:
    """Command `camino`: grid nodes in driving order."""

    nodes: tuple[int, ...]
    seq: int | None
    epoch: int | None
    heard: int | None = None
    token: str | None = None


@dataclass(frozen=True, kw_only=True)
class EffectorGoal:
    """Command `efector`: switch the effector."""

    on: bool
    seq: int | None
    epoch: int | None
    heard: int | None = None
    token: str | None = None


@dataclass(frozen=True, kw_only=True)
class StopGoal:
    """Command `paro`: stop."""

    mode: StopMode
    seq: int | None
    epoch: int | None


@dataclass(frozen=True, kw_only=True)
class HomeGoal:
    """Command `referencia`: run the homing routine."""

    seq: int | None
    epoch: int | None
    heard: int | None = None
    token: str | None = None


@dataclass(frozen=True, kw_only=True)
class VerbGoal:
    """Command `orden`: a verb of a declared kind of device, with its values."""

    verb: str
    values: Facts
    seq: int | None
    epoch: int | None
    heard: int | None = None
    token: str | None = None


@dataclass(frozen=True, kw_only=True)
class Beat:
    """Heartbeat `latido` of the sender of commands."""

    epoch: int


@dataclass(frozen=True, kw_only=True)
class Telemetry:
    """Message `sensores`: `q_deg` of an arm, `node` of a mobile robot or `facts` of a device.

    Every field that was not reported is None. `seq` counts telemetry since boot. `least_epoch`, which is sent
    if it is above `ack_epoch`, is the oldest epoch whose commands count. Seqs of commands are of `ack_epoch`:
    `ack`, `done`, `refused_seq`, `answered_seq` of the last query that a device answered, and those in
    `failures`, the last few commands that the device gave up, oldest first. `ack_token` and `done_token` are
    the tokens of `ack` and `done`.
    """

    state: MotionState
    q_deg: tuple[float, ...] | None
    node: int | None
    seq: int | None = None
    ack_epoch: int | None = None
    ack: int | None = None
    done: int | None = None
    refusal: str | None = None
    refused_seq: int | None = None
    boot_id: int | None = None
    homed: bool | None = None
    effector: bool | None = None
    piece: bool | None = None
    facts: Facts | None = None
    answer: Value | None = None
    answered_seq: int | None = None
    failures: tuple[tuple[int, str], ...] | None = None
    least_epoch: int | None = None
    ack_token: str | None = None
    done_token: str | None = None


@dataclass(frozen=True, kw_only=True)
class Presence:
    """Message `conexion`, retained; False is the board's last will."""

    online: bool


Goal = JointsGoal | PathGoal | EffectorGoal | StopGoal | HomeGoal | VerbGoal
Payload = Goal | Beat | Telemetry | Presence
