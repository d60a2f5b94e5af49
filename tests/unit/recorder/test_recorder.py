"""The record is bounded, whole up to its last chunk, and never in the way of the plant."""

from __future__ import annotations

import json
import logging
import os
import shutil
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader
from tests.threads import AtTheEnd, stand_in

from arboleda.core.plant import Plant
from arboleda.model.recording import Limits
from arboleda.recorder import files, reader, recorder, writing
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.files import PartFile, part_path, parts_in, prune
from arboleda.recorder.recorder import Recorder
from arboleda.recorder.state import state_of
from arboleda.recorder.steps import Step
from arboleda.recorder.writing import Writing
from arboleda.testing import Rig, shipped

from .recorded import DEFAULT, Site, beginning_of

STOPPED = "the record has stopped: {}; the plant goes on without it"


class Late(Site):
    """One whose recorder writes everything once the plant has ended."""

    def __init__(self, path: Path, patch: pytest.MonkeyPatch, **options: Any) -> None:
        stand_in(recorder, AtTheEnd, patch)
        super().__init__(path, patch, **options)

    def recorder(self, plant: Plant, writing: Writing) -> Recorder:
        made = Recorder(writing, lambda: round(plant.now * 1e9))
        made.start()
        return made


def warnings(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [each.getMessage() for each in caplog.records if each.levelno >= logging.WARNING]


def test_a_full_disk_stops_the_record_and_not_the_plant(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    site = Late(tmp_path, monkeypatch, least_free=10**18)
    site.work("sis_a 0B 7")
    site.end()
    why = "the disk has less than 1000000000000 MB left"
    assert site.recorders[0].trouble == why
    assert warnings(caplog) == [STOPPED.format(why)]
    assert site.rig.changes[-1].state.value == "done"


def test_a_disk_that_fills_up_later_leaves_what_was_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(files, "CHUNK_BYTES", 5000)
    site = Late(tmp_path, monkeypatch)
    writes = PartFile.put

    def full(part: PartFile, *message: Any) -> None:
        if site.files[0].stat().st_size > 20_000:
            raise OSError(28, os.strerror(28))
        writes(part, *message)

    monkeypatch.setattr(PartFile, "put", full)
    site.work("sis_a 0B 7")
    site.end()
    assert warnings(caplog) == [STOPPED.format("No space left on device")]
    assert sum(1 for _ in reader.opened(site.files[0]).steps()) > 10


def test_a_folder_that_cannot_be_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / files.FOLDER).write_text("in the way")
    site = Late(tmp_path, monkeypatch)
    site.work("sis_a 0B 7", s=5.0)
    site.end()
    assert warnings(caplog) == [STOPPED.format("File exists")]


def test_a_state_that_cannot_be_taken_stops_the_record_and_not_the_plant(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(recorder, "state_of", lambda plant, turn: {}["odd"])
    site = Late(tmp_path, monkeypatch)
    site.work("sis_a 0B 7")
    site.end()
    assert site.rig.changes[-1].state.value == "done"
    assert warnings(caplog) == [STOPPED.format("KeyError: 'odd'")]


@pytest.mark.long
def test_files_follow_each_other_and_the_oldest_go(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "PART_BYTES", (10_000, 10_000))
    monkeypatch.setattr(writing, "FLUSH_S", 0.0)
    site = Site(tmp_path, monkeypatch, Limits(megabytes=0.05))
    site.work("sis_a 0B 7", "sis_b 1C 3", "sis_c 2A 5")
    site.end()
    parts = parts_in(site.folder)
    assert sum(part.bytes for part in parts) <= 65_000
    numbers = [part.number for part in parts]
    assert numbers[0] > 1 and numbers == list(range(numbers[0], numbers[0] + len(numbers)))
    record = reader.opened(site.files[-1])
    assert record.missing == numbers[0] - 1 and record.numbers == tuple(numbers)
    times = [step.now for step in record.steps()]
    assert times == sorted(times) and not record.broken


def test_what_was_written_reaches_the_disk_also_where_the_clock_was_set_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now_ns, flushed = [10_000_000_000_000], list[PartFile]()
    monkeypatch.setattr(PartFile, "flush", lambda part: flushed.append(part) or 0)
    writing = Writing(tmp_path, beginning_of(shipped()), DEFAULT, unix_ns=lambda: now_ns[0])
    writing.open()
    writing.tend()
    assert flushed == [], "it is not due yet"
    now_ns[0] -= 3_600_000_000_000
    writing.tend()
    assert len(flushed) == 1
    writing.drop()


def test_what_was_written_survives_a_power_cut_once_a_second_has_passed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a file only what was synced is left then."""
    now_ns, synced = [10_000_000_000_000], dict[str, bytes]()

    def sync(number: int) -> None:
        path = Path(os.readlink(f"/proc/self/fd/{number}"))
        if path.is_file():
            synced[path.name] = path.read_bytes()

    monkeypatch.setattr(files, "sync_data", sync)
    writing = Writing(tmp_path, beginning_of(shipped()), DEFAULT, unix_ns=lambda: now_ns[0])
    writing.open()
    plant = Rig(shipped()).plant
    for second in range(1, 4):
        step = Step(now_ns[0], float(second), (), (), state_of(plant, second))
        assert list(writing.put(step)) != []
        now_ns[0] += 1_000_000_000
        writing.tend()
        left = tmp_path / "left.mcap"
        left.write_bytes(synced["7-0001.mcap"])
        record = reader.opened(left)
        assert [at for at, _ in record.raw()][-1] == step.unix_ns and not record.broken
    writing.drop()


def test_old_files_go_whoever_made_them(tmp_path: Path) -> None:
    for days, (epoch, number) in enumerate(((800, 1), (900, 1), (900, 2), (1000, 1))):
        path = part_path(tmp_path, epoch, number)
        PartFile(path, beginning_of(shipped()), number, 0, ran_s=days * 86_400.0).drop()
        os.utime(path, (0.0, 0.0))  # by a clock that had forgotten the time
    (tmp_path / "notes.txt").write_text("mine")
    prune(tmp_path, Limits(days=2.0), ran_s=3.5 * 86_400.0)
    left = {path.name for path in tmp_path.iterdir()}
    assert left == {"900-0001.mcap", "900-0002.mcap", "1000-0001.mcap", "notes.txt"}


def test_a_part_that_cannot_be_read_keeps_no_older_ones(tmp_path: Path) -> None:
    for days in range(4):
        path = part_path(tmp_path, 900, days)
        PartFile(path, beginning_of(shipped()), days, 0, ran_s=days * 86_400.0).drop()
    part_path(tmp_path, 900, 1).write_bytes(b"")
    prune(tmp_path, Limits(days=2.0), ran_s=4.5 * 86_400.0)
    assert [part.number for part in parts_in(tmp_path)] == [2, 3]


def test_what_cannot_be_read_makes_no_file_old(tmp_path: Path) -> None:
    for number in (1, 2):
        part_path(tmp_path, 900, number).write_bytes(b"x" * 100)
    prune(tmp_path, Limits(days=2.0), ran_s=1e9)
    assert len(parts_in(tmp_path)) == 2


def test_what_a_killed_process_left_is_read_up_to_its_last_chunk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    site = Site(tmp_path, monkeypatch)
    site.work("sis_a 0B 7", s=30.0)
    killed = tmp_path / "killed.mcap"
    shutil.copy(site.files[0], killed)
    site.end()
    whole = [step.hash for step in reader.opened(site.files[0]).steps()]
    record = reader.opened(killed)
    left = [step.hash for step in record.steps()]
    assert 20 < len(left) <= len(whole) and left == whole[: len(left)]
    assert record.last is not None and not record.last.whole


@pytest.mark.long
def test_any_cut_of_a_file_gives_whole_steps_or_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "CHUNK_BYTES", 20_000)
    site = Site(tmp_path, monkeypatch)
    site.work("sis_a 0B 7", s=30.0)
    site.end()
    content = site.files[0].read_bytes()
    whole = [step.hash for step in reader.opened(site.files[0]).steps()]
    cut, counts = tmp_path / "cut.mcap", set()
    for length in range(1, len(content), max(1, len(content) // 25)):
        cut.write_bytes(content[:length])
        try:
            left = [step.hash for step in reader.opened(cut).steps()]
        except NoRecord as refusal:
            assert str(refusal).startswith(str(cut)) and "\n" not in str(refusal)
            continue
        assert left == whole[: len(left)]
        counts.add(len(left))
    assert len(counts) > 2


def test_a_damaged_byte_ends_the_record_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "CHUNK_BYTES", 20_000)
    site = Site(tmp_path, monkeypatch)
    site.work("sis_a 0B 7", s=30.0)
    site.end()
    content = site.files[0].read_bytes()
    whole = [step.hash for step in reader.opened(site.files[0]).steps()]
    broken, counts = tmp_path / "broken.mcap", []
    for eighth in range(2, 8):
        at = len(content) * eighth // 8
        broken.write_bytes(content[:at] + bytes([content[at] ^ 0xFF]) + content[at + 1 :])
        record = reader.opened(broken)
        left = [step.hash for step in record.steps()]
        assert left == whole[: len(left)]
        assert len(left) == len(whole) or record.broken == "broken.mcap is damaged"
        counts.append(len(left))
    assert 0 < min(counts) < len(whole)


def test_a_damaged_length_ends_the_record_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """That of the text in a chunk that says how it is packed, and that of what is packed in it."""
    site = Site(tmp_path, monkeypatch)
    site.work("sis_a 0B 7", s=30.0)
    site.end()
    whole = [step.hash for step in reader.opened(site.files[0]).steps()]
    content, broken = site.files[0].read_bytes(), tmp_path / "broken.mcap"
    packed = content.index(b"\x04\0\0\0zstd")
    for at in (packed + 3, packed + 15):
        broken.write_bytes(content[:at] + b"\xff" + content[at + 1 :])
        record = reader.opened(broken)
        left = [step.hash for step in record.steps()]
        assert len(left) < len(whole) and left == whole[: len(left)]
        assert record.broken == "broken.mcap is damaged"


def test_a_file_that_grows_is_read_on_where_its_reader_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    site = Site(tmp_path, monkeypatch)
    site.work("sis_a 0B 7", s=30.0)
    site.end()
    content = site.files[0].read_bytes()
    whole = [data for _, data in reader.opened(site.files[0]).raw()]
    grows = tmp_path / "grows.mcap"
    grows.write_bytes(content[: len(content) // 3])
    opened = reader.PartReader(grows)
    got = [data for _, data in opened.raw()]
    for end in range(len(content) // 3, len(content), 5000):
        grows.write_bytes(content[:end])
        got += [data for _, data in opened.raw()]
    assert not opened.read.whole
    grows.write_bytes(content)
    got += [data for _, data in opened.raw()]
    opened.close()
    assert got == whole and opened.read.whole


def test_other_tools_find_what_is_in_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    site = Site(tmp_path, monkeypatch)
    site.work("sis_a 0B 7", s=30.0)
    site.end()
    count = sum(1 for _ in reader.opened(site.files[0]).raw())
    with site.files[0].open("rb") as file:
        summary = make_reader(file).get_summary()
        assert summary is not None and summary.statistics is not None
        assert {each.message_encoding for each in summary.channels.values()} == {"json"}
        counts = summary.statistics.channel_message_counts
        assert {each.topic: counts[each.id] for each in summary.channels.values()}["/arboleda/steps"] == count
        for schema, channel, message in make_reader(file).iter_messages():
            schema_row = json.loads(schema.data)
            assert schema.encoding == "jsonschema" and schema_row["title"] == schema.name
            row = json.loads(message.data)
            assert set(schema_row["required"]) <= row.keys() <= schema_row["properties"].keys(), channel.topic
