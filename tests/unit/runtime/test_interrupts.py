from __future__ import annotations

import signal
from collections.abc import Iterator
from queue import SimpleQueue

import pytest

from arboleda.runtime import interrupts


@pytest.fixture(autouse=True)
def ctrl_c_raises() -> Iterator[None]:
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_what_is_put_is_taken_in_order_up_to_none() -> None:
    queue: SimpleQueue[str | None] = SimpleQueue()
    for word in ("one", "two", None, "three"):
        queue.put(word)
    assert list(interrupts.taken_from(queue)) == ["one", "two"]
