"""What stands in where an operating system lacks something: tried here by taking it away."""

from __future__ import annotations

import signal
import subprocess
import sys

from arboleda.host import signals


def test_a_process_ends_with_its_group() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", "input()"], stdin=subprocess.PIPE, start_new_session=True
    ) as run:
        signals.kill_group(run.pid)
        assert run.wait() == -signal.SIGKILL
    signals.kill_group(run.pid)
