"""Timer of the process: calls a function in the middle of the work of the main thread."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def called_after(seconds: float, act: Callable[[], None]) -> Iterator[None]:
    """Time after whose first `seconds` a function is called once, unless it is over by then.

    Only in the main thread, and not on Windows. It takes no thread, as what runs meanwhile may fork.
    """
    if threading.current_thread() is not threading.main_thread() or not hasattr(signal, "setitimer"):
        yield
        return
    before = signal.signal(signal.SIGALRM, lambda *_: act())
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
