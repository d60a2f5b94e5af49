"""Files of the versions that a plant took while it ran, attached to its record."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import IO, Any

from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Attachment
from mcap.writer import MCAP0_MAGIC as MAGIC

from arboleda.model.plant_files import PlantFiles

from .errors import NoRecord
from .files import TORN, VERSION
from .reader import HEAD, KNOWN


@dataclass(frozen=True, kw_only=True)
class VersionFiles:
    """Files of a version, by its digest; to be written before the first step that uses it."""

    digest: str
    files: PlantFiles
    unix_ns: int = 0

    @property
    def name(self) -> str:
        """The name of its attachment."""
        return f"{VERSION}{self.digest}.json"

    def data(self) -> bytes:
        """The files as JSON, which keeps each byte."""
        texts = {name: each.decode("utf-8", "surrogateescape") for name, each in self.files.contents.items()}
        return json.dumps({"plant": self.files.plant, "files": texts}).encode()


def versions_in(paths: Iterable[Path]) -> dict[str, PlantFiles]:
    """The files of each version in the files of a record, by digest; NoRecord for what no plant writes."""
    return {digest: files for path in paths for digest, files in _versions(path)}


def _versions(path: Path) -> Iterator[tuple[str, PlantFiles]]:
    with path.open("rb") as file:
        for attached in _attachments(file, path.stat().st_size):
            if attached.name.startswith(VERSION):
                digest = attached.name[len(VERSION) :].partition(".")[0]
                yield digest, _files(attached.data)


def _attachments(file: IO[bytes], size: int) -> Iterator[Attachment]:
    """The whole attachments of a file; all else is passed over unread."""
    file.seek(len(MAGIC))
    while len(head := file.read(HEAD.size)) == HEAD.size:
        opcode, length = HEAD.unpack(head)
        begins = file.tell()
        if opcode not in KNOWN or begins + length > size:
            return
        if opcode == Opcode.ATTACHMENT:
            try:
                yield Attachment.read(ReadDataStream(BytesIO(file.read(length))))
            except TORN:
                return
        file.seek(begins + length)


def _files(data: bytes) -> PlantFiles:
    try:
        rows: dict[str, Any] = json.loads(data)
        contents = {
            str(name): str(each).encode("utf-8", "surrogateescape") for name, each in rows["files"].items()
        }
        return PlantFiles(plant=str(rows["plant"]), contents=contents)
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise NoRecord("it has a version of the plant that is not as a plant writes it") from error
