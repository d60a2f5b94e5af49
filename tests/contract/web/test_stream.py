"""The stream of changes over a real connection."""

from __future__ import annotations

import json
import select
import socket
from collections.abc import Iterator
from contextlib import contextmanager

import httpx
import pytest
from tests.patience import PATIENCE_MS, PATIENCE_S
from tests.web_plant import TASK, VIEW, Plant

from arboleda.web import server

from .conftest import Web


class Listener:
    """Reads one stream."""

    def __init__(self, answer: httpx.Response) -> None:
        self.answer = answer
        self._lines = answer.iter_lines()

    def block(self) -> list[str]:
        """The lines up to the next empty one."""
        return list(iter(lambda: next(self._lines), ""))

    def event(self) -> tuple[str, str, dict]:
        """(id, kind, row) of the next event."""
        fields = dict(line.split(": ", 1) for line in self.block())
        return fields["id"], fields["event"], json.loads(fields["data"])


@contextmanager
def listening(client: httpx.Client, **headers: str) -> Iterator[Listener]:
    with client.stream("GET", "/api/events", headers=headers, timeout=PATIENCE_S) as answer:
        assert answer.status_code == 200
        assert answer.headers["content-type"].startswith("text/event-stream")
        yield Listener(answer)


def task(state: str) -> list[dict]:
    return [TASK | {"state": state}]


def test_who_comes_back_hears_what_it_missed(web: httpx.Client, plant: Plant) -> None:
    with listening(web) as listener:
        assert listener.event() == ("7-0", "snapshot", VIEW)
        plant.becomes(tasks=task("running"))
        last, kind, row = listener.event()
        assert (last, kind, row["state"]) == ("7-1", "task", "running")
        plant.becomes(tasks=task("done"))
        missed = listener.event()
    with listening(web, **{"last-event-id": last}) as listener:
        assert listener.event() == missed


def test_streams_are_limited_in_number(serve) -> None:
    web = serve(streams=1).client()
    with listening(web) as listener:
        listener.event()
        answer = web.get("/api/events")
        assert (answer.status_code, answer.json()["sentence"]) == (
            503,
            "No more than 1 may listen at a time; close one.",
        )


def test_the_server_ends_with_a_stream_open(serve) -> None:
    with listening(serve().client()) as listener:
        assert listener.event()[1] == "snapshot"


def cut_off(talk: socket.socket) -> bool:
    """Whether the server breaks the connection off; reads nothing."""
    poll = select.poll()
    poll.register(talk, 0)
    return any(events & select.POLLHUP for _, events in poll.poll(PATIENCE_MS))


def test_a_reader_that_never_reads_is_cut_off_and_others_hear_everything(
    local: Web, plant: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "UNREAD_S", 0.3)
    asked = f"GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:{local.port}\r\n\r\n".encode()
    with socket.socket() as deaf, listening(local.client()) as listener:
        deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        deaf.connect(("127.0.0.1", local.port))
        deaf.sendall(asked)
        listener.event()
        for number in range(400):
            plant.becomes(tasks=[TASK | {"state": "failed", "sentence": f"{number} " + "x" * 20_000}])
            assert listener.event()[2]["sentence"].startswith(f"{number} ")
        assert cut_off(deaf)
        plant.becomes(tasks=task("done"))
        assert listener.event()[2]["state"] == "done"
