"""Files of records in their folder: their names, how many are kept, and the writer of one."""

from __future__ import annotations

import math
import os
import re
import struct
import zlib
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import zstandard
from mcap.exceptions import McapError
from mcap.records import Metadata
from mcap.stream_reader import CRCValidationError, StreamReader
from mcap.writer import CompressionType, Writer

from arboleda import __version__
from arboleda.host.files import sync_data, sync_folder
from arboleda.model.recording import DAY_S, MEGABYTE, Limits

from .channels import OURS, Channel, register
from .preamble import FORMAT, Beginning

FOLDER = "record"
NAME = re.compile(r"([0-9]{1,10})-([0-9]{4,9})\.mcap")
METADATA, BEGINNING, OF_PLANT = "arboleda", "beginning.json", "plant/"
RAN = "ran_s"  # the time that the plant had run when the file began
PROFILE = "ros2"
# Without this, readers of bags expect QoS in words; we write the numbers, which all versions read.
OF_BAG = ("rosbag2", {"serialized_metadata": ""})
VERSION = "version/"  # of the plant, put to work while it ran
DIGEST = "events/"  # of the time line, what an attachment has of it
LIBRARY = f"arboleda {__version__}"
CHUNK_BYTES = 1024 * 1024  # more than comes between two flushes: the larger, the smaller they become
PARTS = 10  # into which the megabytes are divided, so that old ones go bit by bit
PART_BYTES = (200_000, 50_000_000)  # a file has at least and at most
TORN = (  # errors of a file that is not as it was written
    McapError,
    CRCValidationError,
    zstandard.ZstdError,
    zlib.error,
    struct.error,
    OverflowError,  # of a length that no file has
    UnicodeDecodeError,
)


@dataclass(frozen=True, kw_only=True, order=True)
class Part:
    """File of a record: the start `epoch` that it belongs to, and its number from 1."""

    epoch: int
    number: int
    path: Path

    @property
    def bytes(self) -> int:
        """Its size; 0 if it is gone."""
        with suppress(OSError):
            return self.path.stat().st_size
        return 0


def part_path(folder: Path, epoch: int, number: int) -> Path:
    return folder / f"{epoch}-{number:04}.mcap"


def part_at(path: Path) -> Part | None:
    """The part that a file is by its name; None for any other file."""
    found = NAME.fullmatch(path.name)
    return Part(epoch=int(found[1]), number=int(found[2]), path=path) if found else None


def parts_in(folder: Path) -> list[Part]:
    """All parts in a folder, the oldest first; none without such a folder."""
    try:
        return sorted(part for path in folder.iterdir() if (part := part_at(path)) is not None)
    except OSError:
        return []


def part_bytes(limits: Limits) -> int:
    """The size in bytes at which a file is closed and the next one begins."""
    least, most = PART_BYTES
    return int(min(max(limits.megabytes * MEGABYTE / PARTS, least), most))


def prune(folder: Path, limits: Limits, ran_s: float) -> None:
    """Delete the oldest parts to make room for another one, and those that are too old.

    The age of a part is the time that the plant has run since the next one began that can be read: a wall
    clock may be wrong.
    """
    left = parts_in(folder)
    while _next_began_ran_s(left[1:]) < ran_s - limits.days * DAY_S:
        left.pop(0).path.unlink(missing_ok=True)
    total = sum(part.bytes for part in left)
    for part in left:
        if total + part_bytes(limits) <= limits.megabytes * MEGABYTE:
            break
        total -= part.bytes
        part.path.unlink(missing_ok=True)


def _next_began_ran_s(parts: list[Part]) -> float:
    return next((each_s for each_s in map(_began_ran_s, parts) if each_s < math.inf), math.inf)


def _began_ran_s(part: Part) -> float:
    """The time that the plant had run when a part began; 0 of a version that did not say it.

    inf of one that cannot be read.
    """
    with suppress(OSError, ValueError, *TORN), part.path.open("rb") as opened:
        for record in islice(StreamReader(opened).records, 2):  # its header comes first
            if isinstance(record, Metadata) and record.name == METADATA:
                return float(record.metadata.get(RAN, 0.0))
    return math.inf


class PartFile:
    """File that is being written; its content survives a power cut after `flush`. Raises OSError."""

    def __init__(
        self,
        path: Path,
        beginning: Beginning,
        number: int,
        unix_ns: int,
        channels: Iterable[Channel] = OURS,
        ran_s: float = 0.0,
    ) -> None:
        self._file = os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb")
        self._writer = Writer(self._file, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD)
        try:
            write_beginning(self._writer, beginning, (number,), unix_ns, ran_s)
            self._channels = register(self._writer, channels)
            self._sync()
            sync_folder(path.parent)
        except BaseException:  # whatever it is, no file is left open
            self._file.close()
            raise

    def put(self, topic: str, unix_ns: int, data: bytes) -> None:
        """Write one message of a channel."""
        put(self._writer, self._channels[topic], unix_ns, data)

    def attach(self, name: str, unix_ns: int, data: bytes) -> None:
        """Attach data that is read without looking at any message."""
        attach(self._writer, name, "application/zstd", data, unix_ns)

    def flush(self) -> int:
        """Write everything to the disk; returns the size then."""
        self._writer.flush()  # type: ignore[no-untyped-call]
        self._sync()
        return self._file.tell()

    def close(self) -> None:
        """Write the end of the file, which other tools look for, and close it."""
        try:
            self._writer.finish()  # type: ignore[no-untyped-call]
            self._sync()
        finally:
            self.drop()

    def _sync(self) -> None:
        self._file.flush()
        sync_data(self._file.fileno())

    def drop(self) -> None:
        """Close the file without an end."""
        with suppress(OSError):  # of a failed write, which was reported before
            self._file.close()


def write_beginning(
    writer: Writer, beginning: Beginning, numbers: Iterable[int], unix_ns: int, ran_s: float = 0.0
) -> None:
    """Write the beginning of a file; `numbers` are those of the parts whose steps it has."""
    writer.start(profile=PROFILE, library=LIBRARY)
    metadata = {
        "format": str(FORMAT),
        "version": beginning.version,
        "plant": beginning.plant,
        "epoch": str(beginning.epoch),
        "parts": " ".join(map(str, numbers)),
        RAN: f"{ran_s:.0f}",
    }
    writer.add_metadata(METADATA, metadata)
    attach(writer, BEGINNING, "application/json", beginning.data(), unix_ns)
    for name, content in beginning.files.contents.items():
        attach(writer, f"{OF_PLANT}{name}", "application/octet-stream", content, unix_ns)
    writer.add_metadata(*OF_BAG)


def attach(writer: Writer, name: str, kind: str, content: bytes, unix_ns: int) -> None:
    """Write a file into the file, as an attachment."""
    writer.add_attachment(create_time=unix_ns, log_time=unix_ns, name=name, media_type=kind, data=content)


def put(writer: Writer, channel: int, unix_ns: int, data: bytes) -> None:
    """Write one message."""
    writer.add_message(channel, log_time=unix_ns, data=data, publish_time=unix_ns)
