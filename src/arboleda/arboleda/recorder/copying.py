"""Records written anew: as one whole file, or as lines for any other program."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from mcap.writer import Writer

from .errors import NoRecord
from .files import put, steps_channel, write_beginning
from .reader import Record


def as_mcap(record: Record, target: Path, numbers: tuple[int, ...]) -> int:
    """Write all that can be read of a record to a new file, whole; how many steps that are. NoRecord."""
    count = 0
    with _made(target) as file:
        writer = Writer(file)
        write_beginning(writer, record.first.beginning, numbers, record.first.began_ns)
        channel = steps_channel(writer)
        for unix_ns, data in record.raw():
            put(writer, channel, unix_ns, data)
            count += 1
        writer.finish()  # type: ignore[no-untyped-call]
    return count


def as_lines(record: Record, target: Path) -> int:
    """The same as lines of JSON, each with its Unix time."""
    count = 0
    with _made(target) as file:
        for unix_ns, data in record.raw():
            head = json.dumps({"unix_s": unix_ns / 1e9})
            file.write(head[:-1].encode() + b", " + data[1:] + b"\n")
            count += 1
    return count


@contextmanager
def _made(target: Path) -> Iterator[IO[bytes]]:
    """A new file, readable by its owner only; none is left where it cannot be written."""
    try:
        opened = os.open(target, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError as error:
        raise NoRecord(f"{target} is there already: name another file.") from error
    except OSError as error:
        raise NoRecord(f"{target} cannot be written: {error.strerror}.") from error
    try:
        with os.fdopen(opened, "wb") as file:
            yield file
    except BaseException as error:  # Ctrl-C leaves no half of a file, either
        target.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise NoRecord(f"{target} cannot be written: {error.strerror}.") from error
        raise
