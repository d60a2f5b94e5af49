"""The state directory has one owner."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from arboleda.runtime import state
from arboleda.runtime.state import StateDir, find_running


@pytest.fixture(autouse=True)
def _no_pause(monkeypatch):
    monkeypatch.setattr(state, "LOCK_PAUSE_S", 0)


def test_what_a_killed_plant_left_behind_is_no_plant(tmp_path):
    leave = f"""
import os
from pathlib import Path
from arboleda.runtime.state import StateDir
state = StateDir(Path({str(tmp_path)!r}))
state.open()
state.announce(4321)
os._exit(1)
"""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    assert subprocess.run([sys.executable, "-c", leave], env=environment, check=False).returncode == 1

    assert (tmp_path / "plant.json").exists()
    assert find_running(tmp_path) is None
    with StateDir(tmp_path):
        assert find_running(tmp_path).pid == os.getpid()
        assert find_running(tmp_path).port is None


FULL = """
import resource, signal, sys
from pathlib import Path
from arboleda.runtime.state import StateDir
from arboleda.model.errors import ArboledaError, StartError
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
room = int(sys.argv[2])
state = StateDir(Path(sys.argv[1]))
resource.setrlimit(resource.RLIMIT_FSIZE, (room, room))
try:
    state.open()
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, room))
    state.next_epoch(5)
except StartError as error:
    print(error)
"""


def test_a_full_disk_at_the_start_is_one_sentence(tmp_path):
    """The limit for the size of files stands for it: nothing can be written."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", FULL, str(tmp_path), "4096"]
    ended = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert ended.stdout.startswith(
        f"The state directory {tmp_path} cannot be used: File too large; make room"
    )
    assert ended.stderr == ""
    assert [file.name for file in tmp_path.iterdir()] == ["plant.lock"]
    with StateDir(tmp_path):
        pass
