"""What is posted to a hook, and what is said where it was not taken."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import httpx
import pytest

from arboleda.adapters import webhook
from arboleda.adapters.webhook import DeliveryRefused, Hook, NotDelivered, Webhook

ALARM = {"id": "lab-1-1", "sentence": "sis_a is held", "dropped": 0}
Answer = Callable[[httpx.Request], httpx.Response]


@pytest.fixture
def post(monkeypatch: pytest.MonkeyPatch) -> Callable[[Answer], None]:
    """Post an alarm to a server that answers so."""
    client = httpx.Client

    def post(answer: Answer) -> None:
        monkeypatch.setattr(httpx, "Client", partial(client, transport=httpx.MockTransport(answer)))
        posting = Webhook(Hook(url="http://alarms.lab/hooks/SECRET", token="T0KEN"), timeout_s=0.5)
        try:
            posting.post(ALARM)
        finally:
            posting.close()

    return post


def test_an_alarm_is_posted_as_json_with_its_token(post: Callable[[Answer], None]) -> None:
    posted: list[httpx.Request] = []

    def takes(request: httpx.Request) -> httpx.Response:
        posted.append(request)
        return httpx.Response(204)

    post(takes)
    (request,) = posted
    assert (request.method, request.url.path) == ("POST", "/hooks/SECRET")
    assert request.headers["Authorization"] == "Bearer T0KEN"
    assert request.headers["Content-Type"] == "application/json"
    assert httpx.Response(200, content=request.content).json() == ALARM


@pytest.mark.parametrize(
    ("status", "error", "why"),
    [
        (422, DeliveryRefused, "it answers 422"),
        (500, NotDelivered, "it answers 500"),
        (403, NotDelivered, f"it answers 403: see ${webhook.TOKEN}"),
        (301, NotDelivered, f"it answers 301: name the address that it leads to in ${webhook.URL}"),
    ],
)
def test_an_answer_that_is_no_yes_says_what_to_do(
    post: Callable[[Answer], None], status: int, error: type[Exception], why: str
) -> None:
    with pytest.raises(error) as said:
        post(lambda request: httpx.Response(status))
    assert str(said.value) == why


@pytest.mark.parametrize(
    ("trouble", "why"),
    [
        (httpx.ReadTimeout("slow"), "no answer within 0.5 s"),
        (httpx.ConnectError("[Errno 111] Connection refused"), "[Errno 111] Connection refused"),
        (OSError(), "OSError"),
    ],
)
def test_who_does_not_answer_or_is_not_there_is_told_of_in_words(
    post: Callable[[Answer], None], trouble: Exception, why: str
) -> None:
    def fails(request: httpx.Request) -> httpx.Response:
        raise trouble

    with pytest.raises(NotDelivered) as said:
        post(fails)
    assert str(said.value) == why
