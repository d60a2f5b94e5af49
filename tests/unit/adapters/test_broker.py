"""Whom the plant's own broker is opened to, before it listens."""

from __future__ import annotations

import errno
import os

import pytest

from arboleda.adapters import descriptors
from arboleda.adapters.broker import EmbeddedBroker
from arboleda.model.errors import StartError

USERS = {"ra_1": "one"}


@pytest.mark.parametrize("host", ["0.0.0.0", "192.0.2.1", "example.org", "::"])
def test_other_machines_are_let_in_only_with_users(host: str) -> None:
    with pytest.raises(StartError, match="give it a user and a password"):
        EmbeddedBroker(host, 0).start()


@pytest.mark.parametrize("users", [{"arboleda": "x"}, {"ra_1": ""}, {"": "x"}])
def test_useless_users_are_refused(users: dict[str, str]) -> None:
    with pytest.raises(StartError):
        EmbeddedBroker(port=0, users=users).start()


@pytest.mark.parametrize(
    ("trouble", "sentence"),
    [(errno.EADDRNOTAVAIL, "Cannot assign requested address"), (errno.EADDRINUSE, "the port is taken")],
)
def test_where_it_cannot_listen_is_one_sentence(
    monkeypatch: pytest.MonkeyPatch, trouble: int, sentence: str
) -> None:
    def listener(host: str, port: int) -> None:
        raise OSError(trouble, os.strerror(trouble))

    monkeypatch.setattr(descriptors, "listener", listener)
    broker = EmbeddedBroker("192.0.2.1", 5, users=USERS)
    broker.stop()  # before its start there is nothing to stop
    with pytest.raises(StartError) as refused:
        broker.start()
    assert str(refused.value) == f"The broker cannot listen on 192.0.2.1:5: {sentence}."


def test_the_plants_password_is_new_at_each_start_and_not_shown() -> None:
    first, second = (EmbeddedBroker(users=USERS).credentials for _ in range(2))
    assert first.password != second.password
    assert first.password not in repr(first)
