"""Fork of this process: what it does stays in it, and its end is seen."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from arboleda.host.forks import Fork, can_fork

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="forks are for Linux")
FORKED = """
import sys
from arboleda.host.forks import Fork, can_fork

print("seen", can_fork(), flush=True)
with Fork(lambda: print("never seen", sys.stdin.read(), flush=True)) as fork:
    print("status", fork.wait())
"""


def test_a_fork_neither_reads_nor_writes_what_this_process_does() -> None:
    command = [sys.executable, "-c", FORKED]
    run = subprocess.run(command, input="more", capture_output=True, text=True, check=True)
    assert run.stdout == "seen True\nstatus 0\n"


def _end_hard() -> None:
    os.kill(os.getpid(), signal.SIGTERM)


def _raise() -> None:
    raise KeyboardInterrupt


@pytest.mark.parametrize(
    ("work", "status"),
    [(int, 0), (_raise, 1), (lambda: os._exit(7), 7), (_end_hard, -signal.SIGTERM)],
    ids=["ends", "raises", "exits", "is ended"],
)
def test_the_end_of_a_fork_is_told_as_that_of_another_process(work: object, status: int) -> None:
    assert callable(work)
    with Fork(work) as fork:
        assert fork.wait(60.0) == status
        fork.kill()  # has ended: nothing to do


def test_what_a_fork_changes_stays_in_it(tmp_path: Path) -> None:
    changed: list[str] = []

    def change() -> None:
        changed.append("here")
        (tmp_path / "written").write_text(changed[0])

    with Fork(change) as fork:
        assert fork.wait(60.0) == 0
    assert (tmp_path / "written").read_text() == "here"
    assert changed == []


def test_a_fork_that_does_not_end_is_waited_for_as_long_as_wanted_and_then_killed() -> None:
    with Fork(signal.pause) as fork:
        with pytest.raises(subprocess.TimeoutExpired):
            fork.wait(0.0)
        fork.kill()
        assert fork.wait(60.0) == -signal.SIGKILL


def test_beside_another_thread_there_is_no_fork() -> None:
    ends = threading.Event()
    other = threading.Thread(target=ends.wait)
    other.start()
    try:
        assert not can_fork()
    finally:
        ends.set()
        other.join()
