"""Timer of the process: calls a function in the middle of the main thread's work, or beside another's."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

LEAST_S = 0.001  # a timer of 0 is off


@dataclass(frozen=True, kw_only=True, eq=False)
class _Call:
    at_s: float
    act: Callable[[], None]


_waiting: list[_Call] = []


@contextmanager
def called_after(seconds: float, act: Callable[[], None]) -> Iterator[None]:
    """Time after whose first `seconds` a function is called once, unless it is over by then.

    One may be within another. What the function raises is raised from the work. Only in the main thread, and
    not on Windows. It takes no thread, as what runs meanwhile may fork.
    """
    if not _can_interrupt():
        yield
        return
    call = _Call(at_s=time.monotonic() + seconds, act=act)
    before = signal.signal(signal.SIGALRM, _call)
    _waiting.append(call)
    _set()
    try:
        yield
    finally:
        if call in _waiting:
            _waiting.remove(call)
        _set()
        signal.signal(signal.SIGALRM, before)


@contextmanager
def told_after(seconds: float, tell: Callable[[], None]) -> Iterator[None]:
    """Time after whose first `seconds` a function is called once, unless it is over by then; in any thread.

    Where the work cannot be interrupted, a thread of its own calls the function meanwhile.
    """
    if _can_interrupt():
        with called_after(seconds, tell):
            yield
        return
    beside = threading.Timer(seconds, tell)
    beside.daemon = True
    beside.start()
    try:
        yield
    finally:
        beside.cancel()


def _can_interrupt() -> bool:
    return threading.current_thread() is threading.main_thread() and hasattr(signal, "setitimer")


def _call(*_: object) -> None:
    """Call what is due, the first first."""
    try:
        for each in sorted(_waiting, key=lambda each: each.at_s):
            if each.at_s <= time.monotonic():
                _waiting.remove(each)
                each.act()
    finally:
        _set()


def _set() -> None:
    """Set the timer of the process for the first call."""
    first_s = min((each.at_s for each in _waiting), default=None)
    left_s = 0.0 if first_s is None else max(first_s - time.monotonic(), LEAST_S)
    signal.setitimer(signal.ITIMER_REAL, left_s)
