"""Records as they are read: whole ones, those that are being written, and what a killed process left."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing, suppress
from dataclasses import dataclass, field
from io import SEEK_END, BytesIO
from pathlib import Path
from typing import IO

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    Channel,
    Chunk,
    Footer,
    Header,
    McapRecord,
    Message,
    Metadata,
    Schema,
)
from mcap.stream_reader import breakup_chunk
from mcap.writer import MCAP0_MAGIC as MAGIC

from arboleda.model.outside import quoted

from .errors import NoRecord
from .files import BEGINNING, METADATA, OF_PLANT, TORN, Part, part_at, parts_in
from .preamble import FORMAT, Beginning, beginning_from
from .steps import TOPIC, RecordedStep, from_json

LARGEST = 64 * 1024 * 1024  # bytes of one piece of a file, also once it is unpacked; ours are much smaller
HEAD = struct.Struct("<BQ")  # head of a piece: its kind and its length
KNOWN = frozenset(Opcode)
STEPS_CHANNEL = 1  # the first one that a file opens
INDEX, INDEXED_BYTES = struct.Struct("<HI"), 16  # its channel and its length; bytes of each message in it
READ: dict[int, Callable[[ReadDataStream], McapRecord]] = {
    Opcode.HEADER: Header.read,
    Opcode.METADATA: Metadata.read,
    Opcode.ATTACHMENT: Attachment.read,
    Opcode.CHUNK: Chunk.read,
    Opcode.FOOTER: Footer.read,
}
Raw = tuple[int, bytes]  # nanoseconds of Unix time, and a message


@dataclass
class PartRead:
    """One file of a record: the start that it belongs to, the steps in it, and how it ends.

    `whole`: it was closed properly; else it is being written, or its plant was killed. `damaged`: it was read
    up to a place at which it is not as it was written.
    """

    path: Path
    beginning: Beginning
    numbers: tuple[int, ...]
    began_ns: int
    whole: bool = False
    damaged: bool = False


class PartReader:
    """File of a record, read from its beginning; raises NoRecord, with a sentence, if it is none.

    A half-written piece at its end is left out: a killed plant wrote no more of it.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.channels: dict[int, Channel] = {}
        self.schemas: dict[int, Schema] = {}
        self._file = _opened(path)
        self._is_torn = False
        self._early: list[Attachment] = []  # those that were written before the first message
        try:
            self._records = self._pieces()
            self.read = self._begin()
        except BaseException:  # whatever it is, no file is left open
            self._file.close()
            raise

    def close(self) -> None:
        self._file.close()

    def raw(self) -> Iterator[Raw]:
        """The steps not given yet, in order, with their times, up to the first damage."""
        for _, unix_ns, data in self.messages_of(TOPIC):
            yield unix_ns, data

    def messages_of(self, *topics: str) -> Iterator[tuple[str, int, bytes]]:
        """The messages of these topics not given yet, each with its topic."""
        for piece in self.everything():
            if isinstance(piece, Message) and (topic := self.topic_of(piece)) in topics:
                yield topic, piece.log_time, piece.data

    def topic_of(self, message: Message) -> str:
        """The topic of a message; empty if its channel was never registered."""
        channel = self.channels.get(message.channel_id)
        return channel.topic if channel else ""

    def everything(self) -> Iterator[Message | Attachment]:
        """All messages not given yet, and the attachments between them."""
        early, self._early = self._early, []
        yield from early
        for record in self._records:
            if isinstance(record, Attachment):
                yield record
            elif isinstance(record, Chunk):
                messages = self._messages(record)
                if messages is None:
                    self.read.damaged = True
                    return
                yield from messages
            self.read.whole = isinstance(record, Footer)
        self.read.damaged |= self._is_torn or (not self.read.whole and self._is_closed())
        self._records = self._rest()

    def _is_closed(self) -> bool:
        """True if the file ends as one does that was closed."""
        at, size = self._file.tell(), self._file.seek(0, SEEK_END)
        self._file.seek(max(0, size - len(MAGIC)))
        end = self._file.read(len(MAGIC))
        self._file.seek(at)
        return size > len(MAGIC) and end == MAGIC

    def _messages(self, chunk: Chunk) -> list[Message] | None:
        """The messages of a chunk; None if it is damaged, or larger than any that a plant writes."""
        records = _unpacked(chunk)
        if records is None:
            return None
        self.channels.update({each.id: each for each in records if isinstance(each, Channel)})
        self.schemas.update({each.id: each for each in records if isinstance(each, Schema)})
        return [each for each in records if isinstance(each, Message)]

    def _begin(self) -> PartRead:
        contents: dict[str, bytes] = {}
        began_ns = 0
        metadata: dict[str, str] | None = None
        for record in self._records:
            if isinstance(record, Metadata) and record.name == METADATA:
                metadata = record.metadata
                self._refuse_newer(metadata)
            elif isinstance(record, Attachment) and metadata is not None:
                if record.name != BEGINNING and not record.name.startswith(OF_PLANT):
                    self._early.append(record)
                    continue
                contents[record.name], began_ns = record.data, record.log_time
            elif isinstance(record, Chunk | Footer):
                self._records = _with(record, self._records)
                break
            elif not isinstance(record, Header):
                break
        if metadata is None:
            raise NoRecord(f"{self.path} is an MCAP file, but no record of a plant.")
        if BEGINNING not in contents:
            raise NoRecord(f"{self.path} is the beginning of a record, too little of it to be read.")
        try:
            files = {
                name[len(OF_PLANT) :]: each for name, each in contents.items() if name.startswith(OF_PLANT)
            }
            numbers = tuple(int(number) for number in metadata.get("parts", "").split())
            return PartRead(self.path, beginning_from(contents[BEGINNING], files), numbers, began_ns)
        except (NoRecord, ValueError) as error:
            raise NoRecord(f"{self.path} cannot be read as a record: {error}.") from error

    def _refuse_newer(self, metadata: dict[str, str]) -> None:
        number = metadata.get("format", "")
        if number.isdecimal() and 0 < len(number) < 10 and int(number) <= FORMAT:
            return
        by = quoted(metadata.get("version", "?"), 40)
        raise NoRecord(
            f"{self.path} was written by a newer Arboleda ({by}): read it with that version, or a later one."
        )

    def _pieces(self) -> Iterator[McapRecord]:
        """The whole pieces of the file, of kinds in READ only."""
        if self._file.read(len(MAGIC)) != MAGIC:
            raise NoRecord(f"{self.path} is no MCAP file.")
        yield from self._rest()

    def _rest(self) -> Iterator[McapRecord]:
        """The records not read yet; one that is half written is left for the next call."""
        begins = self._file.tell()
        while len(head := self._file.read(HEAD.size)) == HEAD.size:
            opcode, length = HEAD.unpack(head)
            if opcode not in KNOWN or length > LARGEST:
                self._is_torn = True
                return
            body = self._file.read(length)
            if len(body) < length:
                break
            if opcode in READ:
                try:
                    yield READ[opcode](ReadDataStream(BytesIO(body)))
                except TORN:
                    self._is_torn = True
                    return
            begins = self._file.tell()
        self._file.seek(begins)


def _with(first: McapRecord, rest: Iterator[McapRecord]) -> Iterator[McapRecord]:
    yield first
    yield from rest


def _unpacked(chunk: Chunk) -> list[McapRecord] | None:
    try:
        if chunk.uncompressed_size > LARGEST or unpacked_bytes(chunk) > LARGEST:
            return None
        return breakup_chunk(chunk, validate_crc=True)
    except TORN:
        return None


def unpacked_bytes(chunk: Chunk) -> int:
    return zstandard.frame_content_size(chunk.data) if chunk.compression == "zstd" else len(chunk.data)


def _opened(path: Path) -> IO[bytes]:
    try:
        if not path.is_file():
            raise NoRecord(f"{path} is {'no file' if path.exists() else 'not there'}.")
        if not path.stat().st_size:
            raise NoRecord(f"{path} is empty.")
        return open(path, "rb")
    except OSError as error:
        raise NoRecord(f"{path} cannot be read: {error.strerror}.") from error
    except ValueError as error:
        raise NoRecord(f"{quoted(str(path), 200)} is not the name of a file.") from error


@dataclass
class Record:
    """Record of one start: its files in order. `missing` is the number of first files that are gone."""

    paths: list[Path]
    first: PartRead
    missing: int = 0
    broken: str = ""  # reason of a premature end, once all was read
    last: PartRead | None = field(default=None, repr=False)
    last_ns: int = 0  # time of the last step read

    @property
    def numbers(self) -> tuple[int, ...]:
        """The numbers of its parts, up to the first gap."""
        return self.first.numbers if len(self.paths) == 1 else tuple(self._follow_on())

    def _follow_on(self) -> Iterator[int]:
        first = self.first.numbers[0]
        for number, path in enumerate(self.paths, start=first):
            part = part_at(path)
            if part is None or part.number != number:
                return
            yield number

    def raw(self) -> Iterator[Raw]:
        """All steps, in order, as they are written."""
        for reader in self.readers():
            for self.last_ns, data in reader.raw():
                yield self.last_ns, data

    def readers(self) -> Iterator[PartReader]:
        """A reader of each file, to be read to its end before the next one is asked for."""
        after: tuple[int, ...] = ()
        for path in self.paths:
            with closing(PartReader(path)) as reader:
                if after and reader.read.numbers[:1] != (after[-1] + 1,):
                    self.broken = f"{path.name} does not follow what is before it"
                    return
                after, self.last = reader.read.numbers, reader.read
                yield reader
            if self.last.damaged or (not self.last.whole and path != self.paths[-1]):
                self.broken = f"{path.name} is damaged"
                return

    def steps(self) -> Iterator[RecordedStep]:
        """All steps, in order."""
        for unix_ns, data in self.raw():
            yield from_json(unix_ns, data)


def steps_there(paths: Iterable[Path]) -> int | None:
    """The number of steps in files, also behind damaged places; None if they cannot be counted.

    They are counted by the indexes that stand behind the chunks.
    """
    counts = [_steps_there(path) for path in paths]
    return None if None in counts else sum(filter(None, counts))


def _steps_there(path: Path) -> int | None:
    count, size = 0, path.stat().st_size
    with path.open("rb") as file:
        file.seek(len(MAGIC))
        while len(head := file.read(HEAD.size)) == HEAD.size:
            opcode, length = HEAD.unpack(head)
            if opcode not in KNOWN or file.tell() + length > size:
                return None
            begins = file.tell()
            if opcode == Opcode.MESSAGE_INDEX and length >= INDEX.size:
                channel, indexed_bytes = INDEX.unpack(file.read(INDEX.size))
                count += indexed_bytes // INDEXED_BYTES if channel == STEPS_CHANNEL else 0
            elif opcode == Opcode.FOOTER:
                return count
            file.seek(begins + length)
    return count


def channels_of(path: Path) -> dict[str, int]:
    """The numbers of a file's channels, by topic."""
    with closing(PartReader(path)) as reader:
        next((piece for piece in reader.everything() if isinstance(piece, Message)), None)
        return {channel.topic: id for id, channel in reader.channels.items()}


def alone(path: Path) -> Record:
    """The record that consists of this file alone."""
    with closing(PartReader(path)) as reader:
        return Record([path], reader.read)


def opened(path: Path) -> Record:
    """The record that a file belongs to, with the other files beside it; raises NoRecord."""
    with closing(PartReader(path)) as reader:
        read = reader.read
    part = part_at(path)
    beside = [each for each in parts_in(path.parent) if part is not None and each.epoch == part.epoch]
    paths = [each.path for each in beside if _follows(each, read)] or [path]
    if path != paths[0]:
        with closing(PartReader(paths[0])) as reader:
            read = reader.read
    return Record(paths, read, missing=(read.numbers[0] if read.numbers else 1) - 1)


def _follows(part: Part, read: PartRead) -> bool:
    """True if the neighbouring file is another part of the same record."""
    with suppress(NoRecord), closing(PartReader(part.path)) as reader:
        return reader.read.beginning.epoch == read.beginning.epoch
    return False
