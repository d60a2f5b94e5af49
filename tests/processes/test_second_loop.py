"""What is made for pages gives way to a stop."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest
from tests.patience import PATIENCE_S

from arboleda.web import second_loop
from arboleda.web.second_loop import GivingWay, StopsUnderWay


class Stops(StopsUnderWay):
    def __init__(self) -> None:
        super().__init__()
        self.met = threading.Event()

    def give_way(self) -> None:
        self.met.set()
        super().give_way()


@pytest.fixture
def stops() -> Stops:
    return Stops()


@pytest.fixture
def loop(stops: Stops) -> Iterator[GivingWay]:
    made = GivingWay(stops)
    yield made
    made.close()


@pytest.mark.parametrize("count", [1, 2])
def test_no_step_begins_before_the_last_stop_is_answered(
    stops: Stops, loop: GivingWay, monkeypatch: pytest.MonkeyPatch, count: int
) -> None:
    monkeypatch.setattr(second_loop, "PAUSE_S", PATIENCE_S)
    done: list[str] = []

    async def make_page() -> None:
        done.append("page")

    pages = threading.Thread(target=loop.run_until_complete, args=(make_page(),))
    with stops.one():
        pages.start()
        assert stops.met.wait(PATIENCE_S)
        for _ in range(count - 1):
            with stops.one():
                pass
        done.append("stop")
    pages.join(PATIENCE_S)
    assert done == ["stop", "page"]


def test_a_stop_that_has_no_answer_for_long_holds_nothing_up(
    stops: Stops, loop: GivingWay, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(second_loop, "PAUSE_S", 0.0)

    async def make_page() -> str:
        return "page"

    with stops.one():
        assert loop.run_until_complete(make_page()) == "page"
