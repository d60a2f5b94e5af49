from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest

from arboleda.dashboard import feed as feed_module
from arboleda.dashboard import frames as frames_module
from arboleda.dashboard.feed import Feed
from arboleda.dashboard.frames import BEAT_S, BEHIND, Background
from arboleda.model.errors import ArboledaError
from arboleda.testing import Rig, shipped
from arboleda.views import view


class Side:
    """A plant behind the page, moved by hand."""

    def __init__(self) -> None:
        self.rig = Rig(shipped())
        self.rig.wait(0.5)
        self.told: Callable[[dict[str, Any]], None] = lambda snapshot: None

    def snapshot(self) -> dict[str, Any]:
        return self.rig.snapshot()

    def layout(self) -> dict[str, Any]:
        return view.layout(self.rig.plant.model)

    def links(self) -> dict[str, Any]:
        return {"broker": None, "ros": None, "refused": {}, "standbys": []}

    def past_acts(self) -> list[dict[str, Any]]:
        return []

    def watch(self, callback: Callable[[dict[str, Any]], None]) -> Callable[[], None]:
        self.told = callback
        return lambda: None


class Viewer:
    def __init__(self, language: str = "en") -> None:
        self.language = language
        self.connected = True
        self.frames: list[tuple[int, dict[str, Any]]] = []

    def show(self, number: int, patch: str) -> None:
        self.frames.append((number, json.loads(patch)))


@pytest.fixture
def side() -> Side:
    return Side()


@pytest.fixture
def feed(side: Side) -> Feed:
    made = Feed(side)  # type: ignore[arg-type]
    made.begin()
    return made


def news(side: Side, feed: Feed, text: str = "sis_a 0B 7") -> None:
    side.rig.submit(text)
    side.told(side.snapshot())
    feed.turn(0.0)


def test_a_page_is_told_everything_first_and_then_what_changed(side: Side, feed: Feed) -> None:
    viewer = Viewer()
    feed.add(viewer)
    feed.turn(0.0)
    news(side, feed)
    (_, first), (_, then) = viewer.frames
    assert "text/sis_b.state" in first and "text/sis_b.state" not in then
    assert then["text/sis_a.state"] == ["working", "execute", "PackML: execute"]


def test_nothing_new_is_not_told(feed: Feed) -> None:
    viewer = Viewer()
    feed.add(viewer)
    for _ in range(3):
        feed.turn(0.0)
    assert len(viewer.frames) == 1


def test_a_plant_at_rest_that_tells_what_is_known_is_shown_to_be_there(side: Side, feed: Feed) -> None:
    viewer = Viewer()
    feed.add(viewer)
    shown_s = []
    for tenth in range(600):
        side.told(side.snapshot())
        feed.turn(tenth / 10)
        shown_s += [tenth / 10] * (len(viewer.frames) - len(shown_s))
        feed.note_shown(viewer, len(viewer.frames))
    assert {json.dumps(patch) for _, patch in viewer.frames[1:]} == {"{}"}
    assert max(later - earlier for earlier, later in pairwise(shown_s)) == pytest.approx(BEAT_S)
    assert shown_s[-1] >= 59.0


def test_a_plant_that_hangs_is_not_shown_to_be_there(side: Side, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(feed_module, "FRAMES_HZ", 1e9)
    monkeypatch.setattr(feed_module, "BEAT_S", 0.0)
    monkeypatch.setattr(frames_module, "BEAT_S", 0.0)
    asked = 0

    def hang() -> dict[str, Any]:
        nonlocal asked
        asked += 1
        raise ArboledaError("the plant does not answer")

    async def until(holds: Callable[[], bool]) -> None:
        while not holds():
            await asyncio.sleep(0)

    async def run() -> tuple[int, int]:
        viewer, feed = Viewer(), Feed(side)  # type: ignore[arg-type]
        feed.start()
        feed.add(viewer)
        background = Background(feed.run)
        background.start()
        await until(lambda: len(viewer.frames) > 2)
        monkeypatch.setattr(side, "snapshot", hang)
        await until(lambda: asked > 0)
        before = len(viewer.frames)
        await until(lambda: asked > 3)
        await background.stop()
        feed.stop()
        return before, len(viewer.frames)

    before, after = asyncio.run(run())
    assert before == after


def test_each_page_is_told_in_its_language(side: Side, feed: Feed) -> None:
    english, spanish = Viewer(), Viewer("es")
    feed.add(english)
    feed.add(spanish)
    news(side, feed)
    assert english.frames[-1][1]["text/sis_a.state"][0] == "working"
    assert spanish.frames[-1][1]["text/sis_a.state"][0] == "trabajando"


def test_a_page_that_was_away_is_told_everything(side: Side, feed: Feed) -> None:
    viewer = Viewer()
    feed.add(viewer)
    feed.turn(0.0)
    viewer.connected = False
    news(side, feed)
    assert len(viewer.frames) == 1
    viewer.connected = True
    feed.turn(0.0)
    assert "text/sis_b.state" in viewer.frames[-1][1]


def test_a_browser_that_stops_reading_is_told_no_more_until_it_reads_again(side: Side, feed: Feed) -> None:
    slow, quick = Viewer(), Viewer()
    feed.add(slow)
    feed.add(quick)
    for number in range(BEHIND * 2):
        news(side, feed, f"sis_a 0B 7 #n{number}")
        feed.note_shown(quick, quick.frames[-1][0])
    assert len(quick.frames) == BEHIND * 2 and len(slow.frames) <= BEHIND + 2
    feed.note_shown(slow, slow.frames[-1][0])
    feed.turn(0.0)
    assert "text/sis_b.state" in slow.frames[-1][1]


def test_a_page_that_is_opened_late_is_not_behind(side: Side, feed: Feed) -> None:
    for number in range(BEHIND * 2):
        news(side, feed, f"sis_a 0B 7 #n{number}")
    viewer = Viewer()
    feed.add(viewer)
    feed.turn(0.0)
    news(side, feed)
    assert len(viewer.frames) == 2


def test_a_page_is_not_behind_after_a_time_without_news(side: Side, feed: Feed) -> None:
    viewer = Viewer()
    feed.add(viewer)
    for _ in range(BEHIND * 2):
        feed.turn(0.0)
    news(side, feed)
    news(side, feed)
    assert [number for number, _ in viewer.frames] == [1, 2, 3]


def test_a_browser_cannot_claim_to_have_seen_the_future(side: Side, feed: Feed) -> None:
    viewer = Viewer()
    feed.add(viewer)
    feed.note_shown(viewer, 10**9)
    for number in range(BEHIND * 2):
        news(side, feed, f"sis_a 0B 7 #n{number}")
    assert len(viewer.frames) <= BEHIND + 2


def test_what_happens_while_nobody_looks_is_in_the_time_line(side: Side, feed: Feed) -> None:
    news(side, feed)
    assert any(event["what"] == "running" for event in feed.events)


@pytest.mark.parametrize("turns", range(6))
def test_the_page_ends_however_soon_after_news(
    side: Side, turns: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(feed_module, "FRAMES_HZ", 1e9)

    async def run() -> int:
        feed = Feed(side)  # type: ignore[arg-type]
        feed.start()
        background = Background(feed.run)
        background.start()
        for _ in range(20):  # until it waits for news
            await asyncio.sleep(0)
        side.told(side.snapshot())
        for _ in range(turns):
            await asyncio.sleep(0)
        await background.stop()
        feed.stop()
        return len(asyncio.all_tasks())

    assert asyncio.run(run()) == 1  # this one
