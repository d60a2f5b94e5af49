"""Effects of a network or a board on messages, for `Rig.lost` and `Rig.carry`; boards by MQTT name."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from typing import Any, cast

from arboleda.sim.arm import ArmBody
from arboleda.wire.transport import Publication

from .rig import Rig

Lost = Callable[[Publication], bool]
Carry = Callable[[Publication], Iterable[Publication]]
Change = Callable[[dict[str, Any]], dict[str, Any]]


def from_board(board: str) -> Lost:
    """True for telemetry and presence of a board."""
    return lambda each: each.topic in (f"{board}/sensores", f"{board}/conexion")


def to_board(board: str) -> Lost:
    """True for commands and beats to a board."""
    is_report = from_board(board)
    return lambda each: each.topic.startswith(f"{board}/") and not is_report(each)


def nth(topic: str, number: int, words: bytes = b"") -> Lost:
    """Match only message `number` (from 1) of a topic, of those that contain `words`."""
    count = 0

    def lost(publication: Publication) -> bool:
        nonlocal count
        is_one = publication.topic == topic and words in publication.payload
        count += is_one
        return is_one and count == number

    return lost


def altered(topic: str, change: Change) -> Carry:
    """Replace every message of a topic by what `change` makes of its fields."""

    def carry(publication: Publication) -> list[Publication]:
        if publication.topic != topic:
            return [publication]
        fields = change(json.loads(publication.payload))
        return [publication._replace(payload=json.dumps(fields, separators=(",", ":")).encode())]

    return carry


def says(board: str, **fields: Any) -> Carry:
    """Set these fields in telemetry, whatever is true; None leaves one out."""

    def change(row: dict[str, Any]) -> dict[str, Any]:
        return {key: value for key, value in {**row, **fields}.items() if value is not None}

    return altered(f"{board}/sensores", change)


def garbled(topic: str, payload: bytes, is_hit: Callable[[int], bool] = lambda number: True) -> Carry:
    """Replace the payload of messages of a topic whose number (from 1) `is_hit`."""
    count = 0

    def carry(publication: Publication) -> list[Publication]:
        nonlocal count
        if publication.topic != topic:
            return [publication]
        count += 1
        return [publication._replace(payload=payload) if is_hit(count) else publication]

    return carry


def frozen(board: str) -> Carry:
    """Repeat the next telemetry message again and again instead of all later ones."""
    first: list[Publication] = []

    def carry(publication: Publication) -> list[Publication]:
        if publication.topic != f"{board}/sensores":
            return [publication]
        first.append(publication)
        return first[:1]

    return carry


def twice(publication: Publication) -> list[Publication]:
    """Deliver every message twice, as QoS 1 allows."""
    return [publication, publication]


def swapped(board: str) -> Carry:
    """Deliver telemetry in pairs, the later message of each pair first."""
    waiting: list[Publication] = []

    def carry(publication: Publication) -> list[Publication]:
        if publication.topic != f"{board}/sensores":
            return [publication]
        waiting.insert(0, publication)
        if len(waiting) < 2:
            return []
        pair, waiting[:] = list(waiting), []
        return pair

    return carry


def hand(rig: Rig, board: str, *, tells_all: bool, slow_s: float = 0.15) -> Carry:
    """Telemetry of an arm whose effector takes its time to switch, and its piece sensor to look again.

    `tells_all`: it also has the effector's value, late by that time; else it has only the piece.
    """
    body = cast(ArmBody, rig.devices.boards[board].body)
    effector, looked_at = [(rig.now, body.effector)], [rig.now]

    def change(row: dict[str, Any]) -> dict[str, Any]:
        if effector[-1][1] is not body.effector:
            effector.append((rig.now, body.effector))
        settled = [on for at, on in effector if at <= rig.now - slow_s] or [effector[0][1]]
        fields = {"efector": int(settled[-1])} if tells_all else {}
        if rig.now < looked_at[-1] + slow_s:
            return {key: value for key, value in {**row, **fields}.items() if key != "pieza"}
        looked_at[:] = [rig.now]
        return {**row, **fields, "pieza": int(bool(body.tell().piece))}

    return altered(f"{board}/sensores", change)
