"""Altered telemetry of boards, with a book of which reports are lies."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from arboleda.rig.world import World
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Publication

from ..deceptions import begin_to_deceive
from .kind import End

Fields = dict[str, Any]
Change = Callable[[Fields], Fields]


def alter(world: World, board: str, change: Callable[[bytes], bytes]) -> End:
    """Replace the payload of each telemetry message of a board by what `change` makes of it."""
    address = topic(board, Channel.TELEMETRY)

    def carry(publication: Publication) -> Iterable[Publication]:
        # a stranger may publish there too, and is not altered
        if publication.topic != address or world.moment.published[-1][0] != board:
            return (publication,)
        return (publication._replace(payload=change(publication.payload)),)

    world.carriers.append(carry)
    return lambda: world.carriers.remove(carry)


def deceive(world: World, board: str, whats: Sequence[str], change: Change) -> End:
    """Alter fields of a board's telemetry, and note them as lies about `whats`."""
    truth = begin_to_deceive(world, board, whats)
    end = alter(world, board, lambda payload: retold(payload, change))

    def stop() -> None:
        end()
        truth()

    return stop


def retold(payload: bytes, change: Change) -> bytes:
    """The message with other fields; a payload that is no JSON object stays as it is."""
    try:
        fields = json.loads(payload)
    except ValueError:
        return payload
    return written(change(fields)) if isinstance(fields, dict) else payload


def written(fields: Fields) -> bytes:
    return json.dumps(fields, separators=(",", ":")).encode()
