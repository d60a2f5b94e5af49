"""The line to a plant: which address it asks, whom it follows, what it asks again. Time is moved by hand."""

from __future__ import annotations

import json
from collections.abc import AsyncGenerator, Sequence
from contextlib import asynccontextmanager
from itertools import islice
from typing import Any

import pytest

from arboleda.client.calls import Blocking
from arboleda.client.errors import (
    Conflict,
    Later,
    NoAnswer,
    OtherPlant,
    StillRunning,
    Unauthorized,
    WrongRequest,
)
from arboleda.client.http import HttpRequest, Reply, Stream, at_once, each_at_once
from arboleda.client.line import Call, Line
from arboleda.client.methods import Tasks, Verbs

A, B, C = "http://a:8080", "http://b:8080", "http://c:8080"
GONE = NoAnswer("No answer.", may_have_heard=False)
CUT = NoAnswer("It broke off.", may_have_heard=True)
LOOK = Call(method="GET", path="/api/tasks", is_repeatable=True)
HOME = Call(method="POST", path="/api/cells/sis_a/home")


def answer(data: Any, status: int = 200, **headers: str) -> Reply:
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    return Reply(status=status, headers=named, text=json.dumps(data))


def standby(leader: str, status: int = 307) -> Reply:
    said = {"plant": "demo", "standby": True, "sentence": "waits for b", "leader": leader, "host": "b"}
    return answer(said, status)


class Scripted:
    """Http whose addresses answer what was prepared for them, the last of it again and again."""

    def __init__(self, **answers: Sequence[Reply | NoAnswer]) -> None:
        self.answers = {f"http://{name}:8080": list(each) for name, each in answers.items()}
        self.streams: dict[str, list[list[str] | Reply | NoAnswer]] = {}
        self.asked: list[HttpRequest] = []
        self.now = 100.0

    def clock(self) -> float:
        return self.now

    async def ask(self, request: HttpRequest) -> Reply:
        return self._next(request, self.answers)

    @asynccontextmanager
    async def stream(self, request: HttpRequest) -> AsyncGenerator[Stream, None]:
        found = self._next(request, self.streams)
        good = not isinstance(found, Reply)
        reply = Reply(status=200, headers={}) if good else found
        yield Stream(reply=reply, lines=self._lines(found if good else []))

    async def sleep(self, seconds: float) -> None:
        self.now += seconds

    async def close(self) -> None:
        pass

    @property
    def urls(self) -> list[str]:
        return [request.url.partition("/api")[0] for request in self.asked]

    def _next(self, request: HttpRequest, answers: dict[str, Any]) -> Any:
        self.asked.append(request)
        waiting = answers.get(self.urls[-1]) or [GONE]
        found = waiting.pop(0) if len(waiting) > 1 else waiting[0]
        if isinstance(found, NoAnswer):
            raise found
        return found

    async def _lines(self, lines: list[str]) -> AsyncGenerator[str, None]:
        for line in lines:
            yield line
        raise CUT


def line(http: Scripted, *addresses: str, patience_s: float = 2.0, **options: Any) -> Line:
    options = {"tokens": {}, **options}
    return Line(http, addresses, clock=http.clock, patience_s=patience_s, **options)


def test_a_look_is_repeated_until_a_plant_is_there() -> None:
    http = Scripted(a=[GONE, CUT, answer(["t-1"])])
    assert at_once(line(http, A).data(LOOK)) == ["t-1"]
    assert len(http.asked) == 3


def test_patience_ends_with_the_reason() -> None:
    http = Scripted(a=[GONE])
    with pytest.raises(NoAnswer, match="No answer"):
        at_once(line(http, A).data(LOOK))
    assert 102.0 <= http.now < 103.0


def test_a_verb_goes_to_whoever_is_there_and_is_never_asked_later() -> None:
    http = Scripted(a=[GONE], b=[answer({"verb": "home"})])
    assert at_once(line(http, A, B).data(HOME)) == {"verb": "home"}
    alone = Scripted(a=[GONE, answer({"verb": "home"})])
    with pytest.raises(NoAnswer):
        at_once(line(alone, A).data(HOME))
    assert len(alone.asked) == 1 and alone.now == 100.0


def test_a_verb_that_may_have_been_heard_is_asked_nobody_else() -> None:
    http = Scripted(a=[CUT], b=[answer({})])
    with pytest.raises(NoAnswer) as silent:
        at_once(line(http, A, B).data(HOME))
    assert silent.value.may_have_heard and http.urls == [A]


def test_who_stands_by_leads_on_to_the_leader_who_is_asked_first_from_then_on() -> None:
    http = Scripted(a=[standby(C)], c=[answer(["t-1"])])
    there = line(http, A, B)
    assert at_once(there.data(LOOK)) == at_once(there.data(LOOK)) == ["t-1"]
    assert http.urls == [A, C, C]
    assert [request.headers.get("arboleda-plant") for request in http.asked] == [None, "demo", "demo"]


def test_a_standby_that_says_so_in_a_good_answer_is_followed_too() -> None:
    http = Scripted(a=[standby(B, 200)], b=[answer(["t-1"])])
    assert at_once(line(http, A).data(LOOK)) == ["t-1"]


def test_where_all_stand_by_nothing_goes_round_and_its_own_words_are_the_reason() -> None:
    http = Scripted(a=[standby(B)], b=[standby(A)])
    with pytest.raises(NoAnswer, match="stands by: it waits for b"):
        at_once(line(http, A, patience_s=0.0).data(LOOK))
    assert http.urls == [A, B]


@pytest.mark.parametrize(
    ("asked", "leader"),
    [("https://a:8080", "http://b:8080"), (A, "http://127.0.0.1:8080"), (A, "file:///etc"), (A, "ftp://b")],
)
def test_a_leader_that_is_less_safe_or_of_another_host_is_not_followed(asked: str, leader: str) -> None:
    http = Scripted()
    http.answers[asked] = [standby(leader)]
    with pytest.raises(NoAnswer, match="cannot be used from here"):
        at_once(line(http, asked, patience_s=0.0, tokens={"": "secret"}).data(LOOK))
    assert http.urls == [asked]


def test_a_token_is_shown_where_it_belongs_to() -> None:
    http = Scripted(a=[standby(B)], b=[answer([])])
    at_once(line(http, A, tokens={A: "one", f"{B}/": "two"}).data(LOOK))
    assert [request.headers["authorization"] for request in http.asked] == ["Bearer one", "Bearer two"]
    strange = Scripted(a=[standby(C)], c=[answer([])])
    at_once(line(strange, A, tokens={A: "one"}).data(LOOK))
    assert "authorization" not in strange.asked[-1].headers


@pytest.mark.parametrize(
    ("reply", "error"),
    [
        (answer({"sentence": "No."}, 409), Conflict),
        (answer({"sentence": "No."}, 401), Unauthorized),
        (answer({"sentence": "No."}, 422), WrongRequest),
        (answer({"sentence": "No."}, 503, retry_after="10"), Later),
    ],
)
def test_a_refusal_is_an_error_with_its_sentence_and_is_not_repeated(reply: Reply, error: type) -> None:
    http = Scripted(a=[reply])
    with pytest.raises(error, match=r"^No\.$") as refused:
        at_once(line(http, A).data(LOOK))
    assert refused.value.status == reply.status and len(http.asked) == 1
    assert refused.value.retry_after_s == (10.0 if error is Later else None)


def test_another_plant_at_one_address_leaves_the_next_one() -> None:
    http = Scripted(a=[answer({"sentence": "This is x."}, 421)], b=[answer([])])
    assert at_once(line(http, A, B, plant="demo").data(LOOK)) == []
    with pytest.raises(OtherPlant, match="This is x"):
        at_once(line(Scripted(a=http.answers[A]), A, plant="demo").data(LOOK))


@pytest.mark.parametrize("reply", [answer("<html>", 500), answer({"detail": "no"}, 404)])
def test_what_no_plant_would_say_is_no_answer(reply: Reply) -> None:
    with pytest.raises(NoAnswer, match="no plant"):
        at_once(line(Scripted(a=[reply]), A, patience_s=0.0).data(LOOK))


def changes(*numbers: int) -> list[str]:
    rows = [
        [f"id: 7-{each}", "event: task", f'data: {{"id": "t-{each}"}}', "", ": still here"]
        for each in numbers
    ]
    return [line for row in rows for line in row]


def test_events_go_on_after_a_cut_with_the_one_after_the_last() -> None:
    http = Scripted()
    http.streams = {A: [changes(1, 2), GONE, changes(3), GONE]}
    stream = each_at_once(line(http, A).events())
    found = [(event.id, event.kind, event.row["id"]) for event in islice(stream, 3)]
    with pytest.raises(NoAnswer):
        next(stream)
    assert found == [("7-1", "task", "t-1"), ("7-2", "task", "t-2"), ("7-3", "task", "t-3")]
    last = [request.headers.get("last-event-id") for request in http.asked]
    assert last[:3] == [None, "7-2", "7-2"] and set(last[3:]) == {"7-3"}


def test_events_come_from_the_next_leader_once_the_first_is_gone() -> None:
    http = Scripted()
    http.streams = {A: [changes(1), GONE], B: [standby(A), changes(2), GONE]}
    stream = each_at_once(line(http, A, B).events())
    assert [next(stream).id, next(stream).id] == ["7-1", "7-2"]


def test_a_task_that_is_submitted_without_an_id_gets_one_and_is_one_however_often_it_is_sent() -> None:
    task = {"id": "c-1", "text": "sis_a 0B 7", "cell": "sis_a", "state": "queued"}
    http = Scripted(a=[CUT, CUT, answer(task, 202)])

    class Client(Blocking, Tasks):
        pass

    Client(line(http, A)).submit("sis_a 0B 7")
    texts = {request.body["text"] for request in http.asked if request.body}
    assert len(http.asked) == 3 and len(texts) == 1
    assert texts.pop().startswith("sis_a 0B 7 #c-")


def test_a_stop_is_told_the_next_address_soon_and_again_until_it_is_answered() -> None:
    http = Scripted(a=[CUT], b=[GONE, answer({"verb": "stop", "scope": ""})])

    class Client(Blocking, Verbs):
        pass

    assert Client(line(http, A, B)).stop().verb == "stop"
    assert http.urls == [A, B, A, B] and {request.within_s for request in http.asked} == {2.5}


def test_a_task_that_ended_under_the_leader_before_is_found_in_the_history() -> None:
    kept = {
        "number": 1,
        "id": "lot",
        "text": "x",
        "cell": "a",
        "recipe": "r",
        "state": "done",
        "accepted_s": 1.0,
    }
    http = Scripted(a=[answer({"sentence": "It knows none."}, 404), answer([kept])])
    http.streams = {A: [["id: 8-0", "event: snapshot", 'data: {"tasks": []}']]}

    class Client(Blocking, Tasks):
        pass

    assert Client(line(http, A)).wait("lot").state == "done"
    assert http.asked[-1].url == f"{A}/api/history?words=lot"


def test_who_waits_too_short_is_told_how_the_task_stands() -> None:
    task = {"id": "lot", "text": "x", "cell": "a", "state": "running", "sentence": ""}
    http = Scripted(a=[answer(task)])
    http.streams = {A: [["id: 8-0", "event: snapshot", 'data: {"tasks": []}']]}

    class Client(Blocking, Tasks):
        pass

    with pytest.raises(StillRunning, match="#lot has not ended yet, it is running") as still:
        Client(line(http, A)).wait("lot", within_s=1.5)
    assert still.value.task.id == "lot" and 101.5 <= http.now < 102.0


def test_a_task_is_followed_to_its_end_by_the_events() -> None:
    task = {"id": "t-1", "text": "x", "cell": "a", "sentence": ""}
    states = ["queued", "running", "done"]
    http = Scripted(a=[answer(task | {"state": each}) for each in states])
    http.streams = {A: [["id: 7-0", "event: snapshot", 'data: {"tasks": []}', *changes(1, 2)]]}

    class Client(Blocking, Tasks):
        pass

    assert [each.state for each in Client(line(http, A)).follow("t-1")] == states
