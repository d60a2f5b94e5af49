"""Lines of a controller: the stream of bytes split into them, and the numbers in them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Generic, TypeVar

from arboleda_drivers.connections.stream import Write

LONGEST = 512  # bytes of a line; GRBL and Marlin send fewer
FARTHEST_MM = 100_000.0
NUMBER = r"-?\d{1,6}\.\d{1,4}"

Line = TypeVar("Line")


class LineReader(Generic[Line]):
    """Splitter of the stream into lines; those that mean nothing to `parsed` are passed over."""

    def __init__(self, parsed: Callable[[str], Line | None], *, longest: int = LONGEST) -> None:
        self._parsed, self._longest = parsed, longest
        self._rest = b""

    def feed(self, data: bytes) -> list[Line]:
        """The lines that are complete now, in order."""
        *whole, rest = (self._rest + data).split(b"\n")
        self._rest = rest[-self._longest :]
        found = (self._parsed(each[-self._longest :].decode("ascii", "replace").strip()) for each in whole)
        return [each for each in found if each is not None]


def millimetres(texts: Sequence[str]) -> tuple[float, ...] | None:
    """The numbers of a position, each as `NUMBER`; None where a machine cannot be."""
    numbers = tuple(map(float, texts))
    return numbers if all(abs(each) < FARTHEST_MM for each in numbers) else None


def written(line: str) -> Write:
    """The message that writes a line to the controller."""
    return Write(data=line.encode("ascii") + b"\n")
