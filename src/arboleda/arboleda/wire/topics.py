"""MQTT topics: `<board>/<channel>`, the channel in Spanish as the boards in the field speak it."""

from __future__ import annotations

import re
from enum import Enum

from arboleda.model.errors import PayloadError
from arboleda.model.outside import quoted

_BOARD = re.compile(r"[A-Za-z0-9_-]{1,64}", re.ASCII)


class Channel(str, Enum):
    """The second level of a topic."""

    JOINTS = "juntas"
    EFFECTOR = "efector"
    STOP = "paro"
    HOME = "referencia"
    BEAT = "latido"
    PATH = "camino"
    ORDER = "orden"
    TELEMETRY = "sensores"
    PRESENCE = "conexion"


def topic(mqtt_name: str, channel: Channel) -> str:
    """The topic of a board's channel: `ra_1/juntas`."""
    return f"{mqtt_name}/{channel.value}"


def parse(topic: str) -> tuple[str, Channel]:
    """The board and the channel of a topic; raises PayloadError for any other topic."""
    board, _, name = topic.partition("/")
    if not _BOARD.fullmatch(board):
        raise PayloadError(f"topic {quoted(topic, 80)}: the board's name is 1 to 64 of A-Z a-z 0-9 _ -")
    try:
        return board, Channel(name)
    except ValueError:
        allowed = ", ".join(channel.value for channel in Channel)
        raise PayloadError(
            f"topic {quoted(topic, 80)}: no channel {quoted(name)}; allowed: {allowed}"
        ) from None
