"""One browser on a record: which moment it is shown, whatever it asks for."""

from __future__ import annotations

import asyncio
import json
from types import SimpleNamespace
from typing import Any

import pytest
from tests.threads import run_here

from arboleda.dashboard.wording import words
from arboleda.recorder.errors import NoRecord
from arboleda_proofs.past.frame_queue import FrameQueue
from arboleda_proofs.past.side import Shown, Start
from arboleda_proofs.past.visitor import Arrival, Visitor

STARTS = [
    Start(epoch=9, began=0, is_own=False, is_same=False),
    Start(epoch=8, began=0, is_own=True, is_same=True),
    Start(epoch=7, began=0, is_own=False, is_same=True),
]


class FakePast:
    """A record from 0 to 100 with events at 10, 20 and 30, of which the second is a failure of sis_b."""

    began, ended = 0, 100

    def __init__(self) -> None:
        self.made: list[int] = []

    def within(self, moment: int) -> int:
        return min(max(moment, 0), 100)

    def marks(self) -> list[int]:
        return [20]

    def step(self, moment: int, *, way: int, failures: bool, cell: str | None = None) -> int | None:
        found = [at for at in ((20,) if failures else (10, 20, 30)) if (at - moment) * way > 0]
        return min(found, key=lambda at: abs(at - moment)) if found and cell in (None, "sis_b") else None

    def last_failure(self, cell: str | None = None) -> int | None:
        return 20 if cell in (None, "sis_b") else None

    def end_of(self, id: str) -> int | None:
        return {"lot": 30}.get(id)

    def face(self, moment: int, language: str, id: str | None = None) -> dict[str, Any]:
        self.made.append(moment)
        return {"text/moment": [str(moment), language], "text/task": [id or "", ""]}


class Client:
    def __init__(self) -> None:
        self.frames: list[dict[str, Any]] = []
        self.said: list[str] = []

    def run_javascript(self, code: str) -> None:
        what, _, told = code.partition("(")
        if what == "arboleda.live":
            self.frames.append(json.loads(f"[{told[:-1]}]")[1])
        else:
            self.said.append(json.loads(f"[{told[:-1]}]")[0])


@pytest.fixture(autouse=True)
def read_here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Records are read without a thread."""
    monkeypatch.setattr(asyncio, "to_thread", run_here)


class Page:
    """A visitor who came; `hear` as the browser would say it."""

    def __init__(self, **arrival: Any) -> None:
        self.past, self.client = FakePast(), Client()
        side: Any = SimpleNamespace(past=lambda epoch: self.past, starts=lambda: STARTS)
        self.visitor = Visitor(self.client, Shown(side), FrameQueue(), words("en"), Arrival(**arrival))  # type: ignore[arg-type]
        asyncio.run(self.visitor.come())

    def hear(self, *what: Any) -> None:
        asyncio.run(self.visitor.hear(SimpleNamespace(args=list(what))))  # type: ignore[arg-type]

    @property
    def at(self) -> int:
        return int(self.client.frames[-1]["past/at"])


def test_a_page_opens_where_its_address_leads() -> None:
    assert Page(moment=55).at == 55
    assert Page(moment=5_000).at == 100
    assert Page(cell="sis_b").at == 20
    assert Page(task="lot", at_its_end=True).at == 30
    assert Page(task="lot", moment=12).at == 12


def test_where_there_is_no_failure_it_opens_at_the_end_and_says_so() -> None:
    page = Page(cell="sis_a")
    assert page.at == 100 and "no failure" in page.client.said[0]
    assert "no such task" in Page(task="none", at_its_end=True).client.said[0]


def test_steps_lead_on_and_the_last_one_is_said() -> None:
    page = Page(moment=10)
    page.hear("step", 1, "")
    assert page.at == 20
    page.hear("failure", 1, "")
    assert page.at == 20 and page.client.said == ["There is no failure after that."]
    page.hear("failure", -1, "sis_a")
    assert page.client.said[1:] == ["There is no failure before."]


def test_a_frame_has_what_changed() -> None:
    page = Page(moment=10)
    page.hear("go", 11)
    assert page.client.frames[-1] == {"text/moment": ["11", "en"], "past/at": 11}
    page.hear("task", "lot")
    assert page.client.frames[-1] == {"text/task": ["lot", ""], "past/at": 11}


def test_who_comes_back_is_told_everything() -> None:
    page = Page(moment=10)
    page.hear("go", 42)
    asyncio.run(page.visitor.come())
    assert page.client.frames[-1]["past/span"] == [0, 100, [20]] and page.at == 42


def test_of_moments_that_come_faster_than_frames_the_last_is_shown() -> None:
    page = Page(moment=10)

    async def drag() -> None:
        moves = [SimpleNamespace(args=["go", moment]) for moment in range(50, 90)]
        await asyncio.gather(*(page.visitor.hear(move) for move in moves))  # type: ignore[arg-type]

    asyncio.run(drag())
    assert page.at == 89 and len(page.past.made) < 10


def test_of_a_record_that_is_longer_by_now_the_end_is_told_and_the_moment_stays() -> None:
    page = Page(moment=10)
    page.hear("grow")
    assert len(page.client.frames) == 1, "it is as long as it was"
    page.past.ended = 120
    page.hear("grow")
    page.hear("grow")
    assert page.client.frames[1:] == [{"past/span": [0, 120, [20]]}]


def test_the_other_records_can_be_chosen_but_those_of_another_plant_file() -> None:
    own, older = Page(moment=10), Page(moment=10, epoch=7)
    rows = own.client.frames[0]["past/starts"]
    assert [(epoch, shown, possible) for epoch, _, shown, possible in rows] == [
        ("9", False, False),
        (None, True, True),
        ("7", False, True),
    ]
    assert "another plant file" in rows[0][1] and "another" not in rows[2][1]
    assert [shown for _, _, shown, _ in older.client.frames[0]["past/starts"]] == [False, False, True]


STRANGE = [(), ("go", "x"), ("go", 2**60), ("step", 7, ""), ("task", {"a": 1}), ("__class__",), (["go"], 1)]


@pytest.mark.parametrize("what", STRANGE, ids=str)
def test_what_no_button_sends_shows_nothing(what: tuple[Any, ...]) -> None:
    page = Page(moment=10)
    page.hear(*what)
    assert len(page.client.frames) == 1


def test_a_record_that_cannot_be_read_is_a_sentence() -> None:
    page = Page(moment=10)

    def unreadable(*_: Any) -> Any:
        raise NoRecord("it is gone")

    page.past.face = unreadable  # type: ignore[method-assign]
    page.hear("go", 20)
    assert page.client.said == ["it is gone"]
    page.past.face = FakePast.face.__get__(page.past)  # type: ignore[method-assign]
    page.hear("go", 30)
    assert page.at == 30
