"""Files that are no records, or not those of this version, are refused in one sentence."""

from __future__ import annotations

import json
import os
import struct
from collections.abc import Callable
from pathlib import Path

import pytest
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import Chunk
from mcap.writer import Writer

from arboleda.recorder import files, reader
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.files import BEGINNING, METADATA

MAGIC = b"\x89MCAP0\r\n"


def of_another_program(path: Path) -> None:
    with open(path, "wb") as out:
        writer = Writer(out)
        writer.start("ros2", "rosbag2")
        schema = writer.register_schema("std_msgs/msg/String", "ros2msg", b"string data")
        channel = writer.register_channel("/chatter", "cdr", schema)
        writer.add_message(channel, 1, b"\x00\x01\x00\x00", 1)
        writer.finish()


def with_metadata(path: Path, beginning: bytes | None = None, **changes: str) -> None:
    with open(path, "wb") as out:
        writer = Writer(out)
        writer.start()
        metadata = {"format": "1", "version": "9.9", "plant": "p", "epoch": "7", "parts": "1", **changes}
        writer.add_metadata(METADATA, metadata)
        if beginning is not None:
            writer.add_attachment(0, 0, BEGINNING, "application/json", beginning)
        writer.finish()


def huge(path: Path) -> None:
    """10 GB of nothing, which take no room on the disk."""
    with open(path, "wb") as out:
        out.write(MAGIC)
        os.truncate(out.fileno(), 10 * 10**9)


def one_huge_piece(path: Path) -> None:
    path.write_bytes(MAGIC + struct.pack("<BQ", 6, 2**62) + b"x" * 100)


CASES: dict[str, tuple[Callable[[Path], object], str]] = {
    "empty": (lambda path: path.write_bytes(b""), "{} is empty."),
    "text": (lambda path: path.write_text("name: arboleda\n"), "{} is no MCAP file."),
    "short": (lambda path: path.write_bytes(MAGIC[:5]), "{} is no MCAP file."),
    "only the magic": (lambda path: path.write_bytes(MAGIC), "{} is an MCAP file, but no record of a plant."),
    "a folder": (lambda path: path.mkdir(), "{} is no file."),
    "nothing": (lambda path: None, "{} is not there."),
    "foreign": (of_another_program, "{} is an MCAP file, but no record of a plant."),
    "huge": (huge, "{} is an MCAP file, but no record of a plant."),
    "one huge piece": (one_huge_piece, "{} is an MCAP file, but no record of a plant."),
    "newer": (
        lambda path: with_metadata(path, format="3"),
        "{} was written by a newer Arboleda ('9.9'): read it with that version, or a later one.",
    ),
    "of no version": (
        lambda path: with_metadata(path, format="²"),
        "{} was written by a newer Arboleda ('9.9'): read it with that version, or a later one.",
    ),
    "too little": (with_metadata, "{} is the beginning of a record, too little of it to be read."),
    "a beginning of something else": (
        lambda path: with_metadata(path, b"[1]"),
        "{} cannot be read as a record: its beginning is not as a plant writes it.",
    ),
    "parts that are no numbers": (
        lambda path: with_metadata(path, b"{}", parts="one"),
        "{} cannot be read as a record: invalid literal for int() with base 10: 'one'.",
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_what_is_no_record_is_one_sentence(tmp_path: Path, name: str) -> None:
    make, sentence = CASES[name]
    path = tmp_path / "some.mcap"
    make(path)
    with pytest.raises(NoRecord) as refusal:
        reader.opened(path)
    assert str(refusal.value) == sentence.format(path)


def test_a_chunk_that_unpacks_to_too_much_ends_the_record(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "bomb.mcap"
    beginning = {"plant": "p", "version": "1", "epoch": 7, "now": 0.0, "rate": 1.0, "virtual": False}
    more = {"memory": {}, "kept": [], "file": "plant.yaml"}
    with_metadata(path, json.dumps({**beginning, **more}).encode())
    bomb = RecordBuilder()
    Chunk("zstd", zstandard.compress(b"\0" * 10**8), 0, 0, 0, 500).write(bomb)
    end = path.read_bytes().index(struct.pack("<BQ", Opcode.DATA_END, 4))
    path.write_bytes(path.read_bytes()[:end] + bomb.end())
    unpacked = []
    monkeypatch.setattr(reader, "breakup_chunk", lambda chunk, **_: unpacked.append(chunk))
    assert list(reader.opened(path).raw()) == [] and not unpacked


def test_names_of_files_are_those_of_parts_only(tmp_path: Path) -> None:
    names = ("7-0002.mcap", "7-0001.mcap", "12-0001.mcap", "7-0001.mcap.bak", "x-0001.mcap", "7-1.mcap")
    for name in names:
        (tmp_path / name).touch()
    assert [part.path.name for part in files.parts_in(tmp_path)] == [names[1], names[0], names[2]]
    assert files.parts_in(tmp_path / "absent") == []
