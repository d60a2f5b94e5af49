"""Interrupts of a program: a signal ends each wait of its main thread, and raises once."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from queue import Empty, SimpleQueue
from types import FrameType
from typing import Any, TypeVar

T = TypeVar("T")
SIGNALS = (signal.SIGINT, signal.SIGTERM)

# Python runs the handler of a signal between two instructions of the main thread. A signal that comes when
# that thread is about to sleep on a lock does not wake it: its handler waits for the end of the sleep.
LOOK_S = 0.5


def until(event: threading.Event) -> None:
    """Block until the event is set."""
    while not event.wait(LOOK_S):
        heed()


def taken_from(queue: SimpleQueue[T | None]) -> Iterator[T]:
    """The items put into the queue, as they come, up to a None."""
    while True:
        try:
            taken = queue.get(timeout=LOOK_S)
        except Empty:
            heed()
            continue
        if taken is None:
            return
        yield taken


class Interrupted(KeyboardInterrupt):
    """A signal wants the program to end.

    While Python executes source text, as it does to make a dataclass, it takes a plain KeyboardInterrupt for
    one that nobody will catch: `python -m` would end with the status of a signal, however clean the end was.
    """


def raise_at_signals() -> dict[signal.Signals, Any]:
    """Raise Interrupted at SIGINT and SIGTERM from now on, once only; returns the former handlers."""
    sys.unraisablehook = _silent_about_signals(sys.unraisablehook)
    return {number: signal.signal(number, _interrupt) for number in SIGNALS}


def heed() -> None:
    """Raise Interrupted if a signal came that has ended nothing yet.

    Every wait calls it, as an exception raised while Python runs a finalizer is dropped.
    """
    if _Signals.unheeded:
        raise Interrupted


@contextmanager
def interruptible() -> Iterator[None]:
    """Raise Interrupted for SIGTERM as for Ctrl-C; a second signal does not break a clean end."""
    hook_before = sys.unraisablehook
    before = raise_at_signals()
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        sys.unraisablehook = hook_before
        _Signals.unheeded = False


@contextmanager
def until_interrupted() -> Iterator[None]:
    """Run a block that a signal ends; the waits after it go on."""
    try:
        yield
    except KeyboardInterrupt:
        _Signals.unheeded = False


class _Signals:
    """The mark that the signal handler leaves, beside the exception that it raises."""

    unheeded = False


def _silent_about_signals(tell: Callable[[Any], object]) -> Callable[[Any], None]:
    """Keep Python silent about a dropped signal, not about others: the next wait ends for the signal."""

    def tell_if_wrong(dropped: Any) -> None:
        if not issubclass(dropped.exc_type, Interrupted):
            tell(dropped)

    return tell_if_wrong


def _interrupt(number: int, frame: FrameType | None) -> None:
    for each in SIGNALS:
        signal.signal(each, signal.SIG_IGN)
    _Signals.unheeded = True
    raise Interrupted
