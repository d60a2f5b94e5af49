"""What a page is answered when somebody acts on it."""

from __future__ import annotations

import asyncio
import json
import re
from concurrent.futures import Future
from types import SimpleNamespace
from typing import Any

import pytest

from arboleda.dashboard import desk
from arboleda.dashboard.desk import Desk
from arboleda.dashboard.feed import Feed
from arboleda.dashboard.wording import words
from arboleda.model.messages import OperatorAnswer, Outcome, Verb
from arboleda.model.sentence import OWN
from arboleda.model.verbs import Arguments
from arboleda.web.access.auth import Role

WHY = OWN(text="jaw: it is stuck")


class Browser:
    """A page of an operator; `shown` has its answers and whether each was good."""

    has_socket_connection = True

    def __init__(self) -> None:
        self.environ = {"asgi.scope": {"arboleda.role": Role.OPERATOR}}
        self.shown: list[tuple[str, bool | None]] = []

    def run_javascript(self, code: str) -> None:
        found = re.fullmatch(r"arboleda\.answer\((.*), (true|false|null)\)", code)
        assert found is not None, code
        self.shown.append((json.loads(found[1]), json.loads(found[2])))


class Plant:
    """A plant that answers an act so; `rows` are what it says of it later, one after the other."""

    def __init__(self, rows: list[Any] | None = None, **told: Any) -> None:
        self.told, self.rows = told, rows or []
        self.heard: list[tuple[Any, ...]] = []

    def operate(
        self, verb: Verb, scope: str, *, by_hand: bool = False, arguments: Arguments = ()
    ) -> Future[OperatorAnswer]:
        self.heard.append((verb, scope, by_hand, *arguments))
        answer: Future[OperatorAnswer] = Future()
        answer.set_result(OperatorAnswer(verb=verb, scope=scope, **self.told))
        return answer

    def act(self, number: int) -> Any:
        return self.rows.pop(0)


def shown(
    plant: Plant, *, act: str = "release", of: str = "jaw", more: object = False
) -> list[tuple[str, bool | None]]:
    browser = Browser()
    its: Any = Desk(browser, plant, Feed(plant), words("en"))  # type: ignore[arg-type]
    asyncio.run(its.take(act, of, more))
    return browser.shown


def row(outcome: Outcome, why: Any = None) -> dict[str, Any]:
    return {"outcome": outcome.value, "why": why}


@pytest.fixture(autouse=True)
def _at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(desk, "LOOK_S", 0.0)


def test_what_devices_do_is_under_way_and_then_failed() -> None:
    plant = Plant([row(Outcome.UNDER_WAY), row(Outcome.FAILED, WHY)], act=7, outcome=Outcome.UNDER_WAY)
    assert shown(plant) == [
        ("Under way: Release part, jaw.", None),
        ("Failed: Release part, jaw: jaw: it is stuck.", False),
    ]


def test_what_devices_have_done_is_told_as_done_then() -> None:
    plant = Plant([row(Outcome.DONE)], act=7, outcome=Outcome.UNDER_WAY)
    assert shown(plant)[-1] == ("Done: Release part, jaw.", True)


def test_an_act_that_the_plant_has_forgotten_is_followed_no_more() -> None:
    assert len(shown(Plant([None], act=7, outcome=Outcome.UNDER_WAY))) == 1


def test_what_was_done_by_hand_is_called_so() -> None:
    plant = Plant(act=7, outcome=Outcome.DONE)
    assert shown(plant, more=True) == [("Done: Part taken out by hand, jaw.", True)]
    assert plant.heard == [(Verb.RELEASE, "jaw", True)]


def test_an_answer_goes_to_its_question_and_is_told_without_the_id() -> None:
    plant = Plant(act=7, outcome=Outcome.DONE)
    told = {"question": "1000-12", "answer": "yes"}
    assert shown(plant, act="answer", of="ana", more=told) == [("Done: Answer, ana yes.", True)]
    assert plant.heard == [(Verb.ANSWER, "ana", False, ("question", "1000-12"), ("answer", "yes"))]


@pytest.mark.parametrize("more", [{"station": "7"}, {"answer": "yes"}, ["station", 7], "7", None])
def test_what_is_no_argument_of_a_verb_does_not_reach_the_plant(more: object) -> None:
    plant = Plant(act=7, outcome=Outcome.DONE)
    shown(plant, act="unload", of="sis_a", more=more)
    assert plant.heard == [(Verb.UNLOAD, "sis_a", False)]


def test_a_refusal_says_why() -> None:
    assert shown(Plant(refusal=WHY)) == [("jaw: it is stuck", False)]


@pytest.mark.parametrize("act", ["explode", "__class__", "orders.nope"])
def test_an_act_that_the_page_does_not_have_is_refused(act: str) -> None:
    browser, plant = Browser(), Plant()
    its: Any = Desk(browser, plant, Feed(plant), words("en"))  # type: ignore[arg-type]
    asyncio.run(its.take(act, "sis_a", False))
    assert browser.shown == [(f"There is no act {act} on this page.", False)]


@pytest.mark.parametrize(
    "event",
    [
        [],
        ["stop"],
        ["submit", 7],
        ["submit", {"a": 1}],
        ["seen", 1e99],
        [["stop"], "x"],
        [None, None, None, None],
        ["submit", "x" * 10_000],
        "stop",
        None,
    ],
    ids=lambda event: str(event)[:20],
)
def test_events_that_no_button_sends_do_nothing(event: object) -> None:
    browser, plant = Browser(), Plant()
    its: Any = Desk(browser, plant, Feed(plant), words("en"))  # type: ignore[arg-type]
    asyncio.run(its.hear(SimpleNamespace(args=event)))
    assert (browser.shown, plant.heard) == ([], [])
