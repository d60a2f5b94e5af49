"""Waits of a program's main thread for as long as it takes, which Ctrl-C always ends."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from queue import Empty, SimpleQueue
from types import FrameType
from typing import TypeVar

T = TypeVar("T")

# Python runs the handler of a signal between two instructions of the main thread. A signal that comes when
# that thread is about to sleep on a lock does not wake it: its handler waits for the end of the sleep.
LOOK_S = 0.5


def until(event: threading.Event) -> None:
    """Block until the event is set."""
    while not event.wait(LOOK_S):
        pass


def taken_from(queue: SimpleQueue[T | None]) -> Iterator[T]:
    """What is put into the queue, as it comes, up to a None."""
    while True:
        try:
            taken = queue.get(timeout=LOOK_S)
        except Empty:
            continue
        if taken is None:
            return
        yield taken


@contextmanager
def interruptible() -> Iterator[None]:
    """SIGTERM is a KeyboardInterrupt like Ctrl-C; a second signal does not break a clean end."""

    def interrupt(number: int, frame: FrameType | None) -> None:
        for each in before:
            signal.signal(each, signal.SIG_IGN)
        raise KeyboardInterrupt

    before = {number: signal.signal(number, interrupt) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
