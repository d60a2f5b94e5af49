from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path

import pytest

from arboleda.runtime import interrupts

from ..patience import PATIENCE_S

pytestmark = pytest.mark.usefixtures("ctrl_c_raises")


def test_an_event_that_is_set_ends_the_wait() -> None:
    event = threading.Event()
    setter = threading.Thread(target=event.set)
    setter.start()
    interrupts.until(event)
    assert event.is_set()
    setter.join()


PROGRAM = """
from contextlib import suppress
from arboleda.runtime.interrupts import interruptible

with suppress(KeyboardInterrupt), interruptible():
    exec("import signal; signal.raise_signal(signal.{name}); print('not ended')")
"""


def test_a_signal_while_a_class_is_made_from_a_text_leaves_a_clean_end(tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text(PROGRAM.format(name="SIGTERM"))
    ran = subprocess.run(
        [sys.executable, "-m", "program"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "", "")


DROPPED = """
import signal, threading
from arboleda.runtime import interrupts
from arboleda.runtime.interrupts import interruptible, until, until_interrupted

interrupts.LOOK_S = 0.01

class Last:
    def __del__(self):
        signal.raise_signal(signal.{name})

class Broken:
    def __del__(self):
        raise OSError("no signal")

with interruptible():
    with until_interrupted():
        Broken()
        Last()
        until(threading.Event())
    over = threading.Event()
    threading.Timer(0.2, over.set).start()
    until(over)
    print("a clean end")
"""


def test_a_signal_that_comes_in_a_finalizer_ends_the_next_wait_and_no_later_one() -> None:
    """Python drops what is raised there, and tells of it only where something went wrong."""
    ran = subprocess.run(
        [sys.executable, "-c", DROPPED.format(name="SIGINT")],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
    )
    assert (ran.returncode, ran.stdout) == (0, "a clean end\n")
    assert ran.stderr.count("Exception ignored") == ran.stderr.count("OSError: no signal") == 1
