"""A signal ends a wait of the main thread, which is really asleep when it comes."""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Callable
from queue import SimpleQueue

import pytest

from arboleda.runtime import interrupts

pytestmark = [pytest.mark.system, pytest.mark.usefixtures("ctrl_c_raises")]
WAITS: dict[str, Callable[[], object]] = {
    "for an event": lambda: interrupts.until(threading.Event()),
    "for a queue": lambda: list(interrupts.taken_from(SimpleQueue())),
}


def test_a_signal_that_does_not_wake_the_main_thread_ends_its_wait() -> None:
    """Another thread takes the signal: the main thread's sleep goes on, as when it came just before that."""
    for what, wait in WAITS.items():
        sender = threading.Thread(target=_signal_once_asleep, args=(threading.get_ident(),))
        sender.start()
        with pytest.raises(KeyboardInterrupt):
            pytest.fail(f"a wait {what} has ended with {wait()!r}")
        sender.join()


def _signal_once_asleep(main: int) -> None:
    here = None
    while here is None or here != _place(main):
        here = _place(main)
        time.sleep(0.01)
    signal.pthread_kill(threading.get_ident(), signal.SIGINT)


def _place(thread: int) -> tuple[str, int] | None:
    """Where the thread is in one of the waits; None before it has come there."""
    frame = innermost = sys._current_frames()[thread]
    while frame is not None and frame.f_code.co_filename != interrupts.__file__:
        frame = frame.f_back
    return None if frame is None else (innermost.f_code.co_name, innermost.f_lineno)
