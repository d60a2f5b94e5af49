"""The `arboleda` command, before anything else is loaded."""

from __future__ import annotations

import signal

from arboleda.host.last_threads import leave

from .loading import loading


def main() -> None:
    """Load the command line and run it; Ctrl-C while Python loads or ends ends the process without a word.

    A thread that a package leaves running does not keep the process.
    """
    handler = signal.getsignal(signal.SIGINT)
    with loading():
        from .main import main as run

    status: object = 1
    try:
        run()
        status = 0
    except SystemExit as ended:
        status = ended.code
        raise
    finally:
        leave(status)
        if handler is signal.default_int_handler:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
