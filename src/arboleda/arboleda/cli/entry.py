"""The `arboleda` command, before anything else is loaded."""

from __future__ import annotations

import signal


def main() -> None:
    """Load the command line and run it; Ctrl-C while Python loads or ends ends the process without a word."""
    handler = signal.getsignal(signal.SIGINT)
    if handler is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from .main import main as run  # it takes most of a second, and starts nothing that would have to be ended

    signal.signal(signal.SIGINT, handler)
    try:
        run()
    finally:
        if handler is signal.default_int_handler:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
