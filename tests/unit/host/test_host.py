"""What stands in where an operating system lacks something: tried here by taking it away."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from arboleda.host import files, limits, locks, machine


@pytest.fixture
def lock_file(tmp_path: Path) -> Path:
    return tmp_path / "lock"


def opened(path: Path) -> int:
    return os.open(path, os.O_RDWR | os.O_CREAT)


def test_one_has_the_lock_until_its_file_is_closed(lock_file: Path) -> None:
    first, second = opened(lock_file), opened(lock_file)
    assert locks.lock(first) and not locks.lock(second)
    os.close(first)
    assert locks.lock(second)
    os.close(second)


def test_those_who_share_suffer_each_other_alone(lock_file: Path) -> None:
    first, second, third = opened(lock_file), opened(lock_file), opened(lock_file)
    assert locks.lock(first, shared=True) and locks.lock(second, shared=True)
    assert not locks.lock(third)
    for each in (first, second, third):
        os.close(each)


@pytest.mark.parametrize("taken", [False, True])
def test_windows_locks_a_byte_that_nobody_reads(
    lock_file: Path, monkeypatch: pytest.MonkeyPatch, *, taken: bool
) -> None:
    asked = []

    def locking(file: int, mode: int, size: int) -> None:
        asked.append((os.lseek(file, 0, os.SEEK_CUR), mode, size))
        if taken:
            raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(locks, "fcntl", None)
    monkeypatch.setitem(sys.modules, "msvcrt", SimpleNamespace(LK_NBLCK=2, locking=locking))
    file = opened(lock_file)
    assert locks.lock(file) is not taken
    assert asked == [(1 << 30, 2, 1)]
    os.close(file)
    assert lock_file.stat().st_size == 0


def test_without_limits_there_are_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "resource", None)
    monkeypatch.delattr(os, "nice")
    assert limits.open_files() is None
    limits.raise_open_files(4096)
    limits.limit_memory(1)
    limits.limit_processor(0)
    limits.give_way(10)


def test_a_name_leads_to_its_addresses_once() -> None:
    assert machine.by_name("localhost") == ["127.0.0.1"]
    assert machine.by_name("127.0.0.1") == ["127.0.0.1"]


def test_a_name_that_leads_nowhere_has_no_address(monkeypatch: pytest.MonkeyPatch) -> None:
    def unknown(*_: object) -> None:
        raise OSError("unknown")

    monkeypatch.setattr(machine.socket, "getaddrinfo", unknown)
    assert machine.by_name("mill.lab") == []


def test_an_open_file_gets_other_content(tmp_path: Path) -> None:
    path = tmp_path / "facts"
    path.write_bytes(b"longer than the next")
    file = opened(path)
    files.write_anew(file, b"short")
    os.close(file)
    assert path.read_bytes() == b"short"


def test_a_folder_is_synced_where_folders_can_be_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    synced: list[int] = []
    monkeypatch.setattr(os, "fsync", lambda opened: synced.append(os.fstat(opened).st_ino))
    files.sync_folder(tmp_path)
    monkeypatch.delattr(os, "O_DIRECTORY")
    files.sync_folder(tmp_path)
    assert synced == [tmp_path.stat().st_ino]


def test_a_boot_that_nobody_tells_is_another_each_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(machine, "BOOT_ID", tmp_path / "absent")
    assert machine.this_boot() != machine.this_boot()


def test_without_an_alarm_no_process_ends_by_it(monkeypatch: pytest.MonkeyPatch) -> None:
    assert limits.ended_by_alarm(-signal.SIGPROF) and not limits.ended_by_alarm(None)
    monkeypatch.setattr(limits, "ALARM", None)
    alarm = limits.ProcessorAlarm(sys.stderr)
    alarm.set(1.0)
    alarm.close()
    assert not limits.ended_by_alarm(-signal.SIGPROF)


def test_a_user_has_a_home_and_nobody_else_has(monkeypatch: pytest.MonkeyPatch) -> None:
    assert machine.home_of("root") == Path("/root")
    assert machine.home_of("") is None and machine.home_of("root/x") is None
    monkeypatch.setattr(machine, "pwd", None)
    assert machine.home_of("root") is None


def test_a_mark_is_that_of_the_user(monkeypatch: pytest.MonkeyPatch) -> None:
    assert machine.own_mark() == str(os.getuid())
    monkeypatch.setenv("LOGNAME", "ana")
    monkeypatch.delattr(os, "getuid")
    assert machine.own_mark() == "ana"


def test_a_limit_that_the_system_refuses_is_done_without(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []

    def refuse(_: int, size: object) -> None:
        asked.append(size)
        raise ValueError("current limit exceeds maximum limit")

    monkeypatch.setattr(limits.resource, "setrlimit", refuse)
    limits.limit_memory(1 << 30)
    assert asked == [(1 << 30, 1 << 30)]
