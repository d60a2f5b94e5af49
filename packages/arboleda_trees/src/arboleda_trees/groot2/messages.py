"""Messages by which a viewer such as Groot2 watches a tree of BehaviorTree.CPP, as bytes.

`groot2_protocol.h` of BehaviorTree.CPP 4 defines them. A request is a header of 6 bytes, with a second part
for some types. A reply is that header, 16 bytes that name the tree, then its parts.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum, IntEnum

PROTOCOL = 2
HEADER = struct.Struct("<BBI")  # protocol, type, the number of the request
STATUS = struct.Struct("<HB")  # the number of a node, its status
IDLE_FROM = 10  # is added to the status that a node had before it was idle
LATEST_US = (1 << 48) - 1  # a time has 6 bytes
MOST_NODES = (1 << 16) - 1  # a number of a node has 2
WRONG_HEADER = "wrong request header"
NOT_RECOGNIZED = "Request not recognized"
TWO_PARTS = "must be 2 parts message"


class RequestType(Enum):
    """Type of a request."""

    TREE = b"T"
    STATUS = b"S"
    BLACKBOARD = b"B"
    HOOK_INSERT = b"I"
    HOOK_REMOVE = b"R"
    BREAKPOINT_UNLOCK = b"U"
    HOOKS_DUMP = b"D"
    REMOVE_ALL_HOOKS = b"A"
    DISABLE_ALL_HOOKS = b"X"
    RECORDING = b"r"
    TRANSITIONS = b"t"


WITH_WORDS = {
    RequestType.BLACKBOARD,
    RequestType.HOOK_INSERT,
    RequestType.HOOK_REMOVE,
    RequestType.BREAKPOINT_UNLOCK,
    RequestType.RECORDING,
}


class NodeStatus(IntEnum):
    """Status of a node, as BehaviorTree.CPP numbers it."""

    IDLE = 0
    RUNNING = 1
    SUCCESS = 2
    FAILURE = 3
    SKIPPED = 4


class NoAnswer(Exception):
    """Request that is refused, or not understood; the text goes to the client."""


@dataclass(frozen=True, kw_only=True)
class Request:
    """Request of a client; `words` is its second part."""

    type: RequestType
    number: int
    words: str = ""


@dataclass(frozen=True, kw_only=True)
class Transition:
    """Change of a node's status; `at_us` counts from the begin of the recording."""

    at_us: int
    node: int
    status: NodeStatus


def request_of(parts: Sequence[bytes]) -> Request:
    """The request in these parts; raises NoAnswer for anything else.

    The protocol's number is ignored, as in BehaviorTree.CPP.
    """
    if not parts or len(parts[0]) != HEADER.size:
        raise NoAnswer(WRONG_HEADER)
    _, letter, number = HEADER.unpack(parts[0])
    try:
        type = RequestType(bytes([letter]))
    except ValueError:
        raise NoAnswer(NOT_RECOGNIZED) from None
    if type in WITH_WORDS and len(parts) != 2:
        raise NoAnswer(TWO_PARTS)
    words = parts[1].decode(errors="replace") if len(parts) == 2 else ""
    return Request(type=type, number=number, words=words)


def reply(request: Request, tree: bytes, *parts: bytes) -> list[bytes]:
    """The reply to a request; `tree` are the 16 bytes that name the tree."""
    return [HEADER.pack(PROTOCOL, request.type.value[0], request.number) + tree, *parts]


def refusal(error: NoAnswer) -> list[bytes]:
    return [b"error", str(error).encode()]


def statuses(codes: Iterable[int]) -> bytes:
    """The statuses of all nodes, numbered from 1."""
    return b"".join(STATUS.pack(number, code) for number, code in enumerate(codes, start=1))


def transitions(rows: Iterable[Transition]) -> bytes:
    """The bytes of transitions, 9 each: the time, the node, the status."""
    return b"".join(
        min(max(row.at_us, 0), LATEST_US).to_bytes(6, "little") + STATUS.pack(row.node, row.status)
        for row in rows
    )
