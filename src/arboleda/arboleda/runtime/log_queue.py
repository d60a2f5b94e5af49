"""Queue of log lines on their way out: no caller waits for a terminal, a file or a network."""

from __future__ import annotations

import copy
import logging
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from queue import Empty, Full, Queue

from arboleda.model.outside import plain

OURS = "arboleda"
RATE = (100, 5.0)  # lines of one place in the program: at once, and each second after that
RATES = {"arboleda.tasks": (2000, 100.0)}  # what a large plant does; by the name of the logger
WAITING = 10_000  # lines that an output may be behind
LONGEST = 2_000  # letters of a line; the rest is cut off
FLUSH_S = 1.0

Output = Callable[[logging.LogRecord], object]  # it gets lines that are ready to be put out, in one thread
Place = tuple[str, int, str]  # file and line number of the call that logs, and the name of its logger

_traceback = logging.Formatter()


class LogQueue(logging.Handler):
    """Hands each line to `outputs`, in the order of the lines, in a thread of its own.

    A line is left out where its place in the program logs more than the RATE allows, or where the outputs are
    WAITING lines behind; the next line of that place says how many were.
    What an output logs itself is left out too, since it would come back to that output.
    Control characters are escaped, so that text from outside makes no lines and moves no cursor.
    """

    def __init__(self, *outputs: Output, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__(logging.DEBUG)
        self._outputs = outputs
        self._rate = LineRate(clock)
        self._left_out: Counter[Place] = Counter()
        self._queue: Queue[Callable[[], None] | None] = Queue(WAITING)
        self._thread = threading.Thread(target=self._work, name="log", daemon=True)
        self._thread.start()

    def emit(self, record: logging.LogRecord) -> None:
        """Never blocks; logging calls it one thread at a time."""
        if threading.current_thread() is self._thread:
            return
        place = (record.pathname, record.lineno, record.name)
        try:
            if self._rate.allows(place):
                line = _ready(record, self._left_out[place])
                self._queue.put_nowait(partial(self._put_out, line))
                del self._left_out[place]
            else:
                self._left_out[place] += 1
        except Full:
            self._left_out[place] += 1
        except Exception:  # noqa: BLE001 - whoever logs a line that cannot be formatted must not fail for it
            self.handleError(record)

    def add(self, output: Output) -> None:
        """Add an output for lines that are logged from now on."""
        self._outputs = (*self._outputs, output)

    def then(self, job: Callable[[], None]) -> None:
        """Call `job` once everything logged so far is out; at once if an output is stuck."""
        try:
            self._queue.put_nowait(job)
        except Full:
            job()

    def flush(self) -> None:
        """Wait until everything logged is out, at most FLUSH_S."""
        out = threading.Event()
        with suppress(Full):
            self._queue.put(out.set, timeout=FLUSH_S)
            out.wait(FLUSH_S if self._thread.is_alive() else 0.0)

    def close(self) -> None:
        """Put out the remaining lines; if an output is stuck, give up after FLUSH_S."""
        if self._thread.is_alive():
            self.flush()
            _empty(self._queue)
            self._queue.put(None)
            self._thread.join(FLUSH_S)
        super().close()

    def _work(self) -> None:
        for job in iter(self._queue.get, None):
            job()

    def _put_out(self, line: logging.LogRecord) -> None:
        for output in self._outputs:
            try:
                output(line)
            except Exception as error:  # noqa: BLE001 - one broken output must not silence the others
                self._give_up(output, error)

    def _give_up(self, broken: Output, error: Exception) -> None:
        self._outputs = tuple(each for each in self._outputs if each is not broken)
        what = getattr(broken, "__qualname__", type(broken).__qualname__)
        text = f"{what} cannot put out log lines and gets no more of them: {error!r}"
        where = ("", 0, text, (), None)
        self._put_out(logging.LogRecord(__name__, logging.ERROR, *where))


class LineRate:
    """LineRate: limits the lines of each place by a bucket of as many as its rate allows at once."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._room: dict[
            Place, tuple[float, float]
        ] = {}  # how many lines it may still log, and when that was

    def allows(self, place: Place) -> bool:
        """Count a line of this place; False where it is one too many."""
        now = self._clock()
        at_once, per_s = RATES.get(place[2], RATE)
        room, at = self._room.get(place, (float(at_once), now))
        room = min(room + (now - at) * per_s, float(at_once))
        allowed = room >= 1.0
        self._room[place] = (room - 1.0 if allowed else room, now)
        return allowed


@contextmanager
def log_to(*outputs: Output) -> Iterator[LogQueue]:
    """Put out every line of Arboleda meanwhile, and the warnings of libraries."""
    root, ours = logging.getLogger(), logging.getLogger(OURS)
    queue, before = LogQueue(*outputs), ours.level
    ours.setLevel(logging.DEBUG)
    root.addHandler(queue)
    try:
        yield queue
    finally:
        root.removeHandler(queue)
        ours.setLevel(before)
        queue.close()


def _ready(record: logging.LogRecord, left_out: int) -> logging.LogRecord:
    """A copy of a record that holds its text, and its traceback as text of its own."""
    line = copy.copy(record)
    text = plain(record.getMessage(), LONGEST)
    line.msg = f"{text} ({left_out} more lines like this one were left out)" if left_out else text
    line.args = None
    if record.exc_info:
        line.exc_text = _indented(record.exc_text or _traceback.formatException(record.exc_info))
    line.exc_info = None
    return line


def _indented(traceback: str) -> str:
    """The lines of a text, indented so that they do not look like lines of the log."""
    return "\n".join(f"  {plain(line, LONGEST)}" for line in traceback.splitlines())


def _empty(queue: Queue[Callable[[], None] | None]) -> None:
    with suppress(Empty):
        while True:
            queue.get_nowait()
