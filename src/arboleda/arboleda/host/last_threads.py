"""Threads that a package has left running: the process ends without them."""

from __future__ import annotations

import os
import sys
import threading
import time

ENDS_S = 3.0  # for threads that are about to end
LEFT = "the process ends without its thread {name}, which does not end\n"
WORKERS = ("asyncio_", "ThreadPoolExecutor-")  # daemons of executors, which Python joins all the same


def leave(status: object) -> None:
    """Have the process end with this status after ENDS_S, whichever threads Python would wait for.

    Call it last of all. It takes a thread, which ends with Python, and no signal: Python takes the handlers
    of signals away before it has ended.
    """
    code = status if isinstance(status, int) else int(status is not None)
    threading.Thread(target=_end, args=(code,), name="end", daemon=True).start()


def _end(code: int) -> None:
    time.sleep(ENDS_S)
    left = [each for each in threading.enumerate() if _is_waited_for(each)]
    if not left:
        return  # Python itself is about to end
    sys.stderr.write("".join(LEFT.format(name=each.name) for each in left))
    sys.stderr.flush()
    sys.stdout.flush()
    os._exit(code)


def _is_waited_for(thread: threading.Thread) -> bool:
    """True if Python waits for its end before the process ends."""
    return thread is not threading.main_thread() and (not thread.daemon or thread.name.startswith(WORKERS))
