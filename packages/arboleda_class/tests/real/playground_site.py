"""A playground that is made once in a run of tests, and served as files alone."""

from __future__ import annotations

import fcntl
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.scripts import load
from tests.workers import shared_between_workers

ROOT = Path(__file__).parents[4]
BELOW = "some/where"


def make_site(folder: Path) -> None:
    """Make a playground below this folder, which is there only once all of it is."""
    unfinished = folder.with_suffix(".unfinished")
    made = [sys.executable, str(ROOT / "scripts/playground"), str(unfinished / BELOW)]
    done = subprocess.run(made, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    unfinished.rename(folder)


@pytest.fixture(scope="session")
def playground(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a playground that was made in this run, below a folder of its server."""
    if not load("playground").is_fetched():
        pytest.skip("what the playground is made of is not there: make test-tools")
    folder = shared_between_workers(tmp_path_factory) / "served"
    with folder.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not folder.exists():
            make_site(folder)
    # In a process of its own: a browser keeps connections open beyond the test that made them.
    command = [
        sys.executable,
        "-u",
        "-m",
        "http.server",
        "0",
        "--bind",
        "127.0.0.1",
        "--directory",
        str(folder),
    ]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        assert server.stdout is not None
        port = server.stdout.readline().split()[5]  # Serving HTTP on 127.0.0.1 port 41371 (...)
        yield f"http://127.0.0.1:{port}/{BELOW}/"
        server.terminate()
