"""The state directory has one owner."""

from __future__ import annotations

import errno
import os
import re
import shutil
import stat
from pathlib import Path

import pytest

from arboleda.model.errors import ArboledaError, StartError
from arboleda.runtime import host_claim, state
from arboleda.runtime.state import StateDir, default_state, find_running


@pytest.fixture(autouse=True)
def _no_pause(monkeypatch):
    monkeypatch.setattr(state, "LOCK_PAUSE_S", 0)


def test_the_owner_is_found_as_long_as_it_lives(tmp_path):
    path = tmp_path / "a" / "demo"
    assert find_running(path) is None
    with StateDir(path) as owner:
        assert find_running(path).port is None
        owner.announce(4321)
        found = find_running(path)
        assert (found.pid, found.port) == (os.getpid(), 4321)
        assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\+00:00", found.started)
    assert find_running(path) is None
    assert [file.name for file in path.iterdir()] == ["plant.lock"]


def test_a_second_owner_is_told_who_the_first_is(tmp_path):
    with StateDir(tmp_path), pytest.raises(StartError) as refused:
        StateDir(tmp_path).open()
    assert re.fullmatch(
        rf"A plant is already running on {tmp_path} \(process {os.getpid()}, since \S+\)\. "
        r"End it first, or give this plant its own --state directory\.",
        str(refused.value),
    )
    with StateDir(tmp_path):
        pass


def test_its_files_are_for_their_owner_only(tmp_path):
    with StateDir(tmp_path / "new") as owner:
        owner.announce(1)
        modes = {file.name: stat.S_IMODE(file.stat().st_mode) for file in owner.path.iterdir()}
        assert modes == {"plant.lock": 0o600, "plant.json": 0o600}
        assert stat.S_IMODE(owner.path.stat().st_mode) == 0o700


def test_a_disk_that_has_become_read_only_keeps_nobody_from_ending(tmp_path, monkeypatch):
    def fail(*_, **__):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    owner = StateDir(tmp_path)
    owner.open()
    owner.announce(7)
    monkeypatch.setattr(Path, "unlink", fail)
    owner.close()
    assert find_running(tmp_path) is None


def test_closing_twice_leaves_the_next_owner_alone(tmp_path):
    first, second = StateDir(tmp_path), StateDir(tmp_path)
    first.open()
    first.close()
    second.open()
    second.announce(7)
    first.close()
    assert find_running(tmp_path).port == 7
    second.close()


def test_a_place_that_cannot_be_used_is_one_sentence(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(StartError, match="cannot be used: Not a directory"):
        StateDir(tmp_path / "file" / "demo").open()


@pytest.mark.parametrize(
    ("base", "expected"), [("/var/x", "/var/x/arboleda/demo"), ("", "~"), ("relative", "~"), (None, "~")]
)
def test_the_default_place(monkeypatch, base, expected):
    monkeypatch.delenv("XDG_STATE_HOME", raising=False)
    monkeypatch.setenv("HOME", "/home/ana")
    if base is not None:
        monkeypatch.setenv("XDG_STATE_HOME", base)
    assert default_state("demo") == Path(expected.replace("~", "/home/ana/.local/state/arboleda/demo"))


@pytest.mark.parametrize("said", [b"", b"soon", b"\xff", b"-5", b"1e9", b"9" * 80, b"1\n2"])
def test_an_epoch_that_nobody_can_read_is_one_sentence(tmp_path, said):
    (tmp_path / "epoch").write_bytes(said)
    with StateDir(tmp_path) as owner, pytest.raises(StartError) as refused:
        owner.next_epoch(1000)
    assert str(refused.value).startswith(
        f"{tmp_path / 'epoch'} does not say the number of the last start: delete"
    )
    assert (tmp_path / "epoch").read_bytes() == said


@pytest.mark.parametrize("said", [4102444800, 4294967295, 9999999999])
def test_an_epoch_that_no_robot_would_obey_is_refused_and_stays(tmp_path, said):
    (tmp_path / "epoch").write_text(str(said))
    with StateDir(tmp_path) as owner, pytest.raises(StartError) as refused:
        owner.next_epoch(1_795_472_781)
    sentence = str(refused.value)
    assert str(said) in sentence and "clock says 1795472781" in sentence
    assert "delete it and restart the boards" in sentence
    assert (tmp_path / "epoch").read_text() == str(said)


def test_a_clock_that_has_forgotten_the_time_is_no_obstacle(tmp_path):
    (tmp_path / "epoch").write_text("1795472781")
    with StateDir(tmp_path) as owner:
        assert owner.next_epoch(37) == 1795472782


TEN_YEARS_S, NOW = 10 * 366 * 86_400, 1_795_472_781


def test_a_start_by_a_clock_ten_years_ahead_keeps_no_later_one_from_starting(tmp_path):
    with StateDir(tmp_path) as owner:
        ahead = owner.next_epoch(NOW + TEN_YEARS_S)
        assert owner.next_epoch(NOW) == ahead + 1


def test_a_clock_ten_years_ahead_is_no_leap_that_boards_would_refuse(tmp_path):
    (tmp_path / "epoch").write_text(str(NOW))
    with StateDir(tmp_path) as owner:
        numbers = [owner.next_epoch(at) for at in (NOW + 60, NOW + TEN_YEARS_S, NOW + 120)]
    assert numbers == [NOW + 60, NOW + 61, NOW + 120]


def test_a_clock_that_is_far_too_late_is_refused(tmp_path):
    with StateDir(tmp_path) as owner, pytest.raises(StartError, match="Set the clock if it is wrong"):
        owner.next_epoch(4_200_000_000)
    assert not (tmp_path / "epoch").exists()


def test_an_epoch_that_was_cut_off_or_changed_is_refused(tmp_path):
    file = tmp_path / "epoch"
    with StateDir(tmp_path) as owner:
        assert owner.next_epoch(NOW) == NOW
        kept = file.read_bytes()
        cut = [kept[:length] for length in range(len(kept))]
        flips = [bytes([*kept[:at], kept[at] ^ 1, *kept[at + 1 :]]) for at in range(len(kept))]
        for damaged in (*cut, *flips):
            file.write_bytes(damaged)
            with pytest.raises(StartError, match="does not say the number of the last start"):
                owner.next_epoch(NOW + 60)
        file.write_bytes(kept)
        assert owner.next_epoch(NOW + 60) == NOW + 60


def test_an_epoch_that_an_editor_saved_is_read(tmp_path):
    with StateDir(tmp_path) as owner:
        last = owner.next_epoch(1_800_000_000)
    saved = tmp_path / "epoch"
    saved.write_text(saved.read_text() + "\n")
    with StateDir(tmp_path) as owner:
        assert owner.next_epoch(1_800_000_000) == last + 1


def test_an_epoch_that_is_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "epoch")
    with StateDir(tmp_path) as owner, pytest.raises(StartError, match="does not say the number"):
        owner.next_epoch(1000)


def test_the_owner_notices_that_its_lock_is_not_in_its_place(tmp_path):
    place = tmp_path / "demo"
    with StateDir(place) as owner:
        owner.confirm()
        place.rename(tmp_path / "away")
        with pytest.raises(ArboledaError) as noticed:
            owner.confirm()
        assert str(noticed.value).startswith(
            f"The state directory {place} cannot be used any more ({place / 'plant.lock'} was deleted or"
            " moved away while the plant ran)"
        )
    owner.confirm()  # who has given it back has lost nothing


@pytest.mark.skipif(not host_claim.HAS_ABSTRACT, reason="only Linux has names without files")
@pytest.mark.parametrize("ways", [("demo", "demo"), ("demo", "demo/../demo"), ("demo", "link")])
def test_a_second_owner_is_kept_out_though_the_directory_was_deleted(tmp_path, ways):
    first, second = (StateDir(tmp_path / way) for way in ways)
    (tmp_path / "link").symlink_to(tmp_path / "demo")
    with first:
        shutil.rmtree(tmp_path / "demo")
        (tmp_path / "demo").mkdir()
        with pytest.raises(StartError) as refused:
            second.open()
        assert f"still runs (process {os.getpid()}), though its files there are gone" in str(refused.value)
    with second:
        second.confirm()


@pytest.mark.skipif(not host_claim.HAS_ABSTRACT, reason="only Linux has names without files")
def test_owners_of_two_directories_do_not_meet(tmp_path):
    folders = (tmp_path / "north", tmp_path / "south")
    with StateDir(folders[0]), StateDir(folders[1]):
        for each in folders:
            with pytest.raises(StartError, match="already running"):
                StateDir(each).open()


def test_where_no_name_is_without_a_file_the_lock_alone_keeps_owners_apart(tmp_path, monkeypatch):
    monkeypatch.setattr(host_claim, "HAS_ABSTRACT", False)
    with StateDir(tmp_path), pytest.raises(StartError, match="already running"):
        StateDir(tmp_path).open()
