from __future__ import annotations

from queue import SimpleQueue

import pytest

from arboleda.runtime import interrupts

pytestmark = pytest.mark.usefixtures("ctrl_c_raises")


def test_what_is_put_is_taken_in_order_up_to_none() -> None:
    queue: SimpleQueue[str | None] = SimpleQueue()
    for word in ("one", "two", None, "three"):
        queue.put(word)
    assert list(interrupts.taken_from(queue)) == ["one", "two"]
