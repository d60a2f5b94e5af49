"""The `arboleda` command, before anything else is loaded."""

from __future__ import annotations

import signal

from .loading import loading


def main() -> None:
    """Load the command line and run it; Ctrl-C while Python loads or ends ends the process without a word."""
    handler = signal.getsignal(signal.SIGINT)
    with loading():
        from .main import main as run

    try:
        run()
    finally:
        if handler is signal.default_int_handler:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
