"""Time in which modules are loaded, and Ctrl-C meanwhile."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from arboleda.host.garbage import none_collected

from .working import working


@contextmanager
def loading() -> Iterator[None]:
    """Time in which modules are loaded: nothing has begun that Ctrl-C would have to end in order, and there
    is no garbage."""
    with working(), none_collected(), _ended_by_interrupt():
        yield


@contextmanager
def _ended_by_interrupt() -> Iterator[None]:
    handler = signal.getsignal(signal.SIGINT)
    in_main = threading.current_thread() is threading.main_thread()
    if handler is not signal.default_int_handler or not in_main:
        yield
        return
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
