"""Index of the chunks of a file by time, so that a moment is read without all that precedes it."""

from __future__ import annotations

import struct
import zlib
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import IO

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Attachment, AttachmentIndex, Chunk, ChunkIndex, Footer, MessageIndex
from mcap.writer import MCAP0_MAGIC as MAGIC

from arboleda.recorder import files, reader

LoggedMessage = tuple[int, int, bytes]  # number of its channel, ns of Unix time, content
TIMES = struct.Struct("<QQ")
MESSAGE = struct.Struct("<HIQQ")  # channel, sequence, time of the log, time of the publication
FOOTER_BYTES = reader.HEAD.size + 20


@dataclass(frozen=True)
class ChunkAt:
    """Chunk of a file: its time, its place, and the place of its index of each channel."""

    start_ns: int
    end_ns: int
    offset: int
    indexes: dict[int, int]


@dataclass
class FileIndex:
    """Index of the part of a file that is written."""

    chunks: list[ChunkAt] = field(default_factory=list)
    attachments: list[tuple[str, int]] = field(default_factory=list)
    end: int = len(MAGIC)  # the file is indexed up to here
    whole: bool = False

    def position(self, unix_ns: int) -> int:
        """The number of the last chunk that begins before this moment; -1 if there is none."""
        return bisect_right([chunk.start_ns for chunk in self.chunks], unix_ns) - 1


class ChunkFile:
    """File of a record, read at any place; chunks written later are found by the next request."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._index = FileIndex()

    def index(self) -> FileIndex:
        if not self._index.whole:
            with self.path.open("rb") as file:
                self._index = _summary(file) or self._index
                if not self._index.whole:
                    _scan(file, self._index)
        return self._index

    def times(self, offset: int) -> list[tuple[int, int]]:
        """The messages of one channel in a chunk by its index: the time, and the place in the chunk."""
        with suppress(*files.TORN):
            index = self._read(Opcode.MESSAGE_INDEX, offset)
            return MessageIndex.read(ReadDataStream(BytesIO(index))).records if index else []
        return []

    def content(self, chunk: ChunkAt) -> bytes:
        """The content of a chunk; empty if it is damaged."""
        with suppress(*files.TORN):
            body = self._read(Opcode.CHUNK, chunk.offset)
            found = Chunk.read(ReadDataStream(BytesIO(body)))
            if found.uncompressed_size > reader.LARGEST or reader.unpacked_bytes(found) > reader.LARGEST:
                return b""
            data = found.data
            if found.compression == "zstd":
                data = zstandard.decompress(data, found.uncompressed_size)
            return data if zlib.crc32(data) == found.uncompressed_crc else b""
        return b""

    def attachment(self, offset: int) -> bytes:
        body = self._read(Opcode.ATTACHMENT, offset)
        return Attachment.read(ReadDataStream(BytesIO(body))).data if body else b""

    def _read(self, opcode: Opcode, offset: int) -> bytes:
        with self.path.open("rb") as file:
            file.seek(offset)
            found, length = reader.HEAD.unpack(file.read(reader.HEAD.size))
            return file.read(length) if found == opcode and length <= reader.LARGEST else b""


def messages(content: bytes, channels: Iterable[int], begins: int = 0) -> Iterator[LoggedMessage]:
    """The messages of these channels in a chunk, in order, from the byte `begins` on."""
    wanted = frozenset(channels)
    while begins < len(content):
        opcode, length = reader.HEAD.unpack_from(content, begins)
        body = begins + reader.HEAD.size
        if opcode == Opcode.MESSAGE:
            channel, _, log_ns, _ = MESSAGE.unpack_from(content, body)
            if channel in wanted:
                yield channel, log_ns, content[body + MESSAGE.size : body + length]
        begins = body + length


def _summary(file: IO[bytes]) -> FileIndex | None:
    """The index at the end of a closed file; None if there is none that can be read."""
    with suppress(*files.TORN, OSError, ValueError):
        file.seek(-FOOTER_BYTES - len(MAGIC), 2)
        ends = file.tell()
        tail = file.read()
        if tail[0] != Opcode.FOOTER or not tail.endswith(MAGIC):
            return None
        start = Footer.read(ReadDataStream(BytesIO(tail[reader.HEAD.size :]))).summary_start
        if not 0 < ends - start <= reader.LARGEST:
            return None
        file.seek(start)
        return _from_summary(file.read(ends - start), ends)
    return None


def _from_summary(summary: bytes, ends: int) -> FileIndex:
    found, at = FileIndex(end=ends, whole=True), 0
    while at < len(summary):
        opcode, length = reader.HEAD.unpack_from(summary, at)
        stream = ReadDataStream(BytesIO(summary[at + reader.HEAD.size : at + reader.HEAD.size + length]))
        if opcode == Opcode.CHUNK_INDEX:
            each = ChunkIndex.read(stream)
            times = each.message_start_time, each.message_end_time
            found.chunks.append(ChunkAt(*times, each.chunk_start_offset, each.message_index_offsets))
        elif opcode == Opcode.ATTACHMENT_INDEX:
            attached = AttachmentIndex.read(stream)
            found.attachments.append((attached.name, attached.offset))
        at += reader.HEAD.size + length
    return found


def _scan(file: IO[bytes], index: FileIndex) -> None:
    """Extend the index of a file that nobody closed, from its known end on."""
    size = file.seek(0, 2)
    file.seek(index.end)
    while len(head := file.read(reader.HEAD.size)) == reader.HEAD.size:
        opcode, length = reader.HEAD.unpack(head)
        if index.end + reader.HEAD.size + length > size or opcode == Opcode.DATA_END:
            return
        _note(file, index, opcode)
        index.end += reader.HEAD.size + length
        file.seek(index.end)


def _note(file: IO[bytes], index: FileIndex, opcode: int) -> None:
    if opcode == Opcode.CHUNK:
        start_ns, end_ns = TIMES.unpack(file.read(TIMES.size))
        index.chunks.append(ChunkAt(start_ns, end_ns, index.end, {}))
    elif opcode == Opcode.MESSAGE_INDEX and index.chunks:
        (channel,) = struct.unpack("<H", file.read(2))
        index.chunks[-1].indexes[channel] = index.end
    elif opcode == Opcode.ATTACHMENT:
        _, _, letters = struct.unpack("<QQI", file.read(20))
        index.attachments.append((file.read(min(letters, 200)).decode(errors="replace"), index.end))
