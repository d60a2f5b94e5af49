"""A piece of a package that takes long is named meanwhile, one that does not end is left."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import EntryPoint
from typing import Any

import pytest
from tests.patience import PATIENCE_S

from arboleda.host import pieces
from arboleda.host.pieces import Piece, Pieces
from arboleda.host.timer import called_after
from arboleda.runtime import part_list
from arboleda.runtime.part_list import PartList
from arboleda.runtime.registry import Factory, Phase

PIECE = Piece(what="the part Shelf", of="acme 1", package="acme")
SLOW = "Arboleda has waited for the part Shelf of acme 1 for more than 0.01 s"
POINT = EntryPoint("acme", "acme:PARTS", "arboleda.parts")


class Shelf:
    """A part whose end is given."""

    def __init__(self, stop: Callable[[], object]) -> None:
        self._stop = stop
        self.stopped = False

    def start(self) -> None: ...

    def stop(self) -> None:
        self._stop()
        self.stopped = True


def for_ever() -> None:
    threading.Event().wait(PATIENCE_S)
    pytest.fail("nobody left it")


def here(work: Callable[[], None]) -> None:
    work()


def in_a_worker(work: Callable[[], None]) -> None:
    with ThreadPoolExecutor(1) as pool:
        pool.submit(work).result(PATIENCE_S)


@pytest.mark.parametrize("run", [here, in_a_worker])
def test_what_takes_long_is_named_while_it_does(
    monkeypatch: pytest.MonkeyPatch, run: Callable[[Callable[[], None]], None]
) -> None:
    monkeypatch.setattr(pieces, "SLOW_S", 0.01)
    named, told = threading.Event(), list[str]()

    def tell(line: str) -> None:
        told.append(line)
        named.set()

    def work() -> None:
        with Pieces(tell=tell).calling(PIECE):
            assert named.wait(PATIENCE_S), "nobody named it"

    run(work)
    assert told == [SLOW]


def test_a_part_that_does_not_end_is_left_and_named_and_the_others_end(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(pieces, "ENDS_S", 0.01)
    parts = [Shelf(int), Shelf(for_ever), Shelf(int)]
    factory = Factory(phase=Phase.VIEWS, make=lambda _: parts)
    monkeypatch.setattr(part_list, "packaged", lambda _: [(POINT, factory)])
    nothing: Any = None
    made = PartList()
    made.make(nothing, [])
    made.start()
    made.stop()
    assert [each.stopped for each in parts] == [True, False, True]
    assert made.notes == ["Arboleda goes on without the part Shelf of acme: it does not end within 0.01 s"]


def test_one_time_may_be_within_another() -> None:
    inner, outer = threading.Event(), threading.Event()
    with called_after(0.02, outer.set):
        with called_after(0.01, inner.set):
            assert inner.wait(PATIENCE_S)
        with called_after(PATIENCE_S, pytest.fail):
            assert outer.wait(PATIENCE_S / 2)


LEFT = """
import sys, threading
from arboleda.host import last_threads

threading.Thread(target=threading.Event().wait, name="shelf").start()
last_threads.ENDS_S = 0.1
last_threads.leave({status!r})
sys.exit({status!r})
"""


@pytest.mark.parametrize(("status", "code"), [(0, 0), (3, 3), (None, 0)])
def test_a_thread_that_does_not_end_does_not_keep_the_process(status: int | None, code: int) -> None:
    ended = subprocess.run(
        [sys.executable, "-c", LEFT.format(status=status)], capture_output=True, text=True, timeout=PATIENCE_S
    )
    assert ended.returncode == code
    assert ended.stderr == "the process ends without its thread shelf, which does not end\n"


WORKER = """
import asyncio, sys, threading
from concurrent.futures import ThreadPoolExecutor
from arboleda.host import last_threads

hangs = threading.Event()


def hang():
    hangs.set()
    threading.Event().wait()


def routes():
    {begin}


threading.Thread(target=routes, daemon=True).start()
hangs.wait()
last_threads.ENDS_S = 0.1
last_threads.leave(0)
"""


@pytest.mark.parametrize(
    ("begin", "name"),
    [
        ("asyncio.run(asyncio.to_thread(hang))", "asyncio_0"),
        ("ThreadPoolExecutor().submit(hang).result()", "ThreadPoolExecutor-0_0"),
    ],
)
def test_a_worker_that_hangs_does_not_keep_the_process(begin: str, name: str) -> None:
    ended = subprocess.run(
        [sys.executable, "-c", WORKER.format(begin=begin)], capture_output=True, text=True, timeout=PATIENCE_S
    )
    assert ended.returncode == 0
    assert ended.stderr == f"the process ends without its thread {name}, which does not end\n"
