"""Log file of a process: details for a person who has to look, tracebacks among them."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable
from contextlib import suppress
from logging.handlers import RotatingFileHandler
from pathlib import Path

FORMAT = "%(asctime)s %(levelname)s %(name)s: %(message)s"
LOG_BYTES = 1_000_000  # the file before this one is kept as well


class LogFile(RotatingFileHandler):
    """LogFile: grows to twice LOG_BYTES; if it cannot be written, `tell` gets a sentence, work goes on."""

    def __init__(self, file: Path, tell: Callable[[str], None]) -> None:
        with suppress(OSError):  # whatever is in the way, the first line finds it there and says it
            file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        super().__init__(file, maxBytes=LOG_BYTES, backupCount=1, encoding="utf-8", delay=True)
        self.setFormatter(logging.Formatter(FORMAT))
        self._tell = tell
        self._failed = False

    def handleError(self, record: logging.LogRecord) -> None:
        """Report that a line could not be written; `logging` calls this."""
        error = sys.exc_info()[1]
        if not self._failed:
            self._failed = True
            self._tell(f"the log file {self.baseFilename} cannot be written: {error}")
