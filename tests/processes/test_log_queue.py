from __future__ import annotations

import logging
import threading

import pytest

from arboleda.runtime.log_queue import LogQueue

from ..patience import PATIENCE_S
from ..unit.runtime.shelf import Clock, Shelf
from ..unit.runtime.shelf import clock as clock


def test_an_output_that_is_stuck_holds_up_nobody(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("arboleda.runtime.log_queue.WAITING", 10)
    monkeypatch.setattr("arboleda.runtime.log_queue.FLUSH_S", 0.01)
    stuck, busy, shelf = threading.Event(), threading.Event(), Shelf()

    def block(_line: logging.LogRecord) -> None:
        busy.set()
        stuck.wait()

    queue = LogQueue(block, shelf, clock=clock)
    log = logging.Logger("arboleda.test")
    log.addHandler(queue)
    log.info("the first")
    assert busy.wait(PATIENCE_S)
    done = threading.Event()
    for _ in range(15):
        log.info("more")
    queue.then(done.set)
    assert done.is_set(), "what is to be done afterwards waits for the output"
    queue.close()
    stuck.set()
    queue.close()
    assert shelf.texts == ["the first"]


def test_what_waited_for_a_stuck_output_comes_with_a_count(
    clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("arboleda.runtime.log_queue.WAITING", 10)
    go_on, busy, shelf = threading.Event(), threading.Event(), Shelf()

    def slow(_line: logging.LogRecord) -> None:
        busy.set()
        go_on.wait()

    queue = LogQueue(slow, shelf, clock=clock)
    log = logging.Logger("arboleda.test")
    log.addHandler(queue)

    def say(text: str) -> None:
        log.info(text)

    say("the first")
    assert busy.wait(PATIENCE_S)
    for number in range(15):
        say(f"more {number}")
    go_on.set()
    queue.flush()
    say("the last")
    queue.close()
    assert shelf.texts[:2] == ["the first", "more 0"] and len(shelf.lines) == 12
    assert shelf.texts[-1] == "the last (5 more lines like this one were left out)"


def test_an_output_that_logs_is_not_heard(clock: Clock) -> None:
    log = logging.Logger("arboleda.test")
    shelf = Shelf()

    def chatty(_line: logging.LogRecord) -> None:
        log.info("I was given a line")

    queue = LogQueue(chatty, shelf, clock=clock)
    log.addHandler(queue)
    log.info("a line")
    queue.close()
    assert shelf.texts == ["a line"]
