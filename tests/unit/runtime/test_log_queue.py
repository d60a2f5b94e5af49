from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from pathlib import Path
from queue import Queue

import pytest
from tests.threads import AtTheEnd, stand_in

from arboleda.runtime import log_queue
from arboleda.runtime.log_file import LogFile
from arboleda.runtime.log_queue import LONGEST, RATE, RATES, LogQueue, log_to

from .shelf import Clock, Shelf
from .shelf import clock as clock

LOG = logging.getLogger("arboleda.test")


class Prompt(Queue):
    """A queue whose jobs are done as they come, by who brings them."""

    def put_nowait(self, job: Callable[[], None]) -> None:
        job()

    def put(self, job: Callable[[], None], block: bool = True, timeout: float | None = None) -> None:
        job()


@pytest.fixture(autouse=True)
def no_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(log_queue, AtTheEnd, monkeypatch)
    monkeypatch.setattr(log_queue, "Queue", Prompt)


@pytest.fixture
def shelf() -> Shelf:
    return Shelf()


@pytest.fixture
def queue(shelf: Shelf, clock: Clock) -> Iterator[LogQueue]:
    made = LogQueue(shelf, clock=clock)
    root = logging.getLogger()
    root.addHandler(made)
    LOG.setLevel(logging.DEBUG)
    yield made
    root.removeHandler(made)
    made.close()


def test_lines_come_out_in_their_order(queue: LogQueue, shelf: Shelf) -> None:
    for number in range(50):
        LOG.info("line %d", number)
    queue.flush()
    assert shelf.texts == [f"line {number}" for number in range(50)]


def test_a_flood_is_cut_and_counted(queue: LogQueue, shelf: Shelf, clock: Clock) -> None:
    def shout(times: int) -> None:
        for _ in range(times):
            LOG.warning("what %s", "now")

    at_once, per_s = RATE
    shout(at_once + 700)
    clock.now += 1 / per_s
    shout(1)
    LOG.warning("another place")
    queue.flush()
    assert len(shelf.lines) == at_once + 2
    assert shelf.texts[-2:] == ["what now (700 more lines like this one were left out)", "another place"]


def test_a_large_plant_may_say_more_of_its_tasks(queue: LogQueue, shelf: Shelf) -> None:
    tasks = logging.getLogger("arboleda.tasks")
    tasks.setLevel(logging.DEBUG)
    many = RATES["arboleda.tasks"][0]
    for number in range(many + 1):
        tasks.info("task %d", number)
    queue.flush()
    assert len(shelf.lines) == many > RATE[0]


def test_an_output_that_fails_is_said_and_given_up(clock: Clock) -> None:
    shelf, calls = Shelf(), []

    def broken(line: logging.LogRecord) -> None:
        calls.append(line)
        raise BrokenPipeError("nobody reads")

    log = logging.Logger("arboleda.test")
    queue = LogQueue(broken, shelf, clock=clock)
    log.addHandler(queue)
    log.info("one")
    log.info("two")
    queue.close()
    assert len(calls) == 1 and shelf.texts[-1] == "two" and "one" in shelf.texts
    assert any("cannot put out log lines" in text and "nobody reads" in text for text in shelf.texts)


def test_text_from_outside_is_one_line_that_moves_no_cursor(queue: LogQueue, shelf: Shelf) -> None:
    LOG.warning("%s", "a\nb\x1b[2J\u202ec¡ñ")
    logging.getLogger("nicegui").error("x" * 100_000)  # what a browser has it log
    queue.flush()
    assert shelf.texts[0] == "a\\nb\\x1b[2J\\u202ec¡ñ"
    assert len(shelf.texts[1]) == LONGEST


def test_a_traceback_forges_no_line_of_the_log(queue: LogQueue, shelf: Shelf) -> None:
    try:
        raise RuntimeError("boom\n2026-01-01 00:00:00 INFO arboleda: all is well \x1b[2J")
    except RuntimeError:
        LOG.exception("it failed")
    queue.flush()
    written = shelf.lines[-1].exc_text or ""
    assert all(line.startswith("  ") for line in written.splitlines())
    assert "\x1b" not in written


def test_a_traceback_is_kept_apart_from_the_sentence(queue: LogQueue, shelf: Shelf) -> None:
    try:
        raise RuntimeError("boom")
    except RuntimeError:
        LOG.exception("it failed")
    queue.flush()
    (line,) = shelf.lines
    assert line.getMessage() == "it failed" and line.exc_info is None
    assert line.exc_text is not None and "RuntimeError: boom" in line.exc_text


@pytest.fixture
def file(tmp_path: Path) -> Callable[[Path], tuple[LogFile, list[str]]]:
    def make(path: Path) -> tuple[LogFile, list[str]]:
        told: list[str] = []
        return LogFile(path, told.append), told

    return make


def test_the_file_has_time_level_and_traceback(
    file: Callable[..., tuple[LogFile, list[str]]], tmp_path: Path
) -> None:
    details, told = file(tmp_path / "state" / "arboleda.log")
    with log_to(details.handle):
        LOG.info("a line")
        try:
            raise RuntimeError("boom")
        except RuntimeError:
            LOG.exception("it failed")
    details.close()
    first, *rest = (tmp_path / "state" / "arboleda.log").read_text().splitlines()
    date, _, level, name, text = first.split(" ", 4)
    assert (level, name, text) == ("INFO", "arboleda.test:", "a line") and date.count("-") == 2
    assert "  RuntimeError: boom" in rest and not told


def test_a_file_that_cannot_be_written_is_said_once(
    file: Callable[..., tuple[LogFile, list[str]]], tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "taken").write_text("a file where a folder should be")
    details, told = file(tmp_path / "taken" / "arboleda.log")
    with log_to(details.handle):
        LOG.info("one")
        LOG.info("two")
    (sentence,) = told
    assert sentence.startswith(f"the log file {tmp_path}/taken/arboleda.log cannot be written: ")
    assert "Traceback" not in capfd.readouterr().err
