"""Records written anew: as one whole file, or as lines for any other program."""

from __future__ import annotations

import json
import os
from collections.abc import Container, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from mcap.records import Attachment
from mcap.writer import Writer

from .chapter import CHAPTER
from .errors import NoRecord
from .files import DIGEST, VERSION, attach, put, write_beginning
from .reader import PartReader, Record
from .steps import TOPIC


def as_mcap(record: Record, target: Path, numbers: tuple[int, ...]) -> int:
    """Write all readable steps of a record to a new, whole file; returns their number. Raises NoRecord."""
    count = 0
    with _made(target) as file:
        writer = Writer(file)
        write_beginning(writer, record.first.beginning, numbers, record.first.began_ns)
        channels: dict[str, int] = {}
        for reader in record.readers():
            for piece in reader.everything():
                if isinstance(piece, Attachment):
                    _attach(writer, piece)
                elif topic := reader.topic_of(piece):
                    if topic not in channels:
                        channels.update(_opened(writer, reader, channels))
                    put(writer, channels[topic], piece.log_time, piece.data)
                    if topic == TOPIC:
                        count, record.last_ns = count + 1, piece.log_time
        writer.finish()  # type: ignore[no-untyped-call]
    return count


def _opened(writer: Writer, reader: PartReader, known: Container[str]) -> Iterator[tuple[str, int]]:
    """Register the same channels in the copy, all at once."""
    for channel in reader.channels.values():
        if channel.topic not in known:
            schema = reader.schemas.get(channel.schema_id)
            id = 0 if schema is None else writer.register_schema(schema.name, schema.encoding, schema.data)
            encoding, metadata = channel.message_encoding, channel.metadata
            yield channel.topic, writer.register_channel(channel.topic, encoding, id, metadata)


def _attach(writer: Writer, piece: Attachment) -> None:
    """Copy an attachment, unless each file begins with it: then the copy has it already."""
    if piece.name.startswith((CHAPTER, DIGEST, VERSION)):
        attach(writer, piece.name, piece.media_type, piece.data, piece.log_time)


def as_lines(record: Record, target: Path) -> int:
    """The messages as lines of JSON, each with its Unix time."""
    count = 0
    with _made(target) as file:
        for unix_ns, data in record.raw():
            head = json.dumps({"unix_s": unix_ns / 1e9})
            file.write(head[:-1].encode() + b", " + data[1:] + b"\n")
            count += 1
    return count


@contextmanager
def _made(target: Path) -> Iterator[IO[bytes]]:
    """A new file, readable by its owner only; it is removed if writing fails."""
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
