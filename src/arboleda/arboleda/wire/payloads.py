"""Conversion of MQTT payloads and values, strict both ways: a message is taken whole or refused whole."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache, lru_cache
from typing import Any

from arboleda.model.commands import StopMode
from arboleda.model.errors import PayloadError
from arboleda.model.facts import Facts
from arboleda.model.messages import MotionState
from arboleda.model.outside import quoted
from arboleda.model.refusals import BUSY, CONDITION, FORMAT, LATE, LIMIT, NOT_HOMED, OLD, RETAINED, STOPPED

from . import strict
from .topics import Channel
from .values import (
    Beat,
    EffectorGoal,
    Goal,
    HomeGoal,
    JointsGoal,
    PathGoal,
    Payload,
    Presence,
    StopGoal,
    Telemetry,
    VerbGoal,
)

__all__ = [
    "DEVICE",
    "DEVICE_REFUSALS",
    "MOST_FAILURES",
    "REFUSALS",
    "Beat",
    "EffectorGoal",
    "Goal",
    "HomeGoal",
    "JointsGoal",
    "PathGoal",
    "Payload",
    "Presence",
    "StopGoal",
    "Telemetry",
    "VerbGoal",
    "angles",
    "decode",
    "encode",
    "read_angles",
]

_OF_ALL = {OLD, RETAINED, LATE, FORMAT, STOPPED, BUSY}
REFUSALS = frozenset({*_OF_ALL, LIMIT, NOT_HOMED})
"""The words a board may give as `rechazo`."""
DEVICE_REFUSALS = frozenset({*_OF_ALL, CONDITION})
"""The words that a device of a declared kind may give as `rechazo`."""
DEVICE = 0  # `axes` of a device of a declared kind: it has facts instead
MOST_FAILURES = 3  # in one message; so many commands may fail before telemetry arrives again

TOKENS = frozenset({"ficha", "ficha_ack", "ficha_hecho"})

MAX_ANGLE_DEG = 1e6  # far beyond any robot, and exact enough for a board's binary32
FOREIGN_TO_ARMS = ("an arm", "nodo")
FOREIGN_TO_MOBILES = ("a mobile robot", "efector", "pieza", "q1_mov")
FOREIGN_TO_DEVICES = ("a device", "nodo", "efector", "pieza", "q1_mov", "ref")
_DECIMALS = 4
_LAST_STATE = MotionState.STOP_LATCHED.value


def decode(channel: Channel, raw: bytes, *, axes: int | None) -> Payload:
    """The message `raw` on `channel`; PayloadError if it breaks the contract.

    `axes` is the number of joints of an arm, None for a mobile robot, 0 for a device of a declared kind.
    Unknown keys are allowed: a newer board may say more.
    """
    if channel is Channel.PRESENCE:
        return _presence(raw)
    if channel is Channel.BEAT:
        return _beat(raw)
    return _READERS[channel](strict.read(raw), axes)


def encode(payload: Payload) -> bytes:
    """Compact JSON of at most 512 bytes, angles with 4 decimals; PayloadError if that is impossible.

    Tokens are left out where there is no room for them.
    """
    if isinstance(payload, Presence):
        return b"1" if payload.online else b"0"
    body = _WRITERS[type(payload)](payload)
    fields = {key: value for key, value in body.items() if value is not None}
    try:
        return strict.write(fields)
    except PayloadError:
        if TOKENS.isdisjoint(fields):
            raise
        return strict.write({key: value for key, value in fields.items() if key not in TOKENS})


def angles(q: tuple[float, ...]) -> bytes:
    """The beginning of an arm's telemetry, up to its last joint."""
    if not all(map(MAX_ANGLE_DEG.__ge__, map(abs, q))):
        _angles(q)  # raises PayloadError, which names the joint
    rows = zip(_joint_keys(len(q), "_mov"), q, strict=True)
    return ("{" + ",".join([f'"{key}":{round(value, _DECIMALS) + 0.0}' for key, value in rows])).encode()


def read_angles(raw: bytes, axes: int) -> tuple[tuple[float, ...], int] | None:
    """The joints at the begin of telemetry, and how many bytes they take; None if `angles` writes others."""
    begin = _angles_pattern(axes).match(raw)
    if begin is None:
        return None
    q = tuple([float(value) for value in begin.groups()])
    return (q, begin.end()) if max(map(abs, q)) <= MAX_ANGLE_DEG else None


def _presence(raw: bytes) -> Presence:
    if raw not in (b"0", b"1"):
        raise PayloadError(f"conexion is {quoted(raw)}; allowed: 0, 1")
    return Presence(online=raw == b"1")


def _stamp(fields: strict.Fields) -> dict[str, int | None]:
    fields.together("seq", "epoca")
    return {"seq": fields.optional("seq"), "epoch": fields.optional("epoca")}


def _stamp_in_time(fields: strict.Fields) -> dict[str, Any]:
    return {**_stamp(fields), "heard": fields.optional("visto"), "token": fields.token("ficha")}


@cache
def _joint_keys(axes: int | None, suffix: str = "") -> tuple[str, ...]:
    if axes is None:
        raise PayloadError("a mobile robot has no joints")
    return tuple(f"q{index + 1}{suffix}" for index in range(axes))


@cache
def _angles_pattern(axes: int) -> re.Pattern[bytes]:
    number = rb"(-?(?:0|[1-9]\d*)\.\d+)"
    rows = [b'"%b":%b' % (key.encode(), number) for key in _joint_keys(axes, "_mov")]
    return re.compile(rb"\{" + b",".join(rows) + b"(?=,)")


def _joints(fields: strict.Fields, axes: int | None) -> JointsGoal:
    q = tuple(fields.number(key, MAX_ANGLE_DEG) for key in _joint_keys(axes))
    return JointsGoal(q_deg=q, **_stamp_in_time(fields))


def _path(fields: strict.Fields, axes: int | None) -> PathGoal:
    if axes is not None:
        raise PayloadError("an arm drives no path")
    return PathGoal(nodes=fields.integers("nodos"), **_stamp_in_time(fields))


def _effector(fields: strict.Fields, axes: int | None) -> EffectorGoal:
    return EffectorGoal(on=fields.integer("efector", 1) == 1, **_stamp_in_time(fields))


def _stop(fields: strict.Fields, axes: int | None) -> StopGoal:
    return StopGoal(mode=StopMode(fields.integer("paro", 2)), **_stamp(fields))


def _home(fields: strict.Fields, axes: int | None) -> HomeGoal:
    fields.integer("ref", top=1, bottom=1)
    return HomeGoal(**_stamp_in_time(fields))


def _order(fields: strict.Fields, axes: int | None) -> VerbGoal:
    if axes != DEVICE:
        raise PayloadError("only a device of a declared kind takes orders")
    values = fields.facts("valores") if "valores" in fields else ()
    return VerbGoal(verb=fields.name("verbo"), values=values or (), **_stamp_in_time(fields))


@lru_cache(maxsize=64)
def _beat(raw: bytes) -> Beat:
    """The heartbeat in these bytes, which each sender repeats four times a second."""
    return Beat(epoch=strict.read(raw).integer("epoca"))


def _telemetry(fields: strict.Fields, axes: int | None) -> Telemetry:
    fields.together("rechazo", "rechazo_seq")
    if axes == DEVICE:
        return _telemetry_of_device(fields)
    fields.refuse(*FOREIGN_TO_ARMS if axes is not None else FOREIGN_TO_MOBILES)
    keys = () if axes is None else _joint_keys(axes, "_mov")
    return Telemetry(
        q_deg=tuple([fields.number(key, MAX_ANGLE_DEG) for key in keys]) if keys else None,
        node=fields.integer("nodo") if axes is None else None,
        state=MotionState(fields.integer("estado", _LAST_STATE)),
        seq=fields.optional("seq"),
        ack_epoch=fields.optional("epoca_ack"),
        least_epoch=fields.optional("epoca_min"),
        ack=fields.optional("ack"),
        done=fields.optional("hecho"),
        refusal=fields.word("rechazo", REFUSALS) if "rechazo" in fields else None,
        refused_seq=fields.optional("rechazo_seq"),
        boot_id=fields.optional("arranque"),
        homed=fields.flag("ref"),
        effector=fields.flag("efector"),
        piece=fields.flag("pieza"),
        ack_token=fields.token("ficha_ack"),
        done_token=fields.token("ficha_hecho"),
    )


def _telemetry_of_device(fields: strict.Fields) -> Telemetry:
    fields.together("respuesta", "respuesta_seq")
    fields.refuse(*FOREIGN_TO_DEVICES)
    state = MotionState(fields.integer("estado", _LAST_STATE))
    if state is MotionState.NOT_HOMED:
        raise PayloadError(f"estado is {state.value}; a device has no homing")
    return Telemetry(
        q_deg=None,
        node=None,
        state=state,
        seq=fields.optional("seq"),
        ack_epoch=fields.optional("epoca_ack"),
        least_epoch=fields.optional("epoca_min"),
        ack=fields.optional("ack"),
        done=fields.optional("hecho"),
        refusal=fields.word("rechazo", DEVICE_REFUSALS) if "rechazo" in fields else None,
        refused_seq=fields.optional("rechazo_seq"),
        boot_id=fields.optional("arranque"),
        facts=fields.facts("datos", strict.shown_fact),
        answer=fields.shown_fact("respuesta"),
        answered_seq=fields.optional("respuesta_seq"),
        failures=fields.named("fallos", MOST_FAILURES),
        ack_token=fields.token("ficha_ack"),
        done_token=fields.token("ficha_hecho"),
    )


_READERS: dict[Channel, Callable[[strict.Fields, int | None], Payload]] = {
    Channel.JOINTS: _joints,
    Channel.PATH: _path,
    Channel.EFFECTOR: _effector,
    Channel.STOP: _stop,
    Channel.HOME: _home,
    Channel.ORDER: _order,
    Channel.TELEMETRY: _telemetry,
}


def _angles(q: tuple[float, ...], suffix: str = "") -> dict[str, object]:
    return {key: _angle(key, value) for key, value in zip(_joint_keys(len(q), suffix), q, strict=True)}


def _angle(key: str, value: float) -> float:
    # + 0.0 turns -0.0 into 0.0: a sign that means nothing is not worth a byte
    return round(strict.number(key, value, MAX_ANGLE_DEG), _DECIMALS) + 0.0


def _stamped(body: dict[str, object], goal: Goal) -> dict[str, object]:
    if (goal.seq is None) != (goal.epoch is None):
        raise PayloadError("seq and epoca go together")
    body = {**body, "seq": goal.seq, "epoca": goal.epoch}
    return body if isinstance(goal, StopGoal) else {**body, "visto": goal.heard, "ficha": goal.token}


def _telemetry_body(telemetry: Telemetry) -> dict[str, object]:
    if (telemetry.refusal is None) != (telemetry.refused_seq is None):
        raise PayloadError("rechazo and rechazo_seq go together")
    if (telemetry.answer is None) != (telemetry.answered_seq is None):
        raise PayloadError("respuesta and respuesta_seq go together")
    return {
        **_angles(telemetry.q_deg or (), "_mov"),
        "nodo": telemetry.node,
        "estado": strict.integer("estado", telemetry.state.value, _LAST_STATE),
        "seq": telemetry.seq,
        "epoca_ack": telemetry.ack_epoch,
        "epoca_min": telemetry.least_epoch,
        "ack": telemetry.ack,
        "hecho": telemetry.done,
        "ficha_ack": telemetry.ack_token,
        "ficha_hecho": telemetry.done_token,
        "rechazo": telemetry.refusal,
        "rechazo_seq": telemetry.refused_seq,
        "arranque": telemetry.boot_id,
        "ref": _bit(telemetry.homed),
        "efector": _bit(telemetry.effector),
        "pieza": _bit(telemetry.piece),
        "respuesta": None if telemetry.answer is None else strict.fact("respuesta", telemetry.answer),
        "respuesta_seq": telemetry.answered_seq,
        "fallos": [[seq, _word(word)] for seq, word in telemetry.failures or ()] or None,
        "datos": None if telemetry.facts is None else _named("datos", telemetry.facts),
    }


def _word(word: str) -> str:
    return strict.name("fallos", word, strict.LONGEST_WORD)


def _order_body(goal: VerbGoal) -> dict[str, object]:
    return {"verbo": strict.name("verbo", goal.verb), "valores": _named("valores", goal.values) or None}


def _named(key: str, facts: Facts) -> dict[str, object]:
    return dict(strict.facts(key, dict(facts)))


def _bit(value: bool | None) -> int | None:
    return None if value is None else int(value)


_WRITERS: dict[type, Callable[..., dict[str, object]]] = {
    JointsGoal: lambda goal: _stamped(_angles(goal.q_deg), goal),
    PathGoal: lambda goal: _stamped({"nodos": list(goal.nodes)}, goal),
    EffectorGoal: lambda goal: _stamped({"efector": int(goal.on)}, goal),
    StopGoal: lambda goal: _stamped({"paro": goal.mode.value}, goal),
    HomeGoal: lambda goal: _stamped({"ref": 1}, goal),
    VerbGoal: lambda goal: _stamped(_order_body(goal), goal),
    Beat: lambda beat: {"epoca": beat.epoch},
    Telemetry: _telemetry_body,
}
