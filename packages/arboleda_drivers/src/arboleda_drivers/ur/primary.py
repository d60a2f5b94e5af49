"""The primary client interface: it takes programs, and sends messages, of which the driver reads errors."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from arboleda.drivers import plain
from arboleda_drivers.connections.link import LinkBroken

HEADER = struct.Struct(">iB")
MESSAGE = struct.Struct(">QbB")  # time, source, type
ROBOT_MESSAGE, ERROR_CODE, RUNTIME_EXCEPTION = 20, 6, 10
CODE, EXCEPTION = struct.Struct(">iiiII"), struct.Struct(">ii")
READ_ONLY = 210  # C210: the interface is read-only, as in local control
LONGEST = 1 << 20  # bytes of a package; what a controller sends is some thousand
LONGEST_WORD = 80


@dataclass(frozen=True, kw_only=True)
class ScriptError:
    """Error that the controller tells about programs; `code` 0 for one while a program runs."""

    code: int
    text: str


class PackageReader:
    """Splitter of the stream into packages, of which it keeps the errors of programs."""

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> list[ScriptError]:
        """The errors in the packages that are complete now; raises LinkBroken for a length that none has."""
        rest, found = self._rest + data, []
        while len(rest) >= HEADER.size:
            size, kind = HEADER.unpack_from(rest)
            if not HEADER.size <= size <= LONGEST:
                raise LinkBroken(f"its primary interface sends a package of {size} bytes")
            if len(rest) < size:
                break
            if kind == ROBOT_MESSAGE and (error := _error(rest[HEADER.size : size])) is not None:
                found.append(error)
            rest = rest[size:]
        self._rest = rest
        return found


def _error(body: bytes) -> ScriptError | None:
    if len(body) < MESSAGE.size:
        return None
    _, _, kind = MESSAGE.unpack_from(body)
    body = body[MESSAGE.size :]
    if kind == ERROR_CODE and len(body) >= CODE.size:
        code, argument, level, _, _ = CODE.unpack_from(body)
        is_error = 3 <= level < 128  # violations and faults; less is for the log, more for the maker
        named = f"C{code}A{argument} {_text(body[CODE.size :])}".strip()
        return ScriptError(code=code, text=named) if is_error or code == READ_ONLY else None
    if kind == RUNTIME_EXCEPTION and len(body) >= EXCEPTION.size:
        line, _ = EXCEPTION.unpack_from(body)
        return ScriptError(code=0, text=f"line {line}: {_text(body[EXCEPTION.size :])}")
    return None


def _text(data: bytes) -> str:
    return plain(data.decode("utf-8", "replace").strip("\0\n "), LONGEST_WORD)


def packed_code(code: int, text: str) -> bytes:
    """The message of an error code, as a controller sends it."""
    return _packed(ERROR_CODE, CODE.pack(code, 0, 3, 0, 0) + text.encode())


def packed_exception(line: int, text: str) -> bytes:
    """The message of an error in a program, as a controller sends it."""
    return _packed(RUNTIME_EXCEPTION, EXCEPTION.pack(line, 1) + text.encode())


def _packed(kind: int, payload: bytes) -> bytes:
    body = MESSAGE.pack(0, -1, kind) + payload
    return HEADER.pack(HEADER.size + len(body), ROBOT_MESSAGE) + body
