"""The lines of one seed as they happen, to the terminal and to a file."""

from __future__ import annotations

import json
from io import RawIOBase

from arboleda.extension import ArboledaError

TIME = 10  # columns of the time in a line of the trace


class OutputLost(BaseException):
    """Nobody takes the lines any more, `error` is the reason; an Exception would be blamed on the plant."""

    def __init__(self, error: Exception) -> None:
        self.error = error


class LineWriter:
    """LineWriter: prints each line with `printed`, and writes it to `file`; OutputLost if that fails."""

    def __init__(self, *, printed: bool, file: RawIOBase | None) -> None:
        self._printed = printed
        self._file = file

    def __call__(self, line: str) -> None:
        if self._printed:
            self._print(line)
        if self._file is not None:
            self._write(self._file, as_json(line))

    def _print(self, line: str) -> None:
        try:
            print(line)
        except OSError as error:
            raise OutputLost(error) from error

    def _write(self, file: RawIOBase, line: str) -> None:
        try:
            file.write(line.encode() + b"\n")
        except OSError as error:
            sentence = f"the lines cannot be written to the file: {error.strerror}"
            raise OutputLost(ArboledaError(sentence)) from error


def as_json(line: str) -> str:
    """A line of the trace as an object with `time` in s, `who` and `what`."""
    who, _, what = line[TIME:].strip().partition(" ")
    return json.dumps({"time": float(line[:TIME]), "who": who, "what": what.strip()}, ensure_ascii=False)
